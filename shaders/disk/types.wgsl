// The types of the disk of arcs. Glossary: a row is a circle of the disk in one image order; a column is a place on it, even ones the cuts between
// arcs, odd ones the middles of arcs. θ is the azimuth from the camera's.

struct DiskFrame {
    /// In the disk's plane towards the camera; w: sine h of the camera's height over the plane, held away from 0.
    towards: vec4<f32>,
    /// In the plane, a quarter turn on; w: √(1 − h²).
    sideways: vec4<f32>,
    /// Across the axis and upwards: completes (radial, sideways); w: |h|.
    upwards: vec4<f32>,
    /// x: time at the camera since the first generation of streaks, in renewals; y: renewals per r_s/c; z: one renewal in r_s/c; w: age of a new-born.
    renewal: vec4<f32>,
    /// x: deviation of ln density; y: the part of its place that gas has in rings whose gaps are closed; z: error budget of an arc in rad;
    /// w: least width of thin images in pixels.
    gas: vec4<f32>,
    /// x: columns of a row; y: arcs round the hole; z: rows; w: rings over all orders.
    sizes: vec4<u32>,
    /// First indices of the lists of triangles: order 1, 2, 3, and what of order 1 lies beyond a close look.
    regions: vec4<u32>,
    /// x: vertices that there is room for; y: orders up to this one have a close look (finest octaves, slant in each pixel); z: half height over radius
    /// (bits of an f32); w: the end of the last list of triangles.
    room: vec4<u32>,
    /// x: the scene's unit of light over the black body's; y: arcs of order 1 whose light path is longer, in r_s, are beyond a close look; z, w unused.
    light: vec4<f32>,
    /// x, y: where in the pattern the first generation begins; z, w: from each to the next.
    offset: vec4<f32>,
}

struct Circle {
    /// Radius in r_s, lead of falling gas in rad, ln of the temperature in K, optical depth straight through.
    gas: vec4<f32>,
    /// Rain-frame momentum per mass outward and along the rotation, half height in r_s, ln of the pattern's radius over its height.
    motion: vec4<f32>,
    /// x: radius·√(1 − h²) − L, differenced in f64; y: radius of the middle of the gap beside it, of the outermost its end; z: the gap over the whole ring; w: the whole gap's
    /// width over the way from this circle to y: 2, of the outermost 1. Of the circles behind the rows: the gas of the second image that light of the third
    /// from there comes through: optical depth straight through (0 in the second image itself), rain-frame momentum per mass outward and along the
    /// rotation, radius in r_s.
    place: vec4<f32>,
    /// x: image order; y, z: innermost and outermost row of that order; w: for orders 2 and 3 the first of the circles behind the rows, for each of
    /// THIN_AZIMUTHS azimuths THIN_SAMPLES on radii that share the width of that image equally there.
    rows: vec4<u32>,
}

struct DiskVertex {
    /// Direction from the camera times light path, camera axes; w: the light path.
    apparent: vec4<f32>,
    /// x: azimuth less lead, in turns; y: height in the pattern; z: ln of the temperature that is seen, in K; w: optical depth along the ray
    /// (close look: straight through).
    gas: vec4<f32>,
    /// x: ln g; y: |cos| to the normal, in the frame of the gas; z: distance from the middle of a thin image, w: its half width, both in pixels; of order 1, z: the part of its
    /// place that gas has, w: 10⁶.
    more: vec4<f32>,
    /// Of the ring that begins here, by how much its middle is beyond the straight line between its circles: x: height in the pattern; y: logarithm of light, over itself with
    /// its sign turned; z: optical depth, over that of the line, so that it holds at any slant. w: 0 and 1 by turns from row to row, so that over a ring it is the share of its
    /// width, from one side or the other.
    bend: vec4<f32>,
}

struct Counters {
    /// Vertices past the grid.
    vertices: atomic<u32>,
    /// Indices in each list of triangles.
    indices: array<atomic<u32>, 4>,
    /// Arcs drawn; arcs drawn coarser than asked; results that were not finite.
    arcs: atomic<u32>,
    coarse: atomic<u32>,
    caught: atomic<u32>,
    /// 1 once the vertices of the grid are there.
    stage: u32,
}

/// Half widths in pixels between which a thin image goes over from the mean of all its gas to gas from each of its circles, and is no longer drawn wider.
/// What is thinner is drawn wider than it is, and a pixel would show whichever circle its centre falls on: a row of dots. A wide image needs that no more, as
/// the gas thins out towards its edges, and it would move the gas aside.
const MEAN: vec2<f32> = vec2<f32>(0.75, 2.0);

/// The share of its circles' own gas that a thin image shows.
fn own_share(half_width: f32) -> f32 {
    return smoothstep(MEAN.x, MEAN.y, half_width);
}

/// The part of a pixel that a thin image covers, `d` pixels from its middle: its share of a tent two least widths wide. A box would leave a line that is
/// thinner than a pixel in steps of whole pixels, which along a diagonal are beads. The tent narrows as the image is drawn no wider than it is: all
/// of its light is there at any width.
fn coverage(d: f32, half_width: f32) -> f32 {
    let width = max(disk.gas.w * (1.0 - own_share(half_width)), 0.05);
    return tent_below((d + half_width) / width) - tent_below((d - half_width) / width);
}

/// The area of the tent 1 − |x| below x.
fn tent_below(x: f32) -> f32 {
    let t = 1.0 - min(abs(x), 1.0);
    return select(0.5 * t * t, 1.0 - 0.5 * t * t, x > 0.0);
}
