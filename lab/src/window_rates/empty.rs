//! An empty window of the engine that the game is built on: what opening, clearing and showing pictures takes alone.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use clap::Args;
use lensrunner::scene::picture_size;

use bevy::prelude::*;
use bevy::render::{Render, RenderApp, RenderSystems};
use bevy::window::PresentMode;

/// When each frame was handed to the window, in s; both worlds have it.
#[derive(Resource, Clone)]
struct Times(Instant, Arc<Mutex<Vec<f64>>>);

/// The empty window that `chart window` opens.
#[derive(Args, Clone, Debug)]
pub struct EmptyWindowRequest {
    /// Width and height in pixels.
    #[arg(long, value_parser = picture_size)]
    size: [u32; 2],
    /// Frames that are shown.
    #[arg(long)]
    frames: u32,
    /// The file for their times.
    #[arg(long)]
    timings: PathBuf,
}

/// Opens the window, shows the frames, and writes their times as the game does.
pub fn show(request: EmptyWindowRequest) -> std::io::Result<()> {
    let EmptyWindowRequest { size: [width, height], frames, timings } = request;
    let times = Times(Instant::now(), Arc::default());
    let mut app = App::new();
    // As the game's window.
    let window = Window { resolution: (width, height).into(), present_mode: PresentMode::AutoVsync, ..default() };
    app.add_plugins(DefaultPlugins.set(WindowPlugin { primary_window: Some(window), ..default() }));
    app.insert_resource(bevy::winit::WinitSettings::continuous());
    app.add_systems(Startup, |mut commands: Commands| _ = commands.spawn(Camera2d));
    app.add_systems(Update, move |mut drawn: Local<u32>, mut exit: MessageWriter<AppExit>| {
        *drawn += 1;
        if *drawn > frames {
            exit.write(AppExit::Success);
        }
    });
    if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
        let note = |times: Res<Times>| times.1.lock().unwrap_or_else(PoisonError::into_inner).push(times.0.elapsed().as_secs_f64());
        render_app.insert_resource(times.clone()).add_systems(Render, note.in_set(RenderSystems::Cleanup));
    }
    app.run();
    let mut text = "seconds,shown,rung\n".to_owned();
    for seconds in times.1.lock().unwrap_or_else(PoisonError::into_inner).iter() {
        text += &format!("{seconds:.4},playing,0\n");
    }
    std::fs::write(timings, text)
}
