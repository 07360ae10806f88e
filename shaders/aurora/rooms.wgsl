// Where strokes are kept: two levels share a room, one from its beginning and one from its end, so that it does not matter which of them they go to. The rooms
// of coarser pairs are half as large each. Twin of `Rooms` in src/render/aurora/rooms.rs.

/// Rows that the screen is divided into.
const ROWS_OF_SCREEN: u32 = 128u;

/// The first of the numbers of an image in `stroke_draws`.
fn numbers_of(placement: u32) -> u32 {
    return placement * 4u * (PYRAMID + 2u);
}

/// There may be light from pixel row `top` to `bottom` of the screen, `height` pixels high.
fn light_up(placement: u32, top: f32, bottom: f32, height: f32) {
    let rows = clamp(vec2<f32>(top, bottom) / ceil(height / f32(ROWS_OF_SCREEN)), vec2<f32>(0.0), vec2<f32>(f32(ROWS_OF_SCREEN) - 1.0));
    let first = u32(rows.x);
    let last = u32(rows.y);
    for (var word = first / 32u; word <= last / 32u; word++) {
        let low = max(first, 32u * word) & 31u;
        let high = min(last, 32u * word + 31u) & 31u;
        atomicOr(&stroke_draws[numbers_of(placement) + 4u * (PYRAMID + 1u) + word], (0xffffffffu >> (31u - (high - low))) << low);
    }
}

/// Room for a stroke in a level, as the place of its first vertex; the finest takes over from a coarse one that is full. 0xffffffff: there is none.
/// `level` is where it went.
fn room_of(placement: u32, level: ptr<function, u32>) -> u32 {
    let draws = numbers_of(placement);
    for (var attempt = 0u; attempt < 2u; attempt++) {
        let pair = *level / 2u;
        let counter = draws + 4u * PYRAMID + pair;
        if atomicAdd(&stroke_draws[counter], 1u) < (aurora.history.z >> pair) {
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
