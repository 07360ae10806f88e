//! What egui copies goes to the clipboard of the system.

use bevy::prelude::*;
use bevy_egui::egui::OutputCommand;
use bevy_egui::{EguiOutput, EguiPostUpdateSet};

use crate::play::overlay::state::Overlay;

/// The system's clipboard, from the first copy on: on X11 it gives the text as long as it lives.
#[derive(Default)]
struct Clipboard(Option<arboard::Clipboard>);

/// Hands on what egui copies.
pub(super) struct ClipboardPlugin;

impl Plugin for ClipboardPlugin {
    fn build(&self, app: &mut App) {
        app.insert_non_send(Clipboard::default()).add_systems(PostUpdate, hand_on.after(EguiPostUpdateSet::ProcessOutput));
    }
}

/// Hands on what was copied in this frame. Where there is no clipboard, the text is said in the log.
fn hand_on(outputs: Query<&EguiOutput>, mut clipboard: NonSendMut<Clipboard>, mut overlay: ResMut<Overlay>) {
    for command in outputs.iter().flat_map(|output| &output.platform_output.commands) {
        let OutputCommand::CopyText(text) = command else { continue };
        if let Err(error) = put(&mut clipboard, text) {
            info!("{text}");
            overlay.said = format!("no clipboard ({error}): {text}");
        }
    }
}

fn put(clipboard: &mut Clipboard, text: &str) -> Result<(), arboard::Error> {
    if clipboard.0.is_none() {
        clipboard.0 = Some(arboard::Clipboard::new()?);
    }
    clipboard.0.as_mut().map_or(Ok(()), |clipboard| clipboard.set_text(text))
}
