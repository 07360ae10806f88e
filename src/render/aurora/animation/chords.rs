//! How many chords a streak needs. The number is doubled until the middle of each chord lies where its light is seen, with bending and
//! delay.

use glam::{DVec2, DVec3};

use crate::render::aurora::{BOTH_POLES, Segment};
use crate::render::instances::{InstanceView, departure};
use crate::scene::aurora::dipole::{REFERENCE_HEIGHT, on_field_line};
use crate::scene::aurora::lines::{self, Line};
use crate::sim::History;
use crate::spacetime::light::Order;

/// Fewest and most chords of a streak that is not red.
const LEAST: usize = 2;
const MOST: usize = 16;
/// Parts of the curtains that are tested in each image: those nearest to the axis through the hole, where light is bent most, and others
/// evenly spread.
const NEAREST: usize = 6;
const OTHERS: usize = 16;
/// Steps of the search for the emission time of a streak. Each step reduces the error to a third or less.
const SEARCH: u32 = 4;
/// Largest error of a chord's middle: this share of the whole length, of which the luminous one is half, or this many pixels, whichever is
/// more. (The ends of the light may be off by 1 % of the luminous length and half a pixel.)
const OF_LENGTH: f64 = 0.005;
const PIXELS: f64 = 0.5;
/// Most ends of chords in all images together: 48 bytes each, in a buffer of 128 MiB.
const MOST_ENDS: usize = 2_000_000;

/// What the chords depend on.
pub struct ChordInputs<'a, 'b> {
    /// The camera.
    pub view: &'a InstanceView<'b>,
    /// T of the frame.
    pub time: f64,
    /// The planet's worldline, with the dipole's axes.
    pub history: &'a History,
    /// r_s in a km of the planet.
    pub scale: f64,
    /// For green and for red light, the height (km) above which hardly any is made: chords up there are not tested.
    pub tops: [f64; 2],
    /// The greatest and the least height (km) of green light and of red: [`crate::scene::aurora::quantiles::Quantiles::ends`].
    pub heights: [[f64; 2]; 2],
}

impl ChordInputs<'_, '_> {
    /// Number of chords for the streaks of these parts, in images of these orders. `middle(part, s)` is where the middle of a part was `s`
    /// seconds before, in km in the plane across the field: light is delayed in a curtain that moves.
    pub fn chords(&self, segments: &[Segment], middle: impl Fn(&Segment, f64) -> DVec2, orders: &[Order], flags: u32) -> u32 {
        let streaks: usize = segments.iter().map(|segment| segment.streaks as usize).sum();
        let ends = |chords: usize| streaks * (2 * chords + 1) * orders.len();
        let poles: &[f64] = if flags & BOTH_POLES != 0 { &[1.0, -1.0] } else { &[1.0] };
        let axis = self.view.camera.position.normalize();
        let mut chords = LEAST;
        for &order in orders {
            let Some(began) = departure(self.view, self.time, self.history, order).map(|light| light.time) else { continue };
            let all = segments.iter().flat_map(|segment| poles.iter().map(move |pole| (segment, *pole)));
            let mut sample: Vec<(f64, &Segment, f64)> = all
                .map(|(segment, pole)| {
                    let there = self.position(began, middle(segment, 0.0), pole, REFERENCE_HEIGHT);
                    (there.reject_from_normalized(axis).length_squared(), segment, pole)
                })
                .collect();
            if sample.len() > NEAREST {
                sample.select_nth_unstable_by(NEAREST, |a, b| a.0.total_cmp(&b.0));
                let step = (sample.len() - NEAREST).div_ceil(OTHERS);
                let others: Vec<_> = sample.drain(NEAREST..).step_by(step).collect();
                sample.extend(others);
            }
            for (_, segment, pole) in sample {
                let streak = |line: Line, height: f64| (middle(segment, lines::delays(height)[line as usize]), pole);
                while chords < MOST && ends(2 * chords) <= MOST_ENDS && !self.hold(chords, order, began, streak) {
                    chords *= 2;
                }
            }
        }
        chords as u32
    }

    /// Whether with so many chords every middle lies where its light is seen. Chords that are not seen count as right.
    fn hold(&self, chords: usize, order: Order, began: f64, streak: impl Fn(Line, f64) -> (DVec2, f64)) -> bool {
        [(Line::Green, chords), (Line::Red, 2 * chords)].into_iter().enumerate().all(|(kind, (line, count))| {
            let [high, low] = self.heights[kind];
            // Ends and middles; as in streaks.wgsl.
            let height = |k: usize| {
                let end = |k: usize| {
                    let left = 1.0 - k as f64 / count as f64;
                    low + (high - low) * if line == Line::Red { left * left } else { left }
                };
                0.5 * (end(k / 2) + end(k.div_ceil(2)))
            };
            let mut emission = began;
            let seen = |emission: f64, height: f64| {
                let (plane, pole) = streak(line, height);
                self.view.look(self.position(emission, plane, pole, height), order, self.time - emission)
            };
            for _ in 0..if self.view.settings.light_delay { SEARCH } else { 0 } {
                let Some((_, path)) = seen(emission, low) else { return true };
                emission = self.time - path;
            }
            let apparent = |k: usize| {
                let (look, path) = seen(emission, height(k))?;
                // As in shaders/geometry/project.wgsl.
                Some((self.view.camera.camera_from_rain() * (look * path).extend(-path)).truncate())
            };
            let Some(seen) = (0..=2 * count).map(apparent).collect::<Option<Vec<DVec3>>>() else { return true };
            let allowed = (OF_LENGTH * seen[0].angle_between(seen[2 * count])).max(PIXELS * self.view.pixel);
            let mut middles = seen.windows(3).step_by(2).enumerate().filter(|(chord, _)| height(2 * chord + 1) <= self.tops[kind]);
            middles.all(|(_, chord)| (0.5 * (chord[0] + chord[2])).angle_between(chord[1]) <= allowed)
        })
    }

    /// Position at a time, in r_s, of a point of the aurora, given in the plane across the field and by its height, both in km.
    fn position(&self, time: f64, plane: DVec2, pole: f64, height: f64) -> DVec3 {
        let sample = self.history.at(time);
        sample.position + sample.attitude * (on_field_line(plane, height) * DVec3::new(1.0, 1.0, pole) * self.scale)
    }
}
