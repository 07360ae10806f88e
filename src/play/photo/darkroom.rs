//! Pictures that are being made in the background: drawn in any size, or traced exactly.

use std::path::{Path, PathBuf};
use web_time::SystemTime;

use bevy::prelude::*;

use crate::picture_file;
use crate::play::develop::{DevelopProgress, Developing};
use crate::play::hud::notice::Notice;
use crate::play::session::Session;
use crate::play::window::pictures::{folders, stem};
use crate::sim::snapshot::Snapshot;

/// Rays a pixel of an exact picture.
const SAMPLES: u32 = 4;

/// How a picture is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum How {
    /// As the game draws it.
    Drawn,
    /// Each pixel by rays of its own.
    Exactly,
}

/// The pictures that are being made: how, by whom, and the file that carries the moment.
#[derive(Resource, Debug, Default)]
pub struct Darkroom(Vec<(How, Developing, PathBuf)>);

/// Begins to make a picture of a moment.
pub fn begin(world: &mut World, moment: &Snapshot, how: How) {
    let name = stem(SystemTime::now());
    let started = place(&name, how).and_then(|output| {
        let carrier = carrier(moment, &name)?;
        let developing = match how {
            How::Drawn => Developing::draw(&carrier, &output),
            How::Exactly => Developing::trace(&carrier, SAMPLES, &output),
        };
        Ok((how, developing, carrier))
    });
    match started {
        Ok(job) => world.get_resource_or_init::<Darkroom>().0.push(job),
        Err(why) => notify_failure(world, &why),
    }
}

/// Says that there will be no picture, and why.
pub fn notify_failure(world: &mut World, why: &str) {
    let text = world.resource::<Session>().language().fill("photo-failed", &[("why", why)]);
    let until = world.resource::<Time<Real>>().elapsed_secs_f64() + 6.0;
    world.insert_resource(Notice { text, until, share: None });
}

/// A file for the picture that is not there yet, in the first folder that can be made.
fn place(name: &str, how: How) -> Result<PathBuf, String> {
    let suffix = if how == How::Exactly { "-exact" } else { "" };
    let mut wrong = "there is no folder for pictures".to_owned();
    for folder in folders() {
        match std::fs::create_dir_all(&folder) {
            Ok(()) => {
                let numbered = |n: u32| folder.join(if n == 1 { format!("{name}{suffix}.png") } else { format!("{name}-{n}{suffix}.png") });
                if let Some(file) = (1..1000).map(numbered).find(|file| !file.exists()) {
                    return Ok(file);
                }
            }
            Err(error) => wrong = format!("{}: {error}", folder.display()),
        }
    }
    Err(wrong)
}

/// A picture of one pixel that carries the moment, for the program that makes the whole one.
fn carrier(moment: &Snapshot, name: &str) -> Result<PathBuf, String> {
    let names = (0..1000).map(|n| std::env::temp_dir().join(format!("{name}-{}-{n}.png", std::process::id())));
    let file = names.into_iter().find(|file| !file.exists()).ok_or("there are too many pictures at once")?;
    picture_file::write_png_with_text(&file, &[0; 3], [1, 1], &moment.to_text()).map_err(|error| error.to_string())?;
    Ok(file)
}

/// Says how far the pictures are, and where each is in the end.
pub(super) fn watch(mut darkroom: ResMut<Darkroom>, session: Res<Session>, real: Res<Time<Real>>, mut notice: ResMut<Notice>) {
    let (language, now) = (session.language(), real.elapsed_secs_f64());
    let file = |path: &Path| path.display().to_string();
    // The tracer knows of bending alone.
    let render = &session.config.render;
    let whole = render.doppler && render.beaming && render.light_delay && render.orders > 1;
    darkroom.0.retain(|(how, developing, carrier)| {
        let drawn = *how == How::Drawn;
        let named = |key: &str, path: &Path| language.fill(key, &[("file", file(path).as_str())]);
        let (text, seconds, share) = match developing.progress() {
            DevelopProgress::Traced(share) => {
                let key = if drawn { "photo-drawing" } else { "photo-developing" };
                (language.fill(key, &[("percent", format!("{:.0}", 100.0 * share).as_str())]), 0.5, Some(share))
            }
            DevelopProgress::Done(path) if drawn => (named("photo-saved", &path), 6.0, None),
            DevelopProgress::Done(path) if whole => (named("photo-developed", &path), 6.0, None),
            DevelopProgress::Done(path) => (named("photo-developed-whole", &path), 8.0, None),
            DevelopProgress::Failed(why) => (language.fill("photo-failed", &[("why", why.as_str())]), 8.0, None),
            DevelopProgress::Cancelled => (String::new(), 0.0, None),
        };
        let goes_on = share.is_some();
        // How far one is does not hide where another is.
        if !goes_on || now + 0.5 >= notice.until {
            *notice = Notice { text, until: now + seconds, share };
        }
        if !goes_on {
            _ = std::fs::remove_file(carrier);
        }
        goes_on
    });
}
