#define_import_path lensrunner::models::hiding

// The share of a triangle that other parts of its model do not hide: the twin of src/render/models/hiding.rs.

/// a : b of the rectangles whose corners are those of an icosahedron and, together with those of a cube, of a dodecahedron, of unit length.
const GOLDEN_SHORT: f32 = 0.5257311;
const GOLDEN_LONG: f32 = 0.8506508;
const CUBE: f32 = 0.57735026;
const DODECA_SHORT: f32 = 0.35682209;
const DODECA_LONG: f32 = 0.93417236;

/// Directions from which a triangle may be hidden.
const DIRECTIONS: u32 = 32u;

/// Direction k of `DIRECTIONS`, evenly over the sphere: the corners of a cube, then of rectangles across each pair of axes.
fn direction_of(k: u32) -> vec3<f32> {
    let sign = vec3<f32>(select(1.0, -1.0, (k & 1u) != 0u), select(1.0, -1.0, (k & 2u) != 0u), select(1.0, -1.0, (k & 4u) != 0u));
    if k < 8u {
        return CUBE * sign;
    }
    let icosahedron = k < 20u;
    let short = select(DODECA_SHORT, GOLDEN_SHORT, icosahedron) * sign.x;
    let long = select(DODECA_LONG, GOLDEN_LONG, icosahedron) * sign.y;
    let axis = (k - 8u) / 4u % 3u;
    if axis == 0u {
        return select(vec3<f32>(short, 0.0, long), vec3<f32>(0.0, short, long), icosahedron);
    } else if axis == 1u {
        return select(vec3<f32>(0.0, long, short), vec3<f32>(short, long, 0.0), icosahedron);
    }
    return select(vec3<f32>(long, short, 0.0), vec3<f32>(long, 0.0, short), icosahedron);
}

/// The share of a triangle that is seen from `direction` (unit, body axes): the mean of the bits of `seen_from`, one per direction,
/// weighted by (cos angle)⁸, over all directions from which the triangle shows its outer side, whose normal is `outward`.
fn seen_part(seen_from: u32, outward: vec3<f32>, direction: vec3<f32>) -> f32 {
    var sum = 0.0;
    var all = 0.0;
    for (var k = 0u; k < DIRECTIONS; k++) {
        let from_there = direction_of(k);
        let c = max(dot(direction, from_there), 0.0);
        let squared = c * c;
        let weight = select(squared * squared * squared * squared, 0.0, dot(outward, from_there) < 0.0);
        all += weight;
        sum += select(0.0, weight, (seen_from & (1u << k)) != 0u);
    }
    return select(sum / all, 1.0, all < 1e-6);
}
