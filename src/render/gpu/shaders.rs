//! The WGSL of each pass, put together from the files of `shaders/`.
//!
//! A pass is its own file after the library files it needs; the order is the order of the floors. Nothing is generated, so a line of an
//! error message can be found by counting through the list.

use crate::render::method::Method;

const TYPES: &str = include_str!("../../../shaders/types.wgsl");
const BINDINGS: &str = include_str!("../../../shaders/bindings.wgsl");
const SEES_INSIDE: &str = include_str!("../../../shaders/functions/sees_inside.wgsl");
const SEES_OUTSIDE: &str = include_str!("../../../shaders/functions/sees_outside.wgsl");
const LENSING: &str = include_str!("../../../shaders/functions/lensing.wgsl");
const RESIDUALS: &str = include_str!("../../../shaders/functions/residuals.wgsl");
const LENSING_CAMERA: &str = include_str!("../../../shaders/functions/lensing_camera.wgsl");
const SKY: &str = include_str!("../../../shaders/functions/sky.wgsl");
const SKY_DIRECTION: &str = include_str!("../../../shaders/sky/direction.wgsl");
const COLOUR: &str = include_str!("../../../shaders/functions/colour.wgsl");
const COVERAGE: &str = include_str!("../../../shaders/functions/coverage.wgsl");
const HIDING: &str = include_str!("../../../shaders/functions/hiding.wgsl");
const GEOMETRY_BINDINGS: &str = include_str!("../../../shaders/geometry/bindings.wgsl");
const INSTANCE: &str = include_str!("../../../shaders/geometry/instance.wgsl");
const SWING: &str = include_str!("../../../shaders/geometry/swing.wgsl");
const RING: &str = include_str!("../../../shaders/geometry/ring.wgsl");
const PROJECT: &str = include_str!("../../../shaders/geometry/project.wgsl");
const PATCH: &str = include_str!("../../../shaders/geometry/patch.wgsl");
const BOUNDS: &str = include_str!("../../../shaders/geometry/bounds.wgsl");
const EMIT: &str = include_str!("../../../shaders/geometry/emit.wgsl");
const CLIP: &str = include_str!("../../../shaders/geometry/clip.wgsl");
const RANDOM: &str = include_str!("../../../shaders/functions/random.wgsl");
const ENLARGE: &str = include_str!("../../../shaders/aurora/enlarge.wgsl");
const STROKE: &str = include_str!("../../../shaders/aurora/stroke.wgsl");
const LIT_TILES: &str = include_str!("../../../shaders/aurora/lit_tiles.wgsl");
const LIT_CORNERS: &str = include_str!("../../../shaders/aurora/lit_corners.wgsl");
const ROOMS: &str = include_str!("../../../shaders/aurora/rooms.wgsl");
const STREAKS: &str = include_str!("../../../shaders/aurora/streaks.wgsl");
const DISK: &str = include_str!("../../../shaders/functions/disk.wgsl");
const DISK_TYPES: &str = include_str!("../../../shaders/disk/types.wgsl");
const DISK_BINDINGS: &str = include_str!("../../../shaders/disk/bindings.wgsl");
const DISK_PLACE: &str = include_str!("../../../shaders/disk/place.wgsl");
const DISK_SIGMA: &str = include_str!("../../../shaders/disk/sigma.wgsl");
const DISK_RADIAL: &str = include_str!("../../../shaders/disk/radial.wgsl");
const DISK_SPRITES_TYPES: &str = include_str!("../../../shaders/disk/sprites_types.wgsl");
const DISK_LIGHT: &str = include_str!("../../../shaders/disk/light.wgsl");
const DISK_GAS: &str = include_str!("../../../shaders/disk/gas.wgsl");
const AURORA_LIGHT: &str = include_str!("../../../shaders/geometry/aurora_light.wgsl");
const SHADE: &str = include_str!("../../../shaders/geometry/shade.wgsl");

/// How the points of models go through spacetime.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Worldlines {
    /// As those of bodies that fly and turn: `shaders/geometry/swing.wgsl`.
    #[default]
    Bodies,
    /// As those of rings round the hole: `shaders/geometry/ring.wgsl`.
    Rings,
}

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
    /// Exposes, blooms, encodes.
    ToneMap,
    /// Smooths outlines of bodies.
    Smooth,
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
    pub const ALL: [Pass; 32] = [
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
        Pass::ToneMap,
        Pass::Smooth,
        Pass::DiskVertices,
        Pass::DiskSegments,
        Pass::DiskStrips,
        Pass::DiskArguments,
        Pass::DiskDraw,
        Pass::DiskPolygons,
        Pass::DiskSprites,
        Pass::DiskSpritesDraw,
    ];

    /// The whole WGSL source of the pass.
    pub fn source(self) -> String {
        self.source_by(Method::default(), true)
    }

    /// The same with another method of projection, where the pass looks rays up.
    /// `inside` is whether the camera may be inside the horizon.
    pub fn source_by(self, method: Method, inside: bool) -> String {
        self.source_along(Worldlines::Bodies, method, inside)
    }

    /// The same where the points of models go along other worldlines.
    pub fn source_along(self, worldlines: Worldlines, method: Method, inside: bool) -> String {
        let side = if inside { SEES_INSIDE } else { SEES_OUTSIDE };
        let method = method.source();
        let swing = match worldlines {
            Worldlines::Bodies => SWING,
            Worldlines::Rings => RING,
        };
        let geometry = [TYPES, BINDINGS, side, LENSING, LENSING_CAMERA, &method, GEOMETRY_BINDINGS, INSTANCE, CLIP, swing, PROJECT, PATCH];
        let disk = [TYPES, BINDINGS, SEES_OUTSIDE, LENSING, RESIDUALS, LENSING_CAMERA, CLIP, DISK, DISK_TYPES, DISK_SIGMA];
        let own = match self {
            Pass::Vertices => include_str!("../../../shaders/geometry/vertices.wgsl"),
            Pass::Edges => include_str!("../../../shaders/geometry/edges.wgsl"),
            Pass::Triangles => include_str!("../../../shaders/geometry/triangles.wgsl"),
            Pass::Refine => include_str!("../../../shaders/geometry/refine.wgsl"),
            Pass::Arguments => include_str!("../../../shaders/geometry/arguments.wgsl"),
            Pass::Mesh => include_str!("../../../shaders/geometry/mesh.wgsl"),
            Pass::Draw => include_str!("../../../shaders/geometry/draw.wgsl"),
            Pass::SkyCells => include_str!("../../../shaders/sky/cells.wgsl"),
            Pass::Background => include_str!("../../../shaders/sky/background.wgsl"),
            Pass::StarsProject => include_str!("../../../shaders/sky/stars_project.wgsl"),
            Pass::StarsDraw => include_str!("../../../shaders/sky/stars_draw.wgsl"),
            Pass::AuroraProject => include_str!("../../../shaders/aurora/project.wgsl"),
            Pass::AuroraEnds => include_str!("../../../shaders/aurora/ends.wgsl"),
            Pass::AuroraRanges => include_str!("../../../shaders/aurora/ranges.wgsl"),
            Pass::AuroraWalk => include_str!("../../../shaders/aurora/walk.wgsl"),
            Pass::AuroraDraw => include_str!("../../../shaders/aurora/draw.wgsl"),
            Pass::AuroraSpread => include_str!("../../../shaders/aurora/spread.wgsl"),
            Pass::AuroraWipe => include_str!("../../../shaders/aurora/wipe.wgsl"),
            Pass::AuroraResolve => include_str!("../../../shaders/aurora/resolve.wgsl"),
            Pass::Compose => include_str!("../../../shaders/post_process/compose.wgsl"),
            Pass::Bloom => include_str!("../../../shaders/post_process/bloom.wgsl"),
            Pass::Exposure => include_str!("../../../shaders/post_process/exposure.wgsl"),
            Pass::ToneMap => include_str!("../../../shaders/post_process/tone_map.wgsl"),
            Pass::Smooth => include_str!("../../../shaders/post_process/smooth.wgsl"),
            Pass::DiskVertices => include_str!("../../../shaders/disk/vertices.wgsl"),
            Pass::DiskSegments => include_str!("../../../shaders/disk/segments.wgsl"),
            Pass::DiskStrips => include_str!("../../../shaders/disk/strips.wgsl"),
            Pass::DiskArguments => include_str!("../../../shaders/disk/arguments.wgsl"),
            Pass::DiskDraw => include_str!("../../../shaders/disk/draw.wgsl"),
            Pass::DiskPolygons => include_str!("../../../shaders/disk/polygons.wgsl"),
            Pass::DiskSprites => include_str!("../../../shaders/disk/sprites.wgsl"),
            Pass::DiskSpritesDraw => include_str!("../../../shaders/disk/sprites_draw.wgsl"),
        };
        let library: Vec<&str> = match self {
            Pass::Vertices | Pass::Edges | Pass::Arguments => geometry.to_vec(),
            Pass::Triangles | Pass::Refine | Pass::Mesh => geometry.iter().copied().chain([HIDING, BOUNDS, EMIT]).collect(),
            Pass::Draw => vec![TYPES, BINDINGS, INSTANCE, CLIP, COLOUR, COVERAGE, AURORA_LIGHT, SHADE],
            Pass::SkyCells | Pass::Background => vec![TYPES, BINDINGS, SKY, COLOUR, SKY_DIRECTION],
            Pass::StarsProject => vec![TYPES, BINDINGS, SKY, COLOUR],
            Pass::StarsDraw => vec![TYPES, BINDINGS],
            Pass::AuroraDraw => vec![STROKE],
            Pass::AuroraProject => {
                vec![TYPES, BINDINGS, SEES_OUTSIDE, LENSING, LENSING_CAMERA, &method, CLIP, swing, PROJECT, RANDOM, STROKE, STREAKS]
            }
            Pass::AuroraEnds => vec![TYPES, BINDINGS, RANDOM, STROKE, STREAKS],
            Pass::AuroraWalk => vec![TYPES, BINDINGS, CLIP, RANDOM, STROKE, STREAKS, LIT_TILES, ROOMS],
            Pass::AuroraRanges => vec![],
            Pass::AuroraSpread => vec![LIT_TILES, ENLARGE],
            Pass::AuroraWipe => vec![LIT_TILES, LIT_CORNERS],
            Pass::AuroraResolve => vec![LIT_TILES, LIT_CORNERS, ENLARGE],
            Pass::Compose => vec![COVERAGE],
            Pass::Bloom | Pass::Smooth => vec![],
            Pass::Exposure | Pass::ToneMap => vec![TYPES, BINDINGS, COLOUR],
            Pass::DiskVertices => disk.into_iter().chain([DISK_BINDINGS, DISK_PLACE]).collect(),
            Pass::DiskSegments | Pass::DiskStrips | Pass::DiskArguments => vec![TYPES, BINDINGS, DISK_TYPES, DISK_BINDINGS],
            Pass::DiskDraw => vec![TYPES, BINDINGS, CLIP, COLOUR, DISK, DISK_TYPES, DISK_GAS, DISK_LIGHT],
            Pass::DiskPolygons => vec![TYPES, BINDINGS, CLIP, COLOUR, DISK, DISK_TYPES, DISK_GAS, DISK_LIGHT, DISK_RADIAL],
            Pass::DiskSprites => disk.into_iter().chain([COLOUR, DISK_SPRITES_TYPES, DISK_GAS, DISK_LIGHT, DISK_RADIAL]).collect(),
            Pass::DiskSpritesDraw => vec![TYPES, BINDINGS, DISK_SPRITES_TYPES],
        };
        library.into_iter().chain([own]).collect::<Vec<_>>().join("\n")
    }
}

/// The lookup of rays by `method` alone, to go behind a declaration of `frame` and `lens_slice`: for shaders outside of the game.
pub fn lookup(method: Method, inside: bool) -> String {
    [if inside { SEES_INSIDE } else { SEES_OUTSIDE }, LENSING, LENSING_CAMERA, &method.source()].join("\n")
}
