#define_import_path lensrunner::post_process::tiles

// Square tiles of the picture, for what is to be done in few of its pixels.

#import lensrunner::gpu::bindings::frame

/// Pixels along the side of a tile; as in src/render/gpu/targets.rs.
const TILE: u32 = 16u;

/// Number of tiles along the width of the picture, and down.
fn tile_grid() -> vec2<u32> {
    return (vec2<u32>(frame.size) + TILE - 1u) / TILE;
}

/// Corner `i`, from 0 to 5, of the two triangles of a tile, in normalised device coordinates.
fn tile_corner(tile: u32, i: u32) -> vec2<f32> {
    let columns = tile_grid().x;
    let first = vec2<u32>(tile % columns, tile / columns) * TILE;
    let corner = vec2<u32>(select(0u, 1u, i == 1u || i == 2u || i == 4u), select(0u, 1u, i == 2u || i == 4u || i == 5u));
    let place = vec2<f32>(min(first + corner * TILE, vec2<u32>(frame.size))) / frame.size;
    return (place * 2.0 - 1.0) * vec2<f32>(1.0, -1.0);
}
