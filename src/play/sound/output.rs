//! The mix on the loudspeakers. Where there are none, or the game was built without the feature `sound`, it is silent without a word. In a
//! page the browser's own thread for sound makes it ([`sent`](super::sent)).

#[cfg(all(not(target_family = "wasm"), any(feature = "sound", test)))]
use std::path::Path;
use std::sync::{Arc, Mutex};

use crate::play::sound::heard::Heard;
use crate::play::sound::volumes::Volumes;

/// What is to be heard, and how loud.
pub type Wanted = Arc<Mutex<(Heard, Volumes)>>;

/// This is to be heard from now on.
pub fn hear(wanted: &Wanted, heard: Heard, volumes: Volumes) {
    #[cfg(target_family = "wasm")]
    crate::page::sound(&super::sent::numbers(&heard, &volumes));
    // It is held for the time of a copy, and by nobody who can fail.
    if let Ok(mut wanted) = wanted.lock() {
        *wanted = (heard, volumes);
    }
}

/// Whether there may be something to play on. On Linux the ALSA library writes complaints to standard error where there is no sound card,
/// so it is not asked then: there must be a card that plays, or a sound server with the ALSA plugin that leads to it. `root` is / but in
/// tests, `runtime` the folder of the user's sockets.
#[cfg(all(not(target_family = "wasm"), any(feature = "sound", test)))]
fn may_play(root: &Path, runtime: Option<&Path>) -> bool {
    if !cfg!(target_os = "linux") {
        return true;
    }
    let names = |folder: &Path| -> Vec<String> {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect()
    };
    // A card's device for playing: pcmC0D0p.
    let has_card = names(&root.join("dev/snd")).iter().any(|name| name.starts_with("pcm") && name.ends_with('p'));
    let serves = runtime.is_some_and(|runtime| runtime.join("pulse/native").exists() || runtime.join("pipewire-0").exists());
    let leads = ["etc/alsa/conf.d", "usr/share/alsa/alsa.conf.d"]
        .iter()
        .flat_map(|folder| names(&root.join(folder)))
        .any(|name| name.contains("pulse") || name.contains("pipewire"));
    has_card || (serves && leads)
}

#[cfg(feature = "sound")]
pub use speakers::open;

/// The page's: it is silent until the player touches something, as browsers want it.
#[cfg(target_family = "wasm")]
pub fn open() -> Option<Wanted> {
    Some(Wanted::default())
}

/// Silence: the game was built without the feature `sound`.
#[cfg(not(any(feature = "sound", target_family = "wasm")))]
pub fn open() -> Option<Wanted> {
    None
}

#[cfg(feature = "sound")]
mod speakers {
    use std::path::{Path, PathBuf};
    use std::sync::{Arc, Mutex, Weak};
    use std::time::Duration;

    use kira::info::Info;
    use kira::sound::{Sound, SoundData};
    use kira::{AudioManager, AudioManagerSettings, DefaultBackend, Frame};

    use super::{Wanted, may_play};
    use crate::play::sound::heard::Heard;
    use crate::play::sound::mixer::{Mixer, RATE};
    use crate::play::sound::volumes::Volumes;

    /// How often the thread that keeps the device open looks whether it is still needed.
    const LOOKS: Duration = Duration::from_millis(200);
    /// Samples made at once.
    const BLOCK: usize = 128;

    /// Opens the device in a thread of its own, so that no frame waits for it. What is to be heard is put into what is returned; the device
    /// is closed when nobody has that any more. None where there is surely no device.
    pub fn open() -> Option<Wanted> {
        let runtime = std::env::var_os("XDG_RUNTIME_DIR").map(PathBuf::from);
        if !may_play(Path::new("/"), runtime.as_deref()) {
            return None;
        }
        let wanted: Wanted = Arc::new(Mutex::new((Heard::default(), Volumes::default())));
        let shared = Arc::downgrade(&wanted);
        let thread = std::thread::Builder::new().name("sound".into()).spawn(move || play(&shared));
        thread.is_ok().then_some(wanted)
    }

    fn play(shared: &Weak<Mutex<(Heard, Volumes)>>) {
        // A device that cannot be opened is silence.
        let Ok(mut manager) = AudioManager::<DefaultBackend>::new(AudioManagerSettings::default()) else { return };
        if manager.play(Live::new(shared.clone())).is_err() {
            return;
        }
        while shared.strong_count() > 0 {
            std::thread::sleep(LOOKS);
        }
    }

    /// The mix as kira plays it: of the numbers that are wanted now, at the device's rate.
    pub(super) struct Live {
        wanted: Weak<Mutex<(Heard, Volumes)>>,
        mixer: Mixer,
        block: [[f32; 2]; BLOCK],
        /// The samples of the mix before and after the place where the device is, and the share of the way between them.
        between: [[f32; 2]; 2],
        share: f64,
        next: usize,
    }

    impl Live {
        pub(super) fn new(wanted: Weak<Mutex<(Heard, Volumes)>>) -> Live {
            Live { wanted, mixer: Mixer::new(RATE), block: [[0.0; 2]; BLOCK], between: [[0.0; 2]; 2], share: 0.0, next: BLOCK }
        }

        fn pull(&mut self) -> [f32; 2] {
            if self.next == BLOCK {
                self.mixer.fill(&mut self.block);
                self.next = 0;
            }
            self.next += 1;
            self.block[self.next - 1]
        }
    }

    impl Sound for Live {
        fn on_start_processing(&mut self) {
            // A frame that is writing now is heard the next time; the device never waits.
            if let Some(wanted) = self.wanted.upgrade()
                && let Ok(now) = wanted.try_lock()
            {
                self.mixer.set(&now.0, &now.1);
            }
        }

        fn process(&mut self, out: &mut [Frame], dt: f64, _: &Info) {
            let step = dt * f64::from(RATE);
            for frame in out {
                // A device at another rate hears straight lines between the samples: voices are far below half the rate.
                self.share += step;
                while self.share >= 1.0 - 1e-9 {
                    self.share -= 1.0;
                    self.between = [self.between[1], self.pull()];
                }
                let share = self.share.max(0.0) as f32;
                let [left, right] =
                    std::array::from_fn(|side| self.between[0][side] + share * (self.between[1][side] - self.between[0][side]));
                *frame = Frame { left, right };
            }
        }

        fn finished(&self) -> bool {
            self.wanted.strong_count() == 0
        }
    }

    impl SoundData for Live {
        type Error = std::convert::Infallible;
        type Handle = ();

        fn into_sound(self) -> Result<(Box<dyn Sound>, ()), Self::Error> {
            Ok((Box::new(self), ()))
        }
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn without_a_card_nothing_is_opened() {
        let root = std::env::temp_dir().join(format!("lensrunner-cards-{}", std::process::id()));
        let runtime = root.join("run");
        let touch = |path: &str| {
            let path = root.join(path);
            fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            fs::write(path, "").expect("written");
        };
        assert!(!may_play(&root, None) && !may_play(&root, Some(&runtime)), "there is nothing at all");
        touch("dev/snd/timer");
        touch("dev/snd/pcmC0D0c");
        assert!(!may_play(&root, None), "a microphone does not play");
        touch("run/pulse/native");
        assert!(!may_play(&root, Some(&runtime)), "nothing leads to the server");
        touch("etc/alsa/conf.d/99-pulse.conf");
        assert!(may_play(&root, Some(&runtime)) && !may_play(&root, None));
        touch("dev/snd/pcmC0D3p");
        assert!(may_play(&root, None));
        fs::remove_dir_all(root).expect("removed");
    }

    /// kira's own renderer plays the mix sample by sample at its rate, and at another as long as it lasts.
    #[cfg(feature = "sound")]
    #[test]
    fn the_loudspeakers_get_the_mix() {
        use super::speakers::Live;
        use crate::play::sound::mixer::{Mixer, RATE};
        use kira::Frame;
        use kira::info::MockInfoBuilder;
        use kira::sound::Sound;
        let heard = Heard { engine: 0.7, ..Heard::MUSIC };
        let wanted: Wanted = Arc::new(Mutex::new((heard, Volumes::default())));
        let info = MockInfoBuilder::new().build();
        let played = |rate: f64, count: usize| {
            let mut live = Live::new(Arc::downgrade(&wanted));
            live.on_start_processing();
            let mut out = vec![Frame::ZERO; count];
            out.chunks_mut(100).for_each(|chunk| live.process(chunk, 1.0 / rate, &info));
            out
        };
        let mut mixer = Mixer::new(RATE);
        mixer.set(&heard, &Volumes::default());
        let mut mix = vec![[0.0; 2]; 6000];
        mixer.fill(&mut mix);
        let same = played(f64::from(RATE), 6000);
        // Two samples wait between which others would be.
        assert!(same[1..].iter().zip(&mix).all(|(frame, sample)| [frame.left, frame.right] == *sample));
        let loud = |samples: &mut dyn Iterator<Item = f32>| samples.map(|x| f64::from(x * x)).sum::<f64>();
        let (fast, slow) = (loud(&mut same.iter().map(|f| f.left)), loud(&mut played(44_100.0, 5512).iter().map(|f| f.left)));
        assert!((slow / fast * 6000.0 / 5512.0 - 1.0).abs() < 0.03, "{slow} {fast}");
    }
}
