// The disk of sprites, projected: one thread per spot, one dispatch per image order. A spot is a place that gas flows through, as an arc
// is. It reaches to its neighbours' middles, as the camera sees them: two lookups beside its own.

#import lensrunner::disk::gas::{Gas, gas_at, gas_colour, place_in, Sides, STEP, Streaks, streaks_over, two_looks}
#import lensrunner::disk::light::gas_light
#import lensrunner::disk::motion::disk_slant
#import lensrunner::disk::radial::{gas_ratio, radial_gas}
#import lensrunner::disk::sigma::bearing
#import lensrunner::disk::sprites_types::SeenSprite
#import lensrunner::disk::types::disk
#import lensrunner::geometry::clip::{clip_position, finite_vector}
#import lensrunner::gpu::bindings::frame
#import lensrunner::lensing::closed_form::HALF_TURN
#import lensrunner::lensing::lookup::{lens_lookup_at, LensRay}

struct Sprite {
    /// In r_s.
    radius: f32,
    /// Where it is on its ring, even in σ, in rad; and from there to the next.
    sigma: f32,
    step: f32,
}

@group(1) @binding(2) var<storage, read> sprites: array<Sprite>;
/// Those of this order, each in its own place: what is drawn over what is the same in every frame.
@group(1) @binding(3) var<storage, read_write> seen_sprites: array<SeenSprite>;
@group(1) @binding(4) var<uniform> image: SpriteImage;

struct SpriteImage {
    /// The image order.
    order: u32,
    /// From one ring to the next, in r_s.
    ring_width: f32,
    /// Sprites.
    count: u32,
    /// Where the last ring ends, in r_s.
    end: f32,
}

/// Rings to the place by which the width of a spot is told, in orders 2 and 3: their images are so narrow that rounding shows between two
/// rings.
const RINGS_APART: f32 = 4.0;
/// Half the width, in pixels, below which a spot is spread over more than its own: what is narrower would be seen or not seen by chance.
const LEAST_HALF: f32 = 0.5;
/// A spot is spread over this many times its width at most: the least light that this leaves still counts in half precision.
const MOST_SPREAD: f32 = 4096.0;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < image.count {
        seen_sprites[id.x] = seen_sprite(sprites[id.x], image.order);
    }
}

fn seen_sprite(sprite: Sprite, order: u32) -> SeenSprite {
    let nothing = SeenSprite(vec3<f32>(0.0, 0.0, 1.0), 1.0, vec3<f32>(0.0), 0.0, vec3<f32>(0.0), 0.0, vec3<f32>(0.0));
    let r = sprite.radius;
    let gas = radial_gas(r);
    if gas.depth < 1e-3 {
        return nothing;
    }
    let here = bearing(sprite.sigma, disk.steepness);
    // Not by the slope there: near the axis behind the hole that would lead to the other side of the image.
    let next = bearing(sprite.sigma + sprite.step, disk.steepness);
    let step = next.theta - here.theta;
    let turn = select(1.0, -1.0, order == 2u);
    let apart = select(RINGS_APART, 1.0, order == 1u);
    var ray: LensRay;
    var apparent = vec3<f32>(0.0);
    // x, y and w in clip space of the middle, the next ring and the next spot of this ring.
    var seen = vec3<f32>(0.0);
    var next_ring = vec3<f32>(0.0);
    var next_spot = vec3<f32>(0.0);
    // The lookup is called from this one place: the neighbours first.
    for (var k = 0u; k < 3u; k++) {
        let there = r + select(0.0, apart * image.ring_width, k == 0u);
        let s = select(here.sine, next.sine, k == 1u);
        let c = select(here.cosine, next.cosine, k == 1u);
        let up = -disk.camera_sine * c;
        let reach = sqrt(up * up + s * s);
        let side = (disk.upwards * up + disk.sideways * s) / max(reach, 1e-12);
        ray = lens_lookup_at(there * c * disk.camera_cosine - frame.camera_radius, there * reach, there * c * disk.camera_cosine, order);
        let look = frame.outward * ray.cos_psi + side * (turn * ray.sin_psi);
        apparent = (frame.camera_from_rain * vec4<f32>(look * ray.delay, -ray.delay)).xyz;
        if !ray.valid || ray.delay <= 0.0 || !finite_vector(apparent) {
            return nothing;
        }
        seen = clip_position(apparent).xyw;
        if k == 0u {
            next_ring = seen;
        } else if k == 1u {
            next_spot = seen;
        }
    }
    if seen.z <= 1e-3 {
        return nothing;
    }
    var across = (next_ring - seen) / apart;
    let along = next_spot - seen;
    // The same in pixels, and half the width of the spot across its length.
    let pixels = 0.5 * frame.size / seen.z;
    let aside = (across.xy - seen.xy * (across.z / seen.z)) * pixels;
    let ahead = (along.xy - seen.xy * (along.z / seen.z)) * pixels;
    let normal = vec2<f32>(-ahead.y, ahead.x) / max(length(ahead), 1e-12);
    let half = dot(aside, normal);
    let spread = clamp(ceil(LEAST_HALF / max(abs(half), 1e-12)), 1.0, MOST_SPREAD);
    if spread > 1.0 {
        // Straight across, for where the plane is seen edge on rings lie beside one another along their length; each is whole wherever its
        // spots are. A narrow spot is so far off that its own depth is nothing, but not so many times that.
        across = vec3<f32>(spread * half * normal / pixels, 0.0);
    }
    let extent = abs(across) + abs(along);
    if any(abs(seen.xy) - extent.xy > vec2<f32>(seen.z + extent.z)) {
        return nothing;
    }

    let ratio = gas_ratio(apparent, r, ray.emission_slope > 0.0, gas);
    let depth = gas.depth * disk_slant(ratio.y, ray.delay, gas.half_height);
    let turns = (here.theta + atan2(disk.towards.y, disk.towards.x) - gas.lead) / (2.0 * HALF_TURN);
    let light = gas_light(gas.ln_temperature, log(ratio.x));
    let there = gas_at(vec4<f32>(0.0), turns, gas.pattern_height, ray.delay, depth, light, vec2<f32>(0.0, 1e6), ratio.y);
    // What the spot has of the pattern: as much as lies between two rings, and between two spots or as long as a pixel.
    let outer = radial_gas(r + image.ring_width);
    let width = vec2<f32>((gas.lead - outer.lead) / (2.0 * HALF_TURN), outer.pattern_height - gas.pattern_height);
    let long = vec2<f32>(step / (2.0 * HALF_TURN) * max(1.0, 1.0 / max(length(ahead), 1e-3)), 0.0);
    let cooling = two_looks(covered(there, gas.pattern_height, width, long));
    let colour = gas_colour(there.light.rgb, there.slope.xyz, there.light.w, cooling);
    let beyond = round((image.end - r) / image.ring_width - 0.5);
    return SeenSprite(seen, spread, across, beyond, along, colour.a, colour.rgb / max(colour.a, 1e-6));
}

/// Where in the pattern the gas `there` is, `height` up, and how much of it a spot covers that has these sides where it is not sheared.
fn covered(there: Gas, height: f32, width: vec2<f32>, long: vec2<f32>) -> Streaks {
    let even = place_in(there.even, height);
    let odd = place_in(there.odd, height);
    let ahead = vec2<f32>(width.x, 0.0);
    let even_sides = Sides(place_in(there.even, height + width.y) - even + ahead, long);
    let odd_sides = Sides(place_in(there.odd, height + width.y) - odd + ahead, long);
    return streaks_over(there, even, odd, even_sides, odd_sides, 2.0 * STEP);
}
