//! Intel's Embree 3, for comparison; only in builds with the feature `embree`.

use std::sync::Arc;

use embree3::{
    BufferUsage, BuildQuality, Device, Format, GeometryKind, Hit8, Hit16, IntersectContext, Ray8, Ray16, RayHit, RayHit8, RayHit16, Scene,
    ValidMaskN,
};

use crate::reference::bvh::Ray;
use crate::reference::scenes::Triangle;

/// A scene at high build quality.
pub struct Embree {
    scene: Arc<Scene<'static>>,
}

impl Embree {
    pub fn new(triangles: &[Triangle]) -> Embree {
        let device = Device::new().expect("Embree's library starts");
        let mut mesh = device.create_geometry(GeometryKind::TRIANGLE).expect("a mesh");
        let corners: Vec<[f32; 3]> = triangles.iter().flatten().copied().collect();
        let indices: Vec<[u32; 3]> = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        mesh.set_new_buffer::<[f32; 3]>(BufferUsage::VERTEX, 0, Format::FLOAT3, 12, corners.len())
            .expect("memory")
            .copy_from_slice(&corners);
        mesh.set_new_buffer::<[u32; 3]>(BufferUsage::INDEX, 0, Format::UINT3, 12, indices.len()).expect("memory").copy_from_slice(&indices);
        let mesh = mesh.commit();
        let mut scene = device.create_scene().expect("a scene");
        scene.set_build_quality(BuildQuality::HIGH);
        scene.attach_geometry(&mesh);
        scene.commit();
        Embree { scene: Arc::new(scene) }
    }

    pub fn single(&self, rays: &[Ray]) -> Box<dyn FnMut() -> usize> {
        let (scene, rays) = (self.scene.clone(), rays.to_vec());
        let mut hits = vec![(f32::INFINITY, u32::MAX); rays.len()];
        Box::new(move || {
            let mut context = IntersectContext::coherent();
            for (ray, hit) in rays.iter().zip(&mut hits) {
                let mut both = RayHit::from(embree3::Ray::segment(ray.origin, ray.direction, 0.0, ray.until));
                scene.intersect(&mut context, &mut both);
                *hit = (both.ray.tfar, both.hit.primID);
            }
            hits.iter().filter(|hit| hit.1 != u32::MAX).count()
        })
    }

    /// `rays` in the order of packets, a multiple of 8.
    pub fn eight(&self, rays: &[Ray]) -> Box<dyn FnMut() -> usize> {
        let (scene, rays) = (self.scene.clone(), rays.to_vec());
        let mut hits = vec![(f32::INFINITY, u32::MAX); rays.len()];
        Box::new(move || {
            let mut context = IntersectContext::coherent();
            let valid = ValidMaskN::<8>::all_active();
            for (rays, hits) in rays.chunks_exact(8).zip(hits.chunks_exact_mut(8)) {
                let origins = std::array::from_fn(|i| rays[i].origin);
                let directions = std::array::from_fn(|i| rays[i].direction);
                let mut both = RayHit8 { ray: Ray8::new(origins, directions), hit: Hit8::new() };
                scene.intersect8(&mut context, &mut both, &valid);
                for (i, hit) in hits.iter_mut().enumerate() {
                    *hit = (both.ray.tfar[i], both.hit.primID[i]);
                }
            }
            hits.iter().filter(|hit| hit.1 != u32::MAX).count()
        })
    }

    /// `rays` in the order of packets, a multiple of 16.
    pub fn sixteen(&self, rays: &[Ray]) -> Box<dyn FnMut() -> usize> {
        let (scene, rays) = (self.scene.clone(), rays.to_vec());
        let mut hits = vec![(f32::INFINITY, u32::MAX); rays.len()];
        Box::new(move || {
            let mut context = IntersectContext::coherent();
            let valid = ValidMaskN::<16>::all_active();
            for (rays, hits) in rays.chunks_exact(16).zip(hits.chunks_exact_mut(16)) {
                let origins = std::array::from_fn(|i| rays[i].origin);
                let directions = std::array::from_fn(|i| rays[i].direction);
                let mut both = RayHit16 { ray: Ray16::new(origins, directions), hit: Hit16::new() };
                scene.intersect16(&mut context, &mut both, &valid);
                for (i, hit) in hits.iter_mut().enumerate() {
                    *hit = (both.ray.tfar[i], both.hit.primID[i]);
                }
            }
            hits.iter().filter(|hit| hit.1 != u32::MAX).count()
        })
    }
}
