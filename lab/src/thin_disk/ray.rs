//! The image of a thin opaque disk, quickly: what a camera sees of the plane z = 0, ray after ray, without regard to time.
//!
//! A stationary disk needs no travel time, so light is followed by its shape alone: u(φ) = 1/r over the swept angle φ obeys Binet's
//! equation u'' = (3/2)u² − u. One product makes each Taylor coefficient, and a step of order 16 covers about a radian: a ray takes a
//! handful. Packets of four rays go side by side through the same instructions (crate `wide`), each with steps of its own; a packet lives
//! as long as one of its rays does.
//!
//! The general judge ([`lensrunner::judge::picture`]) integrates other equations with other steps; a test holds the two together.

use glam::DVec3;
use wide::f64x4;

use lensrunner::spacetime::metric::river_speed;

/// A camera that hovers and looks at the hole: a grid of square pixels over a field of view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screen {
    /// The camera's radius, r_s.
    pub radius: f64,
    /// Angle between the disk's normal +z and the direction to the camera, radians, in (0, π).
    pub inclination: f64,
    /// Angle of the whole picture, radians: pixels are even in the angle (not its tangent).
    pub field_of_view: f64,
    /// Pixels along each side.
    pub pixels: usize,
}

/// The disk, in r_s: opaque between two radii, turning counter-clockwise seen from +z on circular orbits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Inner edge, at least 1.5 r_s, where orbits end.
    pub inner: f64,
    /// Outer edge.
    pub outer: f64,
}

/// What a pixel sees: radius in r_s and g = ν_observed/ν_emitted; not numbers where it misses the disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Where.
    pub radius: f64,
    /// ν_observed/ν_emitted for the hovering camera.
    pub g: f64,
}

impl Impact {
    const MISS: Impact = Impact { radius: f64::NAN, g: f64::NAN };
}

impl Screen {
    /// The unit vector from the hole to the camera, and the picture's axes: to the right and up.
    fn axes(&self) -> [DVec3; 3] {
        let (sine, cosine) = self.inclination.sin_cos();
        [DVec3::new(sine, 0.0, cosine), DVec3::Y, DVec3::new(-cosine, 0.0, sine)]
    }

    /// The direction in the hovering camera's frame of pixel (`column`, `row`), counted from the upper left: its angles from the middle of
    /// the picture are those of a longitude to the right and a latitude.
    pub fn look(&self, column: usize, row: usize) -> DVec3 {
        let step = self.field_of_view / self.pixels as f64;
        let middle = 0.5 * (self.pixels as f64 - 1.0);
        let (east, north) = ((column as f64 - middle) * step, (middle - row as f64) * step);
        let [outward, right, up] = self.axes();
        -outward * (north.cos() * east.cos()) + right * (north.cos() * east.sin()) + up * north.sin()
    }

    /// Where the camera is, r_s.
    pub fn position(&self) -> DVec3 {
        self.axes()[0] * self.radius
    }
}

/// ν_observed/ν_emitted of light from a circular orbit at radius `r` (r_s) that a hovering camera at `radius` sees; `turning` is the
/// light's angular momentum about +z over its energy, r_s.
pub fn orbit_shift(r: f64, radius: f64, turning: f64) -> f64 {
    let beta = river_speed(radius);
    let omega = (0.5 / (r * r * r)).sqrt();
    (1.0 - 1.5 / r).sqrt() / ((1.0 - beta * beta).sqrt() * (1.0 - omega * turning))
}

/// Highest order of the series.
const MAX_ORDER: usize = 22;
/// Steps after which a packet is given up: rays that wind at the photon sphere to within rounding.
const MAX_STEPS: usize = 300;
/// Crossings of the plane that are looked at: the image of order 3 is the last that is wider than 10⁻⁴ of the shadow.
const CROSSINGS: u32 = 4;

/// The picture, row by row from the top; each step of a ray has an error of about `tolerance` relative to u.
pub fn image(screen: &Screen, ring: &Ring, tolerance: f64) -> Vec<Impact> {
    let count = screen.pixels * screen.pixels;
    let mut impacts = vec![Impact::MISS; count];
    for (packet, out) in impacts.chunks_mut(4).enumerate() {
        let mut rays: [Ray; 4] = std::array::from_fn(|lane| {
            let i = (4 * packet + lane).min(count - 1);
            Ray::new(screen, screen.look(i % screen.pixels, i / screen.pixels))
        });
        follow(&mut rays, screen, ring, tolerance);
        for (out, ray) in out.iter_mut().zip(&rays) {
            *out = ray.impact;
        }
    }
    impacts
}

/// A ray on its way in the plane of its orbit.
#[derive(Clone, Copy)]
struct Ray {
    u: f64,
    /// du/dφ.
    slope: f64,
    swept: f64,
    /// φ of the next crossing of the plane z = 0, and how many there were.
    next: f64,
    crossings: u32,
    /// Angular momentum about +z over energy.
    turning: f64,
    alive: bool,
    impact: Impact,
}

impl Ray {
    fn new(screen: &Screen, look: DVec3) -> Ray {
        let n = screen.axes()[0];
        let cosine = look.dot(n);
        let across = look - n * cosine;
        let sine = across.length();
        let u = 1.0 / screen.radius;
        let lapse = (1.0 - u).sqrt();
        let t = across / sine.max(1e-300);
        let b = screen.radius * sine / lapse;
        Ray {
            u,
            slope: -u * lapse * cosine / sine.max(1e-300),
            swept: 0.0,
            next: n.z.atan2(-t.z).rem_euclid(std::f64::consts::PI),
            crossings: 0,
            // The light moves against the way it is followed.
            turning: -b * (n.x * t.y - n.y * t.x),
            alive: sine > 1e-12,
            impact: Impact::MISS,
        }
    }
}

fn order_for(tolerance: f64) -> usize {
    ((-0.5 * tolerance.ln()).ceil() as usize + 2).clamp(6, MAX_ORDER)
}

fn follow(rays: &mut [Ray; 4], screen: &Screen, ring: &Ring, tolerance: f64) {
    let order = order_for(tolerance);
    for _ in 0..MAX_STEPS {
        if !rays.iter().any(|ray| ray.alive) {
            return;
        }
        let series = series(f64x4::from(rays.map(|ray| ray.u)), f64x4::from(rays.map(|ray| ray.slope)), order);
        let last = series[order].to_array();
        let before = series[order - 1].to_array();
        // The step from the last two coefficients, as in `geodesic`; the end of it is the next crossing if that lies within.
        let steps: [f64; 4] = std::array::from_fn(|lane| {
            let size = last[lane].abs().max(before[lane].abs()) / rays[lane].u.abs().max(1e-3);
            let step = if size > 0.0 { (tolerance / size).powf(1.0 / (order - 1) as f64).min(2.0) } else { 2.0 };
            if rays[lane].alive { step.min(rays[lane].next - rays[lane].swept) } else { 0.0 }
        });
        let h = f64x4::from(steps);
        let (mut u, mut slope) = (f64x4::ZERO, f64x4::ZERO);
        for n in (1..=order).rev() {
            slope = slope * h + u;
            u = u * h + series[n];
        }
        slope = slope * h + u;
        u = u * h + series[0];
        let (u, slope) = (u.to_array(), slope.to_array());
        for (lane, ray) in rays.iter_mut().enumerate().filter(|(_, ray)| ray.alive) {
            (ray.u, ray.slope) = (u[lane], slope[lane]);
            ray.swept += steps[lane];
            // Outward beyond the disk, or inward below where anything turns back.
            if ray.u * ring.outer < 1.0 && ray.slope < 0.0 || ray.u > 2.0 / 3.0 && ray.slope > 0.0 {
                ray.alive = false;
            } else if ray.next - ray.swept <= 1e-14 {
                if ray.u * ring.outer >= 1.0 && ray.u * ring.inner <= 1.0 {
                    let radius = 1.0 / ray.u;
                    ray.impact = Impact { radius, g: orbit_shift(radius, screen.radius, ray.turning) };
                    ray.alive = false;
                }
                ray.crossings += 1;
                ray.next += std::f64::consts::PI;
                ray.alive &= ray.crossings < CROSSINGS;
            }
        }
    }
}

/// The Taylor coefficients of u: (n + 2)(n + 1) u_{n+2} = (3/2) Σ u_k u_{n−k} − u_n, the sum folded about its middle.
fn series(u: f64x4, slope: f64x4, order: usize) -> [f64x4; MAX_ORDER + 1] {
    let mut c = [f64x4::ZERO; MAX_ORDER + 1];
    (c[0], c[1]) = (u, slope);
    for n in 0..order - 1 {
        let mut sum = f64x4::ZERO;
        for k in 0..n.div_ceil(2) {
            sum += c[k] * c[n - k];
        }
        sum += sum;
        if n % 2 == 0 {
            sum += c[n / 2] * c[n / 2];
        }
        c[n + 2] = (f64x4::splat(1.5) * sum - c[n]) * f64x4::splat(1.0 / ((n + 1) * (n + 2)) as f64);
    }
    c
}
