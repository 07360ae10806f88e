#define_import_path lensrunner::instances::ring

// Worldlines of the points of a ring that turns round the hole in the plane z = 0 (Yamashita 2025, section 2.1); used in place of
// instances/recorded.wgsl. In its instance `spin` is x, y: radii of those rims of the disk that are this ring's, or −1; z: dφ/dT; w: azimuth
// at T₀ of what has azimuth 0 in the model.

#import lensrunner::gpu::types::Instance
#import lensrunner::instances::swing::Swing

/// The body point `s` after T₀; its offset is from the hole.
fn swing_at(instance: Instance, body: vec3<f32>, s: f32) -> Swing {
    let angle = instance.spin.w + instance.spin.z * s;
    let c = cos(angle);
    let t = sin(angle);
    let position = vec3<f32>(c * body.x - t * body.y, t * body.x + c * body.y, 0.0);
    return Swing(position, instance.spin.z * vec3<f32>(-position.y, position.x, 0.0), vec4<f32>(0.0));
}

/// First guess of the emission time of a point, after T₀: by straight light from where it was at T₀.
fn first_guess(instance: Instance, body: vec3<f32>) -> f32 {
    return instance.offset.w - length(instance.offset.xyz + swing_at(instance, body, 0.0).offset);
}

/// As for bodies; no image of a flat ring depends on it.
fn before_turning(instance: Instance, leaving: vec3<f32>, delay: f32) -> vec3<f32> {
    return leaving;
}

/// As for bodies.
fn turning_slack(instance: Instance) -> f32 {
    return 0.0;
}

/// Whether an edge inside the surface may be an outline of its image. Only light within the plane grazes a plane, so a flat ring has no
/// outline but its rims.
const MAY_FOLD: bool = false;

/// Whether the disk ends at an edge of the model, which has one triangle (`alone`) and runs from `a` to `b`: where one ring slides along
/// another the disk goes on.
fn is_rim(instance: Instance, alone: bool, a: vec3<f32>, b: vec3<f32>) -> bool {
    let radii = vec2<f32>(length(a.xy), length(b.xy));
    let at = abs(radii.xyxy - instance.spin.xxyy) < vec4<f32>(1e-3 * radii.x);
    return alone && ((at.x && at.y) || (at.z && at.w));
}

/// Whether slivers are not split any more from some depth on. Seen from beside their plane turning rings consist of slivers, which would
/// fill the buffers.
const KEEPS_SLIVERS: bool = true;
