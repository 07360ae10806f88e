// Stage 6, one thread per thin triangle: on which tiles of the picture it is, and with which images of the disk it is drawn.

#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::ThinVertex
#import lensrunner::post_process::tiles::{TILE, tile_grid}

@group(1) @binding(0) var<storage, read> thin: array<ThinVertex>;
/// Those of arguments.wgsl.
@group(1) @binding(1) var<storage, read> arguments: array<vec4<u32>>;
@group(1) @binding(2) var<storage, read_write> draws: Draws;
/// For each number of crossings the corners of its triangles; each list begins `capacity.w` after the one before.
@group(1) @binding(3) var<storage, read_write> lists: array<u32>;
/// For each tile whether it is listed, then the list of tiles.
@group(1) @binding(4) var<storage, read_write> tiles: array<atomic<u32>>;

struct IndexedDraw {
    indices: atomic<u32>,
    instances: u32,
    first: u32,
    base: u32,
    instance: u32,
}

/// Arguments of the draws of triangles, by how often their light crosses the disk's plane, and of that of the tiles.
struct Draws {
    across: array<IndexedDraw, 4>,
    vertices: u32,
    tiles: atomic<u32>,
    first_vertex: u32,
    first_instance: u32,
}

/// Row of the draw of thin triangles in the arguments.
const THIN_ROW: u32 = 4u;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let first = 3u * ((group.y * groups.x + group.x) * 64u + lane);
    if first >= arguments[THIN_ROW].x {
        return;
    }
    let a = place(thin[first].position);
    let b = place(thin[first + 1u].position);
    let c = place(thin[first + 2u].position);
    list_tiles(min(a, min(b, c)), max(a, max(b, c)));
    // What of its light crosses the plane as often as the order says is drawn there, the rest with once less.
    let crossings = thin[first].order;
    list(crossings, first);
    if thin[first].across < 1.0 {
        list(crossings - 1u, first);
    }
}

/// In pixels from the upper left corner.
fn place(clip: vec4<f32>) -> vec2<f32> {
    return (clip.xy / clip.w * vec2<f32>(0.5, -0.5) + 0.5) * frame.size;
}

fn list(crossings: u32, first: u32) {
    let slot = crossings * frame.capacity.thin + atomicAdd(&draws.across[crossings].indices, 3u);
    lists[slot] = first;
    lists[slot + 1u] = first + 1u;
    lists[slot + 2u] = first + 2u;
}

/// Lists the tiles of a rectangle, a pixel wider on each side, unless they are.
fn list_tiles(low: vec2<f32>, high: vec2<f32>) {
    let grid = tile_grid();
    let last = vec2<f32>(grid) * f32(TILE);
    if any(high < vec2<f32>(-1.0)) || any(low > last) {
        return;
    }
    let nearest = vec2<u32>(clamp(low - 1.0, vec2<f32>(0.0), last)) / TILE;
    let farthest = min(vec2<u32>(clamp(high + 1.0, vec2<f32>(0.0), last)) / TILE, grid - 1u);
    for (var y = nearest.y; y <= farthest.y; y++) {
        for (var x = nearest.x; x <= farthest.x; x++) {
            let tile = y * grid.x + x;
            if atomicExchange(&tiles[tile], 1u) == 0u {
                atomicStore(&tiles[grid.x * grid.y + atomicAdd(&draws.tiles, 1u)], tile);
            }
        }
    }
}
