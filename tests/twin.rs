//! Runs a function of a shipped shader beside its Rust twin.

use lensrunner::render::gpu::shaders::Pass;
use lensrunner::render::gpu::{layout, readback};

use crate::gpu::GPU;

/// Runs `body` behind the shipped file of `pass`: one thread per row of `input`. In `body`, `row` is that row and `twin_out` takes
/// `outputs` rows from each thread; lines of `#import` come first, for names that the file itself does not import. `tables`: the lens slice
/// and the sky slice; of an empty one the shader must not speak, of another it must.
pub fn run(pass: Pass, body: &str, tables: [&[[f32; 4]]; 2], input: &[[f32; 4]], outputs: usize) -> Vec<[f32; 4]> {
    run_with(pass, body, tables, &[], input, outputs)
}

/// The same where the shader reads buffers of the pass's own group, by their bindings: those and no others.
pub fn run_with(
    pass: Pass,
    body: &str,
    tables: [&[[f32; 4]]; 2],
    own: &[(u32, &wgpu::Buffer)],
    input: &[[f32; 4]],
    outputs: usize,
) -> Vec<[f32; 4]> {
    let (imports, body): (Vec<&str>, Vec<&str>) = body.lines().partition(|line| line.starts_with("#import "));
    let [imports, body] = [imports, body].map(|lines| lines.join("\n"));
    let module = layout::module_of(
        &GPU.device,
        "twin",
        pass.module_with(&format!(
            "
{imports}
@group(3) @binding(0) var<storage, read> twin_rows: array<vec4<f32>>;
@group(3) @binding(1) var<storage, read_write> twin_out: array<vec4<f32>>;
@compute @workgroup_size(64)
fn twin(@builtin(global_invocation_id) id: vec3<u32>) {{
    if id.x >= arrayLength(&twin_rows) {{ return; }}
    let row = twin_rows[id.x];
    {body}
}}
"
        )),
    );
    let device = &GPU.device;
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("twin"),
        layout: None,
        module: &module,
        entry_point: Some("twin"),
        compilation_options: Default::default(),
        cache: None,
    });
    // As in shaders/gpu/bindings.wgsl.
    let textures: Vec<_> = [(1, "lens slice", tables[0]), (2, "sky slice", tables[1])]
        .into_iter()
        .filter(|(_, _, table)| !table.is_empty())
        .map(|(binding, label, table)| (binding, layout::TableTexture::of(&GPU, label, table)))
        .collect();
    let entries: Vec<_> =
        textures.iter().map(|(binding, texture)| wgpu::BindGroupEntry { binding: *binding, resource: texture.binding() }).collect();
    let group_0 = (!entries.is_empty()).then(|| {
        let layout = pipeline.get_bind_group_layout(0);
        device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries })
    });
    let group_1 = (!own.is_empty()).then(|| {
        let entries: Vec<_> =
            own.iter().map(|&(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() }).collect();
        let layout = pipeline.get_bind_group_layout(1);
        device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries })
    });
    let rows = layout::storage(&GPU, "rows", input);
    let out = layout::buffer(device, "out", 16 * (input.len() * outputs) as u64, wgpu::BufferUsages::STORAGE);
    let group_3 = layout::bind(device, "rows", &pipeline.get_bind_group_layout(3), &[rows.as_entire_binding(), out.as_entire_binding()]);
    let mut encoder = device.create_command_encoder(&Default::default());
    {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        if let Some(group) = &group_0 {
            pass.set_bind_group(0, group, &[]);
        }
        if let Some(group) = &group_1 {
            pass.set_bind_group(1, group, &[]);
        }
        pass.set_bind_group(3, &group_3, &[]);
        pass.dispatch_workgroups(input.len().div_ceil(64) as u32, 1, 1);
    }
    GPU.queue.submit([encoder.finish()]);
    let bytes = readback::buffer(&GPU, &out).unwrap();
    bytemuck::cast_slice::<u8, [f32; 4]>(&bytes)[..input.len() * outputs].to_vec()
}
