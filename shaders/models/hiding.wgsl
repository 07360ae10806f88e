#define_import_path lensrunner::models::hiding

// The share of a triangle that other parts of its model do not hide: the twin of src/render/models/hiding.rs.

/// Nodes along each side of the map of directions: a sphere's octahedron, unfolded onto a square.
const NODES: u32 = 11u;

/// The lower half of the octahedron lies outside of the upper one, folded over its edges.
fn folded(p: vec2<f32>) -> vec2<f32> {
    return (1.0 - abs(p.yx)) * select(vec2<f32>(1.0), vec2<f32>(-1.0), p < vec2<f32>(0.0));
}

/// The direction of a node, of unit length.
fn direction_of(node: vec2<u32>) -> vec3<f32> {
    let p = vec2<f32>(node) / f32(NODES - 1u) * 2.0 - 1.0;
    let z = 1.0 - abs(p.x) - abs(p.y);
    return normalize(vec3<f32>(select(p, folded(p), z < 0.0), z));
}

/// The share of a triangle that is seen from `direction` (unit, body axes): bilinear between the nodes around it, of which `seen_from` has
/// the bits, over those from which the triangle shows its outer side, whose normal is `outward`.
fn seen_part(seen_from: vec4<u32>, outward: vec3<f32>, direction: vec3<f32>) -> f32 {
    let on_octahedron = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    let folded_out = select(on_octahedron.xy, folded(on_octahedron.xy), on_octahedron.z < 0.0);
    let place = (0.5 * folded_out + 0.5) * f32(NODES - 1u);
    let low = min(vec2<u32>(place), vec2<u32>(NODES - 2u));
    let share = place - vec2<f32>(low);
    var sum = 0.0;
    var all = 0.0;
    for (var corner = 0u; corner < 4u; corner++) {
        let high = vec2<u32>(corner % 2u, corner / 2u);
        let node = low + high;
        let weights = select(1.0 - share, share, high == vec2<u32>(1u));
        let weight = select(weights.x * weights.y, 0.0, dot(outward, direction_of(node)) < 0.0);
        let k = node.y * NODES + node.x;
        all += weight;
        sum += select(0.0, weight, (seen_from[k / 32u] & (1u << (k % 32u))) != 0u);
    }
    return select(sum / all, 1.0, all < 1e-6);
}
