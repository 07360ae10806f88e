// Stage 2, the object stage: one thread per arc of a circle. The error δ of its middle against the middle of its seen ends (Yamashita 2025,
// section 3) gives the number of segments. Both arcs that share the circle take the same points, so no gap opens. Halving divides δ by
// four, and n segments by n². Yamashita 2025 halves until δ is small enough; here the least n is taken, which makes a quarter fewer
// triangles.

#import lensrunner::disk::arcs::bindings::{circles, disk_counters, disk_vertices, jobs, segments}
#import lensrunner::disk::types::{disk, Job, own_share, Segments}
#import lensrunner::gpu::bindings::frame

/// Most segments of an arc.
const MOST_SEGMENTS: u32 = 128u;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let arcs = disk.arcs;
    if id.x >= arcs * disk.rows {
        return;
    }
    let row = id.x / arcs;
    let arc = id.x % arcs;
    let first = row * disk.columns + 2u * arc;
    let a = disk_vertices[first];
    let m = disk_vertices[first + 1u];
    let b = disk_vertices[first + 2u];
    if a.path <= 0.0 || m.path <= 0.0 || b.path <= 0.0 {
        segments[id.x] = Segments(1u, 0u, 0.0, 15u);
        return;
    }
    let chord = 0.5 * (a.apparent + b.apparent);
    let error = atan2(length(cross(m.apparent, chord)), dot(m.apparent, chord));
    let beyond = sides_beyond(a.apparent, m.apparent, b.apparent, error);
    if beyond != 0u {
        segments[id.x] = Segments(1u, 0u, error, beyond);
        return;
    }
    // Thin images are widened to lines, so their chords are held closer: the sag shows against their own width. With half the budget a line
    // half a pixel to two wide is uneven by a tenth, with this by a sixteenth. Wide images of orders 2 and 3 are not lines, but all of the
    // disk is narrow in them: with the whole budget gas moves so far that a ball behind it has 0.52 of its light left instead of 0.64.
    let half = min(min(a.half_width, m.half_width), b.half_width);
    let budget = disk.error_budget * select(mix(0.35, 0.6, own_share(half)), 1.0, circles[row].order == 1u);
    var count = u32(clamp(ceil(sqrt(error / budget)), 1.0, f32(MOST_SEGMENTS)));
    var extra = 0u;
    if count > 2u {
        extra = atomicAdd(&disk_counters.vertices, count - 1u);
        let grid = disk.columns * disk.rows;
        if grid + extra + count - 1u > disk.vertex_room {
            // No room: the arc is drawn with its middle only. Nothing is given back, as another thread may have asked since.
            atomicAdd(&disk_counters.coarse, 1u);
            count = 2u;
        } else {
            for (var i = 1u; i < count; i++) {
                jobs[extra + i - 1u] = Job(id.x, i, count);
            }
        }
    }
    segments[id.x] = Segments(count, extra, error, 0u);
}

/// The sides of the screen, as bits, that an arc is surely beyond: its ends and its middle all by more than it bends.
fn sides_beyond(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, error: f32) -> u32 {
    let fx = frame.focal.x;
    let fy = frame.focal.y;
    let sx = inverseSqrt(1.0 + fx * fx);
    let sy = inverseSqrt(1.0 + fy * fy);
    let margin = vec3<f32>(length(a), length(b), length(c)) * (min(error, 3.0) + 4.0 * frame.pixel);
    let x = vec3<f32>(a.x, b.x, c.x);
    let y = vec3<f32>(a.y, b.y, c.y);
    let z = -vec3<f32>(a.z, b.z, c.z);
    return select(0u, 1u, all((z - x * fx) * sx < -margin)) | select(0u, 2u, all((z + x * fx) * sx < -margin))
        | select(0u, 4u, all((z - y * fy) * sy < -margin)) | select(0u, 8u, all((z + y * fy) * sy < -margin));
}
