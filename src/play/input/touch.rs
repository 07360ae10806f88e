//! Fingers on the screen in play: two sticks, buttons, a drag that turns the ship as the mouse does, a pinch for the camera's distance.
//!
//! A stick stands where its finger went down, within its field at the side of the screen: the left one thrusts, the right one turns.

use bevy::input::mouse::AccumulatedMouseMotion;
use bevy::input::touch::{TouchInput, TouchPhase, Touches};
use bevy::prelude::*;
use bevy::window::PrimaryWindow;

use crate::play::input::action::Action;
use crate::play::input::button::Device;
use crate::play::input::mouse::MouseTurn;
use crate::play::menus::screens::Screen;
use crate::play::player_state::PlayerState;
use crate::play::session::Session;
use crate::play::window::points::points_of;

/// Radius of a button, in points, and the least in logical pixels: a target for a finger is 44 wide.
const BUTTON: (f32, f32) = (27.0, 24.0);
/// A stick is wholly pushed so far from where it began, in radii of a button.
const REACH: f32 = 2.2;
/// The share of a stick's way that does nothing: a finger trembles.
const DEAD: f32 = 0.12;
/// Space from the side of the screen to the middle of a stick at rest, in radii of a button.
const ASIDE: f32 = 3.2;
/// A finger that moves by less than this (logical pixels) and is gone within so many seconds has tapped.
const TAP: (f32, f64) = (12.0, 0.35);
/// A tap looks at the target from so near to its marker, in logical pixels.
const NEAR: f32 = 44.0;

/// What the buttons do, with their words: at the sides, and in a row above.
const SIDES: [(Action, &str); 6] = [
    (Action::ThrustUp, "touch-up"),
    (Action::ThrustDown, "touch-down"),
    (Action::FaceTarget, "touch-nose"),
    (Action::ToggleAssist, "touch-assist"),
    (Action::LookAtTarget, "touch-look"),
    (Action::Fire, "touch-fire"),
];
const ABOVE: [(Action, &str); 6] = [
    (Action::Pause, "touch-pause"),
    (Action::WhatAmISeeing, "touch-seeing"),
    (Action::ToggleCamera, "touch-camera"),
    (Action::Slower, "touch-slower"),
    (Action::Faster, "touch-faster"),
    (Action::ToggleAutopilot, "touch-pilot"),
];

/// The key of the word on the button of an action, if it has one.
pub fn word_of(action: Action) -> Option<&'static str> {
    let stick = match action {
        Action::ThrustForward => Some("touch-left-up"),
        Action::ThrustBack => Some("touch-left-down"),
        Action::ThrustLeft => Some("touch-left-left"),
        Action::ThrustRight => Some("touch-left-right"),
        Action::PitchUp => Some("touch-right-up"),
        Action::PitchDown => Some("touch-right-down"),
        Action::YawLeft => Some("touch-right-left"),
        Action::YawRight => Some("touch-right-right"),
        Action::Boost => Some("touch-wholly"),
        _ => None,
    };
    stick.or_else(|| SIDES.iter().chain(&ABOVE).find(|(known, _)| *known == action).map(|(_, word)| *word))
}

/// A button on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchButton {
    /// What it does.
    pub action: Action,
    /// The key of its word.
    pub word: &'static str,
    /// Its middle, in points.
    pub middle: Vec2,
}

/// Where everything is, in points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TouchLayout {
    /// The sticks at rest, left and right.
    pub sticks: [Vec2; 2],
    /// All buttons.
    pub buttons: Vec<TouchButton>,
    /// Their radius.
    pub radius: f32,
}

impl TouchLayout {
    /// For a screen of `size` points, a point being so many logical pixels. `fires`: there are bolts.
    pub fn new(size: Vec2, pixels: f32, fires: bool) -> TouchLayout {
        let radius = BUTTON.0.max(BUTTON.1 / pixels);
        let aside = ASIDE * radius;
        // Between the dials above and below.
        let sticks = [Vec2::new(aside, 0.52 * size.y), Vec2::new(size.x - aside, 0.52 * size.y)];
        let around = |stick: Vec2, right: f32, up: f32| stick + Vec2::new(right, -up) * radius;
        let places = [
            around(sticks[0], -1.2, 3.7),
            around(sticks[0], 1.2, 3.7),
            around(sticks[1], -3.7, -0.9),
            around(sticks[1], -3.7, 1.5),
            around(sticks[1], -1.2, 3.7),
            around(sticks[1], 1.2, 3.7),
        ];
        let sides = SIDES.iter().zip(places).filter(|((action, _), _)| fires || *action != Action::Fire);
        let mut buttons: Vec<TouchButton> = sides.map(|(&(action, word), middle)| TouchButton { action, word, middle }).collect();
        // Three on either side of what is said in the middle above.
        let step = 2.4 * radius;
        buttons.extend(ABOVE.iter().enumerate().map(|(k, &(action, word))| {
            let from_middle = if k < 3 { k as f32 - 4.7 } else { k as f32 - 0.3 };
            TouchButton { action, word, middle: Vec2::new(0.5 * size.x + from_middle * step, 18.0 + radius) }
        }));
        TouchLayout { sticks, buttons, radius }
    }

    /// The button under a finger; between two, the nearer.
    fn button(&self, at: Vec2) -> Option<Action> {
        let distance = |button: &TouchButton| button.middle.distance(at);
        let nearest = self.buttons.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        (distance(nearest) <= 1.15 * self.radius).then_some(nearest.action)
    }

    /// Which stick stands where the finger went down.
    fn stick(&self, at: Vec2) -> Option<usize> {
        self.sticks.iter().position(|stick| stick.distance(at) <= 1.3 * REACH * self.radius)
    }
}

/// What a finger holds.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Holds {
    Stick(usize),
    Button(Action),
    /// Nothing: it drags or taps.
    View,
}

#[derive(Clone, Copy, Debug)]
struct Finger {
    id: u64,
    holds: Holds,
    from: Vec2,
    at: Vec2,
    since: f64,
    /// It has gone farther than a tap does.
    moved: bool,
}

/// The fingers, and what they ask for in this frame.
#[derive(Resource, Clone, Debug, Default)]
pub struct TouchControls {
    /// Where everything is; empty before the first frame.
    pub layout: TouchLayout,
    /// How far the sticks are pushed, left and right: right and up, 1 at most.
    pub sticks: [Vec2; 2],
    /// Where the sticks stand that are held, in points.
    pub stands: [Option<Vec2>; 2],
    fingers: Vec<Finger>,
    /// How long the last frame took, in seconds.
    frame: f64,
    down: Vec<Action>,
    pushed: Vec<Action>,
    /// A tap on the target's marker has switched this on.
    looks: bool,
    /// Where the target's marker is, in points; the HUD says so.
    pub target: Option<Vec2>,
    /// By what the distance of the camera is multiplied in this frame.
    pub pinch: Option<f32>,
}

impl TouchControls {
    /// Whether a finger holds the button of this action.
    pub fn holds(&self, action: Action) -> bool {
        self.down.contains(&action) || (self.looks && action == Action::LookAtTarget)
    }

    /// Whether it went down in this frame.
    pub fn pushed(&self, action: Action) -> bool {
        self.pushed.contains(&action)
    }

    /// How far a stick asks for this action, 0 to 1.
    pub fn partly(&self, action: Action) -> f64 {
        let [left, right] = self.sticks;
        let asked = match action {
            Action::ThrustForward => left.y,
            Action::ThrustBack => -left.y,
            Action::ThrustRight => left.x,
            Action::ThrustLeft => -left.x,
            Action::PitchUp => right.y,
            Action::PitchDown => -right.y,
            Action::YawRight => right.x,
            Action::YawLeft => -right.x,
            _ => 0.0,
        };
        f64::from(asked.max(0.0))
    }

    /// Lets everything go.
    fn release(&mut self) {
        self.fingers.clear();
        self.down.clear();
        self.looks = false;
        (self.sticks, self.stands) = ([Vec2::ZERO; 2], [None; 2]);
    }

    /// A finger's news at `now` seconds; places in points.
    fn hear(&mut self, phase: TouchPhase, id: u64, at: Vec2, now: f64, pixels: f32) {
        match phase {
            TouchPhase::Started => {
                let button = self.layout.button(at).map(Holds::Button);
                let stick = || self.layout.stick(at).filter(|stick| self.stands[*stick].is_none()).map(Holds::Stick);
                let holds = button.or_else(stick).unwrap_or(Holds::View);
                match holds {
                    Holds::Button(action) => {
                        self.down.push(action);
                        self.pushed.push(action);
                    }
                    Holds::Stick(stick) => self.stands[stick] = Some(at),
                    Holds::View => (),
                }
                self.fingers.push(Finger { id, holds, from: at, at, since: now, moved: false });
            }
            TouchPhase::Moved => {
                if let Some(finger) = self.fingers.iter_mut().find(|finger| finger.id == id) {
                    finger.at = at;
                    finger.moved |= finger.from.distance(at) * pixels > TAP.0;
                }
            }
            TouchPhase::Ended | TouchPhase::Canceled => {
                let Some(place) = self.fingers.iter().position(|finger| finger.id == id) else { return };
                let finger = self.fingers.swap_remove(place);
                match finger.holds {
                    Holds::Button(action) => self.down.retain(|other| *other != action),
                    Holds::Stick(stick) => (self.stands[stick], self.sticks[stick]) = (None, Vec2::ZERO),
                    Holds::View if phase == TouchPhase::Ended && !finger.moved && now - finger.since < TAP.1.max(3.0 * self.frame) => {
                        let near = self.target.is_some_and(|target| target.distance(at) * pixels < NEAR);
                        self.looks = near && !self.looks;
                    }
                    Holds::View => (),
                }
            }
        }
    }

    /// What the sticks say, after all news.
    fn settle(&mut self) {
        for finger in &self.fingers {
            let Holds::Stick(stick) = finger.holds else { continue };
            let way = (finger.at - finger.from) * Vec2::new(1.0, -1.0) / (REACH * self.layout.radius);
            let answer = ((way.length().min(1.0) - DEAD) / (1.0 - DEAD)).max(0.0);
            self.sticks[stick] = way.normalize_or_zero() * answer;
        }
    }

    /// The fingers that hold nothing, and where they are.
    fn dragging(&self) -> Vec<(u64, Vec2)> {
        let free = self.fingers.iter().filter(|finger| finger.holds == Holds::View);
        free.map(|finger| (finger.id, finger.at)).collect()
    }
}

/// Has what began and ended within a frame end in the next: a menu must see it held to take it for a tap.
pub(super) fn spread_taps(mut news: ResMut<Messages<TouchInput>>, mut later: Local<Vec<TouchInput>>, mut written: Local<usize>) {
    // Those of the last frame are still there.
    let all: Vec<TouchInput> = later.drain(..).chain(news.drain().skip(*written)).collect();
    let mut begun = Vec::new();
    *written = 0;
    for touch in all {
        let ends = matches!(touch.phase, TouchPhase::Ended | TouchPhase::Canceled);
        let waits = later.iter().any(|other| other.id == touch.id) || (ends && begun.contains(&touch.id));
        if touch.phase == TouchPhase::Started {
            begun.push(touch.id);
        }
        if waits {
            later.push(touch);
        } else {
            news.write(touch);
            *written += 1;
        }
    }
}

/// What is played, if anything.
type Played<'w> = (Option<Res<'w, State<Screen>>>, Option<Res<'w, Session>>, Option<Res<'w, PlayerState>>);

/// Reads the fingers. In play alone: menus have them otherwise.
pub(super) fn read_touches(
    mut news: MessageReader<TouchInput>,
    (windows, real): (Query<&Window, With<PrimaryWindow>>, Res<Time<Real>>),
    (screen, session, player): Played,
    (mut turn, mut motion): (ResMut<MouseTurn>, ResMut<AccumulatedMouseMotion>),
    mut device: ResMut<Device>,
    (mut touch, touches): (ResMut<TouchControls>, Res<Touches>),
) {
    let touch = &mut *touch;
    touch.frame = real.delta_secs_f64();
    // Browsers tell of a finger's way as of a mouse's too.
    if touches.iter().next().is_some() || touches.iter_just_released().next().is_some() {
        motion.delta = Vec2::ZERO;
    }
    touch.pushed.clear();
    touch.pinch = None;
    let (Some(window), Some(session)) = (windows.iter().next(), session) else { return };
    let plays = screen.is_some_and(|screen| *screen.get() == Screen::Playing) && player.is_none_or(|player| !player.overlay);
    if !plays {
        touch.release();
    }
    // Who uses no finger pays for none.
    if *device != Device::Touch && news.is_empty() {
        return;
    }
    let pixels = points_of(window, &session);
    let size = Vec2::new(window.width(), window.height()) / pixels;
    touch.layout = TouchLayout::new(size, pixels, session.config.ship.bolts > 0);
    let before = touch.dragging();
    for TouchInput { phase, position, id, .. } in news.read() {
        device.set_if_neq(Device::Touch);
        if plays {
            touch.hear(*phase, *id, *position / pixels, real.elapsed_secs_f64(), pixels);
        }
    }
    touch.settle();
    let after = touch.dragging();
    match (&before[..], &after[..]) {
        // One finger leads the nose, or the camera of a replay.
        ([(one, from)], [(same, to)]) if one == same => turn.push((*to - *from) * pixels, &session.config),
        ([a, b], [c, d]) if (a.0, b.0) == (c.0, d.0) && c.1 != d.1 => touch.pinch = Some(a.1.distance(b.1) / c.1.distance(d.1)),
        _ => (),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::play::input::ControlsPlugin;
    use bevy::input::InputPlugin;

    const SIZE: Vec2 = Vec2::new(1180.0, 820.0);

    /// Controls for fingers with a target's marker in the middle.
    fn controls() -> TouchControls {
        TouchControls { layout: TouchLayout::new(SIZE, 1.0, true), target: Some(0.5 * SIZE), ..TouchControls::default() }
    }

    #[test]
    fn all_that_fingers_meet_is_wide_enough_and_apart() {
        for (size, pixels) in [(SIZE, 1.0), (Vec2::new(1340.0, 620.0), 0.63), (Vec2::new(900.0, 620.0), 1.0)] {
            let layout = TouchLayout::new(size, pixels, true);
            assert!(2.0 * layout.radius * pixels >= 44.0);
            for (k, button) in layout.buttons.iter().enumerate() {
                let inside = button.middle.cmpge(Vec2::splat(layout.radius)).all() && (button.middle + layout.radius).cmple(size).all();
                assert!(inside, "{size}: {button:?}");
                assert_eq!(layout.button(button.middle), Some(button.action));
                for other in &layout.buttons[..k] {
                    assert!(button.middle.distance(other.middle) >= 2.0 * layout.radius, "{size}: {button:?} {other:?}");
                }
                let apart = layout.sticks.iter().all(|stick| stick.distance(button.middle) > (REACH + 1.0) * layout.radius);
                assert!(apart, "{size}: {button:?} lies on a stick");
            }
        }
    }

    #[test]
    fn two_sticks_and_a_button_at_once() {
        let mut touch = controls();
        let [left, right] = touch.layout.sticks;
        let nose = touch.layout.buttons.iter().find(|button| button.action == Action::FaceTarget).expect("there").middle;
        touch.hear(TouchPhase::Started, 1, left, 0.0, 1.0);
        touch.hear(TouchPhase::Started, 2, right, 0.0, 1.0);
        touch.hear(TouchPhase::Started, 3, nose, 0.0, 1.0);
        touch.hear(TouchPhase::Moved, 1, left - Vec2::Y * 300.0, 0.1, 1.0);
        touch.hear(TouchPhase::Moved, 2, right + Vec2::X * 0.5 * REACH * touch.layout.radius, 0.1, 1.0);
        touch.settle();
        assert_eq!(touch.partly(Action::ThrustForward), 1.0);
        assert!((0.3..0.5).contains(&touch.partly(Action::YawRight)) && touch.partly(Action::PitchUp) == 0.0);
        assert!(touch.holds(Action::FaceTarget) && touch.pushed(Action::FaceTarget));
        for id in 1..=3 {
            touch.hear(TouchPhase::Ended, id, left, 0.2, 1.0);
        }
        touch.settle();
        assert!(touch.sticks == [Vec2::ZERO; 2] && !touch.holds(Action::FaceTarget));
    }

    #[test]
    fn a_tap_on_the_target_looks_there_until_the_next() {
        let mut touch = controls();
        let mut tap = |at: Vec2, seconds: f64| {
            touch.hear(TouchPhase::Started, 1, at, 0.0, 1.0);
            touch.hear(TouchPhase::Ended, 1, at, seconds, 1.0);
            touch.holds(Action::LookAtTarget)
        };
        let middle = 0.5 * SIZE;
        let found = [tap(middle + 60.0, 0.1), tap(middle + 20.0, 0.5), tap(middle + 20.0, 0.1), tap(middle, 0.1)];
        assert_eq!(found, [false, false, true, false]);
    }

    /// In a long frame a finger may come and go.
    #[test]
    fn a_tap_within_a_frame_is_held_in_one_and_gone_in_the_next() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, InputPlugin, ControlsPlugin));
        let touch = |phase| TouchInput { phase, position: Vec2::ONE, window: Entity::PLACEHOLDER, force: None, id: 7 };
        for phase in [TouchPhase::Started, TouchPhase::Moved, TouchPhase::Ended, TouchPhase::Started, TouchPhase::Ended] {
            app.world_mut().write_message(touch(phase));
        }
        let seen: Vec<(bool, bool)> = (0..4)
            .map(|_| {
                app.update();
                let touches = app.world().resource::<Touches>();
                (touches.iter().next().is_some(), touches.iter_just_released().next().is_some())
            })
            .collect();
        assert_eq!(seen, [(true, false), (true, true), (false, true), (false, false)]);
    }
}
