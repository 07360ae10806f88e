// Finds the tiles of the picture with outlines of bodies, which smooth.wgsl draws: one thread per tile.

#import lensrunner::post_process::tiles::{TILE, tile_grid}

@group(2) @binding(0) var depth: texture_depth_2d;
@group(2) @binding(1) var<storage, read_write> outlines: Outlines;

/// Arguments of a draw, then the tiles; as in smooth.wgsl.
struct Outlines {
    vertices: u32,
    tiles: atomic<u32>,
    first_vertex: u32,
    first_instance: u32,
    list: array<u32>,
}

/// A tile has an outline if its nearest depth is this many times the farthest, or if a part of it shows no body.
const STEP: f32 = 1.01;

/// Every other pixel is tested, and those beside the tile, since outlines extend beyond it.
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(depth);
    let tiles = tile_grid();
    let first = vec2<u32>(id.x % tiles.x, id.x / tiles.x) * TILE;
    let last = vec2<i32>(size) - 1;
    var nearest = 0.0;
    var farthest = 1e30;
    for (var k = 0u; k < 100u; k++) {
        let place = vec2<i32>(first) + 2 * vec2<i32>(vec2<u32>(k % 10u, k / 10u)) - 1;
        let here = textureLoad(depth, clamp(place, vec2<i32>(0), last), 0);
        nearest = max(nearest, here);
        farthest = min(farthest, here);
    }
    if id.x < tiles.x * tiles.y && nearest > STEP * farthest {
        outlines.list[atomicAdd(&outlines.tiles, 1u)] = id.x;
    }
}
