//! The scenes of Sei 2008 as bare triangles, for measuring tracers of straight rays: two of Haines' Standard Procedural Databases, a
//! castle, a bunny.
//!
//! Lengths in each scene's own unit; +Z is up.

pub mod bunny;
pub mod castle;
pub mod spd;

/// Three corners.
pub type Triangle = [[f32; 3]; 3];

/// A pinhole camera for straight rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneView {
    /// Where it stands.
    pub eye: [f64; 3],
    /// What it looks at.
    pub target: [f64; 3],
    /// The vertical field of view, radians.
    pub field_of_view: f64,
}

impl SceneView {
    /// A view of 45°, the angle of all scenes here.
    pub const fn new(eye: [f64; 3], target: [f64; 3]) -> SceneView {
        SceneView { eye, target, field_of_view: std::f64::consts::FRAC_PI_4 }
    }

    /// The unit direction through a point of the picture; `across` and `up` run from −1 to 1 over its height, `across` further over its
    /// width. Up is +Z.
    pub fn direction(&self, across: f64, up: f64) -> [f64; 3] {
        let forward = glam::DVec3::from(self.target) - glam::DVec3::from(self.eye);
        let forward = forward.normalize();
        let right = forward.cross(glam::DVec3::Z).normalize();
        let above = right.cross(forward);
        let half = (0.5 * self.field_of_view).tan();
        (forward + half * (across * right + up * above)).normalize().to_array()
    }

    /// The directions through the centres of the pixels of a picture of this width and height, row by row from the upper left.
    pub fn directions(&self, [width, height]: [usize; 2]) -> Vec<[f32; 3]> {
        let mut all = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                let across = (2.0 * x as f64 + 1.0 - width as f64) / height as f64;
                let up = 1.0 - (2.0 * y as f64 + 1.0) / height as f64;
                all.push(self.direction(across, up).map(|c| c as f32));
            }
        }
        all
    }
}

/// A scene and where it is seen from.
#[derive(Clone, Debug)]
pub struct TestScene {
    /// The name in charts, as in Sei 2008.
    pub name: &'static str,
    /// What is there.
    pub triangles: Vec<Triangle>,
    /// Where it is seen from.
    pub view: SceneView,
}

/// Corners computed in f64, rounded once.
fn rounded(corners: [glam::DVec3; 3]) -> Triangle {
    corners.map(|c| c.as_vec3().to_array())
}
