#define_import_path lensrunner::aurora::capacities

// Where strokes are stored. Two levels share a part of the buffer, one from its beginning and one from its end, so the split between them
// need not be known. The part of the next coarser pair is half as large. Twin of `StrokeCapacities` in src/render/aurora/capacities.rs.

#import lensrunner::aurora::levels::lit_tiles::{LIT_TILE_COLUMNS, LIT_TILE_ROWS, lit_tiles_of, numbers_of, PYRAMID}
#import lensrunner::aurora::streaks::{aurora, stroke_draws}
#import lensrunner::aurora::stroke::CORNERS

/// Notes that there may be light in a box of pixels (left, top, right, bottom) of a screen of a size, from the finest level or from a
/// coarser one.
fn light_up(instance: u32, pixels: vec4<f32>, size: vec2<f32>, finest: bool) {
    let tiles = vec2<f32>(f32(LIT_TILE_COLUMNS), f32(LIT_TILE_ROWS));
    let box = vec4<u32>(clamp(pixels / ceil(size / tiles).xyxy, vec4<f32>(0.0), (tiles - 1.0).xyxy));
    let columns = (0xffffffffu >> (31u - (box.z - box.x))) << box.x;
    for (var row = box.y; row <= box.w; row++) {
        atomicOr(&stroke_draws[lit_tiles_of(instance, finest) + row], columns);
    }
}

/// Allocates a stroke in a level, as the index of its first vertex; if a coarse level is full, in the finest. 0xffffffff: there is
/// none. `level` is where it went.
fn allocate_stroke(instance: u32, level: ptr<function, u32>) -> u32 {
    let draws = numbers_of(instance);
    for (var attempt = 0u; attempt < 2u; attempt++) {
        let pair = *level / 2u;
        let counter = draws + 4u * PYRAMID + pair;
        if atomicAdd(&stroke_draws[counter], 1u) < (aurora.capacity >> pair) {
            let own = draws + 4u * *level;
            let before = atomicAdd(&stroke_draws[own], CORNERS);
            if (*level & 1u) == 1u {
                return atomicSub(&stroke_draws[own + 2u], CORNERS) - CORNERS;
            }
            // Of an even level the first does not change.
            return atomicLoad(&stroke_draws[own + 2u]) + before;
        }
        atomicSub(&stroke_draws[counter], 1u);
        *level = 0u;
    }
    return 0xffffffffu;
}
