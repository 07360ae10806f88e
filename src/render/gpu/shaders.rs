//! The shader of each pass: its own file of `shaders/`, with the modules that it imports (`library.rs`).

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::{LazyLock, Mutex, PoisonError};

use wgpu::naga::Module;

use crate::lensing::methods::Method;
use crate::render::gpu::library::{File, Library, Values, Worldlines, file};

/// The libraries that passes have been composed from. One for each choice of worldlines and method, so that its modules are worked out once.
static LIBRARIES: LazyLock<Mutex<HashMap<(Worldlines, &str), Library>>> = LazyLock::new(Default::default);

/// The passes of a frame, by the file that holds their entry points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Pass {
    /// Projects the model vertices.
    Vertices,
    /// Measures the model edges.
    Edges,
    /// The object stage.
    Triangles,
    /// Splits pieces.
    Refine,
    /// Turns counts into indirect arguments.
    Arguments,
    /// The mesh stage.
    Mesh,
    /// Lists thin triangles and their tiles.
    ThinLists,
    /// Rasterises.
    Draw,
    /// Works the sky out at the corners of cells.
    SkyCells,
    /// The sky behind everything.
    Background,
    /// Projects stars.
    StarsProject,
    /// Draws stars.
    StarsDraw,
    /// Projects places amid the parts of the aurora's curtains.
    AuroraProject,
    /// The ends of each streak's chords.
    AuroraEnds,
    /// The depths of what is drawn, by tiles.
    AuroraRanges,
    /// Walks between the ends of chords.
    AuroraWalk,
    /// Adds up the aurora's light.
    AuroraDraw,
    /// Enlarges a coarse picture of it into the next finer one.
    AuroraSpread,
    /// Makes the finest picture of it black where there will be light.
    AuroraWipe,
    /// Makes it a colour.
    AuroraResolve,
    /// Lays thin triangles over the picture.
    Compose,
    /// Halves and doubles the picture.
    Bloom,
    /// Meters the light.
    Exposure,
    /// Measures the brightness of the whole picture.
    Flashes,
    /// Exposes, blooms, encodes.
    ToneMap,
    /// Finds the tiles with outlines of bodies.
    Outlines,
    /// Smooths them.
    Smooth,
    /// Enlarges a picture that was drawn smaller than the output.
    Upscale,
    /// Projects the places of the disk's arcs, and those that halving asks for.
    DiskVertices,
    /// Decides how often arcs are halved.
    DiskSegments,
    /// Joins the arcs' points by triangles.
    DiskStrips,
    /// Turns the disk's counts into indirect arguments.
    DiskArguments,
    /// Rasterises the disk.
    DiskDraw,
    /// Rasterises the disk of polygons.
    DiskPolygons,
    /// Projects the disk's sprites.
    DiskSprites,
    /// Draws the disk's sprites.
    DiskSpritesDraw,
}

impl Pass {
    /// All passes.
    pub const ALL: [Pass; 36] = [
        Pass::Vertices,
        Pass::Edges,
        Pass::Triangles,
        Pass::Refine,
        Pass::Arguments,
        Pass::Mesh,
        Pass::ThinLists,
        Pass::Draw,
        Pass::SkyCells,
        Pass::Background,
        Pass::StarsProject,
        Pass::StarsDraw,
        Pass::AuroraProject,
        Pass::AuroraEnds,
        Pass::AuroraRanges,
        Pass::AuroraWalk,
        Pass::AuroraDraw,
        Pass::AuroraSpread,
        Pass::AuroraWipe,
        Pass::AuroraResolve,
        Pass::Compose,
        Pass::Bloom,
        Pass::Exposure,
        Pass::Flashes,
        Pass::ToneMap,
        Pass::Outlines,
        Pass::Smooth,
        Pass::Upscale,
        Pass::DiskVertices,
        Pass::DiskSegments,
        Pass::DiskStrips,
        Pass::DiskArguments,
        Pass::DiskDraw,
        Pass::DiskPolygons,
        Pass::DiskSprites,
        Pass::DiskSpritesDraw,
    ];

    /// The shader of the pass.
    pub fn module(self) -> Module {
        self.module_by(Method::default(), true)
    }

    /// The same with another method of projection, where the pass looks rays up.
    /// `inside` is whether the camera may be inside the horizon.
    pub fn module_by(self, method: Method, inside: bool) -> Module {
        self.module_along(self.worldlines(), method, inside)
    }

    /// The same where the points of models go along other worldlines.
    pub fn module_along(self, worldlines: Worldlines, method: Method, inside: bool) -> Module {
        self.composed(worldlines, method, inside, "")
    }

    /// The shader of the pass with `more` behind its own file: what a test runs of it.
    pub fn module_with(self, more: &str) -> Module {
        self.composed(self.worldlines(), Method::default(), true, more)
    }

    /// Those of what the pass projects.
    fn worldlines(self) -> Worldlines {
        match self {
            // A planet turns evenly, and its aurora has no nodes at hand.
            Pass::AuroraProject | Pass::AuroraEnds => Worldlines::Even,
            _ => Worldlines::Bodies,
        }
    }

    fn composed(self, worldlines: Worldlines, method: Method, inside: bool, more: &str) -> Module {
        let (path, source) = self.file();
        // What is always a planet's is so whatever else is drawn.
        let worldlines = if self.worldlines() == Worldlines::Even { Worldlines::Even } else { worldlines };
        let values = Values { inside: inside && self.may_be_inside(), data_group: if self.draws_data() { 2 } else { 1 } };
        let mut libraries = LIBRARIES.lock().unwrap_or_else(PoisonError::into_inner);
        let composed = match libraries.entry((worldlines, method.name)) {
            Entry::Occupied(library) => library.into_mut().compose(path, &[source, more].concat(), values),
            Entry::Vacant(place) => Library::new(worldlines, method, &[])
                .and_then(|library| place.insert(library).compose(path, &[source, more].concat(), values)),
        };
        composed.unwrap_or_else(|error| panic!("{self:?}: {error}"))
    }

    /// Whether the pass is ever run for a camera inside the horizon that looks at what is inside.
    fn may_be_inside(self) -> bool {
        matches!(self, Pass::Vertices | Pass::Edges | Pass::Triangles | Pass::Refine | Pass::Arguments | Pass::Mesh)
    }

    /// Whether instances, or the numbers of the disk, are in the group of images.
    fn draws_data(self) -> bool {
        matches!(self, Pass::Draw | Pass::DiskDraw | Pass::DiskPolygons | Pass::DiskSprites)
    }

    /// The file that holds the entry points.
    fn file(self) -> File {
        match self {
            Pass::Vertices => file!("geometry/vertices.wgsl"),
            Pass::Edges => file!("geometry/edges.wgsl"),
            Pass::Triangles => file!("geometry/triangles.wgsl"),
            Pass::Refine => file!("geometry/refine.wgsl"),
            Pass::Arguments => file!("geometry/arguments.wgsl"),
            Pass::Mesh => file!("geometry/mesh.wgsl"),
            Pass::ThinLists => file!("geometry/thin_lists.wgsl"),
            Pass::Draw => file!("shading/draw.wgsl"),
            Pass::SkyCells => file!("sky/cells.wgsl"),
            Pass::Background => file!("sky/background.wgsl"),
            Pass::StarsProject => file!("sky/stars_project.wgsl"),
            Pass::StarsDraw => file!("sky/stars_draw.wgsl"),
            Pass::AuroraProject => file!("aurora/project.wgsl"),
            Pass::AuroraEnds => file!("aurora/ends.wgsl"),
            Pass::AuroraRanges => file!("aurora/levels/ranges.wgsl"),
            Pass::AuroraWalk => file!("aurora/walk.wgsl"),
            Pass::AuroraDraw => file!("aurora/draw.wgsl"),
            Pass::AuroraSpread => file!("aurora/levels/spread.wgsl"),
            Pass::AuroraWipe => file!("aurora/levels/wipe.wgsl"),
            Pass::AuroraResolve => file!("aurora/levels/resolve.wgsl"),
            Pass::Compose => file!("post_process/compose.wgsl"),
            Pass::Bloom => file!("post_process/bloom.wgsl"),
            Pass::Exposure => file!("post_process/exposure.wgsl"),
            Pass::Flashes => file!("post_process/flashes.wgsl"),
            Pass::ToneMap => file!("post_process/tone_map.wgsl"),
            Pass::Outlines => file!("post_process/outlines.wgsl"),
            Pass::Smooth => file!("post_process/smooth.wgsl"),
            Pass::Upscale => file!("post_process/upscale.wgsl"),
            Pass::DiskVertices => file!("disk/arcs/vertices.wgsl"),
            Pass::DiskSegments => file!("disk/arcs/segments.wgsl"),
            Pass::DiskStrips => file!("disk/arcs/strips.wgsl"),
            Pass::DiskArguments => file!("disk/arcs/arguments.wgsl"),
            Pass::DiskDraw => file!("disk/arcs/draw.wgsl"),
            Pass::DiskPolygons => file!("disk/polygons.wgsl"),
            Pass::DiskSprites => file!("disk/sprites.wgsl"),
            Pass::DiskSpritesDraw => file!("disk/sprites_draw.wgsl"),
        }
    }
}
