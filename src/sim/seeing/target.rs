//! Where the target is and where it is seen.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DQuat, DVec3};

use super::body::{SeenBody, SeenImage};
use super::field::Field;
use super::kind::{Phenomenon, Pointer};
use crate::sim::sight;

/// How far from the line through camera and hole, in rad as seen from the hole, a body's images of order 1 and 2 nearly join: 4 degrees.
const BEHIND: f64 = 0.07;

/// The target's sights. `images` are its own, of order 1 and 2; `others` those of bodies that may be before them.
pub fn target(field: &Field, time: f64, body: &SeenBody, images: &[Option<SeenImage>], others: &[SeenImage]) -> Vec<Pointer> {
    let mut found = Vec::new();
    let truth = body.track.place(time).and_then(|place| sight::true_direction(field.eye.camera, place));
    found.extend(truth.map(|direction| Pointer { sight: Phenomenon::TrueTarget, direction, number: None }));
    // A ring is the image of both orders.
    let is_ring = images.iter().flatten().any(|image| image.half_turn >= PI && image.swept > FRAC_PI_2);
    for (image, sight) in images.iter().zip([Phenomenon::TargetImage, Phenomenon::SecondImage]).take(if is_ring { 1 } else { 2 }) {
        let Some(image) = image.filter(|image| is_open(field, image.direction, image.swept, image.age, others)) else { continue };
        found.push(Pointer { sight, direction: image.direction, number: Some(image.age) });
    }
    found.extend(images.first().and_then(|image| ring(field, image.as_ref()?, others)));
    found
}

/// A place on the ring that the image of order 1 is part of, beside the image's middle.
fn ring(field: &Field, image: &SeenImage, others: &[SeenImage]) -> Option<Pointer> {
    let off = PI - image.swept;
    if !(0.0..=BEHIND).contains(&off) {
        return None;
    }
    let middle = field.eye.seen(PI, image.side);
    [0.5, -0.5].into_iter().find_map(|part| {
        let turn = part * image.half_turn;
        // Seen from the line the body is a disk; this is the middle of its chord in that direction.
        let swept = PI - off * libm::cos(turn);
        let side = DQuat::from_axis_angle(field.eye.outward, turn) * image.side;
        let direction = field.eye.seen_ray(image.r, swept, side)?;
        let pointer = Pointer { sight: Phenomenon::EinsteinRing, direction, number: Some(direction.angle_between(middle)) };
        is_open(field, direction, swept, image.age, others).then_some(pointer)
    })
}

/// Whether light of this age (r_s/c) from Φ = `swept` comes through from the direction, which is on the screen, past gas and nearer bodies.
fn is_open(field: &Field, direction: DVec3, swept: f64, age: f64, others: &[SeenImage]) -> bool {
    let look = field.eye.look(direction);
    field.screen.place(direction).is_some() && look.is_clear(swept) && !others.iter().any(|other| other.age < age && other.covers(&look))
}
