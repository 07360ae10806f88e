//! The walks of the aurora's experiment on the GPU as runners of the chart `aurora`.

use std::cell::RefCell;
use std::rc::Rc;
use std::time::Instant;

use glam::{Mat3, Vec3};

use crate::aurora::engine::draw::{Job, TOLERANCE, Timed};
use crate::aurora::engine::lattice::Lattice;
use crate::aurora::engine::splat::Picture;
use crate::aurora::engine::walk::across;
use crate::aurora::experiment::Runner;
use crate::aurora::race::{Electron, Experiment, Race, Scene, Walk};
use crate::aurora::sheet::{FALLS, Falls, LEVELS, TOP, row_reach};
use lensrunner::render::Gpu;

/// One walk on the best adapter there is.
struct Contestant {
    race: Rc<RefCell<Race>>,
    walk: Walk,
}

/// The adapter's name and both walks on it; none, and a word on stderr, where there is no adapter or it cannot do it.
pub fn runners() -> (String, Vec<Box<dyn Runner>>) {
    let race = match Gpu::headless() {
        Ok(gpu) => Race::new(&gpu),
        Err(error) => {
            eprintln!("lensrunner: {error}; the chart is drawn without a graphics adapter");
            return (String::new(), Vec::new());
        }
    };
    let Some(race) = race else {
        eprintln!("lensrunner: the graphics adapter cannot add up 32-bit floats; the chart is drawn without it");
        return (String::new(), Vec::new());
    };
    let name = race.adapter();
    let race = Rc::new(RefCell::new(race));
    let runner = |walk| Box::new(Contestant { race: race.clone(), walk }) as Box<dyn Runner>;
    (name, vec![runner(Walk::Particles), runner(Walk::Exact)])
}

fn row(v: Vec3) -> [f32; 4] {
    v.extend(0.0).to_array()
}

fn columns(m: Mat3) -> [[f32; 4]; 3] {
    [m.x_axis, m.y_axis, m.z_axis].map(row)
}

/// Of each level what lab/shaders/aurora/experiment_walks.wgsl asks for; there are `chords` chords from the top down to `foot`.
fn air(falls: &Falls, chords: usize, foot: f32) -> Vec<[f32; 4]> {
    let length = (TOP as f32 - foot) / chords as f32;
    let chord = |height: f32| (((TOP as f32 - height) / length) as usize).min(chords - 1) as f32;
    let level = |k: usize| [falls.heights[k], falls.sway[k], falls.overheads[k] as f32, chord(falls.heights[k])];
    (0..LEVELS).map(level).collect()
}

/// The table of falls in its order.
fn table(falls: &Falls) -> Vec<[f32; 4]> {
    let row = |row: usize| {
        let (below, _) = falls.spent[row][1..].as_chunks::<4>();
        below.iter().copied().chain([[row_reach(row) as f32, falls.stops[row] as f32, 0.0, 0.0]])
    };
    (0..FALLS).flat_map(row).collect()
}

impl Runner for Contestant {
    fn name(&self) -> &str {
        match self.walk {
            Walk::Particles => "particles-gpu",
            Walk::Exact => "exact-gpu",
        }
    }

    fn draw(&mut self, job: &Job) -> Option<Timed> {
        let eye = job.eye;
        // The lattice is made on the processor, as for the walk there.
        let start = Instant::now();
        let lattice = Lattice::around(eye, job.streaks, TOLERANCE);
        let before = if self.walk == Walk::Exact { start.elapsed().as_secs_f64() } else { 0.0 };
        let (low, per_km, cells) = lattice.grid();
        let (origin, order, place, axes) = match &eye.bent {
            None => (eye.position, 0, Mat3::IDENTITY, eye.axes),
            Some(bent) => (bent.origin, bent.order, bent.place, bent.axes),
        };
        let across = across();
        let uniform = Experiment {
            origin: origin.extend(order as f32).to_array(),
            place: columns(place),
            axes: columns(axes),
            across: across.map(row),
            across_seen: across.map(|e| row(eye.direction(e))),
            screen: [0.5 * eye.size[0] as f32, 0.5 * eye.size[1] as f32, eye.focal, eye.scale()],
            various: [eye.near(), job.splat.radius, lattice.foot(), 0.0],
            lattice: [low.x, low.y, per_km.x, per_km.y],
            cells: [cells[0] as u32, cells[1] as u32, cells[2] as u32, job.seed],
        };
        let electrons: Vec<Electron> = job
            .streaks
            .iter()
            .map(|streak| Electron {
                top: streak.top.extend(streak.end_height).to_array(),
                end: streak.end.extend(streak.collisions).to_array(),
                numbers: [streak.row, streak.id, 0, 0],
            })
            .collect();
        let nodes: Vec<[f32; 4]> = lattice.nodes().iter().map(|node| row(*node)).collect();
        let scene = Scene {
            uniform,
            size: eye.size.map(|side| side as u32),
            slice: eye.bent.as_ref().map(|bent| bent.slice.texels()),
            electrons: &electrons,
            nodes: &nodes,
            air: &air(job.falls, lattice.chords(), lattice.foot()),
            falls: &table(job.falls),
            light: &job.falls.light,
        };
        let drawn = self.race.borrow_mut().draw(&scene, self.walk).inspect_err(|error| eprintln!("lensrunner: {error}")).ok()?;
        let picture = Picture { size: eye.size, pixels: drawn.pixels };
        Some(Timed { picture, walk: (before + drawn.walk) * 1e3, splat: drawn.splat * 1e3 })
    }
}
