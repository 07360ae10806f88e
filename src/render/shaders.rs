//! The WGSL of each pass, put together from the files of `shaders/`.
//!
//! A pass is its own file after the library files it needs; the order is the order of the floors. Nothing is generated, so a line of an
//! error message can be found by counting through the list.

const TYPES: &str = include_str!("../../shaders/types.wgsl");
const BINDINGS: &str = include_str!("../../shaders/bindings.wgsl");
const LENSING: &str = include_str!("../../shaders/functions/lensing.wgsl");
const LENSING_CAMERA: &str = include_str!("../../shaders/functions/lensing_camera.wgsl");
const SKY: &str = include_str!("../../shaders/functions/sky.wgsl");
const SKY_DIRECTION: &str = include_str!("../../shaders/sky/direction.wgsl");
const COLOUR: &str = include_str!("../../shaders/functions/colour.wgsl");
const GEOMETRY_BINDINGS: &str = include_str!("../../shaders/geometry/bindings.wgsl");
const PROJECT: &str = include_str!("../../shaders/geometry/project.wgsl");
const PATCH: &str = include_str!("../../shaders/geometry/patch.wgsl");
const EMIT: &str = include_str!("../../shaders/geometry/emit.wgsl");
const CLIP: &str = include_str!("../../shaders/geometry/clip.wgsl");
const SHADE: &str = include_str!("../../shaders/geometry/shade.wgsl");

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
    /// Lays thin triangles over the picture.
    Compose,
    /// Halves and doubles the picture.
    Bloom,
    /// Meters the light.
    Exposure,
    /// Exposes, blooms, encodes.
    Develop,
}

impl Pass {
    /// All passes.
    pub const ALL: [Pass; 15] = [
        Pass::Vertices,
        Pass::Edges,
        Pass::Triangles,
        Pass::Refine,
        Pass::Arguments,
        Pass::Mesh,
        Pass::Draw,
        Pass::SkyCells,
        Pass::Background,
        Pass::StarsProject,
        Pass::StarsDraw,
        Pass::Compose,
        Pass::Bloom,
        Pass::Exposure,
        Pass::Develop,
    ];

    /// The whole WGSL source of the pass.
    pub fn source(self) -> String {
        let geometry = [TYPES, BINDINGS, LENSING, LENSING_CAMERA, GEOMETRY_BINDINGS, CLIP, PROJECT, PATCH];
        let own = match self {
            Pass::Vertices => include_str!("../../shaders/geometry/vertices.wgsl"),
            Pass::Edges => include_str!("../../shaders/geometry/edges.wgsl"),
            Pass::Triangles => include_str!("../../shaders/geometry/triangles.wgsl"),
            Pass::Refine => include_str!("../../shaders/geometry/refine.wgsl"),
            Pass::Arguments => include_str!("../../shaders/geometry/arguments.wgsl"),
            Pass::Mesh => include_str!("../../shaders/geometry/mesh.wgsl"),
            Pass::Draw => include_str!("../../shaders/geometry/draw.wgsl"),
            Pass::SkyCells => include_str!("../../shaders/sky/cells.wgsl"),
            Pass::Background => include_str!("../../shaders/sky/background.wgsl"),
            Pass::StarsProject => include_str!("../../shaders/sky/stars_project.wgsl"),
            Pass::StarsDraw => include_str!("../../shaders/sky/stars_draw.wgsl"),
            Pass::Compose => include_str!("../../shaders/develop/compose.wgsl"),
            Pass::Bloom => include_str!("../../shaders/develop/bloom.wgsl"),
            Pass::Exposure => include_str!("../../shaders/develop/exposure.wgsl"),
            Pass::Develop => include_str!("../../shaders/develop/develop.wgsl"),
        };
        let library: Vec<&str> = match self {
            Pass::Vertices | Pass::Edges | Pass::Arguments => geometry.to_vec(),
            Pass::Triangles | Pass::Refine | Pass::Mesh => geometry.iter().copied().chain([EMIT]).collect(),
            Pass::Draw => vec![TYPES, BINDINGS, CLIP, COLOUR, SHADE],
            Pass::SkyCells | Pass::Background => vec![TYPES, BINDINGS, SKY, COLOUR, SKY_DIRECTION],
            Pass::StarsProject => vec![TYPES, BINDINGS, SKY, COLOUR],
            Pass::StarsDraw => vec![TYPES, BINDINGS],
            Pass::Compose | Pass::Bloom => vec![],
            Pass::Exposure | Pass::Develop => vec![TYPES, BINDINGS, COLOUR],
        };
        library.into_iter().chain([own]).collect::<Vec<_>>().join("\n")
    }
}
