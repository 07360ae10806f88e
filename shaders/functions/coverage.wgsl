// Coverage of a pixel by several thin images, of which only sums are known, in any order.

/// +1 or −1, by the object: as good as chance from object to object, the same for all images of one. These are disjoint: light that meets a
/// body on its way half around the hole comes by its next image only if it goes all around and meets it again.
fn coverage_sign(object: u32) -> f32 {
    var h = object * 0x9E3779B1u;
    h = (h ^ (h >> 15u)) * 0x85EBCA77u;
    return select(-1.0, 1.0, (h ^ (h >> 13u)) >> 31u == 0u);
}

/// The part of a pixel that images cover together. Triangles of one object lie side by side in all its images, so their coverages add up;
/// objects know nothing of each other, so what they leave free is a product. `sum` is over all, `signed` the same with each object's sign:
/// its square is, on average, the sum of the squares of the objects' coverages, and for one object alone exactly so. Taken as objects alike
/// with these two sums.
fn covered(sum: f32, signed: f32) -> f32 {
    if sum <= 0.0 {
        return 0.0;
    }
    // A thousand images alike are no other than infinitely many.
    let count = clamp(sum * sum / max(signed * signed, 1e-12), 1.0, 1000.0);
    let each = min(sum / count, 1.0);
    return 1.0 - pow(1.0 - each, count);
}

/// What a part of an image takes of a pixel, of which it covers `part`, if the nearer part of the same image will cover `later` of it. The
/// two lie side by side, but that one is laid over this one, with what of the disk is between them, and takes `later` of all that is there:
/// so this one takes as much more as leaves its own part in the end.
fn before_later(part: f32, later: f32) -> f32 {
    return min(part / max(1.0 - max(later, 0.0), 1e-3), 1.0);
}
