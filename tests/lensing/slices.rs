//! A slice of the table: its texels, how they are interpolated, eight places at once, and its shader beside it.

use lensrunner::lensing::lookup::{residuals, residuals_linear};
use lensrunner::lensing::table::slice::Cut;
use lensrunner::lensing::{Slice, lens_lookup_at, score};
use rand::SeedableRng;

use crate::support::table;

/// A texel made alone is the one of the whole slice, in both other formats.
#[test]
fn single_texels_are_those_of_the_slice() {
    for l in [0.05, 0.7, 1.3, 40.0, 5000.0] {
        let (slice, cut) = (Slice::new(table(), l), Cut::new(table(), l));
        for (half, texels) in [(false, slice.nodes()), (true, slice.halves())] {
            for index in (4..texels.len()).step_by(7).chain([texels.len() - 1]) {
                let alone = if half { cut.half(index) } else { cut.node(index) };
                assert_eq!(alone.map(f32::to_bits), texels[index].map(f32::to_bits), "L {l}, texel {index}");
            }
        }
    }
}

/// At the nodes of the slice there is nothing to interpolate: linear gives what cubic gives, to the rounding of sums of nine terms.
#[test]
fn linear_and_cubic_agree_at_the_nodes() {
    let slice = Slice::new(table(), 2.5);
    let (texels, [nx, ny]) = (slice.nodes(), slice.size);
    for (i, j) in [(0, 0), (3, 40), (nx - 2, 7), (20, ny - 2), (nx - 2, ny - 2)] {
        let (x, y) = (i as f32 / (nx - 1) as f32, j as f32 / (ny - 1) as f32);
        let (linear, cubic) = (residuals_linear(|k| texels[k], slice.size, x, y), residuals(&slice, x, y));
        for (a, b) in linear.into_iter().zip(cubic) {
            assert!((a - b).abs() < 2e-5 * (1.0 + b.abs()), "node {i}, {j}: {linear:?} and {cubic:?}");
        }
    }
}

/// What is looked up is the cubic B-spline of the coefficients, by its definition (de Boor, A Practical Guide to Splines, ch. IX), in the
/// table's corners too; places beyond are those of the edge.
#[test]
fn the_lookup_is_the_spline_of_its_coefficients() {
    let slice = Slice::new(table(), 1.3);
    let ([nx, ny], coefficients) = (slice.size.map(|n| n as usize), &slice.texels()[4..]);
    // The basis function around 0 over knots a unit apart.
    let basis = |x: f64| match x.abs() {
        d if d < 1.0 => 2.0 / 3.0 - d * d + 0.5 * d * d * d,
        d if d < 2.0 => (2.0 - d).powi(3) / 6.0,
        _ => 0.0,
    };
    for x in [0.0, 1e-4, 0.013, 0.31, 0.5, 0.77, 0.995, 0.9999, 1.0, 1.5, -0.2] {
        for y in [0.0, 1e-4, 0.007, 0.24, 0.5, 0.86, 0.998, 1.0, 1.1, -3.0] {
            let (px, py) = (f64::clamp(x, 0.0, 1.0) * (nx - 1) as f64, f64::clamp(y, 0.0, 1.0) * (ny - 1) as f64);
            let mut sum = [0.0f64; 3];
            for j in 0..ny + 2 {
                for i in 0..nx + 2 {
                    let weight = basis(px + 1.0 - i as f64) * basis(py + 1.0 - j as f64);
                    (0..3).for_each(|h| sum[h] += weight * f64::from(coefficients[j * (nx + 2) + i][h]));
                }
            }
            let found = residuals(&slice, x as f32, y as f32);
            for (got, want) in found.into_iter().zip(sum) {
                assert!((f64::from(got) - want).abs() < 3e-5 * (0.1 + want.abs()), "at {x}, {y}: {found:?}, not {sum:?}");
            }
        }
    }
}

/// Eight at once give what one at a time gives, to the rounding of f32: directions to 5e-6 rad, delays to 1e-5 of them.
#[test]
fn the_batch_agrees_with_the_lookup() {
    use lensrunner::lensing::batch::lens_lookup_batch;
    let mut rng = rand::rngs::SmallRng::seed_from_u64(11);
    for _ in 0..300 {
        let l = score::draw(score::Points::Adversarial, &mut rng)[2];
        let slice = Slice::new(table(), l);
        let mut points: [[f32; 3]; 8] = std::array::from_fn(|_| {
            let [r, phi, camera] = score::draw(score::Points::Adversarial, &mut rng);
            let r = (r / camera * l).clamp(1.0005, 1e4);
            let half = (0.5 * phi).sin();
            [(r - l) - 2.0 * r * half * half, r * phi.sin(), r * phi.cos()].map(|v| v as f32)
        });
        // One lane holds what is not a point outside.
        points[7][2] = [f32::NAN, 0.3, f32::INFINITY][(l * 1e6) as usize % 3];
        let lanes = |k: usize| points.map(|point| point[k]);
        for order in 1..=3 {
            let rays = lens_lookup_batch(&slice, lanes(0), lanes(1), lanes(2), order);
            for (i, [along, across, height]) in points.into_iter().enumerate() {
                let one = lens_lookup_at(&slice, along, across, height, order);
                let ray = rays.ray(i);
                assert_eq!(ray.valid, one.valid, "L {l} lane {i}");
                let angle = |s: f32, c: f32| f64::from(s).atan2(f64::from(c));
                let off = (angle(ray.sin_psi, ray.cos_psi) - angle(one.sin_psi, one.cos_psi)).abs();
                assert!(off < 5e-6, "L {l} order {order}: {ray:?} and {one:?}");
                assert!((ray.delay - one.delay).abs() < 2e-4 + 1e-5 * one.delay.abs(), "L {l} order {order}: {ray:?} and {one:?}");
                let tilt = |e: &lensrunner::lensing::LensRay| angle(e.emission_tangential, -e.emission_radial);
                assert!((tilt(&ray) - tilt(&one)).abs() < 2e-5, "L {l} order {order}: {ray:?} and {one:?}");
            }
        }
    }
}

/// The shader is valid WGSL with nothing but `lens_texel` supplied.
#[test]
fn the_shader_is_valid() {
    let source = format!(
        "{}\n{}\n@group(0) @binding(0) var<storage, read> slice: array<vec4<f32>>;\n\
         @group(0) @binding(1) var<storage, read_write> out: array<vec4<f32>>;\n\
         const SEES_INSIDE: bool = true;\n\
         fn lens_texel(index: u32) -> vec4<f32> {{ return slice[index]; }}\n\
         @compute @workgroup_size(1) fn main() {{ let ray = lens_lookup(1.0, 2.0, 1u); out[0] = vec4<f32>(ray.cos_psi, ray.sin_psi, ray.delay, ray.slope); }}",
        include_str!("../../shaders/functions/lensing.wgsl"),
        include_str!("../../shaders/functions/residuals.wgsl")
    );
    let module = naga::front::wgsl::parse_str(&source).unwrap_or_else(|wrong| panic!("{}", wrong.emit_to_string(&source)));
    naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty()).validate(&module).expect("valid");
}

/// Constants and names that the shader and its twin share.
#[test]
fn the_shader_has_every_function_of_its_twin() {
    macro_rules! shaders {
        ($($name:literal),*) => { concat!($(include_str!(concat!("../../shaders/functions/", $name, ".wgsl"))),*) };
    }
    let lensing = shaders!("lensing", "residuals");
    let others = shaders!("orbit", "shooting", "exact", "integrate", "refine", "closed", "static_ray");
    for (twin, shader) in [
        (include_str!("../../src/lensing/closed_form/elementary.rs"), lensing),
        (include_str!("../../src/lensing/closed_form/formulas.rs"), lensing),
        (include_str!("../../src/lensing/lookup/inside.rs"), lensing),
        (include_str!("../../src/lensing/lookup/mod.rs"), lensing),
        (include_str!("../../src/lensing/orbit.rs"), others),
        (include_str!("../../src/lensing/shooting.rs"), others),
        (include_str!("../../src/lensing/closed.rs"), others),
    ] {
        // The shader has one `fire` and one `tilt`, of the method's own; `residuals` in other formats too.
        let own = |name: &str| {
            ["camera", "ln", "ln4", "above", "least", "most"].contains(&name)
                || name == "lookup_with"
                || ["fire_", "tilt_", "residuals_"].iter().any(|start| name.starts_with(start))
        };
        for name in twin.split("pub fn ").skip(1).filter_map(|rest| rest.split('(').next()).filter(|name| !own(name)) {
            assert!(shader.contains(&format!("fn {name}(")), "the shader lacks {name}");
        }
    }
}
