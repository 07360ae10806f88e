//! What the last frames took, as plots and numbers, and what the stages counted.

use bevy_egui::egui::{Color32, Grid, RichText, ScrollArea, Ui};
use egui_plot::{GridMark, HLine, Line, Plot, PlotPoints};

use crate::play::overlay::frames::{Durations, WINDOW};
use crate::play::overlay::rows::UNSAVED;
use crate::play::overlay::state::OverlayView;

/// Colours of the passes that are plotted, the longest first: told apart by all (Okabe and Ito's, on dark).
const COLOURS: [Color32; 6] = [
    Color32::from_rgb(230, 159, 0),
    Color32::from_rgb(86, 180, 233),
    Color32::from_rgb(0, 158, 115),
    Color32::from_rgb(240, 228, 66),
    Color32::from_rgb(204, 121, 167),
    Color32::from_rgb(213, 94, 0),
];

/// The page.
pub fn show(ui: &mut Ui, seen: &OverlayView) {
    if let Some((mean, worst)) = seen.frames.whole.mean_and_worst() {
        let line = format!("frame {mean:.1} ms mean, {worst:.1} ms worst of {WINDOW}   ({:.0} a second)", 1e3 / mean.max(1e-6));
        ui.label(RichText::new(line).strong());
        plot(ui, "frames", 58.0, |plot| {
            plot.line(line_of("frame", &seen.frames.whole, Color32::LIGHT_GRAY));
            plot.hline(HLine::new("mean", mean).color(COLOURS[1]).width(1.0).allow_hover(false));
            plot.hline(HLine::new("worst", worst).color(COLOURS[5]).width(1.0).allow_hover(false));
        });
    }
    counts(ui, seen);
    let ranking = seen.frames.ranking();
    if ranking.is_empty() {
        ui.weak("no times of passes: the device has no timestamps, or nothing was drawn yet");
    } else {
        let (mean, worst) = ranking.iter().fold((0.0, 0.0), |(mean, worst), pass| (mean + pass.1, worst + pass.2));
        ui.label(format!("passes {mean:.1} ms mean; their worst together {worst:.1} ms"));
        plot(ui, "passes", 70.0, |plot| {
            for ((name, _, _, durations), colour) in ranking.iter().zip(COLOURS) {
                plot.line(line_of(name, durations, colour));
            }
        });
    }
    ScrollArea::vertical().auto_shrink([false, true]).show(ui, |ui| {
        // Two columns of passes.
        ui.spacing_mut().interact_size.y = 12.0;
        let half = ranking.len().div_ceil(2);
        Grid::new("passes").num_columns(6).spacing([8.0, 0.0]).striped(true).show(ui, |ui| {
            for heading in ["pass", "mean", "worst", "pass", "mean", "worst"] {
                ui.weak(RichText::new(heading).small());
            }
            ui.end_row();
            for left in 0..half {
                for place in [left, left + half] {
                    let Some((name, mean, worst, _)) = ranking.get(place) else { continue };
                    let colour = COLOURS.get(place).copied().unwrap_or(Color32::GRAY);
                    ui.colored_label(colour, RichText::new(*name).small());
                    ui.label(RichText::new(format!("{mean:.2}")).small());
                    ui.label(RichText::new(format!("{worst:.2}")).small());
                }
                ui.end_row();
            }
        });
        if let Some((mean, worst)) = seen.frames.overlay.mean_and_worst() {
            ui.weak(RichText::new(format!("this overlay, laid out: {mean:.2} ms mean, {worst:.2} ms worst")).small());
        }
    });
}

/// What the stages counted, and what overflowed.
fn counts(ui: &mut Ui, seen: &OverlayView) {
    let disk = seen.disk.filter(|counters| counters.arcs > 0);
    let geometry = seen.counters.map(|counters| (counters.complaint(), counters.to_string()));
    let all = geometry.into_iter().chain(disk.map(|counters| (counters.complaint(), counters.to_string())));
    for (complaint, counts) in all {
        if let Some(complaint) = complaint {
            ui.colored_label(UNSAVED, complaint);
        }
        ui.label(RichText::new(counts).small());
    }
}

fn line_of<'a>(name: &str, durations: &Durations, colour: Color32) -> Line<'a> {
    Line::new(name, PlotPoints::from_iter(durations.points())).color(colour).width(1.2).allow_hover(false)
}

/// Two to four marks at round numbers of milliseconds.
fn marks((least, most): (f64, f64)) -> Vec<GridMark> {
    let rough = ((most - least) / 3.0).max(1e-6);
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * power).find(|step| *step >= rough).unwrap_or(rough);
    (0..5).map(|k| GridMark { value: f64::from(k) * step, step_size: step }).filter(|mark| mark.value <= most).collect()
}

/// A plot over the frames, from 0 ms on, that cannot be moved.
fn plot<'a>(ui: &mut Ui, name: &'static str, height: f32, draw: impl FnOnce(&mut egui_plot::PlotUi<'a>) + 'a) {
    Plot::new(name)
        .height(height)
        .show_axes([false, true])
        .show_grid([false, true])
        .show_x(false)
        .show_y(false)
        .show_crosshair(false)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
        .include_y(0.0)
        .include_x(1.0 - WINDOW as f64)
        .include_x(0.0)
        .y_axis_min_width(30.0)
        .y_grid_spacer(|grid| marks(grid.bounds))
        .grid_spacing(4.0..=12.0)
        .show(ui, draw);
}
