//! How many chords a streak needs. The number is doubled until the middle of each chord lies where its light is seen, with bending and
//! delay.

use glam::{DMat3, DMat4, DVec2, DVec3};

use crate::render::aurora::animation::streaks::RowPlaces;
use crate::render::aurora::{BOTH_POLES, Segment};
use crate::render::instances::InstanceView;
use crate::scene::aurora::dipole::on_field_line;
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
/// Steps of the search for the emission time of a streak. Each step reduces the error to a third or less, and all of a streak is tested at
/// one time: a tenth of the light's way through the planet is near enough.
const SEARCH: u32 = 2;
/// Largest error of a chord's middle: this share of the whole length, of which the luminous one is half, or this many pixels, whichever is
/// more. (The ends of the light may be off by 1 % of the luminous length and half a pixel.)
const OF_LENGTH: f64 = 0.005;
const PIXELS: f64 = 0.5;
/// Most ends of chords in all images together: 48 bytes each, in a buffer of 128 MiB.
const MOST_ENDS: usize = 2_000_000;

/// What was found for one frame is kept until camera and planet together have moved by this share of the planet's radius, or of the way
/// from its ground if that is less: streaks are bent alike that long.
const KEPT: f64 = 0.1;

/// A number of chords, and what it was found for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chords {
    /// Of a streak that is not red.
    pub count: u32,
    /// Camera and planet, in r_s.
    places: [DVec3; 2],
    /// Radius of the planet, in r_s, and angle of a pixel, in rad.
    radius: f64,
    pixel: f64,
    /// The orders in which it was seen, a bit each.
    orders: u32,
    /// Whether light bends, and is delayed.
    light: [bool; 2],
}

impl Chords {
    /// For a planet of this `radius` at this `place`, in r_s, seen in these images.
    pub fn new(count: u32, view: &InstanceView, place: DVec3, radius: f64, departures: &[(Order, f64)]) -> Chords {
        let orders = departures.iter().fold(0, |orders, (order, _)| orders | 1 << order.number());
        let light = [view.settings.method.bends, view.settings.light_delay];
        Chords { count, places: [view.camera.position, place], radius, pixel: view.pixel, orders, light }
    }

    /// The number, if it still is right for these streaks where the rest is as in `now`.
    pub fn kept(&self, now: &Chords, segments: &[Segment]) -> Option<u32> {
        let moved = self.places[0].distance(now.places[0]) + self.places[1].distance(now.places[1]);
        let way = (self.places[0].distance(self.places[1]) - self.radius).clamp(0.0, self.radius);
        let is_kept = (self.orders, self.pixel, self.light) == (now.orders, now.pixel, now.light) && moved < KEPT * way;
        let fits = || ends(segments, self.count as usize, now.orders.count_ones()) <= MOST_ENDS;
        (is_kept && fits()).then_some(self.count)
    }
}

/// Ends of chords of these streaks in so many images.
fn ends(segments: &[Segment], chords: usize, images: u32) -> usize {
    let streaks: usize = segments.iter().map(|segment| segment.streaks as usize).sum();
    streaks * (2 * chords + 1) * images as usize
}

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

/// The planet at one time: where its centre is in r_s, and what turns km in the dipole's axes into r_s from there.
#[derive(Clone, Copy)]
struct Globe {
    centre: DVec3,
    axes: DMat3,
}

/// A height in km at which a chord ends or has its middle, and for how long light is delayed there, s.
type Height = [f64; 2];

/// Most ends and middles of the chords of a streak: of a red one, with twice as many chords.
const MOST_HEIGHTS: usize = 4 * MOST + 1;

/// Ends and middles of a streak's chords, from the highest down.
struct Heights {
    count: usize,
    all: [Height; MOST_HEIGHTS],
}

impl Heights {
    fn list(&self) -> &[Height] {
        &self.all[..self.count]
    }
}

/// The middle of a part of a curtain at one pole.
type Part<'a> = (&'a Segment, f64);

impl ChordInputs<'_, '_> {
    /// Number of chords for the streaks of these parts, in images of these orders, by the light that left the planet's centre at these
    /// times. `places` has the nodes of the parts; `middle(part, s)` is where the middle of a part was `s` seconds before, in km in the
    /// plane across the field: light is delayed in a curtain that moves.
    pub fn chords(
        &self,
        segments: &[Segment],
        places: &RowPlaces,
        middle: impl Fn(&Segment, f64) -> DVec2,
        departures: &[(Order, f64)],
        flags: u32,
    ) -> u32 {
        let ends = |chords: usize| ends(segments, chords, departures.len() as u32);
        let poles: &'static [f64] = if flags & BOTH_POLES != 0 { &[1.0, -1.0] } else { &[1.0] };
        let to_camera = self.view.camera.camera_from_rain();
        let mut chords = LEAST;
        let mut heights = self.heights(chords);
        for &(order, began) in departures {
            for part in self.sample(segments, places, poles, began) {
                let place = |height: Height| on_field_line(middle(part.0, height[1]), height[0]) * DVec3::new(1.0, 1.0, part.1);
                while chords < MOST && ends(2 * chords) <= MOST_ENDS && !self.hold(&heights, order, began, place, &to_camera) {
                    chords *= 2;
                    heights = self.heights(chords);
                }
            }
        }
        chords as u32
    }

    /// The parts that are tested, by where the planet was at the time `began`.
    fn sample<'a>(
        &self,
        segments: &'a [Segment],
        places: &RowPlaces,
        poles: &'static [f64],
        began: f64,
    ) -> impl Iterator<Item = Part<'a>> + use<'a> {
        let axis = self.view.camera.position.normalize();
        let globe = self.globe(began);
        // The square of the distance from the axis.
        let mut nearest = [(f64::INFINITY, None); NEAREST];
        for segment in segments {
            let node = segment.first_node + (segment.span - 1) / 2;
            let Some(point) = places.points.get(node as usize) else { continue };
            for &pole in poles {
                let off = globe.place(*point * DVec3::new(1.0, 1.0, pole)).reject_from_normalized(axis).length_squared();
                if off < nearest[NEAREST - 1].0 {
                    let k = nearest.partition_point(|other| other.0 <= off);
                    nearest[k..].rotate_right(1);
                    nearest[k] = (off, Some((segment, pole)));
                }
            }
        }
        // So many of each pole as make them all together.
        let step = segments.len().div_ceil(OTHERS / poles.len()).max(1);
        let others = poles.iter().flat_map(move |&pole| segments.iter().step_by(step).map(move |segment| (segment, pole)));
        nearest.into_iter().filter_map(|(_, part)| part).chain(others)
    }

    /// Ends and middles of so many chords of a green streak, and of twice as many of a red one, from the highest down; as in streaks.wgsl.
    fn heights(&self, chords: usize) -> [Heights; 2] {
        [(Line::Green, chords), (Line::Red, 2 * chords)].map(|(line, count)| {
            let [high, low] = self.heights[usize::from(line == Line::Red)];
            let end = |k: usize| {
                let left = 1.0 - k as f64 / count as f64;
                low + (high - low) * if line == Line::Red { left * left } else { left }
            };
            let height = |k: usize| 0.5 * (end(k / 2) + end(k.div_ceil(2)));
            let mut heights = Heights { count: 2 * count + 1, all: [[0.0; 2]; MOST_HEIGHTS] };
            for (k, place) in heights.all[..heights.count].iter_mut().enumerate() {
                *place = [height(k), lines::delays(height(k))[line as usize]];
            }
            heights
        })
    }

    /// Whether with chords between these heights every middle lies where its light is seen. Chords that are not seen count as right.
    fn hold(&self, heights: &[Heights; 2], order: Order, began: f64, place: impl Fn(Height) -> DVec3, to_camera: &DMat4) -> bool {
        let Some(low) = heights[0].list().last().map(|height| place(*height)) else { return true };
        let mut emission = began;
        for _ in 0..if self.view.settings.light_delay { SEARCH } else { 0 } {
            let Some((_, path)) = self.view.look(self.globe(emission).place(low), order, self.time - emission) else { return true };
            emission = self.time - path;
        }
        let globe = self.globe(emission);
        heights.iter().map(Heights::list).zip(self.tops).all(|(heights, top)| {
            let mut seen = [DVec3::ZERO; MOST_HEIGHTS];
            for (seen, height) in seen.iter_mut().zip(heights) {
                let Some((look, path)) = self.view.look(globe.place(place(*height)), order, self.time - emission) else { return true };
                // As in shaders/geometry/project.wgsl.
                *seen = (*to_camera * (look * path).extend(-path)).truncate();
            }
            let seen = &seen[..heights.len()];
            let allowed = (OF_LENGTH * seen[0].angle_between(seen[seen.len() - 1])).max(PIXELS * self.view.pixel);
            let mut middles = seen.windows(3).step_by(2).zip(heights.iter().skip(1).step_by(2)).filter(|(_, [height, _])| *height <= top);
            middles.all(|(chord, _)| (0.5 * (chord[0] + chord[2])).angle_between(chord[1]) <= allowed)
        })
    }

    fn globe(&self, time: f64) -> Globe {
        let sample = self.history.at(time);
        Globe { centre: sample.position, axes: DMat3::from_quat(sample.attitude) * self.scale }
    }
}

impl Globe {
    /// A point in km in the dipole's axes, in r_s.
    fn place(&self, point: DVec3) -> DVec3 {
        self.centre + self.axes * point
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For a planet of radius 0.4 at 5 r_s, seen from `way` above its ground.
    fn chords(way: f64) -> Chords {
        let place = DVec3::new(0.0, 5.0, 0.0);
        let camera = place + DVec3::new(0.4 + way, 0.0, 0.0);
        Chords { count: 4, places: [camera, place], radius: 0.4, pixel: 1e-3, orders: 2, light: [true; 2] }
    }

    fn moved(from: Chords, by: f64) -> Chords {
        Chords { places: [from.places[0] + DVec3::new(0.0, 0.0, by), from.places[1]], ..from }
    }

    #[test]
    fn a_number_is_kept_over_a_tenth_of_the_way() {
        for (way, kept) in [(5.0, 0.04), (0.1, 0.01)] {
            let before = chords(way);
            assert_eq!(before.kept(&moved(before, 0.99 * kept), &[]), Some(4), "from {way} above");
            assert_eq!(before.kept(&moved(before, 1.01 * kept), &[]), None, "from {way} above");
        }
        // Where the camera was in the ground.
        assert_eq!(chords(-0.2).kept(&chords(-0.2), &[]), None);
    }

    #[test]
    fn another_way_of_looking_needs_another_number() {
        let before = chords(5.0);
        let others = [Chords { pixel: 2e-3, ..before }, Chords { orders: 6, ..before }, Chords { light: [true, false], ..before }];
        for other in others {
            assert_eq!(before.kept(&other, &[]), None, "{other:?}");
        }
    }

    #[test]
    fn more_streaks_than_fit_need_another_number() {
        let before = chords(5.0);
        let part = |streaks| Segment { streaks, ..Segment::default() };
        let most = (MOST_ENDS / 9) as u32;
        assert_eq!(before.kept(&before, &[part(most)]), Some(4));
        assert_eq!(before.kept(&before, &[part(most), part(1)]), None);
    }
}
