#define_import_path lensrunner::post_process::coverage

// Coverage of a pixel by several thin images, of which only sums are known, in any order.

/// +1 or −1, pseudo-random by object, the same for all images of one object. These images are disjoint: light that meets a body on its way
/// half round the hole would come by the next order only if it went all round and met the body again.
fn coverage_sign(object: u32) -> f32 {
    var h = object * 0x9E3779B1u;
    h = (h ^ (h >> 15u)) * 0x85EBCA77u;
    return select(-1.0, 1.0, (h ^ (h >> 13u)) >> 31u == 0u);
}

/// How many objects cover a pixel, as if all were equal: from the sum of their coverages and the sum with each object's sign.
fn equal_objects(sum: f32, signed: f32) -> f32 {
    // A thousand equal objects are like infinitely many.
    return clamp(sum * sum / max(signed * signed, 1e-12), 1.0, 1000.0);
}

/// The share of a pixel that images cover together. Triangles of one object lie side by side in all its images, so their coverages add up.
/// Objects are independent, so what they leave free is a product. `sum` is over all; `signed` is the same with each object's sign. The
/// square of `signed` is on average the sum of the squares of the objects' coverages, and for one object exactly so. The result is that of
/// equal objects with these two sums.
fn covered(sum: f32, signed: f32) -> f32 {
    if sum <= 0.0 {
        return 0.0;
    }
    let count = equal_objects(sum, signed);
    let each = min(sum / count, 1.0);
    return 1.0 - pow(1.0 - each, count);
}

/// Factor on the light of what is covered. Thin triangles are drawn a pixel wide around their places, so a pixel inside an image gets
/// coverages of more than one here and of less there. It shines by as much more, or the image would be too dark in the mean.
fn overfull(sum: f32, signed: f32) -> f32 {
    return clamp(sum / equal_objects(sum, signed), 1.0, MOST_OVERFULL);
}

/// The largest such factor: more is a fault of the sums.
const MOST_OVERFULL: f32 = 2.0;

/// The opacity with which a part of an image is drawn that covers `part` of a pixel, if the nearer part of the same image will cover
/// `later` of it. The two lie side by side, but the nearer part is laid over this one, with images of the disk between them, and takes
/// `later` of everything there. So this one is drawn with as much more as leaves its own share in the end.
fn before_later(part: f32, later: f32) -> f32 {
    return min(part / max(1.0 - max(later, 0.0), 1e-3), 1.0);
}
