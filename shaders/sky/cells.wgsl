// The sky in cells: what a pixel sees changes slowly over most of the picture, so it is worked out at the corners of a grid, and a cell is
// drawn by interpolation where that is right to a fraction of a pixel. The other cells (at the edge of the shadow, at the Einstein ring, at
// the poles and the seam of the panorama) are drawn pixel by pixel.

#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::colour::shifted_colour
#import lensrunner::gpu::types::{FLAG_BEAMING, FLAG_DOPPLER, SkyCorner}
#import lensrunner::sky::direction::{PANORAMA_BRIGHT, PANORAMA_FAINT, sky_view}
#import lensrunner::sky::table::PI

@group(1) @binding(0) var<storage, read_write> corners: array<SkyCorner>;
/// Indices of the interpolated cells, then from the middle on those of the exact ones.
@group(1) @binding(1) var<storage, read_write> cell_indices: array<u32>;
@group(1) @binding(2) var<storage, read_write> cell_draws: CellDraws;

/// Arguments of two indexed draws.
struct CellDraws {
    smooth_indices: atomic<u32>,
    smooth_instances: u32,
    smooth_first: u32,
    smooth_base: u32,
    smooth_instance: u32,
    exact_indices: atomic<u32>,
    exact_instances: u32,
    exact_first: u32,
    exact_base: u32,
    exact_instance: u32,
    /// Cells along the width, and down, and the side of one in pixels.
    columns: u32,
    rows: u32,
    side: u32,
    unused: u32,
}

/// How far off an interpolated place on the sky may be, as a part of what one pixel covers there.
const SKY_ERROR: f32 = 1.0;

/// Normalised device coordinates of a place counted in cells from the upper left corner.
fn cell_ndc(place: vec2<f32>) -> vec2<f32> {
    let pixel = place * f32(cell_draws.side) / frame.size;
    return vec2<f32>(2.0 * pixel.x - 1.0, 1.0 - 2.0 * pixel.y);
}

/// One thread per corner.
@compute @workgroup_size(64)
fn corner(@builtin(global_invocation_id) id: vec3<u32>) {
    let across = cell_draws.columns + 1u;
    if id.x >= across * (cell_draws.rows + 1u) {
        return;
    }
    let ndc = cell_ndc(vec2<f32>(f32(id.x % across), f32(id.x / across)));
    let view = sky_view(ndc);
    let flags = frame.flags;
    // The shift is linear in the colour, so it may come before the mixing.
    var colours = array<vec3<f32>, 2>(PANORAMA_FAINT, PANORAMA_BRIGHT);
    for (var k = 0u; k < 2u; k++) {
        colours[k] = frame.sky_brightness * shifted_colour(colours[k], view.g, (flags & FLAG_DOPPLER) != 0u, (flags & FLAG_BEAMING) != 0u);
    }
    corners[id.x] = SkyCorner(view.uv, view.size, select(0.0, 1.0, view.lit), colours[0], ndc.x, colours[1], ndc.y);
}

/// One thread per cell: compares the middles of its sides and its centre with what interpolation makes of the corners.
@compute @workgroup_size(64)
fn cell(@builtin(global_invocation_id) id: vec3<u32>) {
    let columns = cell_draws.columns;
    if id.x >= columns * cell_draws.rows {
        return;
    }
    let column = id.x % columns;
    let row = id.x / columns;
    let first = row * (columns + 1u) + column;
    // Upper left, upper right, lower left, lower right.
    let vertices = array<u32, 4>(first, first + 1u, first + columns + 1u, first + columns + 2u);
    let a = corners[vertices[0]];
    let b = corners[vertices[1]];
    let c = corners[vertices[2]];
    let d = corners[vertices[3]];
    var lit = a.lit + b.lit + c.lit + d.lit;
    let low = min(min(a.place, b.place), min(c.place, d.place));
    let high = max(max(a.place, b.place), max(c.place, d.place));
    var smooth_cell = high.x - low.x < 0.25;
    for (var k = 0u; k < 5u; k++) {
        var place = vec2<f32>(0.5, 0.5);
        var between = array<SkyCorner, 2>(b, c);
        if k == 1u { place = vec2<f32>(0.5, 0.0); between = array<SkyCorner, 2>(a, b); }
        if k == 2u { place = vec2<f32>(0.5, 1.0); between = array<SkyCorner, 2>(c, d); }
        if k == 3u { place = vec2<f32>(0.0, 0.5); between = array<SkyCorner, 2>(a, c); }
        if k == 4u { place = vec2<f32>(1.0, 0.5); between = array<SkyCorner, 2>(b, d); }
        let mean = 0.5 * (between[0].place + between[1].place);
        let size = 0.5 * (between[0].size + between[1].size);
        let view = sky_view(cell_ndc(vec2<f32>(f32(column), f32(row)) + place));
        let off = (view.uv - mean) * vec2<f32>(2.0 * PI * sin(PI * view.uv.y), PI);
        lit += select(0.0, 1.0, view.lit);
        smooth_cell &= view.lit && length(off) < SKY_ERROR * view.size && abs(log2(size / view.size)) < 0.5;
    }
    // All within the shadow, which is a disc: black, as the picture is to begin with.
    if lit == 0.0 {
        return;
    }
    smooth_cell &= lit == 9.0;
    // Two triangles along the diagonal b–c, as the middle above is that of b and c.
    var slot = 0u;
    if smooth_cell {
        slot = atomicAdd(&cell_draws.smooth_indices, 6u);
    } else {
        slot = cell_draws.exact_first + atomicAdd(&cell_draws.exact_indices, 6u);
    }
    cell_indices[slot] = vertices[0];
    cell_indices[slot + 1u] = vertices[2];
    cell_indices[slot + 2u] = vertices[1];
    cell_indices[slot + 3u] = vertices[1];
    cell_indices[slot + 4u] = vertices[2];
    cell_indices[slot + 5u] = vertices[3];
}
