//! Whether the scene is still being loaded.

use bevy::prelude::Resource;

/// There as long as the scene is not on the screen: models and passes are being made. Time stands still, and the screen says so.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct Loading;
