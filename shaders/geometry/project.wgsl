#define_import_path lensrunner::geometry::project

// From a point of an object to where the camera sees it: `project_point()`.

#import lensrunner::chosen::method::method_ray
#import lensrunner::chosen::worldlines::{first_guess, local_motion_at}
#import lensrunner::geometry::clip::least_pixel
#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::{Instance, INSTANCE_MINUS}
#import lensrunner::lensing::lookup::{OLD, YOUNG}

/// One ray: where its source is seen, how long it took, and the photon's momentum at both ends over |E b|.
struct Sight {
    /// Apparent position, camera axes: direction times light path.
    apparent: vec3<f32>,
    delay: f32,
    /// Rain-frame momentum of the photon at the point and at the camera, over E b; w: its frequency there.
    leaving: vec4<f32>,
    arriving: vec4<f32>,
    /// The conserved energy E, in the same unit: negative only inside the horizon.
    energy: f32,
    valid: bool,
}

/// The ray of `order` from a point to the camera. `along` is the point's offset from the camera along the axis, `across` its distance from
/// the axis, `height` its distance from the hole along the axis, `side` the unit vector across the axis towards it (given apart, because on
/// the axis the offset does not tell it). `elapsed` is the age of the light as far as it is known.
fn sight(along: f32, across: f32, height: f32, side: vec3<f32>, order: u32, elapsed: f32) -> Sight {
    let ray = method_ray(along, across, height, order, elapsed);
    let turn = select(1.0, -1.0, order == 2u);
    let n = frame.outward;
    // The direction from which light comes at the camera; even orders come from the other side.
    let seen_at = n * ray.cos_psi + side * (turn * ray.sin_psi);

    var result: Sight;
    result.valid = ray.valid && ray.delay > 0.0;
    result.delay = ray.delay;
    result.apparent = (frame.camera_from_rain * vec4<f32>(seen_at * ray.delay, -ray.delay)).xyz;
    result.arriving = vec4<f32>(-seen_at * ray.frequency, ray.frequency);

    // At the point: radial m, and the sweep's tangent side·cosφ − n·sinφ, times its sense.
    result.energy = ray.energy;
    let c = inverseSqrt(max(height * height + across * across, 1e-12));
    let m = n * (height * c) + side * (across * c);
    let tangent = (side * (height * c) - n * (across * c)) * turn;
    result.leaving = vec4<f32>(m * ray.emission_radial - tangent * ray.emission_tangential, ray.emission_frequency);
    return result;
}

/// The unit vector across the axis towards a position with the coordinates `across` along `side_a` and `side_b`.
fn side_towards(across: vec2<f32>) -> vec3<f32> {
    let distance = length(across);
    if distance > 0.0 {
        return (frame.side_a * across.x + frame.side_b * across.y) / distance;
    }
    return frame.side_a;
}

/// ν_observed/ν_emitted for an emitter of rain-frame momentum `momentum` (xyz, γ).
fn frequency_ratio(arriving: vec4<f32>, leaving: vec4<f32>, momentum: vec4<f32>) -> f32 {
    // Time row of the Lorentz matrix: the photon (k, ω) has frequency Λ_t·(k, ω) in the camera's frame.
    let m = frame.camera_from_rain;
    let observed = m[0].w * arriving.x + m[1].w * arriving.y + m[2].w * arriving.z + m[3].w * arriving.w;
    let emitted = momentum.w * leaving.w - dot(momentum.xyz, leaving.xyz);
    return clamp(observed / emitted, 1e-3, 1e3);
}

/// The direction in which light left, in the emitter's rest frame.
fn leaving_direction(leaving: vec4<f32>, momentum: vec4<f32>) -> vec3<f32> {
    let k = leaving.xyz + momentum.xyz * (dot(momentum.xyz, leaving.xyz) / (1.0 + momentum.w) - leaving.w);
    return k / max(length(k), 1e-20);
}

/// What is to be projected: a body point, at its own emission time, or a fixed position.
struct ProjectionInput {
    body: vec3<f32>,
    fixed: bool,
    along: f32,
    across: f32,
    /// L + along, with the digits it has near the hole.
    height: f32,
    side: vec3<f32>,
}

struct ProjectedPoint {
    ray: Sight,
    /// The position of emission by the axis of hole and camera. x, y: across it, along `side_a` and `side_b`; z: along it, from the camera
    /// outward.
    by_axis: vec3<f32>,
    /// The same position, from the hole.
    position: vec3<f32>,
    /// `MovedPoint.attitude` of a body point.
    attitude: vec4<f32>,
}

fn body_input(body: vec3<f32>) -> ProjectionInput {
    return ProjectionInput(body, false, 0.0, 0.0, 0.0, vec3<f32>(0.0));
}

/// Most steps of the search for the emission time. Newton's method squares the error, which starts as the share of c at which the object
/// turns or accelerates while light crosses it; so two or three steps are usual. Next to the horizon the first guesses may have no ray at
/// all, and bisection comes before Newton. For what falls inside the horizon beside the camera, seen by light of hardly any energy, most
/// points of a ship need 8 to 18 steps and a few between 24 and 40: the delay goes there as the root of the time that is left until there
/// is no ray.
const EMISSION_STEPS: u32 = 40u;
/// The longest step back in search of a ray, in r_s/c: beyond it f32 overflows in the fourth power.
const FARTHEST_BACK: f32 = 1e5;
/// Before any time, and after all.
const NEVER: f32 = 3e38;

/// Whether a point's path less the centre's is told by gradients.
fn has_gradient(instance: Instance) -> bool {
    return instance.path_along != 0.0 || instance.path_across != 0.0;
}

/// How much longer the light's path from a point, `moved` from the instance's centre, is than from there, in r_s: by the trapezoid rule from the gradients at
/// both, in the half-plane of the axis. The difference of both paths would have no more digits than the whole path leaves.
fn longer_by(instance: Instance, point: ProjectedPoint, moved: vec3<f32>, side: vec3<f32>) -> f32 {
    let centre = vec2<f32>(instance.across_a, instance.across_b);
    let beside = vec2<f32>(dot(moved, frame.side_a), dot(moved, frame.side_b));
    // The difference of two distances from the axis has fewer digits than that of their squares.
    let outward = dot(beside, point.by_axis.xy + centre) / max(length(point.by_axis.xy) + length(centre), 1e-30);
    let along = dot(moved, frame.outward);
    let gradient = -point.ray.leaving.xyz / point.ray.energy;
    return 0.5 * (along * (dot(gradient, frame.outward) + instance.path_along) + outward * (dot(gradient, side) + instance.path_across));
}

/// Projects a point: the ray from it to the camera. For a body point it solves s + Δ(x(s)) = T − T₀. The left side increases
/// strictly with s for light of E > 0 and decreases for E < 0, since no emitter outruns light. So there is one solution, between times that
/// are too early and too late; Newton's steps are kept between them. The lookup is called from one place here, and a pass should call this
/// function from one place: shader compilers copy functions into every call.
fn project_point(instance: Instance, input: ProjectionInput, order: u32) -> ProjectedPoint {
    var result: ProjectedPoint;
    var s = first_guess(instance, input.body);
    // Known to be too early, and too late.
    var early = -NEVER;
    var late = NEVER;
    var back = 0.0;
    let moves = instance.scale != 0.0;
    let finest = least_pixel();
    let steps = select(0u, EMISSION_STEPS, moves);
    for (var i = 0u; i <= steps; i++) {
        var along = input.along;
        var across = input.across;
        var height = input.height;
        var side = input.side;
        var velocity = vec3<f32>(0.0);
        var moved_by = vec3<f32>(0.0);
        if input.fixed {
            result.by_axis = vec3<f32>(dot(side, frame.side_a) * across, dot(side, frame.side_b) * across, along);
            result.position = frame.outward * height + side * across;
        } else {
            let moved = local_motion_at(instance, input.body, s);
            velocity = moved.velocity;
            moved_by = moved.offset;
            result.attitude = moved.attitude;
            result.position = instance.position + moved.offset;
            let beside = vec2<f32>(instance.across_a, instance.across_b)
                + vec2<f32>(dot(moved.offset, frame.side_a), dot(moved.offset, frame.side_b));
            along = dot(instance.offset + moved.offset, frame.outward);
            across = length(beside);
            height = dot(result.position, frame.outward);
            side = side_towards(beside);
            result.by_axis = vec3<f32>(beside, along);
        }
        // A moving point is seen by light of one age. A static point may be seen by light of two ages: its instance says which is meant.
        let elapsed = select(select(YOUNG, OLD, (instance.flags & INSTANCE_MINUS) != 0u), instance.delay - s, moves);
        result.ray = sight(along, across, height, side, order, elapsed);
        if input.fixed || !moves {
            break;
        }
        if !result.ray.valid && i < steps {
            // Not in the camera's past any more: try earlier. Light crosses the object in about its size.
            late = s;
            back = min(select(2.0 * back, 2.0 * distance(result.position, instance.position), back == 0.0), FARTHEST_BACK);
            s = select(s - back, 0.5 * (early + s), early > -NEVER);
            // The last step is at a time that has a ray.
            s = select(s, early, i + 1u == steps && early > -NEVER);
            continue;
        }
        let missing = select(elapsed - result.ray.delay, -s - longer_by(instance, result, moved_by, side), has_gradient(instance));
        let speed = length(velocity);
        // The search ends when the image moves by less than a fiftieth of a pixel in the missing time. Round the axis it moves as the
        // azimuth turns.
        let seen_from = min(result.ray.delay, across);
        if i > 0u && abs(missing) * speed < max(0.02 * frame.pixel * finest * seen_from, instance.rounding) {
            break;
        }
        // dΔ/dT along the worldline: the gradient of the light path at the point is minus the photon's momentum over its energy.
        let energy = result.ray.energy;
        let step = missing * clamp(energy / (energy - dot(velocity, result.ray.leaving.xyz)), -20.0, 20.0);
        if i == steps {
            // A point whose emission time was not found is not drawn: it would be seen where it never was.
            result.ray.valid = result.ray.valid && abs(step) * speed < 4.0 * frame.pixel * result.ray.delay;
            break;
        }
        early = select(early, s, step > 0.0);
        late = select(s, late, step > 0.0);
        let next = s + step;
        s = select(select(next, 0.5 * (early + late), early > -NEVER && late < NEVER), next, next > early && next < late);
    }
    return result;
}
