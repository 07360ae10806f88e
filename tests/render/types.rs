//! What crosses from Rust to the shaders has one layout in both languages: each struct and constant, as the shipped WGSL has it.

use std::mem::{offset_of, size_of};

use lensrunner::render::aurora::ground::GroundLight;
use lensrunner::render::aurora::rooms::CORNERS;
use lensrunner::render::aurora::{AuroraSettings, BOTH_POLES, Colours, LINEAR, PYRAMID, SHIFTS, Segment};
use lensrunner::render::disk::circles::AZIMUTHS;
use lensrunner::render::disk::types::{self as disk, Circle, DiskCounters, DiskFrame, DiskVertex};
use lensrunner::render::disk::view::THIN_SAMPLES;
use lensrunner::render::frame::{BLACKBODY_COLDEST, BLACKBODY_HOTTEST};
use lensrunner::render::gpu::layout::TABLE_ROW;
use lensrunner::render::gpu::shaders::Pass;
use lensrunner::render::gpu::types::{
    self, CellDraws, Chunk, Counters, Frame, Instance, Material, ModelTriangle, ModelVertex, SeenVertex, Star,
};
use lensrunner::render::gpu::types::{flags, placed};
use lensrunner::render::models::ALONE;
use lensrunner::render::models::outside;
use naga::{ArraySize, Literal, Module, Scalar, ScalarKind, StructMember, TypeInner};

fn module(pass: Pass) -> Module {
    parsed(&pass.source())
}

fn parsed(source: &str) -> Module {
    naga::front::wgsl::parse_str(source).unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)))
}

/// A field as both languages can tell it: name, offset and size in bytes, whether it holds floats (of 4 bytes, as all that crosses).
type Field = (String, u32, u32, bool);

/// The members of a struct of the shader, and its size in bytes.
fn struct_of<'a>(module: &'a Module, name: &str) -> (&'a [StructMember], u32) {
    let found = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name));
    match found.map(|(_, ty)| &ty.inner) {
        Some(TypeInner::Struct { members, span }) => (members, *span),
        other => panic!("{name} is {other:?}"),
    }
}

/// The struct's fields and its size.
fn fields_of(module: &Module, name: &str) -> (Vec<Field>, u32) {
    let (members, span) = struct_of(module, name);
    let fields = members.iter().map(|member| {
        let inner = &module.types[member.ty].inner;
        (member.name.clone().unwrap_or_default(), member.offset, inner.size(module.to_ctx()), is_float(module, inner))
    });
    (fields.collect(), span)
}

fn is_float(module: &Module, inner: &TypeInner) -> bool {
    match inner {
        TypeInner::Scalar(Scalar { kind, width: 4 })
        | TypeInner::Atomic(Scalar { kind, width: 4 })
        | TypeInner::Vector { scalar: Scalar { kind, width: 4 }, .. }
        | TypeInner::Matrix { scalar: Scalar { kind, width: 4 }, .. } => *kind == ScalarKind::Float,
        TypeInner::Array { base, size: ArraySize::Constant(_), .. } => is_float(module, &module.types[*base].inner),
        other => panic!("not of 4-byte numbers: {other:?}"),
    }
}

/// Whether a type of Rust is made of f32, else of u32.
trait Numbers {
    const FLOAT: bool;
}

impl Numbers for f32 {
    const FLOAT: bool = true;
}

impl Numbers for u32 {
    const FLOAT: bool = false;
}

impl<T: Numbers, const N: usize> Numbers for [T; N] {
    const FLOAT: bool = T::FLOAT;
}

fn sized<T, F: Numbers>(_: impl Fn(&T) -> &F) -> (u32, bool) {
    (size_of::<F>() as u32, F::FLOAT)
}

/// The fields of a Rust struct. Where WGSL has several in the place of one (the columns of a matrix) their names follow it.
macro_rules! fields {
    ($ty:ty: $($field:ident $([$($part:literal),+])?),+ $(,)?) => {{
        let mut fields: Vec<Field> = Vec::new();
        $(
            let (size, float) = sized(|value: &$ty| &value.$field);
            let names: Vec<String> = vec![$($($part.to_owned()),+)?];
            let names = if names.is_empty() { vec![stringify!($field).to_owned()] } else { names };
            let each = size / names.len() as u32;
            let start = offset_of!($ty, $field) as u32;
            fields.extend(names.into_iter().enumerate().map(|(k, name)| (name, start + k as u32 * each, each, float)));
        )+
        (fields, size_of::<$ty>() as u32)
    }};
}

#[test]
fn structs_have_one_layout_in_both_languages() {
    let [mesh, draw, stars, cells, arcs, streaks, resolve, triangles] = [
        Pass::Mesh,
        Pass::Draw,
        Pass::StarsProject,
        Pass::SkyCells,
        Pass::DiskVertices,
        Pass::AuroraWalk,
        Pass::AuroraResolve,
        Pass::Triangles,
    ]
    .map(module);
    let cases = [
        (
            &mesh,
            "Frame",
            fields!(Frame: camera_from_rain, rain_from_camera, radial, side_a, side_b, projection, size, light, exposure, switches,
            sky_x, sky_y, sky_z, capacity, fill, unmetered, disk),
        ),
        (
            &mesh,
            "Instance",
            fields!(Instance: offset, axis, position, velocity, momentum, shape ["shape_x", "shape_y", "shape_z"], spin, spin_rate,
            jolt, force, turn ["turn_x", "turn_y", "turn_z"], snap, light ["light_red", "light_green", "light_blue"],
            bounds ["bound_high", "bound_low", "bound_look"], ids, vertices, triangles),
        ),
        (&mesh, "ModelVertex", fields!(ModelVertex: position, normal, info)),
        (&mesh, "ModelTriangle", fields!(ModelTriangle: vertices, edges)),
        (&mesh, "Chunk", fields!(Chunk: instance, first)),
        (&mesh, "SeenVertex", fields!(SeenVertex: apparent, normal, leaving, surface, fan)),
        (
            &triangles,
            "Counters",
            fields!(Counters: vertices, indices, work, thin, pieces, turn, coarse, cut, caught, model_vertices, lost, outside),
        ),
        (&draw, "Material", fields!(Material: base, emissive, surface)),
        (&draw, "GroundLight", fields!(GroundLight: dipole ["dipole_x", "dipole_y", "dipole_z"], colour, map, planet)),
        (&stars, "Star", fields!(Star: direction, colour)),
        (
            &cells,
            "CellDraws",
            fields!(CellDraws: smooth ["smooth_indices", "smooth_instances", "smooth_first", "smooth_base", "smooth_instance"], exact ["exact_indices", "exact_instances", "exact_first", "exact_base", "exact_instance"], columns, rows, side, unused),
        ),
        (&arcs, "DiskFrame", fields!(DiskFrame: towards, sideways, upwards, renewal, gas, sizes, regions, room, light, offset)),
        (&arcs, "Circle", fields!(Circle: gas, motion, place, rows)),
        (&arcs, "DiskVertex", fields!(DiskVertex: apparent, gas, more, bend)),
        (&arcs, "Counters", fields!(DiskCounters: vertices, indices, arcs, coarse, caught, stage)),
        (&streaks, "AuroraSettings", fields!(AuroraSettings: counts, history, clock, strokes, heights)),
        (&streaks, "Segment", fields!(Segment: range, light)),
        (&resolve, "Lines", fields!(Colours: lines ["colours"], steps, tile)),
    ];
    for (module, name, rust) in cases {
        assert_eq!(fields_of(module, name), rust, "{name}");
    }
}

#[test]
fn structs_that_only_shaders_know_have_the_sizes_that_rust_reserves() {
    let [mesh, arguments, cells, disk_arguments, sprites] =
        [Pass::Mesh, Pass::Arguments, Pass::SkyCells, Pass::DiskArguments, Pass::DiskSprites].map(module);
    let cases = [
        (&mesh, "Piece", types::PIECE_BYTES),
        (&mesh, "WorkItem", types::WORK_BYTES),
        (&mesh, "ThinVertex", types::THIN_BYTES),
        (&arguments, "Arguments", types::ARGUMENTS_BYTES),
        (&cells, "SkyCorner", types::SKY_CORNER_BYTES),
        (&disk_arguments, "DiskArguments", disk::ARGUMENTS_BYTES),
        (&sprites, "SeenSprite", disk::SEEN_SPRITE_BYTES),
    ];
    for (module, name, bytes) in cases {
        assert_eq!(u64::from(struct_of(module, name).1), bytes, "{name}");
    }
}

/// The value of a constant of the shader, as f64.
fn constant(module: &Module, name: &str) -> f64 {
    let found = module.constants.iter().find(|(_, constant)| constant.name.as_deref() == Some(name));
    let (_, constant) = found.unwrap_or_else(|| panic!("no constant {name}"));
    match module.global_expressions[constant.init] {
        naga::Expression::Literal(Literal::U32(value)) => f64::from(value),
        naga::Expression::Literal(Literal::I32(value)) => f64::from(value),
        naga::Expression::Literal(Literal::F32(value)) => f64::from(value),
        ref other => panic!("{name} is {other:?}"),
    }
}

#[test]
fn constants_have_one_value_in_both_languages() {
    let [triangles, draw, arcs, streaks, resolve, stroke] =
        [Pass::Triangles, Pass::Draw, Pass::DiskVertices, Pass::AuroraWalk, Pass::AuroraResolve, Pass::AuroraDraw].map(module);
    let whole = |value: u32| f64::from(value);
    let cases = [
        (&draw, "FLAG_DOPPLER", whole(flags::DOPPLER)),
        (&draw, "FLAG_BEAMING", whole(flags::BEAMING)),
        (&draw, "FLAG_INSIDE", whole(flags::INSIDE)),
        (&draw, "FLAG_HOLD_EXPOSURE", whole(flags::HOLD_EXPOSURE)),
        (&triangles, "INSTANCE_TWO_SIDED", whole(placed::TWO_SIDED)),
        (&triangles, "INSTANCE_HELD", whole(placed::HELD)),
        (&triangles, "INSTANCE_THIN", whole(placed::THIN)),
        (&triangles, "INSTANCE_MINUS", whole(placed::MINUS)),
        (&triangles, "INSTANCE_NARROW", whole(placed::NARROW)),
        (&triangles, "INSTANCE_OWN", whole(placed::OWN)),
        (&triangles, "INSTANCE_TEXELS", size_of::<Instance>() as f64 / 16.0),
        (&triangles, "TABLE_ROW", TABLE_ROW as f64),
        (&triangles, "SIDE_OPEN", whole(outside::OPEN)),
        (&triangles, "SIDE_ALONG", whole(outside::ALONG)),
        (&triangles, "SIDE_AGAINST", whole(outside::AGAINST)),
        (&triangles, "SIDE_LONE", whole(outside::LONE)),
        (&triangles, "ALONE", whole(ALONE)),
        (&draw, "BLACKBODY_COLDEST", f64::from(BLACKBODY_COLDEST)),
        (&draw, "BLACKBODY_HOTTEST", f64::from(BLACKBODY_HOTTEST)),
        (&arcs, "THIN_SAMPLES", THIN_SAMPLES as f64),
        (&arcs, "THIN_AZIMUTHS", AZIMUTHS as f64),
        (&streaks, "AURORA_LINEAR", whole(LINEAR)),
        (&streaks, "AURORA_BOTH_POLES", whole(BOTH_POLES)),
        (&streaks, "PYRAMID", whole(PYRAMID)),
        (&stroke, "CORNERS", whole(CORNERS)),
        (&resolve, "SHIFTS", SHIFTS as f64),
    ];
    for (module, name, value) in cases {
        assert_eq!(constant(module, name), value, "{name}");
    }
}
