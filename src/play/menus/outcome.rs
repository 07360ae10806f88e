//! What the result says.

use bevy_egui::egui::{Color32, RichText, Ui};

use super::flight_map;
use super::words::{stars, unit};
use crate::play::coach::review::{Feat, Lesson, Review};
use crate::play::hud::instruments::Scale;
use crate::play::hud::paint::{ALARM, FAINT, OWN, TEXT, TRUE};
use crate::play::hud::palette::Palette;
use crate::play::hud::panel::Panel;
use crate::play::missions::LastFlight;
use crate::play::player_state::Flown;
use crate::play::session::Session;
use crate::play::words::Language;
use crate::sim::{Chase, Outcome};

/// Says how the flight ended, and its times.
pub(super) fn result(ui: &mut Ui, session: &Session, chase: Option<&Chase>, panel: &Panel, (flown, review): (Flown, &Review)) {
    let Some((outcome, time)) = chase.and_then(|chase| chase.outcome) else { return };
    let (palette, language) = (Palette::in_use(ui.ctx()), session.language());
    let mut line = |words: &str, size: f32, colour| _ = ui.label(RichText::new(words).size(size).color(palette.shown(colour)));
    line(&language.say(&format!("outcome-{}", outcome.name())), 34.0, colour_of(outcome));
    line(&language.say(&format!("outcome-{}-why", outcome.name())), 15.0, TEXT);
    let lesson = review.lesson(outcome).filter(|_| flown.by_hand);
    if let Some(lesson) = lesson {
        line(&lesson_words(language, lesson), 15.0, TRUE);
    }
    if let Some(feat) = review.feat(outcome) {
        line(&feat_words(language, feat), 15.0, TRUE);
    }
    let won = matches!(outcome, Outcome::Caught | Outcome::Done);
    // One that ends the flight is said above.
    if review.catches().len() > usize::from(won) {
        let times: Vec<String> = review.catches().iter().map(|time| format!("{time:.1}")).collect();
        line(&language.fill("feat-catches", &[("times", times.join(", ").as_str())]), 15.0, TRUE);
    }
    if let Some(key) = pilot(flown) {
        line(&language.say(key), 13.0, TRUE);
    }
    let scale = Scale::of(session);
    let say = |key: &str, value: &str| language.fill(key, &[("value", value)]);
    line(&say("result-far", &format!("{}   (T = {time:.1} r_s/c)", scale.clock(time))), 13.0, TEXT);
    if let Some(own) = panel.decided {
        line(&say("result-own", &scale.clock(own)), 13.0, TEXT);
        line(&say("result-younger", &scale.clock((time - own).max(0.0))), 13.0, TEXT);
    }
    if let Some(fuel) = panel.instruments.and_then(|read| read.fuel) {
        line(&say("result-fuel", &format!("{:.0} %", 100.0 * fuel)), 13.0, FAINT);
    }
    if let Some(moment) = lesson.and_then(|lesson| review.moment(lesson)) {
        flight_map::show(ui, language, review.ways(), moment);
    }
}

/// Why a flight was lost, in a sentence.
fn lesson_words(language: Language, lesson: Lesson) -> String {
    let tenth = |value: f64| format!("{value:.1}");
    match lesson {
        Lesson::Fell => language.say("lesson-fell"),
        Lesson::Passed { times, speed, from } => {
            let [times, speed, from] = [times.to_string(), format!("{speed:.2}"), tenth(from)];
            language.fill("lesson-passed", &[("times", times.as_str()), ("speed", speed.as_str()), ("from", from.as_str())])
        }
        Lesson::Dry(time) => language.fill("lesson-dry", &[("time", tenth(time).as_str())]),
        Lesson::Far(distance) => language.fill("lesson-far", &[("distance", tenth(distance).as_str())]),
    }
}

/// How a flight was won, in a sentence.
fn feat_words(language: Language, feat: Feat) -> String {
    /// A bolt is bent round the hole from here on, in degrees: a straight one sweeps less than half of a circle.
    const ROUND: f64 = 180.0;
    match feat {
        Feat::Kept { distance, speed, radius } => {
            let [distance, speed, radius] = [distance, speed, radius].map(|value| format!("{value:.2}"));
            let values = [("distance", distance.as_str()), ("speed", speed.as_str()), ("radius", radius.as_str())];
            language.fill("feat-kept", &values)
        }
        Feat::Shot { span, round } => {
            let [length, angle] = [span, round.to_degrees()].map(|value| format!("{value:.0}"));
            let key = if round.to_degrees() > ROUND { "feat-shot-round" } else { "feat-shot" };
            language.fill(key, &[("span", length.as_str()), ("angle", angle.as_str())])
        }
    }
}

/// The stars and the score of a mission.
pub(super) fn score(ui: &mut Ui, session: &Session, last: &LastFlight) {
    let Some((won, mission)) = last.won.zip(session.scene.mission.as_ref()) else { return };
    let (palette, language) = (Palette::in_use(ui.ctx()), session.language());
    let unit = unit(language, mission.clock);
    ui.label(RichText::new(stars(won.stars)).size(28.0).color(palette.shown(TRUE)));
    let score = format!("{:.1} {unit}", won.score);
    let before = last.before.map(|before| format!("{:.1}", before.score)).unwrap_or_default();
    let key = match (last.is_best, last.before) {
        (true, Some(_)) => "score-better",
        (true, None) => "score-first",
        (false, Some(_)) => "score-worse",
        (false, None) => "score-only",
    };
    let words = language.fill(key, &[("score", score.as_str()), ("before", before.as_str())]);
    ui.label(RichText::new(words).size(13.5).color(palette.shown(TEXT)));
}

/// The key of what the result says of the autopilot, if it flew.
fn pilot(flown: Flown) -> Option<&'static str> {
    match (flown.by_autopilot, flown.by_hand) {
        (false, _) => None,
        (true, true) => Some("result-autopilot-part"),
        (true, false) => Some("result-autopilot"),
    }
}

/// The colour of the headline.
fn colour_of(outcome: Outcome) -> Color32 {
    match outcome {
        Outcome::Caught | Outcome::Done => OWN,
        Outcome::HunterLost | Outcome::Taken | Outcome::ShipLost => ALARM,
        Outcome::QuarryLost | Outcome::TimeOut | Outcome::Strayed => TRUE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_result_says_when_the_autopilot_flew() {
        let said = |by_hand, by_autopilot| pilot(Flown { by_hand, by_autopilot });
        assert_eq!(said(true, false), None);
        assert_eq!(said(false, true), Some("result-autopilot"));
        assert_eq!(said(true, true), Some("result-autopilot-part"));
    }
}
