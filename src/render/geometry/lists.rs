//! The lists that tell the stages what there is: the objects of a frame and the chunks of their models. Plain data of the processor.

use crate::render::gpu::layout::{TABLE_ROW, TABLE_ROWS};
use crate::render::gpu::types::placed::THIN;
use crate::render::gpu::types::{CHUNK, Capacity, Chunk, Counters, HeldFrame, Instance, SeenVertex};
use crate::render::instances::Placed;
use crate::render::instances::held::HeldImages;
use crate::render::models::ModelRange;

/// Groups along the first dimension of a dispatch (65,535 is the limit).
const GROUPS: u32 = 32_768;

/// What the stages are told of the objects of a frame.
#[derive(Clone, Debug, Default)]
pub struct BodyLists {
    /// The table of instances: the instances, then their nodes.
    pub(super) texels: Vec<[f32; 4]>,
    /// Of vertices, edges, triangles.
    pub(super) chunks: [Vec<Chunk>; 3],
    fitted: Fitted,
    /// Groups to dispatch over them, if nothing is held.
    pub(super) dispatch: [[u32; 2]; 3],
    /// What is held, with the room that its images have.
    pub(super) held: Option<HeldFrame>,
    /// Chunks of it, at most.
    held_chunks: [u64; 3],
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
    /// Of what is `placed` and, behind it, what is `held`, with room for `budget` vertices of the mesh stage; no buffer may be larger than
    /// `most` bytes. Where models do not fit, the smallest images are drawn by their coarsest stand-ins; where those do not, they are
    /// left out. Both are counted.
    pub fn new(placed: &[Placed], held: Option<HeldImages>, budget: u32, most: u64) -> BodyLists {
        let mut lists = BodyLists::default();
        lists.make(placed, held, budget, most);
        lists
    }

    /// Becomes [`BodyLists::new`] of these, in the memory that it has.
    pub fn make(&mut self, placed: &[Placed], held: Option<HeldImages>, budget: u32, most: u64) {
        let BodyLists { texels, chunks, fitted, .. } = self;
        fitted.choose(placed, vertex_limit(budget, most));
        texels.clear();
        chunks.iter_mut().for_each(Vec::clear);
        let fitted = &*fitted;
        let drawn = || {
            let finite = placed.iter().enumerate().filter(|(_, item)| item.instance.is_finite());
            finite.filter_map(|(number, item)| Some((item, fitted.model(number, item)?)))
        };
        let most_held = held.map(|held| held.most).unwrap_or_default();
        // States of edges lie behind those of all vertices.
        let all_vertices: u32 = drawn().map(|(_, model)| model.vertices[1]).sum();
        let number_drawn = drawn().count();
        let vertices_end = end(all_vertices, most_held.vertices, vertex_limit(budget, most));
        // What is not finite is left out here; counted with what the shaders leave out.
        let refused = placed.iter().filter(|item| !item.instance.is_finite()).count() as u32;
        let calmed = placed.iter().filter(|item| item.calmed).count() as u32;
        let (mut vertices, mut edges, mut triangles) = (0, 0, 0);
        let mut thin_across = [false; 4];
        // The nodes of each lie behind all instances, and it is told where.
        let mut first_node = number_drawn * INSTANCE_TEXELS;
        for (number, (item, model)) in (0..).zip(drawn()) {
            let mut instance = item.instance;
            (instance.first_seen, instance.first_state) = (vertices, vertices_end + edges);
            [instance.first_vertex, instance.vertex_count] = model.vertices;
            [instance.first_edge, instance.edge_count] = model.edges;
            [instance.first_triangle, instance.triangle_count] = model.triangles;
            instance.first_material = model.material;
            for (list, count) in chunks.iter_mut().zip([model.vertices[1], model.edges[1], model.triangles[1]]) {
                list.extend((0..count.div_ceil(CHUNK)).map(|chunk| Chunk { instance: number, first: chunk * CHUNK }));
            }
            vertices += model.vertices[1];
            edges += model.edges[1];
            triangles += model.triangles[1];
            instance.node_texel = first_node as u32;
            first_node += item.nodes.as_flattened().len();
            texels.extend_from_slice(bytemuck::cast_slice(std::slice::from_ref(&instance)));
            if instance.flags & THIN != 0 {
                let (order, crossings) = (instance.order as usize, instance.crossings);
                let range = if crossings < 0.0 { order - 1..=order } else { crossings as usize..=crossings as usize };
                thin_across[range].fill(true);
            }
        }
        drawn().for_each(|(item, _)| texels.extend_from_slice(item.nodes.as_flattened()));
        let dispatch = [0, 1, 2].map(|kind: usize| {
            let count = chunks[kind].len() as u32;
            [count.min(GROUPS), count.div_ceil(GROUPS)]
        });
        if let Some(held) = held {
            // Instances begin at multiples of their size.
            texels.resize(texels.len().next_multiple_of(INSTANCE_TEXELS), [0.0; 4]);
            // Any of their images may be thin.
            if held.frame.has_thin == 1 || held.frame.flags & THIN != 0 {
                thin_across[..=held.frame.orders as usize].fill(true);
            }
        } else {
            for (list, groups) in chunks.iter_mut().zip(dispatch) {
                list.resize((groups[0] * groups[1]) as usize, Chunk { instance: u32::MAX, first: 0 });
            }
        }
        let images = (texels.len() / INSTANCE_TEXELS) as u32;
        let states = vertices_end + edges;
        let states_end = end(states, most_held.edges, most / STATE_BYTES);
        let images_end = end(images, most_held.number, (TABLE_TEXELS / INSTANCE_TEXELS) as u64);
        // Where there may not be room for all, an eighth is kept for what is drawn coarsely when the rest is full.
        let is_full = most_held.vertices > u64::from(vertices_end - vertices) || most_held.edges > u64::from(states_end - states);
        let [vertices_end, states_end] = [(vertices, vertices_end), (states, states_end)]
            .map(|(first, end): (u32, u32)| [if is_full { end - (end - first) / 8 } else { end }, end]);
        // Out vertices are appended behind those of the models; the first pass of splitting reads queue 0.
        self.counters = Counters {
            vertices,
            model_vertices: vertices,
            turn: 1,
            caught: refused,
            calmed,
            simpler: fitted.simpler,
            left_out: fitted.left_out,
            images,
            held_vertices: [vertices, vertices_end[0]],
            held_states: [states, states_end[0]],
            chunks: [0, 1, 2].map(|kind: usize| chunks[kind].len() as u32),
            ..Counters::default()
        };
        self.held = held.map(|held| HeldFrame { images_end, vertices_end, states_end, ..held.frame });
        (self.held_chunks, self.states) = (most_held.chunks, states_end[1]);
        (self.dispatch, self.thin_across) = (dispatch, thin_across);
        self.capacity = capacity_for(budget, vertices_end[1], end(triangles, most_held.triangles, most / INDEX_BYTES), most);
    }

    /// Texels of the tables of instances and of chunks, with the room of what is held and what fills up its dispatches.
    pub(super) fn texels_with_room(&self) -> [usize; 4] {
        let images = self.held.map_or(0, |held| held.images_end as usize);
        let chunks = |kind: usize| (self.chunks[kind].len() + self.held_chunks[kind] as usize).min(TABLE_TEXELS - FILLED) + FILLED;
        [images * INSTANCE_TEXELS, chunks(0), chunks(1), chunks(2)]
    }
}

/// Texels of an instance; `INSTANCE_TEXELS` of WGSL.
const INSTANCE_TEXELS: usize = size_of::<Instance>() / size_of::<[f32; 4]>();
/// Texels of the largest table.
const TABLE_TEXELS: usize = TABLE_ROW * TABLE_ROWS;
/// Chunks that fill up a dispatch of several rows, at most one a row.
const FILLED: usize = TABLE_TEXELS / GROUPS as usize;
/// Bytes of an index.
const INDEX_BYTES: u64 = 4;
/// Bytes of the state of a vertex or an edge.
const STATE_BYTES: u64 = 16;

/// Where the room for `more` behind the first `taken` ends, if no more than `limit` fit in all.
fn end(taken: u32, more: u64, limit: u64) -> u32 {
    (u64::from(taken) + more).min(limit.max(taken.into())) as u32
}

/// The most vertices that models may have: an eighth of the largest buffer is left to the mesh stage.
fn vertex_limit(budget: u32, most: u64) -> u64 {
    let all = most / size_of::<SeenVertex>() as u64;
    all - u64::from(budget).min(all / 8)
}

/// Which model each image is drawn by, where all of them do not fit.
#[derive(Clone, Debug, Default)]
struct Fitted {
    /// By the image's number; empty where all fit.
    models: Vec<Option<ModelRange>>,
    /// Images that are drawn by their coarsest stand-in, and those that are left out.
    simpler: u32,
    left_out: u32,
    /// Room for the numbers of all images.
    smallest_first: Vec<usize>,
}

impl Fitted {
    /// For models of at most `room` vertices together.
    fn choose(&mut self, placed: &[Placed], room: u64) {
        (self.simpler, self.left_out) = (0, 0);
        self.models.clear();
        self.smallest_first.clear();
        let mut vertices: u64 = placed.iter().map(|item| u64::from(item.model.vertices[1])).sum();
        if vertices <= room {
            return;
        }
        self.models.extend(placed.iter().map(|item| Some(item.model)));
        self.smallest_first.extend(0..placed.len());
        self.smallest_first.sort_unstable_by(|&a, &b| placed[a].width.total_cmp(&placed[b].width).then(a.cmp(&b)));
        for &number in &self.smallest_first {
            let Placed { model, coarse, .. } = &placed[number];
            if vertices > room && coarse.vertices[1] < model.vertices[1] {
                vertices -= u64::from(model.vertices[1] - coarse.vertices[1]);
                self.models[number] = Some(*coarse);
                self.simpler += 1;
            }
        }
        for &number in &self.smallest_first {
            if vertices > room {
                vertices -= self.models[number].take().map_or(0, |model| u64::from(model.vertices[1]));
                self.left_out += 1;
            }
        }
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
    let indices = (2 * u64::from(budget) + 5 * u64::from(triangles)).min(most / (3 * INDEX_BYTES));
    Capacity { vertices: vertices + budget, indices: 3 * indices as u32, work: budget / 10, thin: 3 * (budget / 3) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What does not fit is drawn by its coarsest model, the smallest image first, then left out.
    #[test]
    fn small_images_give_way() {
        let range = |count: u32| ModelRange { vertices: [0, count], edges: [0, count], triangles: [0, count], material: 0, flatness: 1.0 };
        let (model, coarse) = (range(1_000), range(100));
        let image = |width: f64| Placed { model, coarse, width, instance: Instance::default(), nodes: Vec::new(), calmed: false };
        let placed: Vec<Placed> = [3.0, 1.0, 2.0].map(image).into();
        let models = |room: u64| {
            let mut fitted = Fitted::default();
            fitted.choose(&placed, room);
            let vertices = placed.iter().enumerate().map(|(k, item)| fitted.model(k, item).map_or(0, |model| model.vertices[1]));
            (vertices.collect::<Vec<_>>(), [fitted.simpler, fitted.left_out])
        };
        assert_eq!(models(3_000), (vec![1_000, 1_000, 1_000], [0, 0]));
        assert_eq!(models(2_500), (vec![1_000, 100, 1_000], [1, 0]));
        assert_eq!(models(250), (vec![100, 0, 100], [3, 1]));
        // No buffer is larger than it may be.
        let most = 80 * 2_500;
        let lists = BodyLists::new(&placed, None, 1_000_000, most);
        assert!(u64::from(lists.capacity.vertices) * size_of::<SeenVertex>() as u64 <= most);
        assert!(u64::from(lists.capacity.indices) * INDEX_BYTES <= most && lists.counters.simpler == 1);
    }
}
