//! The sound of a flight that is flown without a window: what was heard after each step, and the file of it.

use std::path::Path;

use bevy::prelude::World;

use crate::play::session::Session;
use crate::play::sound::file::{self, SoundFileError};
use crate::play::sound::heard::Heard;
use crate::play::sound::read::Listener;
use crate::play::sound::volumes::Volumes;
use crate::sim::Clock;

/// What was heard in a flight.
#[derive(Clone, Debug)]
pub struct Recorder {
    session: Session,
    listener: Listener,
    /// After each step: T in r_s/c, and what was heard.
    moments: Vec<(f64, Heard)>,
    /// Length of a step, in r_s/c of T.
    step: f64,
}

impl Recorder {
    /// For a flight of this session.
    pub fn new(session: &Session) -> Recorder {
        Recorder { session: session.clone(), listener: Listener::of(session), moments: Vec::new(), step: session.config.clock.step }
    }

    /// Listens after a step.
    pub fn listen(&mut self, world: &World) {
        let Some(clock) = world.get_resource::<Clock>() else { return };
        self.step = clock.step;
        let heard = self.listener.heard(world, &self.session, clock.time, None);
        self.moments.push((clock.time, heard.unwrap_or(Heard::MUSIC)));
    }

    /// What was heard from T = `from` on (r_s/c), and for how many seconds each: at the session's pace.
    pub fn since(&self, from: f64) -> (Vec<Heard>, f64) {
        let heard = self.moments.iter().filter(|(time, _)| *time > from).map(|(_, heard)| *heard).collect();
        (heard, self.step / self.session.config.clock.pace)
    }

    /// Writes the sound from T = `from` on (r_s/c) to a WAV file. Its length in seconds.
    pub fn write(&self, path: &Path, from: f64) -> Result<f64, SoundFileError> {
        let (moments, seconds) = self.since(from);
        file::write(path, &moments, seconds, &Volumes::default())
    }
}
