//! Why there is no chart.

use std::path::PathBuf;

use lensrunner::render::DeviceError;
use lensrunner::render::gpu::readback::PictureError;
use lensrunner::render::quality::costs::QualityCostsError;
use lensrunner::render::shot::ShotError;
use lensrunner::scene::{ConfigError, SceneError};
use lensrunner::spacetime::orbit::OrbitError;

use super::SheetError;
use crate::plot::PlotError;

/// Why a chart or table could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ChartError {
    /// What was asked for is wrong; what is allowed.
    #[error("{0}")]
    Input(String),
    /// A scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// `game.toml` is wrong.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The scene cannot be drawn.
    #[error(transparent)]
    Shot(#[from] ShotError),
    /// There is nothing to draw with.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// A frame was not drawn.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// A flight has no start.
    #[error(transparent)]
    Orbit(#[from] OrbitError),
    /// The measured costs do not make a table.
    #[error(transparent)]
    QualityCosts(#[from] QualityCostsError),
    /// A CSV cannot be read or written.
    #[error(transparent)]
    Sheet(#[from] SheetError),
    /// The chart cannot be drawn.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// A file cannot be written.
    #[error("cannot write {0}: {1}")]
    Write(PathBuf, String),
    /// Another program could not be started, or failed.
    #[error("{0}: {1}")]
    Program(String, String),
    /// What was measured cannot be told.
    #[error("{0}")]
    Failed(String),
}

impl ChartError {
    /// Whether what was asked for is wrong, rather than that something failed.
    pub fn is_input(&self) -> bool {
        match self {
            ChartError::Input(_) | ChartError::Scene(_) | ChartError::Config(_) => true,
            ChartError::Shot(error) => error.is_input(),
            _ => false,
        }
    }
}
