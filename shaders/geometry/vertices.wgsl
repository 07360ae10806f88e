// Stage 1: one thread per model vertex and order. Solves the emission time, projects, writes what the rasteriser may draw as it is.

#import lensrunner::geometry::bindings::{
    chunk_of, counters, model_vertex, NO_INSTANCE, seen, states, VERTEX_ON_AXIS, VERTEX_PLAIN, VERTEX_UNSEEN,
}
#import lensrunner::geometry::clip::finite_vector
#import lensrunner::geometry::patch::{axis_core, axis_matters, seen_vertex}
#import lensrunner::geometry::project::{body_input, project_point}
#import lensrunner::instances::instance::instance_at

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = group.y * groups.x + group.x;
    let chunk = chunk_of(index);
    if chunk.instance == NO_INSTANCE {
        return;
    }
    let instance = instance_at(chunk.instance);
    let local = chunk.first + lane;
    if local >= instance.vertex_count {
        return;
    }
    let vertex = model_vertex(instance.first_vertex + local);
    let order = instance.order;
    let slot = instance.first_seen + local;
    let found = project_point(instance, body_input(vertex.position.xyz), order);
    let on_axis = length(found.by_axis.xy) < axis_core(instance, found.ray.apparent) && axis_matters(found.by_axis.z, order);
    let ray = found.ray;
    let ok = ray.valid && finite_vector(ray.apparent);
    if !finite_vector(found.by_axis) || (ray.valid && !ok) {
        atomicAdd(&counters.caught, 1u);
    }
    seen[slot] = seen_vertex(instance, chunk.instance, found, found.attitude, vertex.normal.xyz,
        vec2<f32>(vertex.u, vertex.v), vertex.material + instance.first_material);
    states[slot] = vec4<f32>(found.by_axis, select(VERTEX_UNSEEN, select(VERTEX_PLAIN, VERTEX_ON_AXIS, on_axis), ok));
}
