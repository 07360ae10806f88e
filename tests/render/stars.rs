//! The way of the stars by itself: how a sky of stars is exposed.

use lensrunner::spacetime::Observer;

use glam::{DQuat, DVec3};
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::readback::ReadbackPicture;
use lensrunner::render::gpu::types::Star;
use lensrunner::render::renderer::Surroundings;
use lensrunner::render::settings::Settings;

use crate::render::support::renderer_under;
use crate::support::shared_table;

/// A picture of these stars before a Milky Way of even brightness `haze`, from far away.
fn picture(stars: &[Star], haze: f32, camera: Observer, size: [u32; 2], settings: Settings) -> ReadbackPicture {
    let surroundings = Surroundings { table: shared_table(), stars: stars.to_vec(), milky_way: vec![(1, 1, vec![haze])] };
    let mut renderer = renderer_under(&surroundings, size);
    let input = FrameInput { camera, time: 0.0, placed: Vec::new(), held: None, aurora: None, settings };
    renderer.picture(&input, false).unwrap()
}

fn star(direction: DVec3, flux: f32) -> Star {
    let d = direction.normalize();
    Star { direction: d.as_vec3().to_array(), flux, temperature: 5772.0, luminance: 0.0, unused: [0.0; 2] }
}

/// A camera 10⁵ r_s away that looks along −z, across the direction of the hole.
fn far_camera(momentum: DVec3) -> Observer {
    Observer { position: DVec3::new(1e5, 0.0, 0.0), momentum, attitude: DQuat::IDENTITY, field_of_view: 60f64.to_radians() }
}

/// What a sky of bright stars does to the exposure does not depend on the size of the picture: the haze between them is finished alike. In
/// cells of a part of the picture's width stars weigh as they are, but for what each halving spreads them; pixel by pixel, their spots
/// would be brighter in a finer picture, and the haze darker by a factor of 3.5.
#[test]
fn stars_are_metered_alike_in_pictures_of_any_size() {
    let stars: Vec<Star> = (0..400)
        .map(|k| {
            // A spiral over the sphere.
            let z = 1.0 - (f64::from(k) + 0.5) / 200.0;
            let (sine, cosine) = (2.399_963 * f64::from(k)).sin_cos();
            star(DVec3::new((1.0 - z * z).sqrt() * cosine, (1.0 - z * z).sqrt() * sine, z), 0.1)
        })
        .collect();
    let settings = Settings { bloom: 0.0, exposure_range: [1e-9, 1e9], sky_brightness: 1.0, star_brightness: 1.0, ..Settings::finest() };
    let haze = |size: [u32; 2]| -> f64 {
        let picture = picture(&stars, 0.05, far_camera(DVec3::ZERO), size, settings);
        let mut green: Vec<u8> = picture.display.chunks_exact(4).map(|pixel| pixel[1]).collect();
        green.sort_unstable();
        let value = f64::from(green[green.len() / 2]) / 255.0;
        println!("{size:?}: haze at {value}");
        assert!((0.1..0.9).contains(&value), "the haze is finished to {value}, which tells nothing of the exposure");
        value
    };
    let [coarse, fine] = [haze([320, 180]), haze([1280, 720])];
    assert!((0.7..1.4).contains(&(fine / coarse)), "the haze is {coarse:.3} of white in a coarse picture and {fine:.3} in a fine one");
}
