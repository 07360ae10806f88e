#define_import_path lensrunner::aurora::levels::lit_corners

// Where the lit tiles of an image are on the screen, for the pass that wipes them and for the one that colours them.

#import lensrunner::aurora::levels::lit_tiles::{LIT_TILE_COLUMNS, lit_tiles_of}

/// Frequency ratios that colours are given at. Twin of src/render/aurora/colours.rs.
const SHIFTS: u32 = 16u;

struct Lines {
    /// Linear sRGB of a kilorayleigh of each line at each frequency ratio, the least first, in the unit of the picture's luminance.
    colours: array<vec3<f32>, 4u * SHIFTS>,
    /// By how many steps the ratio changes with the coordinates of the screen right and up (NDC).
    slope: vec2<f32>,
    /// Width and height of a lit tile in NDC.
    tile: vec2<f32>,
    /// Steps from the least ratio to that in the middle of the screen.
    middle: f32,
}

@group(1) @binding(0) var<uniform> lines_seen: Lines;
/// Of each image, as in lit_tiles.wgsl.
@group(1) @binding(1) var<storage, read> numbers: array<u32>;

/// The place on the screen (NDC) of a corner of two triangles for each tile, or of none. The instance is four times the image and the kind
/// of tiles that are drawn: 1 with light in the finest level alone, 2 in coarser ones alone, 3 in both.
fn lit_corner(i: u32, instance: u32) -> vec2<f32> {
    let tile = vec2<u32>((i / 6u) % LIT_TILE_COLUMNS, (i / 6u) / LIT_TILE_COLUMNS);
    let image = instance / 4u;
    let lit = vec2<u32>(numbers[lit_tiles_of(image, true) + tile.y], numbers[lit_tiles_of(image, false) + tile.y]) >> tile.xx;
    let kind = (lit.x & 1u) + 2u * (lit.y & 1u);
    let k = i % 6u;
    let corner = vec2<f32>(vec2<bool>((k & 1u) == 1u, (k >= 2u) & (k != 3u)) & vec2<bool>(kind == instance % 4u));
    let down = (vec2<f32>(tile) + corner) * lines_seen.tile;
    return vec2<f32>(down.x - 1.0, 1.0 - down.y);
}
