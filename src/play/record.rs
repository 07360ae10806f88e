//! Pictures of the window: every frame into a folder, or one on a key.

use std::path::PathBuf;

use bevy::prelude::*;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};

use super::demonstration::write_png;

/// Writes frames, and closes the window after so many.
pub struct RecordPlugin {
    /// Where every frame goes, if anywhere.
    pub folder: Option<PathBuf>,
    /// Frames after which the window closes, if it does.
    pub frames: Option<u32>,
}

#[derive(Resource, Clone, Debug)]
struct Recording {
    folder: Option<PathBuf>,
    frames: Option<u32>,
    drawn: u32,
}

impl Plugin for RecordPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(Recording { folder: self.folder.clone(), frames: self.frames, drawn: 0 }).add_systems(Last, record);
    }
}

/// Frames at the start whose picture is not ready yet: the window's surface and the pipelines are being made.
const WARM_UP: u32 = 3;

fn record(mut recording: ResMut<Recording>, mut commands: Commands, mut exit: MessageWriter<AppExit>) {
    recording.drawn += 1;
    let Some(index) = recording.drawn.checked_sub(WARM_UP) else { return };
    if recording.frames.is_some_and(|frames| index > frames) {
        exit.write(AppExit::Success);
        return;
    }
    if let Some(folder) = &recording.folder {
        let path = folder.join("frames").join(format!("frame-{index:05}.png"));
        take(&mut commands, path);
    }
}

/// Writes the window's picture to `out/`. Where every frame is written this one is among them, and a window gives one picture a frame.
pub fn screenshot(world: &mut World) {
    if world.get_resource::<Recording>().is_some_and(|recording| recording.folder.is_some()) {
        return;
    }
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap_or_default().as_millis();
    take(&mut world.commands(), PathBuf::from("out").join(format!("screenshot-{now}.png")));
}

fn take(commands: &mut Commands, path: PathBuf) {
    commands.spawn(Screenshot::primary_window()).observe(move |captured: On<ScreenshotCaptured>| {
        let (path, image) = (path.clone(), captured.image.clone());
        std::thread::spawn(move || {
            if let Err(error) = write(image, &path) {
                eprintln!("warning: cannot write {}: {error}", path.display());
            }
        });
    });
}

fn write(image: Image, path: &std::path::Path) -> Result<(), String> {
    let picture = image.try_into_dynamic().map_err(|error| error.to_string())?.to_rgb8();
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|error| error.to_string())?;
    }
    write_png(path, [picture.width(), picture.height()], picture.as_raw()).map_err(|error| error.to_string())
}
