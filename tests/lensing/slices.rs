//! A slice of the table: how its texels are interpolated, and its shader beside it.

use lensrunner::lensing::Slice;
use lensrunner::lensing::lookup::residuals;
use lensrunner::lensing::methods::Method;
use lensrunner::render::gpu::library::{Library, Values, Worldlines};

use crate::support::table;

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

/// The shader is valid with nothing but the slice supplied, and asks the device for no capability.
#[test]
fn the_shader_is_valid() {
    let bindings = "#define_import_path lensrunner::gpu::bindings\nconst TABLE_ROW: u32 = 1024u;\n\
         @group(0) @binding(0) var lens_slice: texture_2d<f32>;\n";
    let main = "#import lensrunner::lensing::lookup::lens_lookup\n\
         @group(0) @binding(1) var<storage, read_write> out: array<vec4<f32>>;\n\
         @compute @workgroup_size(1) fn main() {\n\
         let ray = lens_lookup(1.0, 2.0, 1u); out[0] = vec4<f32>(ray.cos_psi, ray.sin_psi, ray.delay, ray.slope); }\n";
    let library = Library::new(Worldlines::Bodies, Method::default(), &[("bindings", bindings)]);
    let module = library.and_then(|mut library| library.compose("main", main, Values { inside: true, data_group: 1 }));
    let module = module.unwrap_or_else(|error| panic!("{error}"));
    naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty()).validate(&module).expect("valid");
}

/// Constants and names that the shader and its twin share.
#[test]
fn the_shader_has_every_function_of_its_twin() {
    macro_rules! shaders {
        ($($name:literal),*) => { concat!($(include_str!(concat!("../../shaders/lensing/", $name, ".wgsl"))),*) };
    }
    let lensing = shaders!("closed_form", "inside", "slice", "lookup");
    for twin in [
        include_str!("../../src/lensing/closed_form/elementary.rs"),
        include_str!("../../src/lensing/closed_form/formulas.rs"),
        include_str!("../../src/lensing/lookup/inside.rs"),
        include_str!("../../src/lensing/lookup/mod.rs"),
    ] {
        let own = |name: &str| ["camera", "ln", "ln4", "above", "least", "most"].contains(&name);
        for name in twin.split("pub fn ").skip(1).filter_map(|rest| rest.split('(').next()).filter(|name| !own(name)) {
            assert!(lensing.contains(&format!("fn {name}(")), "the shader lacks {name}");
        }
    }
}
