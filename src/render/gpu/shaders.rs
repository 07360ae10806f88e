//! The shader of each pass: its own file of `shaders/`, with the modules that it imports (`library.rs`).
//!
//! Composing takes seconds in a page. There it is done when the page is made ([`written`]), and the texts are [brought](bring).

use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, HashMap};
use std::sync::{LazyLock, Mutex, OnceLock, PoisonError};

use wgpu::naga::Module;
use wgpu::naga::back::wgsl;
use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};

use crate::lensing::methods::Method;
use crate::render::gpu::library::{File, Library, Values, Worldlines, file};

/// The libraries that passes have been composed from. One for each choice of worldlines and method, so that its modules are worked out
/// once.
static LIBRARIES: LazyLock<Mutex<HashMap<(Worldlines, &str), Library>>> = LazyLock::new(Default::default);

/// Shaders that were composed before, by what they were composed of.
static BROUGHT: OnceLock<BTreeMap<String, String>> = OnceLock::new();

/// A shader as a device takes it.
#[derive(Clone, Debug)]
pub enum Shader {
    /// Composed here.
    Composed(Box<Module>),
    /// The text of one that was composed before.
    Written(&'static str),
}

impl From<Module> for Shader {
    fn from(module: Module) -> Shader {
        Shader::Composed(Box::new(module))
    }
}

/// Takes shaders that [`written`] gave, before any is asked for; others are composed.
pub fn bring(texts: BTreeMap<String, String>) {
    // Who calls twice has brought them already.
    _ = BROUGHT.set(texts);
}

/// The texts of all shaders that the game draws with, by what they are composed of.
pub fn written() -> BTreeMap<String, String> {
    let all = Pass::ALL.into_iter().flat_map(|pass| {
        // Only the stages of geometry project what is no body.
        let others: &[Worldlines] = if pass.may_be_inside() { &[Worldlines::Rings] } else { &[] };
        let kinds = [&[pass.worldlines()], others].concat();
        kinds.into_iter().flat_map(move |kind| [false, true].map(|inside| pass.choice(kind, Method::default(), inside)))
    });
    let unique: BTreeMap<String, Choice> = all.map(|choice| (choice.name(), choice)).collect();
    unique.into_iter().map(|(name, choice)| (name, text(&choice.composed("")))).collect()
}

/// As wgpu writes it for a page.
fn text(module: &Module) -> String {
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(module);
    let info = info.unwrap_or_else(|error| panic!("a composed shader: {error}"));
    wgsl::write_string(module, &info, wgsl::WriterFlags::empty()).unwrap_or_else(|error| panic!("a composed shader: {error}"))
}

/// What a shader is composed of.
#[derive(Clone, Copy, Debug)]
struct Choice {
    pass: Pass,
    worldlines: Worldlines,
    method: Method,
    inside: bool,
}

macro_rules! passes {
    ($(#[$about:meta] $pass:ident: $file:literal,)*) => {
        /// The passes of a frame, by the file that holds their entry points.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Pass {
            $(#[$about] $pass,)*
        }

        impl Pass {
            /// All passes.
            pub const ALL: [Pass; [$($file),*].len()] = [$(Pass::$pass),*];

            /// The file that holds the entry points.
            fn file(self) -> File {
                match self {
                    $(Pass::$pass => file!($file),)*
                }
            }
        }
    };
}

passes! {
    /// Places what is held.
    Place: "geometry/place.wgsl",
    /// Projects the model vertices.
    Vertices: "geometry/vertices.wgsl",
    /// Measures the model edges.
    Edges: "geometry/edges.wgsl",
    /// The object stage.
    Triangles: "geometry/triangles.wgsl",
    /// Splits pieces.
    Refine: "geometry/refine.wgsl",
    /// Turns counts into indirect arguments.
    Arguments: "geometry/arguments.wgsl",
    /// The mesh stage.
    Mesh: "geometry/mesh.wgsl",
    /// Lists thin triangles and their tiles.
    ThinLists: "geometry/thin_lists.wgsl",
    /// Rasterises.
    Draw: "shading/draw.wgsl",
    /// Works the sky out at the corners of cells.
    SkyCells: "sky/cells.wgsl",
    /// The sky behind everything.
    Background: "sky/background.wgsl",
    /// Lists the clusters of stars that may be on the screen.
    StarsCull: "sky/stars_cull.wgsl",
    /// Projects stars.
    StarsProject: "sky/stars_project.wgsl",
    /// Draws stars.
    StarsDraw: "sky/stars_draw.wgsl",
    /// Lays stars over an enlarged picture.
    StarsOver: "sky/stars_over.wgsl",
    /// Projects places amid the parts of the aurora's curtains.
    AuroraProject: "aurora/project.wgsl",
    /// The ends of each streak's chords.
    AuroraEnds: "aurora/ends.wgsl",
    /// The depths of what is drawn, by tiles.
    AuroraRanges: "aurora/levels/ranges.wgsl",
    /// Walks between the ends of chords.
    AuroraWalk: "aurora/walk.wgsl",
    /// Adds up the aurora's light.
    AuroraDraw: "aurora/draw.wgsl",
    /// Enlarges a coarse picture of it into the next finer one.
    AuroraSpread: "aurora/levels/spread.wgsl",
    /// Makes the finest picture of it black where there will be light.
    AuroraWipe: "aurora/levels/wipe.wgsl",
    /// Makes it a colour.
    AuroraResolve: "aurora/levels/resolve.wgsl",
    /// Lays thin triangles over the picture.
    Compose: "post_process/compose.wgsl",
    /// Halves and doubles the picture.
    Bloom: "post_process/bloom.wgsl",
    /// Meters the light.
    Exposure: "post_process/exposure.wgsl",
    /// Measures the brightness of the whole picture.
    Flashes: "post_process/flashes.wgsl",
    /// Exposes, blooms, encodes.
    ToneMap: "post_process/tone_map.wgsl",
    /// Finds the tiles with outlines of bodies.
    Outlines: "post_process/outlines.wgsl",
    /// Smooths them.
    Smooth: "post_process/smooth.wgsl",
    /// Enlarges a picture that was drawn smaller than the output.
    Upscale: "post_process/upscale.wgsl",
    /// Sharpens the outline of the own ship in it.
    OwnOutline: "post_process/own_outline.wgsl",
    /// Projects the places of the disk's arcs, and those that halving asks for.
    DiskVertices: "disk/arcs/vertices.wgsl",
    /// Decides how often arcs are halved.
    DiskSegments: "disk/arcs/segments.wgsl",
    /// Joins the arcs' points by triangles.
    DiskStrips: "disk/arcs/strips.wgsl",
    /// Turns the disk's counts into indirect arguments.
    DiskArguments: "disk/arcs/arguments.wgsl",
    /// Rasterises the disk.
    DiskDraw: "disk/arcs/draw.wgsl",
    /// Rasterises the disk of polygons.
    DiskPolygons: "disk/polygons.wgsl",
    /// Projects the disk's sprites.
    DiskSprites: "disk/sprites.wgsl",
    /// Draws the disk's sprites.
    DiskSpritesDraw: "disk/sprites_draw.wgsl",
}

impl Pass {
    /// The shader of the pass.
    pub fn module(self) -> Module {
        self.module_by(Method::default(), true)
    }

    /// The same with another method of projection, where the pass looks rays up.
    /// `inside` is whether the camera may be inside the horizon.
    pub fn module_by(self, method: Method, inside: bool) -> Module {
        self.choice(self.worldlines(), method, inside).composed("")
    }

    /// The same where the points of models go along other worldlines.
    pub fn module_along(self, worldlines: Worldlines, method: Method, inside: bool) -> Module {
        self.choice(worldlines, method, inside).composed("")
    }

    /// The shader of the pass with `more` behind its own file: what a test runs of it.
    pub fn module_with(self, more: &str) -> Module {
        self.choice(self.worldlines(), Method::default(), true).composed(more)
    }

    /// The shader of the pass, for a device.
    pub fn shader(self) -> Shader {
        self.shader_by(Method::default(), true)
    }

    /// The same with another method of projection. `inside` as of [`module_by`](Pass::module_by).
    pub fn shader_by(self, method: Method, inside: bool) -> Shader {
        self.shader_along(self.worldlines(), method, inside)
    }

    /// The same along other worldlines.
    pub fn shader_along(self, worldlines: Worldlines, method: Method, inside: bool) -> Shader {
        let choice = self.choice(worldlines, method, inside);
        let brought = BROUGHT.get().and_then(|texts| texts.get(&choice.name()));
        brought.map_or_else(|| choice.composed("").into(), |text| Shader::Written(text))
    }

    /// Those of what the pass projects.
    fn worldlines(self) -> Worldlines {
        match self {
            // A planet turns evenly, and its aurora has no nodes at hand.
            Pass::AuroraProject | Pass::AuroraEnds => Worldlines::Even,
            _ => Worldlines::Bodies,
        }
    }

    fn choice(self, worldlines: Worldlines, method: Method, inside: bool) -> Choice {
        // What is always a planet's is so whatever else is drawn.
        let worldlines = if self.worldlines() == Worldlines::Even { Worldlines::Even } else { worldlines };
        Choice { pass: self, worldlines, method, inside: inside && self.may_be_inside() }
    }

    /// Whether the pass is ever run for a camera inside the horizon that looks at what is inside.
    fn may_be_inside(self) -> bool {
        matches!(self, Pass::Place | Pass::Vertices | Pass::Edges | Pass::Triangles | Pass::Refine | Pass::Arguments | Pass::Mesh)
    }

    /// Whether instances, or the numbers of the disk, are in the group of images.
    fn draws_data(self) -> bool {
        matches!(self, Pass::Draw | Pass::DiskDraw | Pass::DiskPolygons | Pass::DiskSprites)
    }
}

impl Choice {
    fn name(&self) -> String {
        format!("{:?} {:?} {} {}", self.pass, self.worldlines, self.method.name, if self.inside { "inside" } else { "outside" })
    }

    /// The shader, with `more` behind the pass's own file.
    fn composed(&self, more: &str) -> Module {
        let Choice { pass, worldlines, method, inside } = *self;
        let (path, source) = pass.file();
        let values = Values { inside, data_group: if pass.draws_data() { 2 } else { 1 } };
        let mut libraries = LIBRARIES.lock().unwrap_or_else(PoisonError::into_inner);
        let composed = match libraries.entry((worldlines, method.name)) {
            Entry::Occupied(library) => library.into_mut().compose(path, &[source, more].concat(), values),
            Entry::Vacant(place) => Library::new(worldlines, method, &[])
                .and_then(|library| place.insert(library).compose(path, &[source, more].concat(), values)),
        };
        composed.unwrap_or_else(|error| panic!("{pass:?}: {error}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a page draws with is what is drawn with here: each text is read back as the same shader.
    #[test]
    fn written_shaders_can_be_read() {
        let written = written();
        assert!(written.len() > Pass::ALL.len());
        for (name, text) in &written {
            let module = naga::front::wgsl::parse_str(text).unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(text)));
            let entries = |module: &Module| module.entry_points.iter().map(|entry| entry.name.clone()).collect::<Vec<_>>();
            let pass = Pass::ALL.into_iter().find(|pass| name.starts_with(&format!("{pass:?} "))).expect("a pass");
            assert_eq!(entries(&module), entries(&pass.module()), "{name}");
        }
    }
}
