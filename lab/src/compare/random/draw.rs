//! Scenes that nobody chose: a case is drawn from a seed and its number alone, and is the text of a scene file.

use super::corner::Corner;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::path::Path;

use glam::DVec3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use super::place;
use super::text::{Text, rounded};
use lensrunner::scene::model::SHIP_MODELS;
use lensrunner::scene::{GameConfig, Scene};
use lensrunner::spacetime::orbit::Elements;

/// A case: a scene, when it is looked at, and how large the picture is.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// Where it was drawn from.
    pub corner: Corner,
    /// The text of the scene file.
    pub text: String,
    /// T in r_s/c.
    pub at: f64,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

/// A case's own source of chance: cases of one seed do not depend on each other.
pub fn chance(seed: u64, number: u64) -> StdRng {
    // SplitMix64's step makes neighbouring numbers far apart.
    StdRng::seed_from_u64(seed.wrapping_add(number.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15)))
}

/// Case `number` of `seed`. Scenes that no file may hold, or in which the camera is in a thing, are drawn again.
pub fn draw(seed: u64, number: u64) -> Drawn {
    let mut chance = chance(seed, number);
    let config = GameConfig::default();
    loop {
        let drawn = attempt(&mut chance);
        let is_fair = |drawn: &Drawn| {
            let scene = Scene::from_toml(Path::new("drawn.toml"), &drawn.text);
            scene.is_ok_and(|scene| place::is_fair(&scene, &config, drawn.at, drawn.corner == Corner::Within))
        };
        if is_fair(&drawn) {
            return by_hands(&drawn, seed, number).filter(is_fair).unwrap_or(drawn);
        }
    }
}

/// Keeps the chance of hands apart from that of scenes: any number does.
const HANDS: u64 = 0x4a17_d5ee;

/// The same with its ships flown by hands, for one case of four that has any; None for all others.
fn by_hands(drawn: &Drawn, seed: u64, number: u64) -> Option<Drawn> {
    let mut chance = chance(seed ^ HANDS, number);
    // A programme is flown by nobody.
    if !drawn.text.contains("[[ship]]") || drawn.text.contains("thrust = [") || !chance.random_bool(0.25) {
        return None;
    }
    let text = drawn.text.replace("[[ship]]\n", "[[ship]]\nai = \"hands\"\n");
    // They have flown for some time when they are looked at.
    Some(Drawn { text, at: rounded(chance.random_range(1.0..8.0)), ..drawn.clone() })
}

fn attempt(chance: &mut StdRng) -> Drawn {
    // Half of all where methods fail.
    let corner = if chance.random_bool(0.5) { Corner::Open } else { Corner::ALL[chance.random_range(1..Corner::ALL.len())] };
    let mut text = Text::default();
    let camera = place::camera_radius(corner, chance);
    let n = place::direction(chance);
    let eye = n * camera;
    let mut things = Things { chance, eye, corner, text: &mut text, count: 0, first: None };
    match corner {
        Corner::Open => (0..1 + things.chance.random_range(0..4)).for_each(|_| things.any()),
        Corner::Axis | Corner::Horizon | Corner::PhotonSphere => {
            things.any();
            if things.chance.random_bool(0.4) {
                things.any();
            }
        }
        Corner::Fast => (0..1 + things.chance.random_range(0..2)).for_each(|_| things.ship()),
        Corner::Small => things.sphere(),
        Corner::Rings => (0..2 + things.chance.random_range(0..2)).for_each(|_| things.any()),
        Corner::Within => {
            things.around();
            if things.chance.random_bool(0.6) {
                things.any();
            }
        }
        Corner::Planet => {}
    }
    let target = things.first;
    let at = if camera > 4.0 && things.chance.random_bool(0.3) { rounded(things.chance.random_range(0.0..6.0)) } else { 0.0 };
    let behind = (corner == Corner::Planet).then_some((eye, at));
    if behind.is_some() || (corner != Corner::Small && chance.random_bool(0.25)) {
        planet(chance, &mut text, behind);
    }
    let with_disk = match corner {
        Corner::Small => 0.1,
        Corner::Planet => 0.8,
        _ => 0.3,
    };
    if chance.random_bool(with_disk) {
        disk(chance, &mut text);
    }
    let size = *place::pick(
        chance,
        &[[160, 90], [160, 90], [160, 90], [160, 90], [160, 90], [160, 90], [120, 120], [90, 160], [256, 72], [72, 192], [320, 180]],
    );
    let text = format!("{}{}[sky]\nstars = false\nmilky_way = false\n", camera_text(chance, eye, target), text.finish());
    Drawn { corner, text, at, size }
}

/// The camera's section: how it moves, where it looks.
fn camera_text(chance: &mut StdRng, eye: DVec3, target: Option<DVec3>) -> String {
    let mut text = Text::default();
    text.section("[camera]");
    text.vector("position", eye);
    let momentum = place::camera_momentum(chance, eye);
    if let Some(momentum) = momentum {
        text.vector("momentum", momentum);
    }
    let mut fov: f64 = match chance.random_range(0..6) {
        0..3 => 60.0,
        3 => chance.random_range(5.0..40.0),
        4 => chance.random_range(40.0..100.0),
        _ => chance.random_range(100.0..150.0),
    };
    // Mostly to the hole, around which what is behind it is seen, or to where something there is is seen; the rest anywhere.
    let hole = place::seen(eye, momentum, DVec3::ZERO);
    let towards = match (chance.random_range(0..14), target) {
        (0..12, Some(target)) => {
            let (seen, behind) = (place::seen(eye, momentum, target), target.normalize_or_zero().dot(eye.normalize()) < -0.9);
            if behind {
                // The whole ring, give or take.
                fov = fov.max((2.5 * seen.angle_between(hole).to_degrees()).min(150.0));
            }
            if behind { hole } else { seen }
        }
        (12, _) => place::direction(chance),
        (13, _) => -hole,
        _ => hole,
    };
    text.vector("look", towards + place::direction(chance) * chance.random_range(0.0..0.3) * fov.to_radians());
    if chance.random_bool(0.3) {
        text.vector("up", place::direction(chance));
    }
    text.number("fov", fov);
    text.finish()
}

/// Draws the things of a scene.
struct Things<'a> {
    chance: &'a mut StdRng,
    eye: DVec3,
    corner: Corner,
    text: &'a mut Text,
    count: usize,
    /// Where the first of them is.
    first: Option<DVec3>,
}

impl Things<'_> {
    fn any(&mut self) {
        match self.chance.random_range(0..10) {
            0..4 => self.ship(),
            4..8 => self.sphere(),
            8 => self.model(),
            _ => self.square(),
        }
    }

    fn begin(&mut self, section: &str, kind: &str, position: DVec3) {
        self.count += 1;
        self.first.get_or_insert(position);
        self.text.section(section);
        self.text.word("name", &format!("{kind}-{}", self.count));
    }

    fn ship(&mut self) {
        let position = place::thing(self.chance, self.corner, self.eye, 0.25, false);
        self.begin("[[ship]]", "ship", position);
        let orbits = self.corner != Corner::Fast && position.length() > 1.6 && self.chance.random_bool(0.25);
        if orbits {
            let r = rounded(position.length());
            let [inclination, node, phase] = [PI, TAU, TAU].map(|most| rounded(self.chance.random_range(0.0..most)));
            self.text.line(&format!("orbit = {{ radius = {r:?}, inclination = {inclination:?}, node = {node:?}, phase = {phase:?} }}"));
        } else {
            self.text.vector("position", position);
            let momentum = place::ship_momentum(self.chance, self.corner, position);
            self.text.vector("momentum", momentum);
        }
        self.attitude();
        let model = *place::pick(self.chance, &SHIP_MODELS);
        self.text.word("model", model);
        if self.chance.random_bool(0.15) {
            let acceleration = place::direction(self.chance) * self.chance.random_range(0.02..0.3);
            let [x, y, z] = acceleration.to_array().map(rounded);
            self.text.line(&format!("thrust = [{{ from = 0.0, until = 10.0, acceleration = [{x:?}, {y:?}, {z:?}] }}]"));
        }
    }

    fn sphere(&mut self) {
        let size = self.size(0.3..5.0);
        let position = place::thing(self.chance, self.corner, self.eye, size, true);
        self.ball(position, size);
    }

    /// A ball that the camera is in.
    fn around(&mut self) {
        let (position, size) = place::ball_around(self.chance, self.eye);
        self.ball(position, rounded(size));
    }

    fn ball(&mut self, position: DVec3, size: f64) {
        self.begin("[[prop]]", "ball", position);
        let model = *place::pick(self.chance, &["sphere", "icosphere"]);
        self.text.word("model", model);
        self.text.vector("position", position);
        self.text.number("size", size);
        let least = if self.corner == Corner::Small { 1000f64 } else { 20.0 };
        let triangles = place::log_uniform(self.chance, least, 20_000.0);
        self.text.whole("triangles", triangles as u32);
        self.attitude();
        if self.chance.random_bool(0.5) {
            self.text.word("texture", "checker");
        }
    }

    fn model(&mut self) {
        let size = self.size(0.3..3.0);
        let position = place::thing(self.chance, self.corner, self.eye, size, true);
        self.begin("[[prop]]", "model", position);
        let model = *place::pick(self.chance, &SHIP_MODELS);
        self.text.word("model", model);
        self.text.vector("position", position);
        self.text.number("size", size);
        self.attitude();
    }

    fn square(&mut self) {
        let size = self.size(0.5..6.0);
        let position = place::thing(self.chance, self.corner, self.eye, size, true);
        self.begin("[[prop]]", "square", position);
        self.text.word("model", "square");
        self.text.vector("position", position);
        self.text.number("size", size);
        let triangles = place::log_uniform(self.chance, 2.0, 5000.0);
        self.text.whole("triangles", triangles as u32);
        self.attitude();
    }

    fn size(&mut self, range: std::ops::Range<f64>) -> f64 {
        rounded(place::log_uniform(self.chance, range.start, range.end))
    }

    fn attitude(&mut self) {
        if self.chance.random_bool(0.6) {
            let parts = [0; 4].map(|_| rounded(self.chance.random_range(-1.0..1.0)));
            self.text.line(&format!("attitude = {parts:?}"));
        }
    }
}

/// A planet anywhere; or behind the hole, seen from a place at a time.
fn planet(chance: &mut StdRng, text: &mut Text, behind: Option<(DVec3, f64)>) {
    let orbit = rounded(place::log_uniform(chance, 4.0, 40.0));
    text.section("[planet]");
    text.number("orbit_radius", orbit);
    text.number("radius", chance.random_range(0.02..0.2) * orbit);
    let [mut inclination, mut node, mut phase, tilt] = [PI, TAU, TAU, PI].map(|most| chance.random_range(0.0..most));
    if let Some((eye, at)) = behind {
        // Through the point opposite to the camera, give or take.
        let (azimuth, height) = (eye.y.atan2(eye.x), eye.normalize().z.asin());
        inclination = (height.abs() + chance.random_range(-0.1..0.1)).max(0.01);
        node = (azimuth - FRAC_PI_2.copysign(height)).rem_euclid(TAU);
        let circle = Elements { semi_latus_rectum: orbit, eccentricity: 0.0, inclination, node, phase: 0.0, anomaly: 0.0 };
        phase = place::phase_behind(chance, eye, at, &circle);
    }
    for (key, value) in [("inclination", inclination), ("node", node), ("phase", phase), ("axis_tilt", tilt)] {
        text.number(key, value);
    }
    text.word("aurora", "none");
}

fn disk(chance: &mut StdRng, text: &mut Text) {
    text.section("[disk]");
    if chance.random_bool(0.5) {
        let inner = rounded(chance.random_range(3.0..6.0));
        text.number("inner", inner);
        text.number("outer", inner + chance.random_range(2.0..15.0));
    }
}
