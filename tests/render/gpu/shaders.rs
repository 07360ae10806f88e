//! Shaders: each pass is valid WGSL, and what is written in both languages agrees when the shipped shader runs.

use lensrunner::lensing::Slice;
use lensrunner::lensing::lookup::{OLD, YOUNG, lens_lookup_aged};
use lensrunner::lensing::methods::METHODS;
use lensrunner::render::gpu::layout::module_of;
use lensrunner::render::gpu::shaders::Pass;
use lensrunner::render::sky::table::{sky_seen, sky_swept, sky_table};
use lensrunner::scene::sky::milky_way;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::support::table;
use crate::twin::run;

use crate::gpu::GPU;

/// f32 sums in another order, and a driver's sin, log and exp, differ by a few units in the last place; near turning points that grows.
fn close(got: f32, want: f32, relative: f32) -> bool {
    (got - want).abs() <= relative * (1.0 + want.abs())
}

#[test]
fn every_pass_compiles_by_every_method() {
    for method in METHODS {
        for pass in Pass::ALL {
            let scope = GPU.device.push_error_scope(wgpu::ErrorFilter::Validation);
            let _ = module_of(&GPU.device, "pass", pass.module_by(method, true));
            let error = lensrunner::render::gpu::device::wait(scope.pop());
            assert!(error.is_none(), "{method:?} {pass:?}: {}", error.unwrap());
        }
    }
}

/// The shaders' own sine, cosine and angle are the library's but for their roundings, whatever the driver's are.
#[test]
fn sine_cosine_and_angle_are_the_librarys() {
    let body = "#import lensrunner::lensing::closed_form::{angle, sine_cosine}
    let both = sine_cosine(row.x);
    twin_out[id.x] = vec4<f32>(both, angle(abs(both.x), both.y, 1.0), 0.0);";
    let rows: Vec<[f32; 4]> = (0..=8000).map(|i| [(f64::from(i) * 0.001 - 4.0) as f32, 0.0, 0.0, 0.0]).collect();
    for (row, got) in rows.iter().zip(run(Pass::DiskVertices, body, [&[], &[]], &rows, 1)) {
        let x = f64::from(row[0]);
        // A dozen roundings of 6e-8, of which those of half the angle count up to four times: 6.5e-7 in single precision. A pixel is a
        // thousand times that.
        for (got, want, rounded) in [(got[0], x.sin(), 8e-7), (got[1], x.cos(), 8e-7), (got[2], x.sin().abs().atan2(x.cos()), 1.6e-6)] {
            assert!((f64::from(got) - want).abs() < rounded, "{x}: {got:?}, not {want}");
        }
    }
}

#[test]
fn the_lookup_is_the_same_in_both_languages() {
    let body = "#import lensrunner::lensing::lookup::lens_lookup_aged
#import lensrunner::lensing::slice::lens_texel
    let ray = lens_lookup_aged(row.x, row.y, lens_texel(0u).x + row.x, u32(row.z), row.w);
    twin_out[2u * id.x] = vec4<f32>(ray.cos_psi, ray.sin_psi, ray.delay, ray.frequency);
    twin_out[2u * id.x + 1u] = vec4<f32>(ray.emission_radial, ray.emission_tangential, ray.emission_frequency, f32(ray.valid));";
    let mut random = StdRng::seed_from_u64(1);
    for l in [0.3f64, 1.02, 1.5, 6.0, 40.0, 900.0] {
        let slice = Slice::new(table(), l);
        let rows: Vec<[f32; 4]> = (0..3000)
            .map(|i| {
                // Half of the points of a camera inside are inside too, where the age of light decides which of two rays it is.
                let both = l < 1.0 && i % 2 == 0;
                let inside = l + (0.999 - l) * random.random::<f64>();
                let r = if both { inside } else { (1.001f64.ln() + random.random::<f64>() * (3000f64 / 1.001).ln()).exp() };
                let phi = std::f64::consts::PI * random.random::<f64>();
                let (order, phi) = if both { (1, 0.4 * phi) } else { (1 + i % 3, phi) };
                [(r * phi.cos() - l) as f32, (r * phi.sin()) as f32, order as f32, if i % 4 == 0 { OLD } else { YOUNG }]
            })
            .collect();
        let out = run(Pass::Vertices, body, [slice.texels(), &[]], &rows, 2);
        let mut seen = 0;
        for (row, pair) in rows.iter().zip(out.chunks_exact(2)) {
            let want = lens_lookup_aged(&slice, row[0], row[1], slice.camera.l + row[0], row[2] as u32, row[3]);
            let (a, b) = (pair[0], pair[1]);
            // Inside, near the fold of the image at E = 0, a direction goes as the root of what the last place of a sine is worth.
            let fold = if l < 1.0 && row[3] != YOUNG || want.energy.abs() < 1.0 { 20.0 } else { 1.0 };
            assert_eq!(b[3] == 1.0, want.valid, "L = {l}, row {row:?}");
            if !want.valid {
                continue;
            }
            seen += 1;
            for (name, got, want, relative) in [
                ("cos ψ", a[0], want.cos_psi, 2e-5 * fold),
                ("sin ψ", a[1], want.sin_psi, 2e-5 * fold),
                ("delay", a[2], want.delay, 2e-4),
                ("frequency", a[3], want.frequency, 1e-3),
                ("frequency at the point", b[2], want.emission_frequency, 2e-2),
            ] {
                assert!(close(got, want, relative), "L = {l}, row {row:?}: {name} is {got} on the GPU, {want} in Rust");
            }
        }
        assert!(seen > 1500, "only {seen} points were seen at L = {l}");
    }
}

#[test]
fn the_sky_is_the_same_in_both_languages() {
    let body = "#import lensrunner::sky::table::{sky_seen, sky_swept}
    twin_out[id.x] = vec4<f32>(sky_swept(row.x), sky_seen(row.y));";
    for l in [0.5, 1.1, 8.0] {
        let table = sky_table(l);
        let rows: Vec<[f32; 4]> = (0..500).map(|k| [0.023 * k as f32, 0.0188 * k as f32, 0.0, 0.0]).collect();
        let out = run(Pass::Background, body, [&[], &table], &rows, 1);
        for (row, got) in rows.iter().zip(out) {
            let want = [sky_swept(&table, row[0]), sky_seen(&table, row[1])].concat();
            for k in 0..4 {
                assert!(close(got[k], want[k], 1e-5), "L = {l}, row {row:?}, value {k}: {} on the GPU, {} in Rust", got[k], want[k]);
            }
        }
    }
}

#[test]
fn the_milky_way_has_its_colours_in_both_languages() {
    let body = "#import lensrunner::gpu::bindings::sky_slice
    twin_out[id.x] = vec4<f32>(panorama_light(row.x, PANORAMA_FAINT, PANORAMA_BRIGHT), textureLoad(sky_slice, vec2<u32>(0u), 0).x);";
    let tints = milky_way::tints();
    let rows: Vec<[f32; 4]> = (0..=50).map(|k| [k as f32 / 50.0, 0.0, 0.0, 0.0]).collect();
    for (row, got) in rows.iter().zip(run(Pass::Background, body, [&[], &[[1.0; 4]]], &rows, 1)) {
        let want = milky_way::light(row[0] * row[0], &tints);
        for c in 0..3 {
            assert!(close(got[c], want[c], 1e-5), "{row:?}: {got:?} on the GPU, {want:?} in Rust, of {tints:?}");
        }
    }
}

/// The Milky Way lies among the stars as its file says: neither mirrored nor turned.
#[test]
fn the_panorama_is_the_same_in_both_languages() {
    let body = "#import lensrunner::gpu::bindings::sky_slice
#import lensrunner::sky::direction::panorama_place
    twin_out[id.x] = vec4<f32>(panorama_place(row.xyz), 0.0 * textureLoad(sky_slice, vec2<u32>(0u), 0).xy);";
    let mut random = StdRng::seed_from_u64(5);
    let directions: Vec<glam::Vec3> =
        (0..300).map(|_| glam::Vec3::from_array(std::array::from_fn(|_| random.random_range(-1.0..1.0))).normalize()).collect();
    let rows: Vec<[f32; 4]> = directions.iter().map(|d| d.extend(0.0).to_array()).collect();
    let out = run(Pass::Background, body, [&[], &[[1.0; 4]]], &rows, 1);
    for (direction, got) in directions.iter().zip(out) {
        let want = milky_way::direction_to_uv(*direction);
        let across = (got[0] - want.x).rem_euclid(1.0);
        assert!(across.min(1.0 - across) < 1e-5 && (got[1] - want.y).abs() < 1e-4, "{direction}: {got:?}, not {want}");
    }
}

#[test]
fn coverage_is_the_same_in_both_languages_and_right_on_average() {
    use lensrunner::render::post_process::coverage::{before_later, covered, overfull};
    let body = "#import lensrunner::post_process::coverage::coverage_sign
    twin_out[id.x] = vec4<f32>(covered(row.x, row.y), coverage_sign(id.x), before_later(row.x / 3.0, row.y), overfull(row.x, row.y));";
    let mut random = StdRng::seed_from_u64(9);
    let rows: Vec<[f32; 4]> = (0..4000u32)
        .map(|i| {
            let sum = 3.0 * random.random::<f32>();
            [sum, sum * random.random_range(-1.0..1.0f32), (i / 3) as f32, (1 + i % 3) as f32]
        })
        .collect();
    let out = run(Pass::Compose, body, [&[], &[]], &rows, 1);
    for (row, got) in rows.iter().zip(&out) {
        let want = covered(row[0], row[1]);
        assert!(close(got[0], want, 2e-4), "{row:?}: {} on the GPU, {want} in Rust", got[0]);
        let want = overfull(row[0], row[1]);
        assert!(close(got[3], want, 2e-4), "{row:?}: {} on the GPU, {want} in Rust", got[3]);
        let want = before_later(row[0] / 3.0, row[1]);
        assert!(close(got[2], want, 2e-4), "{row:?}: {} on the GPU, {want} in Rust", got[2]);
    }
    // Of two parts of an image, one laid over the other, each keeps its own.
    for [part, later] in [[0.3, 0.5], [0.0, 0.4], [0.4, 0.6], [0.2, 0.0]] {
        assert!((before_later(part, later) * (1.0 - later) - part).abs() < 1e-6, "{part} before {later}");
    }
    // One image alone covers what its triangles add up to; the signs are even.
    assert!([0.1f32, 0.7, 1.0, 1.3].iter().all(|&c| (covered(c, -c) - c.min(1.0)).abs() < 1e-6));
    assert_eq!(covered(0.0, 0.0), 0.0);
    // What they add up to beyond that is light.
    assert_eq!([0.7f32, 1.3, 5.0].map(|c| overfull(c, c)), [1.0, 1.3, 2.0]);
    let plus = out.iter().filter(|got| got[1] > 0.0).count();
    assert!((1800..2200).contains(&plus), "{plus} of 4000 signs are plus");
    // Images that know nothing of each other leave free the product of what each does.
    for coverages in [vec![0.5f32, 0.5], vec![0.3, 0.6, 0.2], vec![0.2; 8]] {
        let sum: f32 = coverages.iter().sum();
        let free: f32 = coverages.iter().map(|c| 1.0 - c).product();
        let count = 1 << coverages.len();
        let mean = (0..count)
            .map(|signs: u32| {
                covered(sum, (0..coverages.len()).map(|k| if signs >> k & 1 == 0 { coverages[k] } else { -coverages[k] }).sum())
            })
            .sum::<f32>()
            / count as f32;
        assert!((mean - (1.0 - free)).abs() < 0.08, "{coverages:?}: {mean}, not {}", 1.0 - free);
    }
}

#[test]
fn hidden_parts_count_the_same_in_both_languages() {
    use glam::Vec3;
    use lensrunner::render::models::hiding::{direction_of, seen_part};
    let body = "#import lensrunner::models::hiding::{direction_of, seen_part}
    let outward = select(vec3<f32>(0.0), direction_of(vec2<u32>(u32(row.w) % 11u, u32(row.w) / 11u)), row.w >= 0.0);
    let k = id.x % 121u;
    let seen_from = vec4<u32>(id.x * 2654435761u, id.x * 2246822519u, id.x * 3266489917u, id.x * 668265263u);
    twin_out[id.x] = vec4<f32>(direction_of(vec2<u32>(k % 11u, k / 11u)), seen_part(seen_from, outward, row.xyz));";
    let mut random = StdRng::seed_from_u64(12);
    let rows: Vec<[f32; 4]> = (0..2000)
        .map(|k| {
            let direction = Vec3::from_array(std::array::from_fn(|_| random.random_range(-1.0..1.0f32))).normalize_or(Vec3::X);
            [direction.x, direction.y, direction.z, (k % 122) as f32 - 1.0]
        })
        .collect();
    let out = run(Pass::Mesh, body, [&[], &[]], &rows, 1);
    for (k, (row, got)) in rows.iter().zip(&out).enumerate() {
        let outward = if row[3] >= 0.0 { direction_of(row[3] as u32) } else { Vec3::ZERO };
        let seen_from = [2_654_435_761, 2_246_822_519, 3_266_489_917, 668_265_263].map(|step: u32| step.wrapping_mul(k as u32));
        let want = seen_part(seen_from, outward, Vec3::new(row[0], row[1], row[2]));
        assert!(close(got[3], want, 1e-4), "{row:?}: {} on the GPU, {want} in Rust", got[3]);
        assert!(Vec3::new(got[0], got[1], got[2]).distance(direction_of(k as u32 % 121)) < 1e-6, "direction {}", k % 121);
    }
}
