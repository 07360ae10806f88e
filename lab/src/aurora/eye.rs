//! From a point of the patch to the screen: a pinhole in flat space, or one that sees the patch on a planet by a hole through the table.

use glam::{DMat3, DVec3, Mat3, Vec3};

use lensrunner::lensing::{Slice, lens_lookup};
use lensrunner::scene::aurora::dipole::PLANET_RADIUS;

/// A pinhole camera with square pixels.
#[derive(Clone, Debug)]
pub struct Eye {
    /// Width and height of the picture, pixels.
    pub size: [usize; 2],
    /// Focal length, pixels.
    pub focal: f32,
    /// Where it is, km, in the patch's axes (flat space).
    pub position: Vec3,
    /// Rows: right, up and back, in the patch's axes.
    pub axes: Mat3,
    /// The hole, if light is bent.
    pub bent: Option<Bent>,
}

/// A planet by a hole, in the hole's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planet {
    /// Where its centre is, r_s from the hole.
    pub at: DVec3,
    /// Its radius, r_s.
    pub radius: f64,
    /// The direction that the side with the patch in its middle faces, of any length.
    pub facing: DVec3,
}

/// The patch as it lies by a hole.
#[derive(Clone, Debug)]
pub struct Bent {
    /// The table at the camera's radius.
    pub slice: Slice,
    /// The camera's radius, r_s; the camera is on the +z axis of the hole's axes.
    pub radius: f32,
    /// The patch's origin minus the camera's position, r_s.
    pub origin: Vec3,
    /// From km in the patch's axes to r_s in the hole's.
    pub place: Mat3,
    /// Rows: right, up and back of the camera, in the hole's axes.
    pub axes: Mat3,
    /// r_s per km.
    pub scale: f32,
    /// Image order.
    pub order: u32,
}

/// Rows right, up, back of a camera that looks along `look`.
fn rows(look: DVec3, up: DVec3) -> Mat3 {
    let back = -look.normalize();
    let right = up.cross(back).normalize_or(back.any_orthonormal_vector());
    DMat3::from_cols(right, back.cross(right), back).transpose().as_mat3()
}

impl Eye {
    /// In flat space at `position` (km), looking at `target`, with a horizontal field of view in radians.
    pub fn flat(position: DVec3, target: DVec3, up: DVec3, field_of_view: f64, size: [usize; 2]) -> Eye {
        Eye {
            size,
            focal: (0.5 * size[0] as f64 / (0.5 * field_of_view).tan()) as f32,
            position: position.as_vec3(),
            axes: rows(target - position, up),
            bent: None,
        }
    }

    /// On a planet, seen in an image order by a camera at (0, 0, `radius`) r_s, for which `slice` is the table, with a horizontal field of
    /// view in radians. The camera looks where the patch's point 150 km up is seen.
    pub fn bent(slice: Slice, radius: f64, planet: &Planet, field_of_view: f64, size: [usize; 2], order: u32) -> Eye {
        let scale = planet.radius / PLANET_RADIUS;
        let up = planet.facing.normalize();
        let north = (DVec3::Y - up * up.y).try_normalize().unwrap_or_else(|| up.any_orthonormal_vector());
        let axes = DMat3::from_cols(north.cross(up), north, up);
        let mut eye = Eye {
            size,
            focal: (0.5 * size[0] as f64 / (0.5 * field_of_view).tan()) as f32,
            position: Vec3::ZERO,
            axes: Mat3::IDENTITY,
            bent: Some(Bent {
                slice,
                radius: radius as f32,
                origin: (planet.at + up * planet.radius - DVec3::Z * radius).as_vec3(),
                place: (axes * scale).as_mat3(),
                axes: Mat3::IDENTITY,
                scale: scale as f32,
                order,
            }),
        };
        let middle = eye.apparent(Vec3::new(0.0, 0.0, 150.0));
        if let Some(bent) = &mut eye.bent {
            bent.axes = rows(middle.as_dvec3(), DVec3::Y);
        }
        eye
    }

    /// The apparent place of a point (km) in camera axes (right, up, back): direction times light path. Flat space: in km; bent: in r_s.
    /// This is the projection whose cost the walks save.
    pub fn apparent(&self, point: Vec3) -> Vec3 {
        match &self.bent {
            None => self.axes * (point - self.position),
            Some(bent) => {
                let offset = bent.origin + bent.place * point;
                let across = offset.truncate().length();
                let ray = lens_lookup(&bent.slice, offset.z, across, bent.order);
                let side = if across > 0.0 { offset.truncate() / across } else { glam::Vec2::X };
                let turn = if bent.order == 2 { -1.0 } else { 1.0 };
                let seen = (side * (turn * ray.sin_psi)).extend(ray.cos_psi) * if ray.valid { ray.delay } else { f32::NAN };
                bent.axes * seen
            }
        }
    }

    /// A vector of one km across the patch as the camera would see it without the change of bending over it.
    pub fn direction(&self, vector: Vec3) -> Vec3 {
        match &self.bent {
            None => self.axes * vector,
            Some(bent) => bent.axes * (bent.place * vector),
        }
    }

    /// Length, in the unit of [`Eye::apparent`], of a km.
    pub fn scale(&self) -> f32 {
        self.bent.as_ref().map_or(1.0, |bent| bent.scale)
    }

    /// The nearest depth drawn, in the unit of [`Eye::apparent`]: a kilometre.
    pub fn near(&self) -> f32 {
        self.scale()
    }

    /// Where an apparent place falls on the screen, pixels from the upper left corner; None before the nearest depth.
    pub fn screen(&self, apparent: Vec3) -> Option<[f32; 2]> {
        let depth = -apparent.z;
        (depth > self.near()).then(|| {
            let f = self.focal / depth;
            [0.5 * self.size[0] as f32 + f * apparent.x, 0.5 * self.size[1] as f32 - f * apparent.y]
        })
    }
}
