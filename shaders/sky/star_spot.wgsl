#define_import_path lensrunner::sky::star_spot

// The spot of a star: of constant shape and exact total light, so that it neither blinks nor stretches as it moves across pixels.

/// Radius of the spot of a bright star, in standard deviations; and of one whose exposed light is less than DIM.
const BRIGHT_RADIUS: f32 = 3.6;
const DIM_RADIUS: f32 = 2.2;
const DIM: f32 = 0.1;
/// Of so many dim stars one is drawn into a picture that is to be enlarged, for all of them.
const DIM_FOR_ONE: u32 = 4u;

/// Corner `i`, from 0 to 2, of the triangle round a spot of radius 1: a third more pixels than a square, but half the triangles, and these
/// are what a software driver pays for.
fn spot_corner(i: u32) -> vec2<f32> {
    let corners = array<vec2<f32>, 3>(vec2<f32>(-1.7320508, -1.0), vec2<f32>(1.7320508, -1.0), vec2<f32>(0.0, 2.0));
    return corners[i];
}

/// The share of a star's light in a pixel at `place` from it, in pixels.
fn spot_share(place: vec2<f32>, sigma: f32) -> f32 {
    let square = 2.0 * sigma * sigma;
    return exp(-dot(place, place) / square) / (3.14159265 * square);
}
