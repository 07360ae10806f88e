//! Stars, Milky Way and black-body colours against published values.

use glam::{Vec2, Vec3};
use lensrunner::scene::blackbody;
use lensrunner::scene::sky::{milky_way, stars};

fn towards(ra_degrees: f64, dec_degrees: f64) -> Vec3 {
    let (ra, dec) = (ra_degrees.to_radians(), dec_degrees.to_radians());
    Vec3::new((dec.cos() * ra.cos()) as f32, (dec.cos() * ra.sin()) as f32, dec.sin() as f32)
}

#[test]
fn the_catalogue_is_whole_and_sirius_the_brightest() {
    let stars = stars::load(&crate::support::root().join("assets/sky/stars.bin")).unwrap();
    assert_eq!(stars.len(), 117_955);
    assert!(stars.windows(2).all(|pair| pair[0].flux >= pair[1].flux));
    assert!(
        stars.iter().all(|star| (star.direction.length() - 1.0).abs() < 1e-6 && star.temperature > 2000.0 && star.temperature < 40_000.0)
    );
    // Sirius, ICRS at epoch 1991.25 (SIMBAD): 06h 45m 09.25s, −16° 42′ 47″; B−V = 0.01, effective temperature 9,940 K.
    let sirius = stars[0];
    assert!(sirius.direction.distance(towards(101.288_54, -16.713_14)) < 2e-5, "{:?}", sirius.direction);
    assert!((sirius.flux - 2.72).abs() < 0.02, "{}", sirius.flux);
    assert!((sirius.temperature / 9940.0 - 1.0).abs() < 0.06, "{}", sirius.temperature);
    // Betelgeuse is among the twenty brightest and red (3,600 K; B−V of so cool a star is reddened, hence the width).
    let betelgeuse = stars[..20].iter().find(|star| star.direction.distance(towards(88.792_94, 7.407_06)) < 1e-4).unwrap();
    assert!((betelgeuse.temperature - 3500.0).abs() < 300.0, "{}", betelgeuse.temperature);
}

#[test]
fn the_sun_has_its_temperature() {
    // B−V = 0.653 (Ramírez et al. 2012), effective temperature 5,772 K (IAU 2015).
    assert!((stars::temperature(0.653) - 5772.0).abs() < 60.0);
}

#[test]
fn a_damaged_catalogue_is_refused_by_reason() {
    let folder = crate::support::Folder::new();
    let path = folder.path().join("stars.bin");
    let whole = std::fs::read(crate::support::root().join("assets/sky/stars.bin")).unwrap();
    let refused = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        stars::load(&path).unwrap_err().to_string()
    };
    let changed = |at: usize| {
        let mut bytes = whole.clone();
        bytes[at] ^= 1;
        bytes
    };
    assert!(refused(&whole[..10]).contains("10 bytes"));
    assert!(refused(&changed(0)).contains("no star file"));
    assert!(refused(&changed(8)).contains("version 0"));
    assert!(refused(&whole[..whole.len() - 1]).contains("117955 stars"));
    assert!(refused(&changed(5000)).contains("checksum"));
    std::fs::remove_file(&path).unwrap();
    assert!(stars::load(&path).unwrap_err().to_string().contains("stars.bin"));
}

#[test]
fn the_milky_way_lies_where_it_does() {
    let (sky, error) = milky_way::load_or_dark();
    assert!(error.is_none(), "{error:?}");
    assert_eq!((sky.levels[0].width, sky.levels[0].height), (2048, 1024));
    assert_eq!((sky.levels.last().unwrap().width, sky.levels.last().unwrap().height), (1, 1));
    let at = |ra, dec| sky.sample(towards(ra, dec), 3);
    let (pole, bulge) = (at(192.86, 27.13), at(270.9, -28.5));
    assert!(bulge > 0.3 && pole < 0.02, "galactic pole {pole}, Sagittarius star cloud {bulge}");
    for (place, ra, dec) in [("Cygnus", 305.0, 40.0), ("Carina", 161.0, -59.0), ("Scutum", 280.0, -6.0)] {
        assert!(at(ra, dec) > 4.0 * pole, "{place}: {}", at(ra, dec));
    }
    // The Coalsack is darker than the band on both sides of it.
    assert!(at(193.0, -63.0) < 0.8 * at(161.0, -59.0));
}

#[test]
fn the_milky_way_has_no_seam_and_no_steps() {
    let sky = milky_way::load_or_dark().0;
    let level = &sky.levels[0];
    let pixel = |row: usize, column: usize| level.brightness[row * level.width + column];
    for row in 0..level.height {
        let across = (pixel(row, 0) - pixel(row, level.width - 1)).abs();
        assert!(across < 0.02, "seam in row {row}: {across}");
    }
    // A contour left sharp would be a step of half the light there and more.
    for row in 1..level.height {
        for column in 0..level.width {
            let (here, above) = (pixel(row, column), pixel(row - 1, column));
            assert!((here - above).abs() < 0.01 + 0.13 * here.max(above), "step at row {row}, column {column}: {above} to {here}");
        }
    }
}

#[test]
fn smaller_copies_keep_the_light() {
    let sky = milky_way::load_or_dark().0;
    let mean = |level: &milky_way::Level| {
        let weight = |row: usize| (std::f64::consts::PI * (row as f64 + 0.5) / level.height as f64).sin();
        let (mut total, mut weights) = (0.0, 0.0);
        for row in 0..level.height {
            total += weight(row) * level.brightness[row * level.width..][..level.width].iter().map(|&b| f64::from(b)).sum::<f64>();
            weights += weight(row) * level.width as f64;
        }
        total / weights
    };
    let full = mean(&sky.levels[0]);
    assert!((mean(&sky.levels[6]) / full - 1.0).abs() < 0.01);
}

#[test]
fn direction_and_picture_agree() {
    for (direction, uv) in [
        (Vec3::X, Vec2::new(0.0, 0.5)),
        (Vec3::Y, Vec2::new(0.25, 0.5)),
        (Vec3::NEG_Y, Vec2::new(0.75, 0.5)),
        (Vec3::new(0.6, 0.0, 0.8), Vec2::new(0.0, 0.204_832_76)),
    ] {
        assert!(milky_way::direction_to_uv(direction).distance(uv) < 1e-6);
    }
    assert_eq!(milky_way::direction_to_uv(Vec3::Z).y, 0.0);
}

#[test]
fn black_bodies_have_their_published_light() {
    // The candela's old definition: platinum at its freezing point, 2041.4 K, has 60 cd/cm².
    let platinum = blackbody::blackbody_xyz(2041.4)[1];
    assert!((platinum / 6.0e5 - 1.0).abs() < 0.01, "{platinum}");
    // CIE standard illuminant A is a black body at 2,856 K with x = 0.44758, y = 0.40745; the fits are good to 0.003.
    let [x, y, z] = blackbody::blackbody_xyz(2856.0);
    let sum = x + y + z;
    assert!((x / sum - 0.447_58).abs() < 0.004 && (y / sum - 0.407_45).abs() < 0.004, "{} {}", x / sum, y / sum);
    // 6,504 K on the Planckian locus is within 0.006 of D65 (x = 0.3127, y = 0.3290), so nearly white.
    let rgb = blackbody::blackbody_rgb(6504.0);
    let luminance = blackbody::luminance(rgb);
    assert!(rgb.iter().all(|channel| (channel / luminance - 1.0).abs() < 0.06), "{rgb:?}");
    assert!((blackbody::luminance(blackbody::blackbody_rgb(5772.0)) - 1.0).abs() < 1e-5);
}

#[test]
fn colder_is_redder_and_darker() {
    let mut last = (f64::INFINITY, f64::INFINITY);
    for step in 0..40 {
        let temperature = 40_000.0 * 0.9f64.powi(step);
        let [r, g, b] = blackbody::blackbody_rgb(temperature);
        let now = (blackbody::luminance([r, g, b]), b / r);
        // Below 1,000 K both green and blue leave sRGB, and what is brought in has no meaning but "deep red".
        assert!(now.0 < last.0 && (now.1 <= last.1 || temperature < 1000.0) && r >= 0.0 && g >= 0.0 && b >= 0.0, "{temperature} K");
        last = now;
    }
    assert_eq!(blackbody::blackbody_rgb(f64::NAN), [0.0; 3]);
    assert_eq!(blackbody::blackbody_rgb(-5.0), [0.0; 3]);
}

#[test]
fn the_table_keeps_to_the_integral() {
    let (coldest, hottest) = (200.0, 2.0e6);
    let table = blackbody::table(512, coldest, hottest);
    for step in 0..580 {
        let temperature = 310.0 * 1.015_f64.powi(step);
        let exact = blackbody::blackbody_rgb(temperature);
        let near = blackbody::lookup(&table, coldest, hottest, temperature as f32).map(f64::from);
        // Linear interpolation of ln Y, which bends as c₂/(λT): h²/8 · 26,000 K/T with h = 0.018 is 0.4 % at 300 K. A channel that
        // leaves sRGB is zero, in the table a ten-thousandth; between the two entries at its end it is off by 0.1 % of the luminance.
        let scale = blackbody::luminance(exact);
        for (a, b) in exact.iter().zip(near) {
            assert!((a - b).abs() < 0.005 * scale.max(*a), "{temperature} K: {exact:?} against {near:?}");
        }
    }
    assert_eq!(blackbody::lookup(&table, coldest, hottest, 1.0), blackbody::lookup(&table, coldest, hottest, coldest));
}
