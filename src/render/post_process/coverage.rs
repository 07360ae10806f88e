//! Coverage of a pixel by several thin images, and by parts of one: the twin of `shaders/post_process/coverage.wgsl`.

/// How many objects cover a pixel, as if all were equal: `equal_objects` of WGSL.
fn equal_objects(sum: f32, signed: f32) -> f32 {
    (sum * sum / (signed * signed).max(1e-12)).clamp(1.0, 1000.0)
}

/// Factor on the light of what is covered, where coverages sum up to more than one: `overfull` of WGSL.
pub fn overfull(sum: f32, signed: f32) -> f32 {
    (sum / equal_objects(sum, signed)).clamp(1.0, MOST_OVERFULL)
}

/// The largest such factor.
const MOST_OVERFULL: f32 = 2.0;

/// The share of a pixel that thin images cover together, from the sum of their coverages and the sum with each object's sign: `covered` of
/// WGSL.
pub fn covered(sum: f32, signed: f32) -> f32 {
    if sum <= 0.0 {
        return 0.0;
    }
    let count = equal_objects(sum, signed);
    let each = (sum / count).min(1.0);
    1.0 - (1.0 - each).powf(count)
}

/// The opacity with which a part of an image is drawn that covers `part` of a pixel, if the nearer part of the same image is laid over it
/// and covers `later`: `before_later` of WGSL.
pub fn before_later(part: f32, later: f32) -> f32 {
    (part / (1.0 - later.max(0.0)).max(1e-3)).min(1.0)
}
