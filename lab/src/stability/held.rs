//! Places where no other method is set beside ours: what must hold there, the test that holds it, and a fault that the test finds.

/// A fault put into a file on purpose: the test must fail.
#[derive(Clone, Copy, Debug)]
pub struct Fault {
    /// The file, from the root of the project.
    pub file: &'static str,
    /// What stands there, once,
    pub right: &'static str,
    /// and what is put there.
    pub wrong: &'static str,
}

/// One place.
#[derive(Clone, Copy, Debug)]
pub struct Held {
    /// What part of the game.
    pub part: &'static str,
    /// Where.
    pub place: &'static str,
    /// What must hold.
    pub must: &'static str,
    /// The file of the test, from the root of the project, and its name.
    pub test: [&'static str; 2],
    /// A fault that it finds.
    pub fault: Fault,
}

const fn fault(file: &'static str, right: &'static str, wrong: &'static str) -> Fault {
    Fault { file, right, wrong }
}

/// All of them.
pub const HELD: [Held; 18] = [
    Held {
        part: "light",
        place: "NaN, infinities, denormals and zeros in every argument",
        must: "no NaN comes out; what is not a place is not answered",
        test: ["tests/lensing/stability.rs", "hostile_numbers_give_no_nan"],
        fault: fault("src/lensing/lookup/mod.rs", "    if !finite(along) {", "    if along == 7.5 {"),
    },
    Held {
        part: "light",
        place: "camera and point inside, light of either sign of E",
        must: "direction, delay and emission are the judge's",
        test: ["tests/lensing/tables.rs", "inside_the_horizon_both_branches_agree_with_the_judge"],
        fault: fault(
            "src/lensing/lookup/mod.rs",
            "emission_radial: 0.5 * (emitted - emitted_less),",
            "emission_radial: 0.49 * (emitted - emitted_less),",
        ),
    },
    Held {
        part: "matter",
        place: "past of a ship that came out of the hole",
        must: "it hovered before; a look into any past ends",
        test: ["tests/sim/history.rs", "what_would_have_come_out_of_the_hole_hovered"],
        fault: fault("src/sim/history.rs", "} else if came_out_of_the_hole(&self.state) {", "} else if self.held {"),
    },
    Held {
        part: "matter",
        place: "ships in hands, at any pace, with any turn rate that is set",
        must: "no vertex faster than a quarter of light; no turn sooner than light crosses the ship",
        test: ["tests/sim/turning.rs", "no_vertex_is_faster_than_a_quarter_of_light_and_no_turn_begins_at_once"],
        fault: fault("src/sim/ship.rs", "self.max_rate.min(TIP_SPEED / self.reach)", "self.max_rate.min(1.2 * TIP_SPEED / self.reach)"),
    },
    Held {
        part: "drawing",
        place: "a ship that hands throw about, from all sides, at five paces",
        must: "within the limits of the verdict",
        test: ["lab/tests/compare/flight.rs", "a_ship_in_hands_is_drawn_where_it_is"],
        fault: fault(
            "src/render/instances/swing.rs",
            "before = if sample.attitude.dot(before) < 0.0 { -sample.attitude } else { sample.attitude };",
            "before = now.attitude;",
        ),
    },
    Held {
        part: "drawing",
        place: "flights that nobody can fly: tips faster than light, thrust that tears a ship apart, jumps",
        must: "at most four times the work of the ship at rest; no NaN",
        test: ["tests/render/instances/hostile.rs", "any_history_takes_bounded_work_and_has_numbers"],
        fault: fault("src/render/instances/swing.rs", "turns[*k] * reach <= FASTEST &&", "turns[*k] * reach <= 1e9 &&"),
    },
    Held {
        part: "drawing",
        place: "vertex buffer full",
        must: "coarser patches, said in the overlay; nothing vanishes",
        test: ["tests/render/trouble.rs", "a_full_vertex_buffer_is_said_and_nothing_vanishes"],
        fault: fault(
            "shaders/geometry/emit.wgsl",
            "if coarse {\n                atomicAdd(&counters.coarse, 1u);",
            "if coarse {\n                atomicAdd(&counters.coarse, 0u);",
        ),
    },
    Held {
        part: "drawing",
        place: "triangles without area at the rim of an image, products fused by the driver",
        must: "the guard of bounds leaves none out that does not leave them",
        test: ["tests/render/instances/bounds.rs", "triangles_without_area_are_told_from_those_that_leave_a_cap"],
        fault: fault("shaders/instances/bounds.wgsl", "    return cross(a, b - a);", "    return cross(a, b);"),
    },
    Held {
        part: "drawing",
        place: "camera within a closed body",
        must: "its inner side is seen on every pixel",
        test: ["tests/render/trouble.rs", "from_within_a_body_its_inner_side_is_seen"],
        fault: fault("src/render/instances/mod.rs", "if within || !settings.method.bends() {", "if !settings.method.bends() {"),
    },
    Held {
        part: "drawing",
        place: "device lost",
        must: "an error in words",
        test: ["tests/render/trouble.rs", "a_lost_device_is_an_error_in_words"],
        fault: fault("src/render/renderer/prepare.rs", "if self.hidden || self.gpu.watch.complaint().is_some() {", "if self.hidden {"),
    },
    Held {
        part: "drawing",
        place: "window of no pixel",
        must: "nothing is drawn until it has one",
        test: ["tests/render/trouble.rs", "a_picture_without_a_size_waits"],
        fault: fault("src/render/renderer/mod.rs", "self.hidden = size.contains(&0);", "self.hidden = size.contains(&1);"),
    },
    Held {
        part: "drawing",
        place: "instances with NaN and infinities",
        must: "left out and counted; what is beside them is drawn",
        test: ["tests/render/trouble.rs", "what_is_not_finite_is_counted_and_not_drawn"],
        fault: fault(
            "src/render/geometry/lists.rs",
            "caught: refused, calmed, ..Counters::default()",
            "caught: refused.min(0), calmed, ..Counters::default()",
        ),
    },
    Held {
        part: "drawing",
        place: "NaN, huge and degenerate triangles in a model",
        must: "refused with place, value and range",
        test: ["tests/scene/models.rs", "a_model_is_refused_by_place_value_and_range"],
        fault: fault(
            "src/scene/model/mod.rs",
            "(!self.vertices.iter().all(finite)).then_some(\"a vertex is not finite\")",
            "self.vertices.iter().all(finite).then_some(\"a vertex is not finite\")",
        ),
    },
    Held {
        part: "drawing",
        place: "pictures of any size",
        must: "the exposure is the same",
        test: ["tests/render/pictures.rs", "the_exposure_does_not_depend_on_the_size_of_the_picture"],
        fault: fault(
            "shaders/post_process/exposure.wgsl",
            "let metered = exp(mix(each.x, each.y, octaves));",
            "let metered = exp(each.x) + 0.0 * octaves;",
        ),
    },
    Held {
        part: "drawing",
        place: "other drivers",
        must: "every pipeline translates to SPIR-V, Metal and HLSL within WebGPU's limits",
        test: ["tests/render/gpu/translate.rs", "every_pipeline_is_within_webgpus_limits_and_translates"],
        fault: fault("shaders/disk/arcs/strips.wgsl", "@compute @workgroup_size(64)", "@compute @workgroup_size(512)"),
    },
    Held {
        part: "straight rays",
        place: "NaN, infinite, empty and coincident triangles",
        must: "they hit nothing and harm nobody; of equals the first is hit",
        test: ["lab/tests/bvh/robust.rs", "degenerate_triangles_harm_nobody"],
        fault: fault(
            "lab/src/straight/ray.rs",
            "self.t == other.t && self.triangle < other.triangle",
            "self.t == other.t && self.triangle > other.triangle",
        ),
    },
    Held {
        part: "aurora",
        place: "electrons of any energy, pitch and height",
        must: "finite, and no more is spent than there is",
        test: ["tests/scene/aurora/curtains.rs", "any_energy_and_any_step_is_sane"],
        fault: fault("src/scene/aurora/fall.rs", "if energy.is_nan() { ENERGIES[0] }", "if energy == 7.5 { ENERGIES[0] }"),
    },
    Held {
        part: "aurora",
        place: "a frame after another",
        must: "nothing is left of it",
        test: ["tests/render/aurora/pictures.rs", "nothing_is_left_of_an_earlier_frame"],
        fault: fault("shaders/aurora/levels/wipe.wgsl", "    return vec4<f32>(0.0);", "    discard;\n    return vec4<f32>(0.0);"),
    },
];
