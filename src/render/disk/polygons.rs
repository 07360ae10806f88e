//! The disk of polygons: triangles through the stages of geometry, like any other model. As rings that turn with the gas they are those of
//! Yamashita 2025; at rest they are fixed in place and gas flows through them, as with arcs.

use crate::spacetime::Observer;
use std::f64::consts::TAU;

use glam::DVec3;
use wgpu::{BufferUsages, ShaderStages};

use crate::lensing::methods::Method;
use crate::render::Gpu;
use crate::render::frame::FrameInput;
use crate::render::geometry::Geometry;
use crate::render::geometry::lists::BodyLists;
use crate::render::gpu::layout::{Growing, HDR_FORMAT, Raster, Slot, bind, layout, module, raster};
use crate::render::gpu::library::Worldlines;
use crate::render::gpu::shaders::Pass;
use crate::render::gpu::types::placed::{STATIC, TWO_SIDED};
use crate::render::gpu::types::{ARGUMENTS_OPAQUE, Instance};
use crate::render::instances::{Placed, place_by_axis};
use crate::render::models::{ModelRange, ModelSet, Models};
use crate::scene::disk::polygons::{Ring, model, rings};

use crate::render::disk::drawn::DrawnDisk;
use crate::render::disk::types::Turning;

/// Two-sided triangles, with the frequency ratio of static observers; the gas's own motion comes in with its colour.
const STATIC_TWO_SIDED: u32 = STATIC | TWO_SIDED;

/// Stages of geometry of their own, and the draw.
#[derive(Debug)]
pub struct PolygonPass {
    geometry: Geometry,
    models: Models,
    parts: Vec<Part>,
    /// The radii between which there are triangles, in r_s.
    extent: [f64; 2],
    seen_layout: wgpu::BindGroupLayout,
    draw: wgpu::RenderPipeline,
    radial: wgpu::Buffer,
    turning: Growing,
    group: Option<wgpu::BindGroup>,
}

/// One instance: a ring, or everything at rest.
#[derive(Debug)]
struct Part {
    range: ModelRange,
    /// dφ/dT in c/r_s; None at rest.
    rate: Option<f64>,
    rims: [Option<f64>; 2],
}

/// How far from the axis of hole and camera the triangles are kept behind the hole, in pixels: much more than the rounding of f32, and
/// invisible.
const OFF_AXIS: f64 = 0.12;

/// The height over the plane z = 0 at which the triangles are drawn, in r_s: 0 unless the camera is nearly in that plane. From behind the
/// hole light comes round it on all sides; of a disk seen edge on that is all of the image. But if the axis lies in the triangles, there is
/// no point at which they could be opened. So they are kept beside the axis, on the side of the camera.
fn beside_the_axis(camera: &Observer, width: u32, extent: [f64; 2]) -> f64 {
    let (l, z) = (camera.radius(), camera.position.z);
    let pixel = 2.0 * (0.5 * camera.field_of_view).tan() / f64::from(width.max(1));
    let missing = extent.map(|r| OFF_AXIS * pixel * (l + r) - z.abs() * r / l);
    let height = missing[0].max(missing[1]).max(0.0);
    if z < 0.0 { -height } else { height }
}

impl PolygonPass {
    /// Compiles the stages and uploads the triangles of `disk`, which turn with the gas or rest.
    pub fn new(
        gpu: &Gpu,
        frame_layout: &wgpu::BindGroupLayout,
        gas_layout: &wgpu::BindGroupLayout,
        radial: wgpu::Buffer,
        disk: &DrawnDisk,
        turn: bool,
    ) -> PolygonPass {
        let device = &gpu.device;
        let seen_layout = layout(device, "polygons", ShaderStages::VERTEX, &[Slot::Read, Slot::Read, Slot::Read]);
        let shader = module(device, "polygons", Pass::DiskPolygons);
        let stage = Raster { vertex: "vertex", fragment: "fragment", targets: &[(HDR_FORMAT, None)], depth: Some(true) };
        let draw = raster(device, "polygons", &shader, stage, &[Some(frame_layout), Some(&seen_layout), Some(gas_layout)]);
        let mut set = ModelSet::default();
        let (parts, worldlines) = if turn {
            let mut part = |ring: Ring| Part { range: set.add(&ring.model), rate: Some(ring.rate), rims: ring.rims };
            (rings(&disk.config, &disk.gas.radial).into_iter().map(&mut part).collect(), Worldlines::Rings)
        } else {
            let range = set.add(&model(&disk.config, &disk.gas.radial));
            (vec![Part { range, rate: None, rims: [None; 2] }], Worldlines::Bodies)
        };
        let mut models = Models::new(device);
        models.upload(gpu, set);
        PolygonPass {
            geometry: Geometry::new(device, frame_layout, worldlines),
            models,
            parts,
            extent: disk.gas.extent(),
            seen_layout,
            draw,
            radial,
            turning: Growing::new(device, "polygons turning", BufferUsages::STORAGE),
            group: None,
        }
    }

    /// Compiles the stages for another method of projection.
    pub fn set_method(&mut self, method: Method, inside: bool) {
        self.geometry.set_method(method, inside);
    }

    /// Uploads what the frame needs, for a picture `width` pixels wide.
    pub fn prepare(&mut self, gpu: &Gpu, input: &FrameInput, width: u32) {
        let bends = input.settings.method.bends;
        let height = if bends { beside_the_axis(&input.camera, width, self.extent) } else { 0.0 };
        let p = height * DVec3::Z - input.camera.position;
        // T − T₀: about the time that light takes from the hole's surroundings.
        let elapsed = input.camera.radius();
        let mut unplaced = Instance {
            offset: p.as_vec3().to_array(),
            delay: elapsed as f32,
            position: [0.0, 0.0, height as f32],
            gamma: 1.0,
            shape_x: [1.0, 0.0, 0.0],
            shape_y: [0.0, 1.0, 0.0],
            shape_z: [0.0, 0.0, 1.0],
            turn_x: [1.0, 0.0, 0.0],
            turn_y: [0.0, 1.0, 0.0],
            turn_z: [0.0, 0.0, 1.0],
            flags: STATIC_TWO_SIDED,
            ..Instance::default()
        };
        place_by_axis(&mut unplaced, &input.camera, height * DVec3::Z, self.extent[1] + elapsed, false);
        let mut placed = Vec::new();
        let mut turning = Vec::new();
        for order in 1..=input.settings.orders.min(input.settings.method.orders).min(3) {
            for part in &self.parts {
                let azimuth = part.rate.map_or(0.0, |rate| (rate * (input.time - elapsed)).rem_euclid(TAU));
                let [inner, outer] = part.rims.map(|rim| rim.map_or(-1.0, |radius| radius as f32));
                let rate = part.rate.unwrap_or_default();
                // Light may cross a ring in several orders, so each order has its own id for coverage (`coverage_sign`).
                let scale = if part.rate.is_some() { 1.0 } else { 0.0 };
                let instance = Instance { scale, order, object: order, ..unplaced };
                // `Ring` of shaders/instances/ring.wgsl.
                let ring = [inner, outer, rate as f32, azimuth as f32];
                let (model, nodes) = (part.range, vec![[ring, [0.0; 4], [0.0; 4]]]);
                placed.push(Placed { model, coarse: model, width: f64::INFINITY, instance, nodes, calmed: false });
                turning.push(Turning { rate: (rate / TAU) as f32, azimuth: (azimuth / TAU) as f32 });
            }
        }
        let most = gpu.device.limits().max_storage_buffer_binding_size;
        self.geometry.prepare(gpu, &mut BodyLists::new(&placed, None, input.settings.vertex_budget, most), None);
        self.turning.write(gpu, &turning);
    }

    /// Makes the bind groups of a prepared frame.
    pub fn bind(&mut self, device: &wgpu::Device) {
        self.geometry.bind(device, &self.models);
        self.group = Some(bind(
            device,
            "polygons",
            &self.seen_layout,
            &[self.geometry.seen().as_entire_binding(), self.radial.as_entire_binding(), self.turning.buffer.as_entire_binding()],
        ));
    }

    /// Vertices, edges and triangles.
    pub fn compute(&self, pass: &mut wgpu::ComputePass) {
        self.geometry.vertices(pass);
        self.geometry.edges(pass);
        self.geometry.triangles(pass);
    }

    /// Splitting and the mesh stage.
    pub fn compute_rest(&self, pass: &mut wgpu::ComputePass) {
        self.geometry.refine(pass);
        self.geometry.mesh(pass);
    }

    /// The draw.
    pub fn draw(&self, pass: &mut wgpu::RenderPass) {
        let Some(group) = &self.group else { return };
        pass.set_pipeline(&self.draw);
        pass.set_bind_group(1, group, &[]);
        pass.set_index_buffer(self.geometry.indices().slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed_indirect(self.geometry.arguments(), ARGUMENTS_OPAQUE);
    }

    /// Seen vertices, those of the models first: for each order ring by ring.
    pub fn seen(&self) -> &wgpu::Buffer {
        self.geometry.seen()
    }
}
