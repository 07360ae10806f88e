// Placements, read from their table. What a pass does not use of one is not fetched.

/// Texels of a placement.
const PLACEMENT_TEXELS: u32 = 25u;

/// Texel k of placement `index`, bits of u32 or f32.
fn placement_words(index: u32, k: u32) -> vec4<u32> {
    let texel = index * PLACEMENT_TEXELS + k;
    return textureLoad(placements, vec2<u32>(texel % TABLE_ROW, texel / TABLE_ROW), 0);
}

fn placement_numbers(index: u32, k: u32) -> vec4<f32> {
    return bitcast<vec4<f32>>(placement_words(index, k));
}

fn placement_at(i: u32) -> Placement {
    return Placement(
        placement_numbers(i, 0u), placement_numbers(i, 1u), placement_numbers(i, 2u), placement_numbers(i, 3u),
        placement_numbers(i, 4u), placement_numbers(i, 5u), placement_numbers(i, 6u),
        placement_numbers(i, 7u), placement_numbers(i, 8u), placement_numbers(i, 9u), placement_numbers(i, 10u),
        placement_numbers(i, 11u), placement_numbers(i, 12u), placement_numbers(i, 13u),
        placement_numbers(i, 14u), placement_numbers(i, 15u), placement_numbers(i, 16u), placement_numbers(i, 17u),
        placement_numbers(i, 18u), placement_numbers(i, 19u), placement_numbers(i, 20u), placement_numbers(i, 21u),
        placement_words(i, 22u), placement_words(i, 23u), placement_words(i, 24u));
}
