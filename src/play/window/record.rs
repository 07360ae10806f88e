//! Pictures of the window: every frame into a folder, or one on a key.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, Sender, channel};

use bevy::prelude::*;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};

use crate::play::demonstration::write_png;
use crate::play::hud::notice::Notice;
use crate::play::picture::Staged;

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

/// A picture's file, and why it could not be written, if it could not.
type Written = (PathBuf, Result<(), String>);

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
            .add_systems(Update, tell)
            .add_systems(Last, record.run_if(resource_exists::<Staged>));
    }
}

/// How long the player reads where the picture is, in seconds of wall time.
const SHOWN: f64 = 4.0;

/// Says, on the screen and in the log, where a picture is or why there is none.
fn tell(news: Res<News>, real: Res<Time<Real>>, mut notice: ResMut<Notice>) {
    let Ok(receiver) = news.receiver.lock() else { return };
    for (path, result) in receiver.try_iter() {
        let text = match &result {
            Ok(()) => format!("picture written to {}", path.display()),
            Err(error) => format!("the picture cannot be written to {}: {error}", path.display()),
        };
        if result.is_ok() {
            info!("{text}")
        } else {
            warn!("{text}")
        }
        *notice = Notice { text, until: real.elapsed_secs_f64() + SHOWN };
    }
}

/// Frames at the start whose picture is not ready yet: the window's surface and the pipelines are being made.
const WARM_UP: u32 = 3;

fn record(mut recording: ResMut<VideoRecording>, mut commands: Commands, mut exit: MessageWriter<AppExit>) {
    recording.drawn += 1;
    let Some(index) = recording.drawn.checked_sub(WARM_UP) else { return };
    if recording.frames.is_some_and(|frames| index > frames) {
        exit.write(AppExit::Success);
        return;
    }
    if let Some(folder) = &recording.folder {
        let path = folder.join("frames").join(format!("frame-{index:05}.png"));
        take(&mut commands, path, |path, result| {
            if let Err(error) = result {
                eprintln!("warning: cannot write {}: {error}", path.display());
            }
        });
    }
}

/// Writes the window's picture to `out/` and says so. Where every frame is written this one is among them, and a window gives one picture a
/// frame.
pub fn screenshot(world: &mut World) {
    let until = world.get_resource::<Time<Real>>().map_or(0.0, |real| real.elapsed_secs_f64()) + SHOWN;
    let Some(mut notice) = world.get_resource_mut::<Notice>() else { return };
    // What was said last is not to be in the picture.
    *notice = Notice::default();
    if let Some(folder) = world.get_resource::<VideoRecording>().and_then(|recording| recording.folder.clone()) {
        let text = format!("every frame is written to {}", folder.join("frames").display());
        world.insert_resource(Notice { text, until });
        return;
    }
    let Some(sender) = world.get_resource::<News>().map(|news| news.sender.clone()) else { return };
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap_or_default().as_millis();
    let path = PathBuf::from("out").join(format!("screenshot-{now}.png"));
    // The player may not know in which folder the game was started.
    let path = std::path::absolute(&path).unwrap_or(path);
    // After the game's end nobody listens.
    take(&mut world.commands(), path, move |path, result| _ = sender.send((path.to_path_buf(), result)));
}

/// Takes a picture of the window into `path`; `done` hears from another thread how that went.
fn take(commands: &mut Commands, path: PathBuf, done: impl Fn(&Path, Result<(), String>) + Clone + Send + Sync + 'static) {
    commands.spawn(Screenshot::primary_window()).observe(move |captured: On<ScreenshotCaptured>| {
        let (path, image, done) = (path.clone(), captured.image.clone(), done.clone());
        std::thread::spawn(move || done(&path, write(image, &path)));
    });
}

fn write(image: Image, path: &Path) -> Result<(), String> {
    let picture = image.try_into_dynamic().map_err(|error| error.to_string())?.to_rgb8();
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|error| error.to_string())?;
    }
    write_png(path, [picture.width(), picture.height()], picture.as_raw()).map_err(|error| error.to_string())
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
        for (result, said) in [(Ok(()), "picture written to out/a.png"), (Err("no room".to_owned()), "no room")] {
            app.world().resource::<News>().sender.send(("out/a.png".into(), result)).expect("somebody listens");
            app.update();
            let notice = app.world().resource::<Notice>();
            assert!(notice.text.contains(said) && notice.until > 1.0, "{notice:?}");
        }
    }

    #[test]
    fn the_last_message_is_not_in_the_picture() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, RecordPlugin { folder: None, frames: None }));
        app.insert_resource(Notice { text: "picture written".into(), until: 9.0 });
        screenshot(app.world_mut());
        assert_eq!(app.world().resource::<Notice>().text, "");
        // Where every frame is written, the player is told so instead.
        app.world_mut().resource_mut::<VideoRecording>().folder = Some("film".into());
        screenshot(app.world_mut());
        assert!(app.world().resource::<Notice>().text.contains("film"));
    }
}
