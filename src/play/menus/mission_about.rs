//! What the chosen mission is about.

use bevy_egui::egui::{RichText, Ui};

use super::words::{goal, measure, unit};
use crate::play::hud::instruments::Scale;
use crate::play::hud::paint::{FAINT, TEXT, TRUE};
use crate::play::hud::palette::Palette;
use crate::play::missions::Catalogue;
use crate::play::records::Records;
use crate::play::session::Session;
use crate::scene::Scene;
use crate::scene::mission::{Mission, ScoredBy};
use crate::scene::ship::Ai;

/// What the title is made of.
pub(super) struct Title<'a> {
    pub(super) catalogue: &'a Catalogue,
    pub(super) records: &'a Records,
    pub(super) choice: usize,
    pub(super) free: usize,
}

/// Says what the chosen mission, or the scene for free flight, is about.
pub(super) fn about(ui: &mut Ui, session: &Session, title: &Title) {
    let scene = title.catalogue.scene(title.choice, title.free);
    let palette = Palette::in_use(ui.ctx());
    let mut line = |words: &str, size: f32, colour| _ = ui.label(RichText::new(words).size(size).color(palette.shown(colour)));
    let language = session.language();
    match &scene.mission {
        Some(mission) => {
            line(&language.mission(scene, "title", &mission.title), 21.0, TEXT);
            line(&language.mission(scene, "idea", &mission.idea), 14.0, TRUE);
            line(&language.mission(scene, "brief", &mission.brief), 13.0, TEXT);
            for words in scores(session, title, scene, mission) {
                line(&words, 12.5, FAINT);
            }
        }
        None => {
            line(&language.say("menu-free-flight"), 21.0, TEXT);
            let count = title.catalogue.free.len();
            let place = [("place", (title.free + 1).to_string()), ("count", count.to_string())];
            let place = place.each_ref().map(|(name, value)| (*name, value.as_str()));
            line(&format!("{}  {}", scene.name, language.fill("free-place", &place)), 14.0, TRUE);
            let chased = scene.ships.iter().any(|ship| ship.ai == Ai::Flee);
            line(&if chased { goal(session) } else { language.say("free-nothing") }, 13.0, TEXT);
            line(&measure(session), 12.5, FAINT);
        }
    }
}

/// The best score so far, and what the stars ask for.
fn scores(session: &Session, title: &Title, scene: &Scene, mission: &Mission) -> Vec<String> {
    let language = session.language();
    let clock = language.say(match mission.clock {
        ScoredBy::Far => "score-far",
        ScoredBy::Own => "score-own",
        ScoredBy::Fuel => "score-fuel",
    });
    let unit = unit(language, mission.clock);
    let best = title.records.best(&scene.record_name(), session.difficulty);
    let best = best.map_or(language.say("score-none"), |best| match mission.clock {
        ScoredBy::Fuel => format!("{:.2} {unit}", best.score),
        ScoredBy::Far | ScoredBy::Own => format!("{:.1} {unit} ({})", best.score, Scale::of(session).span(best.score)),
    });
    let level = language.say(&format!("difficulty-{}", session.difficulty.name()));
    let mut lines = vec![format!("{clock}, {level}: {best}")];
    if let Some([three, two]) = mission.levels[session.difficulty as usize].stars {
        lines.push(format!("★★★ ≤ {three} {unit}  ·  ★★☆ ≤ {two} {unit}"));
    }
    lines
}
