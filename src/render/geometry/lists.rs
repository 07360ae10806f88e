//! The lists that tell the stages what there is: the objects of a frame and the chunks of their models. Plain data of the processor.

use crate::render::gpu::types::placed::THIN;
use crate::render::gpu::types::{Capacity, Chunk, Counters, Instance, SeenVertex};
use crate::render::instances::Placed;
use crate::render::instances::local_motion::MotionNode;
use crate::render::models::ModelRange;

/// Threads of a workgroup; `@workgroup_size` of the stages.
const LANES: u32 = 64;
/// Groups along the first dimension of a dispatch (65,535 is the limit).
const GROUPS: u32 = 32_768;

/// What the stages are told of the objects of a frame.
#[derive(Clone, Debug, Default)]
pub struct BodyLists {
    /// The table of instances: the instances, then their nodes.
    pub(super) texels: Vec<[f32; 4]>,
    /// Of vertices, edges, triangles.
    pub(super) chunks: [Vec<Chunk>; 3],
    /// Groups to dispatch over them.
    pub(super) dispatch: [[u32; 2]; 3],
    /// Vertices and edges of all models.
    pub(super) states: u32,
    /// Where the counters begin.
    pub(super) counters: Counters,
    /// Whether any image is thin, by how often its light crosses the disk's plane.
    pub(super) thin_across: [bool; 4],
    /// Room in the buffers, as given to the shaders.
    pub capacity: Capacity,
}

impl BodyLists {
    /// Of what is `placed`, with room for `budget` vertices of the mesh stage; no buffer may be larger than `most` bytes. Where models do not
    /// fit, the smallest images are drawn by their coarsest stand-ins, and where those do not, they are left out; both are counted.
    pub fn new(placed: &[Placed], budget: u32, most: u64) -> BodyLists {
        let fitted = Fitted::new(placed, (MODELS * most as f64 / size_of::<SeenVertex>() as f64) as u64);
        let mut instances: Vec<Instance> = Vec::with_capacity(placed.len());
        let mut chunks: [Vec<Chunk>; 3] = Default::default();
        let drawn = || {
            let finite = placed.iter().enumerate().filter(|(_, item)| item.instance.is_finite());
            finite.filter_map(|(number, item)| Some((item, fitted.model(number, item)?)))
        };
        // States of edges lie behind those of vertices.
        let all_vertices: u32 = drawn().map(|(_, model)| model.vertices[1]).sum();
        // What is not finite is left out here; counted with what the shaders leave out.
        let refused = placed.iter().filter(|item| !item.instance.is_finite()).count() as u32;
        let calmed = placed.iter().filter(|item| item.calmed).count() as u32;
        let (mut vertices, mut edges, mut triangles) = (0, 0, 0);
        for (item, model) in drawn() {
            let mut instance = item.instance;
            (instance.first_seen, instance.first_state) = (vertices, all_vertices + edges);
            [instance.first_vertex, instance.vertex_count] = model.vertices;
            [instance.first_edge, instance.edge_count] = model.edges;
            [instance.first_triangle, instance.triangle_count] = model.triangles;
            instance.first_material = model.material;
            let number = instances.len() as u32;
            for (list, count) in chunks.iter_mut().zip([model.vertices[1], model.edges[1], model.triangles[1]]) {
                list.extend((0..count.div_ceil(LANES)).map(|chunk| Chunk { instance: number, first: chunk * LANES }));
            }
            vertices += model.vertices[1];
            edges += model.edges[1];
            triangles += model.triangles[1];
            instances.push(instance);
        }
        let mut thin_across = [false; 4];
        for instance in instances.iter().filter(|instance| instance.flags & THIN != 0) {
            let (order, crossings) = (instance.order as usize, instance.crossings);
            let range = if crossings < 0.0 { order - 1..=order } else { crossings as usize..=crossings as usize };
            thin_across[range].fill(true);
        }
        let dispatch = [0, 1, 2].map(|kind: usize| {
            let count = chunks[kind].len() as u32;
            [count.min(GROUPS), count.div_ceil(GROUPS)]
        });
        for (list, groups) in chunks.iter_mut().zip(dispatch) {
            // Two are a texel.
            list.resize((groups[0] * groups[1]).next_multiple_of(2) as usize, Chunk { instance: u32::MAX, first: 0 });
        }
        BodyLists {
            texels: instance_table(&mut instances, drawn().map(|(item, _)| &item.nodes[..])),
            chunks,
            dispatch,
            states: vertices + edges,
            // Out vertices are appended behind those of the models; the first pass of splitting reads queue 0.
            counters: Counters {
                vertices,
                model_vertices: vertices,
                turn: 1,
                caught: refused,
                calmed,
                reduced: fitted.reduced,
                left_out: fitted.left_out,
                ..Counters::default()
            },
            thin_across,
            capacity: capacity_for(budget, vertices, triangles, most),
        }
    }
}

/// The share of a buffer of seen vertices that models may take; the mesh stage has the rest.
const MODELS: f64 = 0.75;

/// Which model each image is drawn by, where all of them do not fit.
#[derive(Debug, Default)]
struct Fitted {
    /// By the image's number; empty where all fit.
    models: Vec<Option<ModelRange>>,
    /// Images that are drawn by their coarsest stand-in, and those that are left out.
    reduced: u32,
    left_out: u32,
}

impl Fitted {
    /// For models of at most `room` vertices together.
    fn new(placed: &[Placed], room: u64) -> Fitted {
        let mut vertices: u64 = placed.iter().map(|item| u64::from(item.model.vertices[1])).sum();
        if vertices <= room {
            return Fitted::default();
        }
        let mut fitted = Fitted { models: placed.iter().map(|item| Some(item.model)).collect(), ..Fitted::default() };
        let mut smallest_first: Vec<usize> = (0..placed.len()).collect();
        smallest_first.sort_by(|&a, &b| placed[a].width.total_cmp(&placed[b].width));
        for &number in &smallest_first {
            let Placed { model, coarse, .. } = &placed[number];
            if vertices > room && coarse.vertices[1] < model.vertices[1] {
                vertices -= u64::from(model.vertices[1] - coarse.vertices[1]);
                fitted.models[number] = Some(*coarse);
                fitted.reduced += 1;
            }
        }
        for number in smallest_first {
            if vertices > room {
                vertices -= fitted.models[number].take().map_or(0, |model| u64::from(model.vertices[1]));
                fitted.left_out += 1;
            }
        }
        fitted
    }

    /// What an image is drawn by; None if it is left out.
    fn model(&self, number: usize, item: &Placed) -> Option<ModelRange> {
        self.models.get(number).copied().unwrap_or(Some(item.model))
    }
}

/// Room beyond that of the models for `budget` vertices of the mesh stage. A vertex is in at most two triangles of three indices; blocks of
/// the mesh stage have about ten vertices. A fifth of the indices is enough for every triangle of the models. No buffer is larger than
/// `most` bytes, the device's limit, as long as the models fit.
fn capacity_for(budget: u32, vertices: u32, triangles: u32, most: u64) -> Capacity {
    let budget = budget.min(((most / size_of::<SeenVertex>() as u64) as u32).saturating_sub(vertices));
    let indices = (2 * u64::from(budget) + 5 * u64::from(triangles)).min(most / (3 * size_of::<u32>() as u64));
    Capacity { vertices: vertices + budget, indices: 3 * indices as u32, work: budget / 10, thin: 3 * (budget / 3) }
}

/// The texels of the table of instances: the instances, then the nodes of each, whose place is told to it.
fn instance_table<'a>(instances: &mut [Instance], nodes: impl Iterator<Item = &'a [MotionNode]>) -> Vec<[f32; 4]> {
    let mut first = size_of_val(instances) / size_of::<[f32; 4]>();
    let mut behind: Vec<[f32; 4]> = Vec::new();
    for (instance, nodes) in instances.iter_mut().zip(nodes) {
        instance.node_texel = first as u32;
        behind.extend(nodes.as_flattened());
        first += nodes.as_flattened().len();
    }
    [bytemuck::cast_slice(instances), &behind].concat()
}
