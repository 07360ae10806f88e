//! The goals of a mission on the screen: which it is, what is to be done, how much of it is done, and how, for those who are slow.

use bevy_egui::egui::{Align2, Painter, Rect, pos2};

use crate::play::hud::paint::{FAINT, OWN, TEXT, TRUE, TextBox};
use crate::play::input::action::Action;
use crate::play::input::bindings::Bindings;
use crate::play::input::button::Device;
use crate::play::words::{self, Language};
use crate::scene::Scene;
use crate::scene::mission::buttons::with_buttons;
use crate::scene::mission::{GoalTask, Mission};
use crate::scene::rules::Rules;
use crate::sim::goals::needed;
use crate::sim::{ActiveMission, ChaseRules, Progress};

/// Who has not done a goal after this time, in seconds of wall time, is told how.
const SLOW: f64 = 6.0;
/// The widest that goals are written, in points.
const WIDEST: f32 = 460.0;

/// Since when (wall time in seconds) the present goal is to be done.
#[derive(Clone, Copy, Debug, Default)]
pub struct Slow {
    goal: Option<usize>,
    since: f64,
}

/// What is known of the goals.
#[derive(Clone, Copy, Debug)]
pub struct Goals<'a> {
    /// The mission.
    pub mission: &'a Mission,
    /// How far it has come.
    pub progress: &'a Progress,
    /// The rules in force.
    pub rules: ChaseRules,
    /// The language, and the scene whose words they are.
    pub scene: (Language, &'a Scene),
    /// What is bound to each action, and the device in use.
    pub buttons: (&'a Bindings, Device),
}

/// Lays out the present goal below `top`, `seconds` of wall time after the start of the game; nothing when all are done.
pub fn lay_out(painter: &Painter, rect: Rect, top: f32, goals: &Goals, slow: &mut Slow, seconds: f64) -> Option<TextBox> {
    let Goals { mission, progress, rules, scene, buttons } = *goals;
    let goal = mission.goals.get(progress.goal)?;
    if slow.goal != Some(progress.goal) {
        *slow = Slow { goal: Some(progress.goal), since: seconds };
    }
    let count = mission.goals.len();
    let place = progress.goal + 1;
    let number = match count {
        1 => scene.0.say("hud-goal"),
        _ => scene.0.fill("hud-goal-of", &[("number", place.to_string().as_str()), ("count", count.to_string().as_str())]),
    };
    let text = scene.0.mission(scene.1, &format!("goal-{place}"), &goal.text);
    let hint = goal.hint.as_ref().filter(|_| seconds - slow.since > SLOW);
    let hint = hint.map(|hint| scene.0.mission(scene.1, &format!("goal-{place}-hint"), hint));
    let button = |key: &str| {
        let action = Action::ALL.into_iter().find(|action| action.key() == key)?;
        Some(words::buttons::of(scene.0, buttons.0, buttons.1, action))
    };
    let hint = hint.map(|hint| with_buttons(&hint, button));
    let mut lines = vec![(number.as_str(), 11.0, FAINT), (text.as_str(), 15.0, TRUE)];
    let held = held_words(scene.0, mission, progress, &rules);
    lines.extend(held.as_ref().map(|words| (words.as_str(), 12.0, TEXT)));
    lines.extend(hint.as_ref().map(|hint| (hint.as_str(), 12.0, TEXT)));
    let at = pos2(rect.center().x, top);
    let share = progress.share(mission, &rules);
    let widest = WIDEST.min(0.6 * rect.width());
    Some(TextBox::lay_out(painter, at, Align2::CENTER_TOP, widest, &lines).over_bar(share as f32, OWN))
}

/// How near a ship must be held or flown with, and for how long, where that is the goal; how much of the way round is done; how near a hunter must come.
fn held_words(language: Language, mission: &Mission, progress: &Progress, rules: &ChaseRules) -> Option<String> {
    let task = &mission.goals.get(progress.goal)?.task;
    let decimals = |value: f64| format!("{value:.2}");
    let whole = decimals(needed(task, mission, rules));
    match *task {
        GoalTask::Hold { distance, .. } => {
            let reach = decimals(distance.unwrap_or(rules.0.capture_radius));
            Some(language.fill("hud-hold-needs", &[("reach", reach.as_str()), ("span", whole.as_str())]))
        }
        GoalTask::Match { distance, speed, span, .. } => {
            let [reach, speed] = [distance, speed].map(decimals);
            let all = [("reach", reach.as_str()), ("speed", speed.as_str()), ("span", whole.as_str())];
            let key = if span > 0.0 { "hud-match-needs" } else { "hud-match-needs-once" };
            Some(language.fill(key, &all))
        }
        GoalTask::Survive { .. } if !mission.caught_by.is_empty() => {
            let [reach, span] = [rules.0.capture_radius, rules.0.hold_time].map(decimals);
            Some(language.fill("hud-caught-within", &[("reach", reach.as_str()), ("span", span.as_str())]))
        }
        GoalTask::Whirl { turns, .. } => {
            let [done, whole] = [progress.done, turns].map(decimals);
            Some(language.fill("hud-turns-done", &[("done", done.as_str()), ("whole", whole.as_str())]))
        }
        _ => None,
    }
}

/// From this share of the farthest allowed radius on the edge is near.
const EDGE: f64 = 0.85;

/// Whether the ship at `radius` (r_s) is about to leave where the present goal wants it to stay.
pub fn near_edge(mission: &Mission, progress: &Progress, radius: f64) -> bool {
    let task = mission.goals.get(progress.goal).map(|goal| &goal.task);
    matches!(task, Some(GoalTask::Survive { most, .. }) if radius > EDGE * most)
}

/// Whether the present goal is a ship to be held or flown with, which is shown by a ring.
pub fn is_held(mission: &Mission, progress: &Progress) -> bool {
    mission.goals.get(progress.goal).is_some_and(|goal| matches!(goal.task, GoalTask::Hold { .. } | GoalTask::Match { .. }))
}

/// For how long a ship must be held, in r_s/c.
pub fn whole(mission: Option<&ActiveMission>, progress: Option<&Progress>, rules: &Rules) -> f64 {
    let goal = mission.zip(progress).and_then(|(mission, progress)| mission.0.goals.get(progress.goal).map(|goal| (goal, mission)));
    goal.map_or(rules.hold_time, |(goal, mission)| needed(&goal.task, &mission.0, &ChaseRules(*rules)))
}
