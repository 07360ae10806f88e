//! How points of the aurora's experiment become a picture: the pyramid against plain sums, its memory, and threads.

use lensrunner_lab::aurora::engine::draw::{Job, Tables, VARIANTS, draw};
use lensrunner_lab::aurora::engine::lattice::Lattice;
use lensrunner_lab::aurora::engine::points::{Point, Points};
use lensrunner_lab::aurora::engine::pyramid::Pyramid;
use lensrunner_lab::aurora::engine::shares::Shares;
use lensrunner_lab::aurora::engine::splat::{Gaussian, Picture, Splat};
use lensrunner_lab::aurora::engine::walk::{Method, Walker};
use lensrunner_lab::aurora::experiment::View;
use lensrunner_lab::aurora::sheet::{Falls, Sheet, Streak};
use std::sync::LazyLock;

use crate::aurora::engine::walk::{FALLS_TABLE, all_points};
use crate::support::table;

static SHARES: LazyLock<Shares> = LazyLock::new(Shares::default);

#[test]
fn the_table_of_the_gaussian_is_the_gaussian() {
    let eye = View::Side.eye([192, 108], table());
    let found = all_points(Method::Exact, &eye, &Sheet::numbered(0).streaks(200)).concat();
    let draw = |table: bool| {
        let mut picture = Picture::new(eye.size);
        picture.add(&found.iter().copied().collect(), &FALLS_TABLE, Splat { radius: 8.0, table }, &Gaussian::default());
        picture
    };
    // 128 entries a standard deviation: half an entry is 0.4 % of slope at most.
    assert!(draw(true).error(&draw(false)) < 0.01);
}

/// The sum of Gaussians itself, without cut-off or table; standard deviations from half a pixel to 40.
fn direct_sum(size: [usize; 2], points: &[Point], radius: f64) -> Picture {
    let mut picture = Picture::new(size);
    let mut sums = vec![[0.0f64; 4]; size[0] * size[1]];
    for point in points {
        let sigma = (radius * f64::from(point.scale)).clamp(0.5, 40.0);
        let light = FALLS_TABLE.light[point.level as usize].map(|line| {
            f64::from(line) * f64::from(point.count) * f64::from(point.scale).powi(2) / (std::f64::consts::TAU * sigma * sigma)
        });
        let side = |centre: f32, side: usize| -> Vec<(usize, f64)> {
            let at = |k: usize| (k as f64 + 0.5 - f64::from(centre)) / sigma;
            (0..side).filter(|&k| at(k).abs() < 5.0).map(|k| (k, (-0.5 * at(k).powi(2)).exp())).collect()
        };
        let columns = side(point.x, size[0]);
        for (y, g) in side(point.y, size[1]) {
            for (x, h) in &columns {
                (0..4).for_each(|line| sums[y * size[0] + x][line] += light[line] * g * h);
            }
        }
    }
    for (pixel, sum) in picture.pixels.iter_mut().zip(sums) {
        *pixel = sum.map(|light| light as f32);
    }
    picture
}

pub fn by_pyramid(size: [usize; 2], points: &[Point], radius: f32) -> Picture {
    let mut pyramid = Pyramid::new(size);
    pyramid.add(&points.iter().copied().collect(), &FALLS_TABLE, radius, &SHARES);
    pyramid.picture()
}

/// The greatest difference in any line over the greatest light in that line.
fn worst(got: &Picture, want: &Picture) -> f32 {
    let most = |line: usize| want.pixels.iter().map(|pixel| pixel[line]).fold(0.0, f32::max);
    let most: [f32; 4] = std::array::from_fn(most);
    let pairs = got.pixels.iter().zip(&want.pixels);
    pairs.flat_map(|(a, b)| (0..4).map(move |line| (a[line] - b[line]).abs() / most[line])).fold(0.0, f32::max)
}

#[test]
fn one_splat_of_the_pyramid_is_a_gaussian() {
    // Half-pixel Gaussians vary by 1.4 % along each side with their place, as the pyramid's do not, half a step of the tabulated width is
    // 1.2 % of them, and the cut-off of the narrowest is seen: 6 % of the peak. Where a layer begins, what the humps of its pixels cannot
    // tell is 5.5 %, and half a step of the tabulated place as much as 1 %. A widening of the Gaussian that is not taken off beforehand is
    // 20 %.
    for k in 0..2400 {
        let sigma = 0.5 * 80f32.powf(k as f32 / 2399.0);
        let place = |step: f32| 128.0 + (step * k as f32).fract() * 64.0;
        let point = Point { x: place(0.754_877_7), y: place(0.569_840_3), scale: sigma, count: 3.0, level: 100 };
        let size = [320, 320];
        let (got, want) = (by_pyramid(size, &[point], 1.0), direct_sum(size, &[point], 1.0));
        let off = worst(&got, &want);
        assert!(off < 0.068, "a splat of {sigma} px is off by {off} of its peak");
    }
}

#[test]
fn the_pyramid_keeps_all_light() {
    let radius = 2.0;
    for (k, scale) in [0.1f32, 0.3, 0.7, 1.4, 3.0, 6.0, 15.0].into_iter().enumerate() {
        // A streak of points that overlap, farther than its width from every edge.
        let points: Vec<Point> = (0..50)
            .map(|n| Point { x: 300.3 + 0.37 * n as f32, y: 310.0 - 0.21 * n as f32, scale, count: n as f32, level: 20 + 2 * n })
            .collect();
        let picture = by_pyramid([640, 640], &points, radius);
        for line in 0..4 {
            let got: f64 = picture.pixels.iter().map(|pixel| f64::from(pixel[line])).sum();
            let light = |p: &Point| f64::from(FALLS_TABLE.light[p.level as usize][line]) * f64::from(p.count * p.scale * p.scale);
            let want: f64 = points.iter().map(light).sum();
            // Shares add up to 1 to rounding.
            assert!((got / want - 1.0).abs() < 1e-5, "case {k}, line {line}: {got} of {want}");
        }
    }
}

#[test]
fn the_pyramid_is_the_sum_of_gaussians() {
    // 2 % of the picture's root mean square: a splat's own error (see above), which differs in sign from place to place.
    for (view, name) in View::ALL {
        let eye = view.eye([192, 108], table());
        let found = all_points(Method::Exact, &eye, &Sheet::numbered(3).streaks(200)).concat();
        for radius in [0.5f32, 1.5, 6.0] {
            let want = direct_sum(eye.size, &found, f64::from(radius));
            let got = by_pyramid(eye.size, &found, radius);
            let square = |p: &[f32; 4], q: &[f32; 4]| (0..4).map(|line| f64::from(p[line] - q[line]).powi(2)).sum::<f64>();
            let difference: f64 = got.pixels.iter().zip(&want.pixels).map(|(p, q)| square(p, q)).sum();
            let total: f64 = want.pixels.iter().map(|p| square(p, &[0.0; 4])).sum();
            let off = (difference / total).sqrt();
            assert!(off < 0.02, "{name}, splats of {radius} km: off by {off}");
        }
    }
}

#[test]
fn wider_instructions_change_no_bit() {
    for (view, name) in View::ALL {
        let eye = view.eye([192, 108], table());
        let streaks = Sheet::numbered(5).streaks(300);
        let lattice = Lattice::around(&eye, &streaks, 0.25);
        let walker = Walker::new(&eye, &FALLS_TABLE, Some(&lattice), 3);
        for (method, way) in Method::ALL {
            let (mut wide, mut plain) = (Points::default(), Points::default());
            walker.walk(method, &streaks, &mut wide);
            walker.walk_plainly(method, &streaks, &mut plain);
            assert!(wide.len() > 1000 && wide.iter().eq(plain.iter()), "{name}, {way}: {} and {} points", wide.len(), plain.len());
            let picture = |add: fn(&mut Pyramid, &Points, &Falls, f32, &Shares)| {
                let mut pyramid = Pyramid::new(eye.size);
                // From half a pixel to eight.
                for radius in [0.5, 1.5, 6.0] {
                    add(&mut pyramid, &plain, &FALLS_TABLE, radius, &SHARES);
                }
                pyramid.picture()
            };
            assert!(picture(Pyramid::add) == picture(Pyramid::add_plainly), "{name}, {way}: the pictures differ");
        }
    }
}

#[test]
fn nothing_is_left_in_a_pyramid_that_is_used_again() {
    // Wide splats, which touch other tiles and layers than narrow ones.
    let found = |view: View, number: u32| {
        let eye = view.eye([192, 108], table());
        all_points(Method::Exact, &eye, &Sheet::numbered(number).streaks(100)).concat().into_iter().collect::<Points>()
    };
    let mut pyramid = Pyramid::new([192, 108]);
    pyramid.add(&found(View::Below, 2), &FALLS_TABLE, 9.0, &SHARES);
    for (radius, number) in [(1.0, 4), (20.0, 6), (3.0, 7)] {
        let points = found(View::Orbit, number);
        pyramid.wipe();
        pyramid.add(&points, &FALLS_TABLE, radius, &SHARES);
        let mut fresh = Pyramid::new([192, 108]);
        fresh.add(&points, &FALLS_TABLE, radius, &SHARES);
        assert!(pyramid.picture() == fresh.picture(), "splats of {radius} km");
    }
    pyramid.wipe();
    assert!(pyramid.picture() == Picture::new([192, 108]));
}

#[test]
fn threads_draw_the_picture_of_one() {
    let tables = Tables::default();
    for (view, name) in View::ALL {
        // An odd height and bands that begin within a tile.
        let eye = view.eye([190, 107], table());
        let streaks = Sheet::numbered(3).streaks(300);
        let job = Job { eye: &eye, falls: &FALLS_TABLE, streaks: &streaks, seed: 3, splat: Splat { radius: 3.0, table: true } };
        let picture = |name: &str| draw(*VARIANTS.iter().find(|variant| variant.name == name).unwrap(), &job, &tables).picture;
        for method in ["exact", "particles"] {
            let off = worst(&picture(&format!("{method}-pyramid-threads")), &picture(&format!("{method}-pyramid")));
            // Light is added in another order: thousands of roundings of 6e-8 of what was there.
            assert!(off < 2e-4, "{name}, {method}: off by {off}");
        }
    }
}

#[test]
fn nothing_is_left_of_a_picture_whose_memory_is_used_again() {
    // An odd width, which ends with half a pair; a sheet far out of sight, of which nothing is drawn; and no electron at all.
    let eye = View::Side.eye([189, 107], table());
    let streaks = Sheet::numbered(3).streaks(100);
    let away: Vec<Streak> = streaks.iter().map(|streak| Streak { top: streak.top * 100.0, end: streak.end * 100.0, ..*streak }).collect();
    for streaks in [&streaks[..], &away, &[]] {
        let job = Job { eye: &eye, falls: &FALLS_TABLE, streaks, seed: 3, splat: Splat { radius: 3.0, table: true } };
        for variant in VARIANTS.iter().filter(|variant| variant.method == Method::Exact && !variant.threads) {
            let tables = Tables::default();
            for _ in 0..3 {
                let mut dirty = Picture::new(eye.size);
                dirty.pixels.fill([7.0; 4]);
                tables.take_back(dirty);
            }
            let (used, fresh) = (draw(*variant, &job, &tables).picture, draw(*variant, &job, &Tables::default()).picture);
            assert!(used == fresh, "{}, {} electrons", variant.name, streaks.len());
            assert!(!streaks.is_empty() || fresh == Picture::new(eye.size));
        }
    }
}
