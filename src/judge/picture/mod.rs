//! Whole pictures by the judge: any scene, any camera, one geodesic for every sample of a pixel.
//!
//! - [`world`]: the bodies of a scene; their worldlines are handed in.
//! - `find`: what is seen in one direction, or in neighbouring ones together.
//! - `roots`: crossings of a curve of bounded bend with a plane.
//! - [`shade`], [`texture`], [`sky`], [`disk`]: the game's rules of colour.
//! - [`post_process`]: linear light to a picture for the eye.

pub mod disk;
mod find;
pub mod post_process;
mod roots;
pub mod shade;
pub mod sky;
pub mod texture;
pub mod world;

use std::f64::consts::PI;

use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;

pub use disk::{Disk, PlaneCrossing};
pub use find::Seen;
pub use world::worldline::{BodyMotion, Pose, Sway, Worldline};
pub use world::{Thing, World};

use super::bvh::order::squares;
use super::trace::{Hit, PixelCamera};
use shade::{LightShift, Surface, Textures, detail};
use sky::{SPOT_SIGMA, SkyBackground, Spot};

/// The parts of a scene that are not bodies.
pub struct Environment<'a> {
    /// The Milky Way.
    pub background: &'a SkyBackground,
    /// The stars' spots on this picture.
    pub stars: &'a [Spot],
    /// The accretion disk.
    pub disk: Option<&'a Disk>,
    /// How light changes on its way.
    pub shift: LightShift,
}

/// How exactly a picture is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Samples along each side of a pixel: n² rays in all.
    pub samples: u32,
    /// Local error of each step of a ray.
    pub tolerance: f64,
    /// Rays along each side of a packet; with 1 each goes alone. The picture is the same to the last bit.
    pub packet: u32,
}

/// Rays along each side of a packet unless asked otherwise.
pub const DEFAULT_PACKET: u32 = 8;

/// What the centre of a pixel shows, for comparing pictures. All are 0 where it shows no surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Layer {
    /// The number of the thing, from 1.
    pub object: u32,
    /// The triangle of its model, from 0: `object` alone tells whether there is one.
    pub triangle: u32,
    /// Weights of the triangle's corners.
    pub barycentrics: [f32; 3],
    /// Texture coordinates.
    pub uv: [f32; 2],
    /// The image order.
    pub order: u32,
    /// The angle Φ swept, radians.
    pub swept: f64,
    /// T_camera − T_emission, r_s/c.
    pub delay: f64,
    /// ν_observed/ν_emitted.
    pub g: f64,
    /// The surface's own light, linear RGB: without what the disk adds and takes on the way.
    pub light: [f32; 3],
}

/// A picture in linear light, with what its pixels show.
#[derive(Clone, Debug)]
pub struct TracedPicture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Linear RGB.
    pub light: Vec<[f32; 3]>,
    /// What the centre of each pixel shows.
    pub layers: Vec<Layer>,
    /// For each pixel the part of its samples that show each thing in each order: (object, order, part), in that order.
    pub shares: Vec<Vec<(u32, u32, f32)>>,
    /// The part of each pixel that nothing solid covers.
    pub open: Vec<f32>,
    /// Whether every sample of a pixel shows the shadow.
    pub dark: Vec<bool>,
    /// How many rays were given up: see [`World::given_up`].
    pub given_up: usize,
    /// How many pixels are missing, black, since the world's deadline passed before: see [`World::stop_at`].
    pub missing: u64,
}

impl TracedPicture {
    /// What was given up, in words; None if that is nothing.
    pub fn given_up_in_words(&self) -> Option<String> {
        let rays = if self.given_up == 1 { "1 ray was".into() } else { format!("{} rays were", self.given_up) };
        let why = "wound at the photon sphere beyond rounding, or took more looks at flying bodies than one ray is worth";
        (self.given_up > 0).then(|| format!("{rays} given up: {why}; such a ray shows what it had met, else the shadow"))
    }
}

/// Rows of pixels that one task traces together; texture detail is found from neighbours inside it.
const BAND: u32 = 8;

/// One ray: what it shows at its end, through the disk.
#[derive(Clone, Copy)]
struct PixelSample {
    end: Ending,
    /// The light of the disk in front.
    foreground: Vec3,
    /// The part of what is behind that comes through the disk.
    through: f32,
}

/// What a ray ends at, before it is coloured.
#[derive(Clone, Copy)]
enum Ending {
    Dark,
    Sky { direction: DVec3, g: f64 },
    Surface { hit: Hit, surface: Surface },
}

/// Traces the picture that `camera` sees. `done` is told how many pixels have been finished, again and again.
pub fn picture(
    world: &World,
    environment: &Environment,
    camera: &PixelCamera,
    sampling: &Sampling,
    done: &(dyn Fn(u64) + Sync),
) -> TracedPicture {
    let [width, height] = camera.size;
    let given_up = world.given_up();
    let painter = Painter { world, environment, camera, sampling, textures: Textures::of(world) };
    let bands: Vec<Band> = (0..height.div_ceil(BAND))
        .into_par_iter()
        .map(|band| {
            let (first, end) = (band * BAND, ((band + 1) * BAND).min(height));
            let traced = (!world.is_late()).then(|| painter.band(first, end));
            // What was being traced when the deadline passed is not finished.
            let Some(band) = traced.filter(|_| !world.is_late()) else { return Band::missing((width * (end - first)) as usize) };
            done(band.light.len() as u64);
            band
        })
        .collect();
    let count = (width * height) as usize;
    let mut picture = TracedPicture {
        size: camera.size,
        light: Vec::with_capacity(count),
        layers: Vec::with_capacity(count),
        shares: Vec::with_capacity(count),
        open: Vec::with_capacity(count),
        dark: Vec::with_capacity(count),
        given_up: world.given_up() - given_up,
        missing: bands.iter().map(|band| band.missing).sum(),
    };
    for band in bands {
        picture.light.extend(band.light);
        picture.layers.extend(band.layers);
        picture.shares.extend(band.shares);
        picture.open.extend(band.open);
        picture.dark.extend(band.dark);
    }
    for spot in environment.stars {
        draw_spot(&mut picture, spot);
    }
    picture
}

/// Adds a star's light to the pixels around it, as far as nothing solid covers them.
fn draw_spot(picture: &mut TracedPicture, spot: &Spot) {
    let [width, height] = picture.size.map(i64::from);
    let [x, y] = spot.place;
    for row in (y - 2.5).ceil() as i64..=(y + 2.5).floor() as i64 {
        for column in (x - 2.5).ceil() as i64..=(x + 2.5).floor() as i64 {
            let (dx, dy) = (column as f64 + 0.5 - x, row as f64 + 0.5 - y);
            if row < 0 || column < 0 || row >= height || column >= width || dx.abs() > 2.5 || dy.abs() > 2.5 {
                continue;
            }
            let at = (row * width + column) as usize;
            let weight = (-(dx * dx + dy * dy) / (2.0 * SPOT_SIGMA * SPOT_SIGMA)).exp() / (2.0 * PI * SPOT_SIGMA * SPOT_SIGMA);
            let light = spot.light * (weight as f32 * picture.open[at]);
            for (channel, add) in picture.light[at].iter_mut().zip(light.to_array()) {
                *channel += add;
            }
        }
    }
}

struct Painter<'a> {
    world: &'a World<'a>,
    environment: &'a Environment<'a>,
    camera: &'a PixelCamera,
    sampling: &'a Sampling,
    textures: Textures,
}

struct Band {
    light: Vec<[f32; 3]>,
    layers: Vec<Layer>,
    shares: Vec<Vec<(u32, u32, f32)>>,
    open: Vec<f32>,
    dark: Vec<bool>,
    /// How many of its pixels are missing.
    missing: u64,
}

impl Band {
    /// Empty, with room for so many pixels.
    fn with_capacity(pixels: usize) -> Band {
        Band {
            light: Vec::with_capacity(pixels),
            layers: Vec::with_capacity(pixels),
            shares: Vec::with_capacity(pixels),
            open: Vec::with_capacity(pixels),
            dark: Vec::with_capacity(pixels),
            missing: 0,
        }
    }

    /// Black and empty: so many pixels for which there was no time.
    fn missing(pixels: usize) -> Band {
        Band {
            light: vec![[0.0; 3]; pixels],
            layers: vec![Layer::default(); pixels],
            shares: vec![Vec::new(); pixels],
            open: vec![0.0; pixels],
            dark: vec![false; pixels],
            missing: pixels as u64,
        }
    }
}

impl Painter<'_> {
    fn band(&self, first: u32, end: u32) -> Band {
        let n = self.sampling.samples;
        let width = self.camera.size[0];
        let (columns, rows) = ((width * n) as usize, ((end - first) * n) as usize);
        let part = 1.0 / f64::from(n);
        let place = |index: usize| {
            let (row, column) = (index / columns, index % columns);
            [(column as f64 + 0.5) * part, f64::from(first) + (row as f64 + 0.5) * part]
        };
        let samples = self.samples(columns, rows, &place);
        let grid = Grid { samples: &samples, columns, rows };
        let mut band = Band::with_capacity((width * (end - first)) as usize);
        for y in 0..(end - first) as usize {
            for x in 0..width as usize {
                // With an even number of samples none lies at the centre: one more ray is traced for the layers.
                let [row, column] = [y, x].map(|k| k * n as usize + n as usize / 2);
                let centre =
                    if n % 2 == 1 { *grid.at(row, column) } else { self.sample(x as f64 + 0.5, f64::from(first) + y as f64 + 0.5) };
                self.add_pixel(&mut band, &grid, [x, y]);
                band.layers.push(self.layer(&grid, &centre, row, column));
            }
        }
        band
    }

    /// Adds the mean of a pixel's samples to a band, and what they have met.
    fn add_pixel(&self, band: &mut Band, grid: &Grid, [x, y]: [usize; 2]) {
        let n = self.sampling.samples as usize;
        let weight = 1.0 / (n * n) as f32;
        let mut light = Vec3::ZERO;
        let mut open = 0.0;
        let mut dark = true;
        let mut shares: Vec<(u32, u32, f32)> = Vec::new();
        for k in 0..n * n {
            let (row, column) = (y * n + k / n, x * n + k % n);
            let sample = grid.at(row, column);
            light += (sample.foreground + self.colour(grid, sample, row, column) * sample.through) * weight;
            dark &= matches!(sample.end, Ending::Dark) && sample.through == 1.0;
            match &sample.end {
                Ending::Surface { hit, .. } => {
                    let key = (self.world.things[hit.object].id, hit.order);
                    match shares.iter_mut().find(|share| (share.0, share.1) == key) {
                        Some(share) => share.2 += weight,
                        None => shares.push((key.0, key.1, weight)),
                    }
                }
                _ => open += weight * sample.through,
            }
        }
        shares.sort_unstable_by_key(|share| (share.0, share.1));
        band.light.push(light.to_array());
        band.shares.push(shares);
        band.open.push(open);
        band.dark.push(dark);
    }

    /// The rays of a band, `place` giving the place of each on the screen.
    fn samples(&self, columns: usize, rows: usize, place: &dyn Fn(usize) -> [f64; 2]) -> Vec<PixelSample> {
        let packet = self.sampling.packet as usize;
        if packet <= 1 {
            return (0..columns * rows).map(place).map(|[x, y]| self.sample(x, y)).collect();
        }
        let blank = PixelSample { end: Ending::Dark, foreground: Vec3::ZERO, through: 1.0 };
        let mut samples = vec![blank; columns * rows];
        let (order, starts) = squares([columns, rows], packet);
        for tile in starts.windows(2).map(|ends| &order[ends[0]..ends[1]]) {
            let rays: Vec<(DVec3, f64)> = tile.iter().map(|&index| place(index as usize)).map(|[x, y]| self.camera.look(x, y)).collect();
            let looks: Vec<DVec3> = rays.iter().map(|ray| ray.0).collect();
            let mut foregrounds = vec![(Vec3::ZERO, 1.0); tile.len()];
            let seen = self.world.look_together(self.camera.observer.position, &looks, self.sampling.tolerance, &mut |ray, crossing| {
                self.dim(&mut foregrounds[ray], &crossing, rays[ray].1);
            });
            for (k, &index) in tile.iter().enumerate() {
                samples[index as usize] = self.ended(seen[k], foregrounds[k], rays[k].1);
            }
        }
        samples
    }

    fn sample(&self, x: f64, y: f64) -> PixelSample {
        let (look, blue) = self.camera.look(x, y);
        let mut foreground = (Vec3::ZERO, 1.0);
        let seen = self.world.look_through(self.camera.observer.position, look, self.sampling.tolerance, &mut |crossing| {
            self.dim(&mut foreground, &crossing, blue)
        });
        self.ended(seen, foreground, blue)
    }

    /// What the disk adds to the light in front, and takes from what comes through.
    fn dim(&self, (light, through): &mut (Vec3, f32), crossing: &PlaneCrossing, blue: f64) {
        if let Some(disk) = self.environment.disk {
            let (added, opacity) = disk.light(crossing, blue, self.world.time, self.environment.shift);
            *light += added * *through;
            *through *= 1.0 - opacity;
        }
    }

    fn ended(&self, seen: Seen, (foreground, through): (Vec3, f32), blue: f64) -> PixelSample {
        let end = match seen {
            Seen::Captured => Ending::Dark,
            Seen::Sky { direction, energy, .. } => Ending::Sky { direction, g: blue / energy },
            Seen::Hit(hit) => Ending::Surface { hit, surface: self.world.surface(&hit, blue) },
        };
        PixelSample { end, foreground, through }
    }

    /// The light of what a ray ends at that goes through this place of the grid.
    fn colour(&self, grid: &Grid, sample: &PixelSample, row: usize, column: usize) -> Vec3 {
        match sample.end {
            Ending::Dark => Vec3::ZERO,
            Ending::Sky { direction, g } => {
                let size = grid.change(row, column, |other| match other.end {
                    Ending::Sky { direction: other, .. } => Some(direction.angle_between(other)),
                    _ => None,
                });
                self.environment.background.light(direction, size[0].max(size[1]), g, self.environment.shift)
            }
            Ending::Surface { hit, surface } => {
                let [across, down] = grid.change(row, column, |other| match other.end {
                    Ending::Surface { hit: other, surface: there } if other.object == hit.object && other.order == hit.order => {
                        Some(f64::from(there.uv.distance(surface.uv)))
                    }
                    _ => None,
                });
                let detail = detail(Vec2::X * across as f32, Vec2::X * down as f32);
                self.textures.light(self.world, hit.object, &surface, detail, self.environment.shift)
            }
        }
    }

    /// What a ray shows that goes through this place of the grid.
    fn layer(&self, grid: &Grid, sample: &PixelSample, row: usize, column: usize) -> Layer {
        let Ending::Surface { hit, surface } = &sample.end else { return Layer::default() };
        Layer {
            object: self.world.things[hit.object].id,
            triangle: hit.triangle as u32,
            barycentrics: hit.barycentrics.map(|w| w as f32),
            uv: surface.uv.to_array(),
            order: hit.order,
            swept: hit.swept,
            delay: hit.delay,
            g: surface.g,
            light: self.colour(grid, sample, row, column).to_array(),
        }
    }
}

/// Samples of a band, row by row.
struct Grid<'a> {
    samples: &'a [PixelSample],
    columns: usize,
    rows: usize,
}

impl Grid<'_> {
    fn at(&self, row: usize, column: usize) -> &PixelSample {
        &self.samples[row * self.columns + column]
    }

    /// How much something changes from a sample to its neighbour, across and down: the lesser of the changes to the two sides, as one of
    /// them may lie beyond an edge; 0 where `measure` finds no likeness on either.
    fn change(&self, row: usize, column: usize, measure: impl Fn(&PixelSample) -> Option<f64>) -> [f64; 2] {
        let least = |sides: [Option<&PixelSample>; 2]| {
            let least = sides.into_iter().flatten().filter_map(&measure).fold(f64::INFINITY, f64::min);
            if least.is_finite() { least } else { 0.0 }
        };
        let left = (column > 0).then(|| self.at(row, column - 1));
        let right = (column + 1 < self.columns).then(|| self.at(row, column + 1));
        let up = (row > 0).then(|| self.at(row - 1, column));
        let down = (row + 1 < self.rows).then(|| self.at(row + 1, column));
        [least([left, right]), least([up, down])]
    }
}
