//! What crosses from Rust to the shaders has one layout in both languages: each struct and constant, as the shipped WGSL has it.

use std::mem::size_of;
use std::sync::{LazyLock, Mutex, PoisonError};

use lensrunner::lensing::methods::Method;
use lensrunner::render::aurora::capacities::{CORNERS, LIT_TILES};
use lensrunner::render::aurora::ground::GroundLight;
use lensrunner::render::aurora::{
    AuroraSettings, BOTH_POLES, CHORD_END_BYTES, Colours, CurtainNode, LEAST_DEPTH_TILE, LINEAR, PYRAMID, RED_EVERY, REFERENCE_BYTES,
    SHIFTS, SMOOTH, STROKE_BYTES, Segment,
};
use lensrunner::render::disk::circles::AZIMUTHS;
use lensrunner::render::disk::types::{self as disk, Circle, DiskCounters, DiskFrame, DiskVertex, RadialGas, Sprite, SpriteImage, Turning};
use lensrunner::render::disk::view::THIN_SAMPLES;
use lensrunner::render::frame::{BLACKBODY_COLDEST, BLACKBODY_HOTTEST};
use lensrunner::render::gpu::layout::TABLE_ROW;
use lensrunner::render::gpu::library::{Library, Values, Worldlines};
use lensrunner::render::gpu::shaders::Pass;
use lensrunner::render::gpu::targets::TILE;
use lensrunner::render::gpu::types::{
    self, Adaptation, Cap, Capacity, CellDraws, Chunk, Counters, Frame, HeldBody, HeldFrame, HeldModel, Instance, Material, ModelTriangle,
    ModelVertex, STAR_ORDERS, SeenVertex, Star, StarCluster,
};
use lensrunner::render::gpu::types::{flags, placed};
use lensrunner::render::models::ALONE;
use lensrunner::render::models::hiding::NODES;
use lensrunner::render::models::outside;
use lensrunner::render::post_process::flashes;
use lensrunner::scene::disk::DISK_UNIT;
use wgpu::naga::{Expression, Literal, Module};

use crate::layout::{Numbers, fields, fields_of, struct_of};

impl Numbers for Cap {
    const FLOAT: bool = true;
}

impl Numbers for RadialGas {
    const FLOAT: bool = true;
}

impl Numbers for Capacity {
    const FLOAT: bool = false;
}

static LIBRARY: LazyLock<Mutex<Library>> =
    LazyLock::new(|| Mutex::new(Library::new(Worldlines::Bodies, Method::default(), &[]).unwrap_or_else(|error| panic!("{error}"))));

fn composed(text: &str) -> Module {
    let values = Values { inside: true, data_group: 1 };
    let module = LIBRARY.lock().unwrap_or_else(PoisonError::into_inner).compose("types", text, values);
    module.unwrap_or_else(|error| panic!("{error}"))
}

/// A shader with the struct at a path. In the memory of a workgroup, where atomics may be.
fn with_struct(path: &str) -> Module {
    match path {
        "sky::cells::CellDraws" => Pass::SkyCells.module(),
        "disk::arcs::arguments::DiskArguments" => Pass::DiskArguments.module(),
        "disk::polygons::Turning" => Pass::DiskPolygons.module(),
        "disk::sprites::Sprite" | "disk::sprites::SpriteImage" => Pass::DiskSprites.module(),
        _ => composed(&format!("var<workgroup> variable: lensrunner::{path};")),
    }
}

#[test]
fn structs_have_one_layout_in_both_languages() {
    let cases = [
        (
            "gpu::types::Frame",
            fields!(Frame: camera_from_rain, rain_from_camera, outward, camera_radius, side_a, least_width, side_b, river_speed, focal, near,
            time, size, pixel, error_budget, exposure_bias, star_brightness, sky_brightness, bloom, least_exposure, greatest_exposure,
            adaptation, shadow_edge, flags, halvings, star_sigma, faintest_star, capacity, least_fill, greatest_fill, last_exposure,
            exposure_known, unmetered_middle, unmetered_radius, exposure_key, disk_indices, exposure_key_without_disk, most_rise,
            rise_per_luminance, enlargement),
        ),
        ("gpu::types::Adaptation", fields!(Adaptation: exposure, metered, known, steadied)),
        ("gpu::types::Capacity", fields!(Capacity: vertices, indices, work, thin)),
        (
            "gpu::types::Instance",
            fields!(Instance: offset, delay, position, engines_off, velocity, scale, acceleration, across_a, jerk, across_b, snap, crossings,
            momentum, gamma, contraction, rounding, force, path_across, spin, spin_slack, shape_x, strictness, shape_y, first_node, shape_z,
            nodes_per_time, turn_x, node_intervals, turn_y, node_texel, turn_z, path_along, light ["light_red", "light_green", "light_blue"],
            bounds ["bound_high", "bound_low", "bound_look"], order, object, first_seen, first_state, first_vertex, vertex_count, first_edge,
            edge_count, first_triangle, triangle_count, first_material, flags),
        ),
        ("gpu::types::Cap", fields!(Cap: middle, rim)),
        ("gpu::types::ModelVertex", fields!(ModelVertex: position, u, normal, v, material, unused ["unused_a", "unused_b", "unused_c"])),
        ("gpu::types::ModelTriangle", fields!(ModelTriangle: vertices, side, edges, unused, seen_from)),
        ("gpu::types::Chunk", fields!(Chunk: instance, first)),
        (
            "gpu::types::SeenVertex",
            fields!(SeenVertex: apparent, path, normal, shift, leaving, radius, uv, instance, material, axis_uv, from_axis, height),
        ),
        (
            "geometry::bindings::Counters",
            fields!(Counters: vertices, indices, work, thin, pieces, turn, coarse, cut, caught, model_vertices, lost, outside, split,
            calmed, passes, is_last, simpler, left_out, images, held_vertices, held_states, chunks),
        ),
        (
            "instances::held::HeldBody",
            fields!(HeldBody: position, reach, position_rest, scale, attitude, light ["light_red", "light_green", "light_blue"], first_model,
            model_count, object, flatness),
        ),
        (
            "instances::held::HeldModel",
            fields!(HeldModel: first_vertex, vertex_count, first_edge, edge_count, first_triangle, triangle_count, first_material, below),
        ),
        (
            "instances::held::HeldFrame",
            fields!(HeldFrame: camera, bodies, camera_rest, images, orders, flags, bounded, thin_below, coarse_below,
            least_width, allowed, strictness, has_thin, images_end, vertices_end, states_end, unused),
        ),
        ("gpu::types::Material", fields!(Material: base, alpha, emissive, roughness, metallic, layer, temperature, nozzle)),
        (
            "shading::aurora_light::GroundLight",
            fields!(GroundLight: dipole_x, planet, dipole_y, both_poles, dipole_z, per_radian, colour, older, pole, half_texel, unused),
        ),
        ("gpu::types::Star", fields!(Star: direction, flux, temperature, luminance, unused ["unused_a", "unused_b"])),
        ("gpu::types::StarCluster", fields!(StarCluster: middle, spread, sine, first, count, unused)),
        (
            "sky::cells::CellDraws",
            fields!(CellDraws: smooth ["smooth_indices", "smooth_instances", "smooth_first", "smooth_base", "smooth_instance"], exact ["exact_indices", "exact_instances", "exact_first", "exact_base", "exact_instance"], columns, rows, side, unused),
        ),
        (
            "disk::types::DiskFrame",
            fields!(DiskFrame: towards, camera_sine, sideways, camera_cosine, upwards, steepness, renewals, renewals_per_time, renewal, newborn,
            contrast, filled, error_budget, least_width, columns, arcs, rows, rings, regions, vertex_room, near_orders, thickness,
            regions_end, unit, close, most_looks, unused, offset, offset_step),
        ),
        ("disk::types::RadialGas", fields!(RadialGas: radius, lead, ln_temperature, depth, outward, along, half_height, pattern_height)),
        (
            "disk::types::Circle",
            fields!(Circle: gas, beyond, gap_radius, gap, gap_sides, order, first_row, last_row, first_sample, nearer_depth,
            nearer_outward, nearer_along, nearer_radius),
        ),
        (
            "disk::types::DiskVertex",
            fields!(DiskVertex: apparent, path, turns, pattern_height, ln_temperature, depth, ln_g, cosine, filled, from_middle, half_width,
            bend_height, bend_light, bend_depth, side),
        ),
        ("disk::polygons::Turning", fields!(Turning: rate, azimuth)),
        ("disk::sprites::Sprite", fields!(Sprite: radius, sigma, step)),
        ("disk::sprites::SpriteImage", fields!(SpriteImage: order, ring_width, count, end)),
        ("disk::types::Counters", fields!(DiskCounters: vertices, indices, arcs, coarse, caught, stage)),
        (
            "aurora::streaks::AuroraSettings",
            fields!(AuroraSettings: streaks, chords, parts, row_nodes, newest_row, segments, capacity, flags, row_seconds, ahead, clock,
            contrast, point, levels, midnight, green_top, green_foot, red_top, red_foot),
        ),
        ("aurora::streaks::Segment", fields!(Segment: first_streak, streaks, first_node, span, collisions, width, length)),
        ("aurora::streaks::CurtainNode", fields!(CurtainNode: place, flux, along)),
        ("aurora::levels::lit_corners::Lines", fields!(Colours: lines ["colours"], slope, tile, middle)),
    ];
    for (path, rust) in cases {
        assert_eq!(fields_of(&with_struct(path), path), rust, "{path}");
    }
}

#[test]
fn structs_that_only_shaders_know_have_the_sizes_that_rust_reserves() {
    let cases = [
        ("gpu::types::Piece", types::PIECE_BYTES),
        ("gpu::types::WorkItem", types::WORK_BYTES),
        ("gpu::types::ThinVertex", types::THIN_BYTES),
        ("geometry::bindings::Arguments", types::ARGUMENTS_BYTES),
        ("gpu::types::SkyCorner", types::SKY_CORNER_BYTES),
        ("disk::arcs::arguments::DiskArguments", disk::ARGUMENTS_BYTES),
        ("disk::types::Segments", disk::SEGMENTS_BYTES),
        ("disk::types::Job", disk::JOB_BYTES),
        ("aurora::streaks::ChordEnd", CHORD_END_BYTES),
        ("aurora::streaks::Reference", REFERENCE_BYTES),
        ("aurora::stroke::Stroke", STROKE_BYTES),
        ("disk::sprites_types::SeenSprite", disk::SEEN_SPRITE_BYTES),
    ];
    for (path, bytes) in cases {
        assert_eq!(u64::from(struct_of(&with_struct(path), path).1), bytes, "{path}");
    }
}

/// The value of a constant of the shader, as f64.
fn constant(path: &str) -> f64 {
    named_constant(&composed(&format!("const VALUE = lensrunner::{path};")), "VALUE", path)
}

/// The value of a constant of a module, by its name there.
fn named_constant(module: &Module, name: &str, path: &str) -> f64 {
    let found = module.constants.iter().find(|(_, constant)| constant.name.as_deref() == Some(name));
    let (_, constant) = found.unwrap_or_else(|| panic!("no constant {path}"));
    match module.global_expressions[constant.init] {
        Expression::Literal(Literal::U32(value)) => f64::from(value),
        Expression::Literal(Literal::I32(value)) => f64::from(value),
        Expression::Literal(Literal::F32(value)) => f64::from(value),
        ref other => panic!("{path} is {other:?}"),
    }
}

#[test]
fn constants_of_passes_have_one_value_in_both_languages() {
    let cases =
        [(Pass::Flashes, "GROUPS", f64::from(flashes::GROUPS)), (Pass::AuroraWalk, "LEAST_DEPTH_TILE", f64::from(LEAST_DEPTH_TILE))];
    for (pass, name, value) in cases {
        assert_eq!(named_constant(&pass.module(), name, name), value, "{name}");
    }
}

#[test]
fn constants_have_one_value_in_both_languages() {
    let whole = |value: u32| f64::from(value);
    let cases = [
        ("gpu::types::FLAG_DOPPLER", whole(flags::DOPPLER)),
        ("gpu::types::FLAG_BEAMING", whole(flags::BEAMING)),
        ("gpu::types::FLAG_INSIDE", whole(flags::INSIDE)),
        ("gpu::types::FLAG_HOLD_EXPOSURE", whole(flags::HOLD_EXPOSURE)),
        ("gpu::types::FLAG_MIDPOINT", whole(flags::MIDPOINT)),
        ("gpu::types::INSTANCE_TWO_SIDED", whole(placed::TWO_SIDED)),
        ("gpu::types::INSTANCE_STATIC", whole(placed::STATIC)),
        ("gpu::types::INSTANCE_THIN", whole(placed::THIN)),
        ("gpu::types::INSTANCE_MINUS", whole(placed::MINUS)),
        ("gpu::types::INSTANCE_NARROW_RING", whole(placed::NARROW_RING)),
        ("gpu::types::INSTANCE_OWN", whole(placed::OWN)),
        ("gpu::types::INSTANCE_STRAYS", whole(placed::STRAYS)),
        ("gpu::types::STAR_ORDERS", whole(STAR_ORDERS)),
        ("instances::instance::INSTANCE_TEXELS", size_of::<Instance>() as f64 / 16.0),
        ("gpu::bindings::TABLE_ROW", TABLE_ROW as f64),
        ("gpu::types::SIDE_OPEN", whole(outside::OPEN)),
        ("gpu::types::SIDE_ALONG", whole(outside::ALONG)),
        ("gpu::types::SIDE_AGAINST", whole(outside::AGAINST)),
        ("gpu::types::SIDE_LONE", whole(outside::LONE)),
        ("geometry::bindings::ALONE", whole(ALONE)),
        ("post_process::tiles::TILE", whole(TILE)),
        ("gpu::colour::BLACKBODY_COLDEST", f64::from(BLACKBODY_COLDEST)),
        ("gpu::colour::BLACKBODY_HOTTEST", f64::from(BLACKBODY_HOTTEST)),
        ("shading::shade::DISK_UNIT", DISK_UNIT),
        ("disk::arcs::place::THIN_SAMPLES", THIN_SAMPLES as f64),
        ("disk::arcs::place::THIN_AZIMUTHS", AZIMUTHS as f64),
        ("aurora::streaks::AURORA_LINEAR", whole(LINEAR)),
        ("aurora::streaks::AURORA_BOTH_POLES", whole(BOTH_POLES)),
        ("aurora::levels::lit_tiles::PYRAMID", whole(PYRAMID)),
        ("aurora::levels::lit_tiles::LIT_TILE_COLUMNS", whole(LIT_TILES[0])),
        ("aurora::levels::lit_tiles::LIT_TILE_ROWS", whole(LIT_TILES[1])),
        ("aurora::streaks::RED_EVERY", whole(RED_EVERY)),
        ("aurora::streaks::SMOOTH", f64::from(SMOOTH as f32)),
        ("models::hiding::NODES", whole(NODES)),
        ("aurora::stroke::CORNERS", whole(CORNERS)),
        ("aurora::levels::lit_corners::SHIFTS", SHIFTS as f64),
    ];
    for (path, value) in cases {
        assert_eq!(constant(path), value, "{path}");
    }
}
