//! The graphics device lost, or out of memory: the game ends, and says why in one sentence. What the player chose and won is in its files.

use bevy::prelude::*;
use bevy::render::error_handler::{ErrorType, RenderError, RenderErrorHandler, RenderErrorPolicy};

/// Ends the game when the device cannot draw any more. Add it after Bevy's `RenderPlugin`.
pub struct LostDevicePlugin;

impl Plugin for LostDevicePlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(RenderErrorHandler(end));
    }
}

/// It has been said.
#[derive(Resource)]
struct Said;

/// Bevy asks this in each frame from the error on.
fn end(error: &RenderError, main: &mut World, _: &mut World) -> RenderErrorPolicy {
    if !main.contains_resource::<Said>() {
        main.insert_resource(Said);
        let sentence = sentence(error);
        error!("{sentence}");
        #[cfg(target_family = "wasm")]
        crate::page::ended(&sentence);
        main.write_message(AppExit::error());
    }
    RenderErrorPolicy::StopRendering
}

/// What happened, for the player.
fn sentence(error: &RenderError) -> String {
    let said = error.description.lines().map(str::trim).rfind(|line| !line.is_empty()).unwrap_or("no reason was given");
    match error.ty {
        ErrorType::DeviceLost => format!("The game ends because the graphics device was lost ({said}); it can be started again at once."),
        ErrorType::OutOfMemory => "The game ends because the graphics device has no memory left; a smaller window needs less.".into(),
        ErrorType::Validation | ErrorType::Internal => {
            format!("The game ends because the window or the graphics device cannot be drawn to any more ({said}).")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_error_is_one_sentence() {
        let of = |ty, description: &str| sentence(&RenderError { ty, description: description.into(), source: None });
        assert!(of(ErrorType::DeviceLost, "the driver was updated").contains("was lost (the driver was updated)"));
        assert!(of(ErrorType::DeviceLost, "").contains("no reason"));
        let validation = of(ErrorType::Validation, "Validation Error\n\nCaused by:\n  In Surface::configure\n    It is gone\n");
        assert!(validation.contains("(It is gone)") && !validation.contains('\n'), "{validation}");
        assert!(of(ErrorType::OutOfMemory, "").contains("smaller window"));
    }
}
