//! The flow of time: frozen, by steps, at another pace, and through a replay; and moments that are saved.

use bevy_egui::egui::{Slider, Ui};

use crate::play::overlay::rows;
use crate::play::overlay::state::{Ask, Overlay, OverlayView};

/// Steps that pass at a press of a button.
const STEPS: [u32; 3] = [1, 8, 64];

/// The page.
pub fn show(ui: &mut Ui, seen: &OverlayView, overlay: &mut Overlay) {
    let passing = seen.passing;
    ui.label(format!("T = {:.3} r_s/c, in steps of {} r_s/c", passing.now, passing.step));
    ui.horizontal(|ui| {
        let mut frozen = passing.frozen;
        if ui.checkbox(&mut frozen, "freeze").on_hover_text("time stands still; the picture is drawn on").changed() {
            overlay.asked.push(Ask::Freeze(frozen));
        }
        for steps in STEPS {
            let name = format!("{steps} step{}", if steps == 1 { "" } else { "s" });
            if ui.button(name).on_hover_text("freezes time, and lets so many steps of the simulation pass").clicked() {
                overlay.asked.push(Ask::Step(steps));
            }
        }
    });
    rows::list(ui, &["clock.pace", "clock.slow_near_danger"], seen, overlay);
    ui.separator();
    match passing.end {
        None => _ = ui.weak("No replay is shown: while one is, any of its moments can be gone to here."),
        Some(end) => {
            ui.label("The replay: any of its moments. Back is flown again from its start.");
            let mut time = passing.travels.unwrap_or(passing.now).min(end);
            ui.spacing_mut().slider_width = ui.available_width() - 120.0;
            let slider = ui.add(Slider::new(&mut time, 0.0..=end).text("T").fixed_decimals(2));
            // A drag through the past would fly it anew in each frame.
            let held = slider.id.with("held");
            if slider.dragged() {
                ui.data_mut(|data| data.insert_temp(held, time));
            }
            let let_go = slider.drag_stopped().then(|| ui.data_mut(|data| data.remove_temp::<f64>(held))).flatten();
            let chosen = let_go.or((slider.changed() && !slider.dragged()).then_some(time));
            if let Some(to) = chosen {
                overlay.asked.push(Ask::Teleport(to));
            }
            if let Some(to) = passing.travels {
                ui.weak(format!("flying to T = {to:.2}: {:.0} %", 100.0 * passing.now / to.max(1e-9)));
            }
        }
    }
    ui.separator();
    if ui.button("Save this moment").on_hover_text("as a file for shot, trace and compare: --scene FILE").clicked() {
        overlay.asked.push(Ask::SaveMoment);
    }
    if let Some(file) = &overlay.moment {
        ui.label(format!("lensrunner shot --scene {} -o moment.png", file.display()));
    }
}
