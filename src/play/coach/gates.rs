//! A word on a gate that was missed: how far off its middle one passed it.

use bevy::prelude::*;

use crate::play::hud::notice::Notice;
use crate::play::hud::panel::{GateAhead, Panel};
use crate::play::input::action::Action;
use crate::play::input::bindings::Bindings;
use crate::play::input::button::Device;
use crate::play::menus::screens::Screen;
use crate::play::player_state::PlayerState;
use crate::play::session::Session;
use crate::play::words;
use crate::sim::replay::Playback;

/// A gate counts as missed by who passes it within so many of its radii; whoever is farther off is still on the way.
const NEAR: f64 = 6.0;
/// It is passed when the distance has grown again by this share of its radius.
const PAST: f64 = 0.5;
/// How long a miss is said, in seconds of wall time.
const SHOWN: f64 = 6.0;

/// The approach to the next gate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Approaching {
    number: usize,
    nearest: f64,
    said: bool,
}

impl Approaching {
    /// Goes on by a frame. How near its middle was passed (r_s), once for each time that it is missed.
    fn follow(&mut self, gate: Option<&GateAhead>) -> Option<f64> {
        let Some(gate) = gate else {
            *self = Approaching::default();
            return None;
        };
        let before = *self;
        let is_nearer = before.number != gate.number || gate.distance < before.nearest;
        if is_nearer {
            *self = Approaching { number: gate.number, nearest: gate.distance, said: false };
            return None;
        }
        if before.said || gate.distance < before.nearest + PAST * gate.radius {
            return None;
        }
        // From here the next approach begins.
        *self = Approaching { nearest: gate.distance, said: true, ..before };
        (before.nearest < NEAR * gate.radius).then_some(before.nearest)
    }
}

/// Says so when a gate was missed by hand.
pub(super) fn say_missed_gate(
    (panel, player, playback): (Res<Panel>, Res<PlayerState>, Option<Res<Playback>>),
    (session, screen, real): (Res<Session>, Res<State<Screen>>, Res<Time<Real>>),
    (bindings, device): (Res<Bindings>, Res<Device>),
    mut approaching: Local<Approaching>,
    mut notice: ResMut<Notice>,
) {
    let missed = approaching.follow(panel.gate.as_ref());
    let by_hand = *screen.get() == Screen::Playing && !player.autopilot && playback.is_none();
    let Some((nearest, gate)) = missed.zip(panel.gate).filter(|_| by_hand) else { return };
    let language = session.language();
    let button = words::buttons::of(language, &bindings, *device, Action::FaceTarget);
    let [number, nearest, radius] = [gate.number.to_string(), format!("{nearest:.1}"), format!("{:.1}", gate.radius)];
    let values = [("number", number.as_str()), ("nearest", nearest.as_str()), ("radius", radius.as_str()), ("button", button.as_str())];
    *notice = Notice { text: language.fill("coach-gate", &values), until: real.elapsed_secs_f64() + SHOWN, share: None };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gate_is_missed_once_for_each_pass() {
        let mut approaching = Approaching::default();
        let mut said = Vec::new();
        let mut fly = |number: usize, ways: &[f64]| {
            for &distance in ways {
                let gate = GateAhead { direction: None, number, distance, radius: 1.0 };
                said.extend(approaching.follow(Some(&gate)));
            }
        };
        fly(1, &[9.0, 5.0, 2.0, 1.4, 1.8, 2.2, 4.0, 8.0]);
        // Round, and past it again; then through it, after which the next is far off.
        fly(1, &[6.0, 3.0, 1.2, 1.9, 3.0, 2.0, 0.3]);
        fly(2, &[9.0, 20.0, 30.0, 8.0]);
        assert_eq!(said, [1.4, 1.2]);
        assert_eq!(approaching.follow(None), None);
        assert_eq!(approaching, Approaching::default());
    }
}
