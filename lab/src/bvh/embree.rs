//! Intel's Embree 3, for comparison; only in builds with the feature `embree`.

use std::sync::Arc;

use embree3::{
    BufferUsage, BuildQuality, Device, Format, GeometryKind, Hit8, Hit16, IntersectContext, Ray8, Ray16, RayHit, RayHit8, RayHit16, Scene,
    ValidMaskN,
};

use crate::straight::scenes::Triangle;
use crate::straight::{Hit, Ray};

use super::rays::Trace;

/// What Embree could not do, and why not.
#[derive(Debug, thiserror::Error)]
#[error("Embree cannot {task}: {reason}")]
pub struct EmbreeError {
    task: &'static str,
    reason: embree3::Error,
}

/// A scene at high build quality, without the flag that makes its test watertight: its fastest.
pub struct Embree {
    scene: Arc<Scene<'static>>,
}

/// How it is asked.
#[derive(Clone, Copy, Debug)]
pub enum Way {
    /// `rtcIntersect1`.
    Single,
    /// `rtcIntersect8`.
    Eight,
    /// `rtcIntersect16`.
    Sixteen,
    /// `rtcIntersect1M`, a stream of the rays of a tile of so many pixels across.
    Stream(usize),
    /// `rtcIntersectNM`, a stream of packets of sixteen.
    StreamOfSixteen(usize),
}

/// All of them.
pub const WAYS: [Way; 9] = [
    Way::Single,
    Way::Eight,
    Way::Sixteen,
    Way::Stream(8),
    Way::Stream(16),
    Way::Stream(64),
    Way::StreamOfSixteen(8),
    Way::StreamOfSixteen(16),
    Way::StreamOfSixteen(64),
];

impl Way {
    /// As the chart calls it.
    pub fn name(self) -> &'static str {
        match self {
            Way::Single => "Embree",
            Way::Eight => "Embree 8",
            Way::Sixteen => "Embree 16",
            Way::Stream(_) => "Embree stream",
            Way::StreamOfSixteen(_) => "Embree stream 16",
        }
    }

    /// What the chart's column `packet` says: the edge of the tile of a stream, else the number of rays.
    pub fn packet(self) -> usize {
        match self {
            Way::Single => 1,
            Way::Eight => 8,
            Way::Sixteen => 16,
            Way::Stream(edge) | Way::StreamOfSixteen(edge) => edge,
        }
    }

    /// The edge of the tiles in whose order it wants its rays; 1 for rows.
    pub fn tile(self) -> usize {
        match self {
            Way::Eight => 16,
            way => way.packet(),
        }
    }
}

/// Fills a packet lane by lane and reads its hits; fields are set here, not by the crate's constructors, which are not built for speed.
macro_rules! packet {
    ($both:ident, $rays:ident) => {
        for (i, ray) in $rays.iter().enumerate() {
            $both.ray.org_x[i] = ray.origin[0];
            $both.ray.org_y[i] = ray.origin[1];
            $both.ray.org_z[i] = ray.origin[2];
            $both.ray.dir_x[i] = ray.direction[0];
            $both.ray.dir_y[i] = ray.direction[1];
            $both.ray.dir_z[i] = ray.direction[2];
            $both.ray.tfar[i] = ray.until;
        }
    };
}

fn one(empty: &RayHit, ray: &Ray) -> RayHit {
    let mut both = *empty;
    [both.ray.org_x, both.ray.org_y, both.ray.org_z] = ray.origin;
    [both.ray.dir_x, both.ray.dir_y, both.ray.dir_z] = ray.direction;
    both.ray.tfar = ray.until;
    both
}

fn empty_one() -> RayHit {
    RayHit::from(embree3::Ray::segment([0.0; 3], [0.0; 3], 0.0, f32::INFINITY))
}

/// Lanes that a tile cut by the edge leaves over hold no ray.
fn empty_sixteen() -> RayHit16 {
    RayHit16 { ray: Ray16 { tfar: [-1.0; 16], ..Ray16::empty() }, hit: Hit16::new() }
}

/// Embree loads its masks as wide as they are; the crate aligns them to 16 bytes only, and with AVX-512 the process then ends.
#[repr(C, align(64))]
struct Aligned<T>(T);

impl Embree {
    pub fn new(triangles: &[Triangle]) -> Result<Embree, EmbreeError> {
        let cannot = |task| move |reason| EmbreeError { task, reason };
        let device = Device::new().map_err(cannot("start"))?;
        let mut mesh = device.create_geometry(GeometryKind::TRIANGLE).map_err(cannot("make a mesh"))?;
        let corners: Vec<[f32; 3]> = triangles.iter().flatten().copied().collect();
        let indices: Vec<[u32; 3]> = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        mesh.set_new_buffer::<[f32; 3]>(BufferUsage::VERTEX, 0, Format::FLOAT3, 12, corners.len())
            .map_err(cannot("hold the corners of the scene"))?
            .copy_from_slice(&corners);
        mesh.set_new_buffer::<[u32; 3]>(BufferUsage::INDEX, 0, Format::UINT3, 12, indices.len())
            .map_err(cannot("hold the triangles of the scene"))?
            .copy_from_slice(&indices);
        let mesh = mesh.commit();
        let mut scene = device.create_scene().map_err(cannot("make a scene"))?;
        scene.set_build_quality(BuildQuality::HIGH);
        scene.attach_geometry(&mesh);
        scene.commit();
        // To commit says nothing by itself.
        match device.get_error() {
            embree3::Error::NONE => Ok(Embree { scene: Arc::new(scene) }),
            reason => Err(cannot("build the tree of the scene")(reason)),
        }
    }

    /// `rays` in the order of [`Way::tile`], and where tiles start. Rays are told to be coherent.
    pub fn trace(&self, way: Way, rays: Vec<Ray>, starts: Vec<usize>) -> Trace<'static> {
        match way {
            Way::Single => self.single(rays, true),
            Way::Eight => self.eight(rays),
            Way::Sixteen => self.sixteen(rays),
            Way::Stream(_) => self.stream(rays, starts),
            Way::StreamOfSixteen(_) => self.stream_of_sixteen(rays, starts),
        }
    }

    /// Ray by ray.
    pub fn single(&self, rays: Vec<Ray>, coherent: bool) -> Trace<'static> {
        let (scene, empty) = (self.scene.clone(), empty_one());
        Box::new(move |hits| {
            let mut context = if coherent { IntersectContext::coherent() } else { IntersectContext::incoherent() };
            for (ray, hit) in rays.iter().zip(hits) {
                let mut both = one(&empty, ray);
                scene.intersect(&mut context, &mut both);
                *hit = Hit { t: both.ray.tfar, triangle: both.hit.primID };
            }
        })
    }

    /// Ray by ray, whether anything is met.
    pub fn any(&self, rays: Vec<Ray>) -> Trace<'static> {
        let (scene, empty) = (self.scene.clone(), empty_one());
        Box::new(move |hits| {
            let mut context = IntersectContext::incoherent();
            for (ray, hit) in rays.iter().zip(hits) {
                *hit = if scene.occluded(&mut context, &mut one(&empty, ray).ray) { Hit::SOME } else { Hit::MISS };
            }
        })
    }

    fn eight(&self, rays: Vec<Ray>) -> Trace<'static> {
        let scene = self.scene.clone();
        let empty = RayHit8 { ray: Ray8 { tfar: [-1.0; 8], ..Ray8::empty() }, hit: Hit8::new() };
        Box::new(move |hits| {
            let mut context = IntersectContext::coherent();
            let valid = Aligned(ValidMaskN::<8>::all_active());
            for (rays, hits) in rays.chunks(8).zip(hits.chunks_mut(8)) {
                let mut both = empty;
                packet!(both, rays);
                scene.intersect8(&mut context, &mut both, &valid.0);
                for (i, hit) in hits.iter_mut().enumerate() {
                    *hit = Hit { t: both.ray.tfar[i], triangle: both.hit.primID[i] };
                }
            }
        })
    }

    fn sixteen(&self, rays: Vec<Ray>) -> Trace<'static> {
        let (scene, empty) = (self.scene.clone(), empty_sixteen());
        Box::new(move |hits| {
            let mut context = IntersectContext::coherent();
            let valid = Aligned(ValidMaskN::<16>::all_active());
            for (rays, hits) in rays.chunks(16).zip(hits.chunks_mut(16)) {
                let mut both = empty;
                packet!(both, rays);
                scene.intersect16(&mut context, &mut both, &valid.0);
                for (i, hit) in hits.iter_mut().enumerate() {
                    *hit = Hit { t: both.ray.tfar[i], triangle: both.hit.primID[i] };
                }
            }
        })
    }

    fn stream(&self, rays: Vec<Ray>, starts: Vec<usize>) -> Trace<'static> {
        let (scene, empty) = (self.scene.clone(), empty_one());
        let mut stream = Vec::new();
        Box::new(move |hits| {
            let mut context = IntersectContext::coherent();
            for run in starts.windows(2) {
                stream.clear();
                stream.extend(rays[run[0]..run[1]].iter().map(|ray| one(&empty, ray)));
                scene.intersect_stream_aos(&mut context, &mut stream);
                for (both, hit) in stream.iter().zip(&mut hits[run[0]..run[1]]) {
                    *hit = Hit { t: both.ray.tfar, triangle: both.hit.primID };
                }
            }
        })
    }

    fn stream_of_sixteen(&self, rays: Vec<Ray>, starts: Vec<usize>) -> Trace<'static> {
        let (scene, empty) = (self.scene.clone(), empty_sixteen());
        let mut stream = Vec::new();
        Box::new(move |hits| {
            let mut context = IntersectContext::coherent();
            for run in starts.windows(2) {
                stream.clear();
                stream.extend(rays[run[0]..run[1]].chunks(16).map(|rays| {
                    let mut both = empty;
                    packet!(both, rays);
                    both
                }));
                scene.intersect_stream_aos(&mut context, &mut stream);
                for (both, hits) in stream.iter().zip(hits[run[0]..run[1]].chunks_mut(16)) {
                    for (i, hit) in hits.iter_mut().enumerate() {
                        *hit = Hit { t: both.ray.tfar[i], triangle: both.hit.primID[i] };
                    }
                }
            }
        })
    }
}
