//! Other drivers: each shipped pipeline is translated for Vulkan, Metal and DirectX 12, and asks for no more than WebGPU guarantees.

use lensrunner::lensing::methods::{METHODS, Method};
use lensrunner::render::gpu::library::Worldlines;
use lensrunner::render::gpu::shaders::Pass;
use naga::back::{hlsl, msl, spv};
use naga::valid::{Capabilities, GlobalUse, ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, ImageClass, Module, StorageAccess, StorageFormat, TypeInner};

/// Each pass as it is shipped, and the stages of geometry in all their variants.
fn shipped() -> Vec<(String, Module)> {
    let mut modules: Vec<_> = Pass::ALL.map(|pass| (format!("{pass:?}"), pass.module())).into();
    let stages = [Pass::Place, Pass::Vertices, Pass::Edges, Pass::Triangles, Pass::Refine, Pass::Arguments, Pass::Mesh];
    for pass in stages {
        let outside = pass.module_by(Method::default(), false);
        modules.push((format!("{pass:?} outside of the horizon"), outside));
        modules.push((format!("{pass:?} of rings"), pass.module_along(Worldlines::Rings, Method::default(), true)));
    }
    for method in METHODS {
        modules.push((format!("vertices by {method:?}"), Pass::Vertices.module_by(method, true)));
        modules.push((format!("place by {method:?}"), Pass::Place.module_by(method, true)));
    }
    modules
}

/// What a stage binds, in the terms of WebGPU's limits: storage buffers, uniform buffers, textures, samplers, textures that are written.
fn bound(module: &Module, info: &ModuleInfo, entry: usize) -> [u32; 5] {
    let mut counts = [0; 5];
    for (handle, global) in module.global_variables.iter() {
        if info.get_entry_point(entry)[handle] == GlobalUse::empty() {
            continue;
        }
        let kind = match (global.space, &module.types[global.ty].inner) {
            (AddressSpace::Storage { .. }, _) => 0,
            (AddressSpace::Uniform, _) => 1,
            (_, TypeInner::Image { class: ImageClass::Storage { format, access }, .. }) => {
                let may_be_written =
                    matches!(format, StorageFormat::Rgba32Uint | StorageFormat::Rg32Uint) && *access == StorageAccess::STORE;
                assert!(may_be_written, "{format:?} is not known to be allowed");
                4
            }
            (_, TypeInner::Image { .. }) => 2,
            (_, TypeInner::Sampler { .. }) => 3,
            _ => continue,
        };
        counts[kind] += 1;
    }
    counts
}

/// Bytes of workgroup memory.
fn shared(module: &Module, info: &ModuleInfo, entry: usize) -> u32 {
    let is_shared = |global: &naga::GlobalVariable| global.space == AddressSpace::WorkGroup;
    let used = module
        .global_variables
        .iter()
        .filter(|(handle, global)| is_shared(global) && info.get_entry_point(entry)[*handle] != GlobalUse::empty());
    used.map(|(_, global)| module.types[global.ty].inner.size(module.to_ctx())).sum()
}

fn check_limits(name: &str, module: &Module, info: &ModuleInfo) {
    let limits = wgpu::Limits::default();
    let most = [
        limits.max_storage_buffers_per_shader_stage,
        limits.max_uniform_buffers_per_shader_stage,
        limits.max_sampled_textures_per_shader_stage,
        limits.max_samplers_per_shader_stage,
        limits.max_storage_textures_per_shader_stage,
    ];
    for (k, entry) in module.entry_points.iter().enumerate() {
        let bound = bound(module, info, k);
        assert!(bound.iter().zip(most).all(|(count, most)| *count <= most), "{name}, {}: binds {bound:?}, allowed {most:?}", entry.name);
        let lanes: u32 = entry.workgroup_size.iter().product();
        assert!(lanes <= limits.max_compute_invocations_per_workgroup, "{name}, {}: {lanes} threads a group", entry.name);
        let shared = shared(module, info, k);
        assert!(shared <= limits.max_compute_workgroup_storage_size, "{name}, {}: {shared} bytes of a group", entry.name);
    }
}

#[test]
fn every_pipeline_is_within_webgpus_limits_and_translates() {
    for (name, module) in shipped() {
        // Nothing that WebGPU lacks: pairs of halves packed in words are part of it.
        let info = Validator::new(ValidationFlags::all(), Capabilities::SHADER_FLOAT16_IN_FLOAT32).validate(&module);
        let info = info.unwrap_or_else(|error| panic!("{name}: {error:?}"));
        check_limits(&name, &module, &info);

        let words = spv::write_vec(&module, &info, &spv::Options::default(), None);
        assert!(words.unwrap_or_else(|error| panic!("{name}, SPIR-V: {error}")).len() > 100, "{name}");

        // Metal 2.4 is what wgpu asks for on macOS 12.
        let options = msl::Options { lang_version: (2, 4), ..msl::Options::default() };
        let (text, translated) = msl::write_string(&module, &info, &options, &msl::PipelineOptions::default())
            .unwrap_or_else(|error| panic!("{name}, Metal: {error}"));
        assert!(text.contains("#include <metal_stdlib>"), "{name}");
        for entry in translated.entry_point_names {
            assert!(entry.is_ok(), "{name}, Metal: {entry:?}");
        }

        let mut text = String::new();
        let options = hlsl::Options { shader_model: hlsl::ShaderModel::V6_0, ..hlsl::Options::default() };
        let pipeline = hlsl::PipelineOptions::default();
        let translated = hlsl::Writer::new(&mut text, &options, &pipeline).write(&module, &info, None);
        for entry in translated.unwrap_or_else(|error| panic!("{name}, DirectX 12: {error}")).entry_point_names {
            assert!(entry.is_ok(), "{name}, DirectX 12: {entry:?}");
        }
        assert!(!text.is_empty(), "{name}");
    }
}

/// The check itself sees what is too much.
#[test]
fn a_ninth_storage_buffer_is_refused() {
    let buffers: String = (0..9).map(|k| format!("@group(0) @binding({k}) var<storage, read_write> b{k}: array<f32>;\n")).collect();
    let sum: String = (1..9).map(|k| format!("b0[0] += b{k}[0];\n")).collect();
    let module = naga::front::wgsl::parse_str(&format!("{buffers} @compute @workgroup_size(64) fn main() {{ {sum} }}")).unwrap();
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).unwrap();
    assert_eq!(bound(&module, &info, 0), [9, 0, 0, 0, 0]);
    assert!(std::panic::catch_unwind(|| check_limits("nine", &module, &info)).is_err());
}
