// Where splats are kept: two levels share a room, one from its beginning and one from its end, so that it does not matter which of them they go to. The rooms
// of coarser pairs are half as large each. Twin of `Rooms` in src/render/aurora/rooms.rs.

/// Room for a splat in a level, as the place of its first vertex; the finest takes over from a coarse one that is full. 0xffffffff: there is none.
/// `level` is where it went.
fn room_of(placement: u32, level: ptr<function, u32>) -> u32 {
    let draws = placement * 4u * (PYRAMID + 1u);
    for (var attempt = 0u; attempt < 2u; attempt++) {
        let pair = *level / 2u;
        let counter = draws + 4u * PYRAMID + pair;
        if atomicAdd(&splat_draws[counter], 1u) < (aurora.history.z >> pair) {
            let own = draws + 4u * *level;
            let before = atomicAdd(&splat_draws[own], CORNERS);
            if (*level & 1u) == 1u {
                return atomicSub(&splat_draws[own + 2u], CORNERS) - CORNERS;
            }
            // Of an even level the first does not change.
            return atomicLoad(&splat_draws[own + 2u]) + before;
        }
        atomicSub(&splat_draws[counter], 1u);
        *level = 0u;
    }
    return 0xffffffffu;
}
