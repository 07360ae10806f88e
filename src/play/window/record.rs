//! Pictures of the window: every frame into a folder, or one on a key.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, Sender, channel};

use bevy::prelude::*;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};

use crate::picture_file::png;
use crate::play::hud::notice::Notice;
use crate::play::picture::snapshot::snapshot;
use crate::play::picture::stage_loading::CurrentStage;
use crate::play::window::pictures::{folders, save_new, stem};
use crate::sim::snapshot::Snapshot;
use crate::user_file::write_whole;

/// Writes frames, and closes the window after so many.
pub struct RecordPlugin {
    /// Where every frame goes, if anywhere.
    pub folder: Option<PathBuf>,
    /// Frames after which the window closes, if it does.
    pub frames: Option<u32>,
}

#[derive(Resource, Clone, Debug)]
struct VideoRecording {
    folder: Option<PathBuf>,
    frames: Option<u32>,
    drawn: u32,
}

/// A picture's file and, in words, what of its moment it does not carry; or why it could not be written.
type Written = Result<(PathBuf, Option<&'static str>), String>;

/// The key has asked for a picture of this frame: it is taken when the frame's camera is chosen.
#[derive(Resource, Default)]
struct Wanted(bool);

/// What became of the pictures that were asked for by the key, from the threads that write them.
#[derive(Resource)]
struct News {
    sender: Sender<Written>,
    receiver: Mutex<Receiver<Written>>,
}

impl Plugin for RecordPlugin {
    fn build(&self, app: &mut App) {
        let (sender, receiver) = channel();
        app.insert_resource(VideoRecording { folder: self.folder.clone(), frames: self.frames, drawn: 0 })
            .insert_resource(News { sender, receiver: Mutex::new(receiver) })
            .init_resource::<Wanted>()
            .add_systems(Update, notify)
            .add_systems(Last, (take_wanted, record.run_if(resource_exists::<CurrentStage>)).chain());
    }
}

/// How long the player reads where the picture is, in seconds of wall time.
const SHOWN: f64 = 4.0;

/// Says, on the screen and in the log, where a picture is or why there is none.
fn notify(news: Res<News>, real: Res<Time<Real>>, mut notice: ResMut<Notice>) {
    let Ok(receiver) = news.receiver.lock() else { return };
    for result in receiver.try_iter() {
        let text = match &result {
            Ok((path, None)) => format!("picture written to {}", path.display()),
            Ok((path, Some(why))) => format!("picture written to {}, without its moment: {why}", path.display()),
            Err(error) => format!("the picture cannot be written: {error}"),
        };
        if result.is_ok() {
            info!("{text}")
        } else {
            warn!("{text}")
        }
        *notice = Notice { text, until: real.elapsed_secs_f64() + SHOWN, share: None };
    }
}

/// Frames at the start whose picture is not ready yet: the window's surface and the pipelines are being made.
const WARM_UP: u32 = 3;

pub(super) fn record(world: &mut World) {
    let mut recording = world.resource_mut::<VideoRecording>();
    recording.drawn += 1;
    let Some(index) = recording.drawn.checked_sub(WARM_UP) else { return };
    if recording.frames.is_some_and(|frames| index > frames) {
        world.write_message(AppExit::Success);
        return;
    }
    if let Some(folder) = recording.folder.clone() {
        let path = folder.join("frames").join(format!("frame-{index:05}.png"));
        take(world, move |image, moment| {
            if let Err(error) = encoded(image, moment.ok()).and_then(|png| write(&path, &png)) {
                eprintln!("warning: cannot write {}: {error}", path.display());
            }
        });
    }
}

/// Has the window's picture of this frame written to the player's folder of pictures, and says so. Where every frame is written this one
/// is among them, and a window gives one picture a frame.
pub fn screenshot(world: &mut World) {
    let until = world.get_resource::<Time<Real>>().map_or(0.0, |real| real.elapsed_secs_f64()) + SHOWN;
    let Some(mut notice) = world.get_resource_mut::<Notice>() else { return };
    // What was said last is not to be in the picture.
    *notice = Notice::default();
    if let Some(folder) = world.get_resource::<VideoRecording>().and_then(|recording| recording.folder.clone()) {
        let text = format!("every frame is written to {}", folder.join("frames").display());
        world.insert_resource(Notice { text, until, share: None });
        return;
    }
    world.insert_resource(Wanted(true));
}

/// Takes the picture that was asked for.
fn take_wanted(world: &mut World) {
    if !std::mem::take(&mut world.resource_mut::<Wanted>().0) {
        return;
    }
    let sender = world.resource::<News>().sender.clone();
    let stem = stem(web_time::SystemTime::now());
    take(world, move |image, moment| {
        let without = moment.as_ref().err().copied();
        let saved = encoded(image, moment.ok()).and_then(|png| save_new(&folders(), &stem, "png", &png).map_err(|error| error.to_string()));
        // After the game's end nobody listens.
        _ = sender.send(saved.map(|path| (path, without)));
    });
}

/// Takes a picture of the window and its moment; `done` gets them, in a thread of its own where there are threads.
fn take(world: &mut World, done: impl Fn(Image, Result<Snapshot, &'static str>) + Clone + Send + Sync + 'static) {
    let moment = snapshot(world);
    world.spawn(Screenshot::primary_window()).observe(move |captured: On<ScreenshotCaptured>| {
        let (image, moment, done) = (captured.image.clone(), moment.clone(), done.clone());
        if cfg!(target_family = "wasm") {
            done(image, moment);
        } else {
            std::thread::spawn(move || done(image, moment));
        }
    });
}

/// The bytes of a PNG of the image, with its moment.
fn encoded(image: Image, moment: Option<Snapshot>) -> Result<Vec<u8>, String> {
    let picture = image.try_into_dynamic().map_err(|error| error.to_string())?.to_rgb8();
    let size = [picture.width(), picture.height()];
    // The window may have changed its size since.
    let text = moment.map(|moment| moment.resized(size).to_text());
    png(picture.as_raw(), size, true, text.as_deref())
}

fn write(path: &Path, png: &[u8]) -> Result<(), String> {
    write_whole(path, png).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_player_is_told_where_the_picture_is() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, RecordPlugin { folder: None, frames: None })).init_resource::<Notice>();
        app.update();
        assert_eq!(app.world().resource::<Notice>().text, "");
        for (result, said) in [
            (Ok(("out/a.png".into(), None)), "picture written to out/a.png"),
            (Ok(("out/a.png".into(), Some("it is late"))), "out/a.png, without its moment: it is late"),
            (Err("no room".to_owned()), "no room"),
        ] {
            app.world().resource::<News>().sender.send(result).expect("somebody listens");
            app.update();
            let notice = app.world().resource::<Notice>();
            assert!(notice.text.contains(said) && notice.until > 1.0, "{notice:?}");
        }
    }

    #[test]
    fn the_last_message_is_not_in_the_picture() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, RecordPlugin { folder: None, frames: None }));
        app.insert_resource(Notice { text: "picture written".into(), until: 9.0, share: None });
        screenshot(app.world_mut());
        assert_eq!(app.world().resource::<Notice>().text, "");
        // Where every frame is written, the player is told so instead.
        app.world_mut().resource_mut::<VideoRecording>().folder = Some("film".into());
        screenshot(app.world_mut());
        assert!(app.world().resource::<Notice>().text.contains("film"));
    }
}
