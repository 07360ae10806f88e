//! ꟻLIP, the difference that an eye sees between two pictures shown in turn: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and
//! Fairchild, *FLIP: A Difference Evaluator for Alternating Images*, Proc. ACM Comput. Graph. Interact. Tech. 3(2) 2020, article 15.
//! Sections and constants below are those of the paper; pictures come in as linear light.

use rayon::prelude::*;

/// Pixels for one degree of the field of view: a screen 0.7 m wide with 3,840 pixels, seen from 0.7 m (section 4.1).
const PIXELS_PER_DEGREE: f64 = 67.020_643_276_582_25;

/// Exponent of the colour difference (section 4.1.3).
const COLOUR_POWER: f64 = 0.7;
/// Where the colour difference is bent, as a part of the greatest, and what it becomes there (section 4.1.3).
const BEND: (f64, f64) = (0.4, 0.95);
/// Exponent of the feature difference (section 4.2).
const FEATURE_POWER: f64 = 0.5;
/// Width of the feature detectors, in degrees (section 4.2).
const FEATURE_WIDTH: f64 = 0.082;

/// XYZ of the white of linear sRGB, D65.
const WHITE: [f64; 3] = [0.950_428_545, 1.0, 1.088_900_371];

/// The difference of each pixel, 0 to 1, between two pictures of `size` pixels in linear sRGB; light outside [0, 1] is cut off.
pub fn flip(reference: &[[f32; 3]], test: &[[f32; 3]], size: [u32; 2]) -> Vec<f32> {
    let [a, b] = [reference, test].map(|light| Seen::new(light, size));
    let greatest = hyab(hunt([0.0, 1.0, 0.0]), hunt([0.0, 0.0, 1.0])).powf(COLOUR_POWER);
    (0..a.lab.len())
        .into_par_iter()
        .map(|i| {
            let colour = bend(hyab(a.lab[i], b.lab[i]).powf(COLOUR_POWER), greatest);
            let feature = (a.edges[i] - b.edges[i]).abs().max((a.points[i] - b.points[i]).abs());
            let feature = (feature / std::f64::consts::SQRT_2).powf(FEATURE_POWER);
            colour.powf(1.0 - feature.min(1.0)) as f32
        })
        .collect()
}

/// The mean difference of two pictures, by [`flip`].
pub fn mean_flip(reference: &[[f32; 3]], test: &[[f32; 3]], size: [u32; 2]) -> f64 {
    let differences = flip(reference, test, size);
    differences.iter().map(|difference| f64::from(*difference)).sum::<f64>() / differences.len().max(1) as f64
}

/// What of a picture is compared.
struct Seen {
    /// CIELAB after the eye's blur, with Hunt's adjustment.
    lab: Vec<[f64; 3]>,
    /// Strength of edges and of points.
    edges: Vec<f64>,
    points: Vec<f64>,
}

impl Seen {
    fn new(light: &[[f32; 3]], size: [u32; 2]) -> Seen {
        let opponent: Vec<[f64; 3]> = light.par_iter().map(|rgb| to_opponent(to_xyz(rgb.map(|c| f64::from(c).clamp(0.0, 1.0))))).collect();
        let plane = |k: usize| Plane { size: size.map(|side| side as usize), values: opponent.iter().map(|c| c[k]).collect() };
        let planes = [plane(0), plane(1), plane(2)];
        // Contrast sensitivity: sums of Gaussians for the three opponent channels (section 4.1.1, table 1).
        let sensitivity: [&[(f64, f64)]; 3] = [&[(1.0, 0.0047)], &[(1.0, 0.0053)], &[(34.1, 0.04), (13.5, 0.025)]];
        let blurred: Vec<Plane> = planes.iter().zip(sensitivity).map(|(plane, terms)| blur(plane, terms)).collect();
        let lab =
            (0..opponent.len()).into_par_iter().map(|i| hunt(to_rgb(from_opponent([0, 1, 2].map(|k| blurred[k].values[i]))))).collect();
        let grey = Plane { values: planes[0].values.iter().map(|y| (y + 16.0) / 116.0).collect(), ..planes[0].clone() };
        let [edges, points] = features(&grey);
        Seen { lab, edges, points }
    }
}

fn bend(difference: f64, greatest: f64) -> f64 {
    let (part, value) = BEND;
    let knee = part * greatest;
    if difference < knee { value / knee * difference } else { value + (difference - knee) / (greatest - knee) * (1.0 - value) }
}

/// The distance of two colours in L*a*b*: along lightness plus within the plane of hues.
fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// Linear sRGB, cut to [0, 1], as L*a*b* with the hues of dark colours drawn together (section 4.1.2).
fn hunt(rgb: [f64; 3]) -> [f64; 3] {
    let xyz = to_xyz(rgb.map(|c| c.clamp(0.0, 1.0)));
    let [x, y, z] = [0, 1, 2].map(|k| {
        let t: f64 = xyz[k] / WHITE[k];
        let d: f64 = 6.0 / 29.0;
        if t > d.powi(3) { t.cbrt() } else { t / (3.0 * d * d) + 4.0 / 29.0 }
    });
    let lightness = 116.0 * y - 16.0;
    [lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)]
}

fn to_xyz([r, g, b]: [f64; 3]) -> [f64; 3] {
    [
        0.412_390_80 * r + 0.357_584_34 * g + 0.180_480_79 * b,
        0.212_639_01 * r + 0.715_168_68 * g + 0.072_192_32 * b,
        0.019_330_82 * r + 0.119_194_78 * g + 0.950_532_15 * b,
    ]
}

fn to_rgb([x, y, z]: [f64; 3]) -> [f64; 3] {
    [
        3.240_969_94 * x - 1.537_383_18 * y - 0.498_610_76 * z,
        -0.969_243_64 * x + 1.875_967_50 * y + 0.041_555_06 * z,
        0.055_630_08 * x - 0.203_976_96 * y + 1.056_971_51 * z,
    ]
}

/// The linear opponent space YCxCz.
fn to_opponent(xyz: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = [0, 1, 2].map(|k| xyz[k] / WHITE[k]);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn from_opponent([l, cx, cz]: [f64; 3]) -> [f64; 3] {
    let y = (l + 16.0) / 116.0;
    [(y + cx / 500.0) * WHITE[0], y * WHITE[1], (y - cz / 200.0) * WHITE[2]]
}

/// One channel of a picture.
#[derive(Clone)]
struct Plane {
    size: [usize; 2],
    values: Vec<f64>,
}

impl Plane {
    /// Convolved with a row of weights across and one down; held at the edges.
    fn convolved(&self, across: &[f64], down: &[f64]) -> Plane {
        let [width, height] = self.size;
        let pass = |source: &[f64], weights: &[f64], step: usize, place: fn(usize, usize) -> usize, length: usize| -> Vec<f64> {
            let reach = (weights.len() / 2) as i64;
            (0..source.len())
                .into_par_iter()
                .map(|i| {
                    let here = place(i, width) as i64;
                    weights
                        .iter()
                        .zip(-reach..)
                        .map(|(w, k)| {
                            let there = (here + k).clamp(0, length as i64 - 1);
                            w * source[(i as i64 + (there - here) * step as i64) as usize]
                        })
                        .sum()
                })
                .collect()
        };
        let rows = pass(&self.values, across, 1, |i, width| i % width, width);
        Plane { size: self.size, values: pass(&rows, down, width, |i, width| i / width, height) }
    }
}

/// The blur of the eye: Gaussians a√(π/b) exp(−π²x²/b) over x in degrees, each separable, together of weight 1.
fn blur(plane: &Plane, terms: &[(f64, f64)]) -> Plane {
    let widest = terms.iter().map(|term| term.1).fold(0.0, f64::max);
    let reach = (3.0 * (widest / (2.0 * std::f64::consts::PI.powi(2))).sqrt() * PIXELS_PER_DEGREE).ceil() as i64;
    let mut sum = vec![0.0; plane.values.len()];
    let mut total = 0.0;
    for &(a, b) in terms {
        let kernel: Vec<f64> =
            (-reach..=reach).map(|k| (-(std::f64::consts::PI * k as f64 / PIXELS_PER_DEGREE).powi(2) / b).exp()).collect();
        let weight = kernel.iter().sum::<f64>().powi(2) * a * std::f64::consts::PI / b;
        let scale = a * std::f64::consts::PI / b;
        total += weight;
        for (sum, value) in sum.iter_mut().zip(plane.convolved(&kernel, &kernel).values) {
            *sum += scale * value;
        }
    }
    Plane { size: plane.size, values: sum.into_iter().map(|value| value / total).collect() }
}

/// Strength of edges and of points: first and second derivatives of a Gaussian (section 4.2).
fn features(grey: &Plane) -> [Vec<f64>; 2] {
    let sigma = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE;
    let reach = (3.0 * sigma).ceil() as i64;
    let gauss = |k: i64| (-(k as f64).powi(2) / (2.0 * sigma * sigma)).exp();
    let smooth: Vec<f64> = (-reach..=reach).map(gauss).collect();
    let total: f64 = smooth.iter().sum();
    let smooth: Vec<f64> = smooth.iter().map(|w| w / total).collect();
    // Positive weights sum to 1, negative ones to −1.
    let balanced = |raw: Vec<f64>| {
        let positive: f64 = raw.iter().filter(|w| **w > 0.0).sum();
        let negative: f64 = -raw.iter().filter(|w| **w < 0.0).sum::<f64>();
        raw.into_iter().map(|w| if w > 0.0 { w / positive } else { w / negative }).collect::<Vec<f64>>()
    };
    let first = balanced((-reach..=reach).map(|k| -(k as f64) * gauss(k)).collect());
    let second = balanced((-reach..=reach).map(|k| ((k as f64 / sigma).powi(2) - 1.0) * gauss(k)).collect());
    [first, second].map(|kernel| {
        let x = grey.convolved(&kernel, &smooth);
        let y = grey.convolved(&smooth, &kernel);
        x.values.iter().zip(&y.values).map(|(x, y)| x.hypot(*y)).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(rgb: [f32; 3]) -> Vec<[f32; 3]> {
        vec![rgb; 32 * 24]
    }

    fn mean(a: &[[f32; 3]], b: &[[f32; 3]]) -> f64 {
        mean_flip(a, b, [32, 24])
    }

    #[test]
    fn nothing_differs_from_itself_and_blue_from_green_most() {
        let picture: Vec<[f32; 3]> = (0..32 * 24).map(|i| [(i % 7) as f32 / 7.0, (i % 5) as f32 / 5.0, 0.3]).collect();
        assert_eq!(mean(&picture, &picture), 0.0);
        let (green, blue) = (plain([0.0, 1.0, 0.0]), plain([0.0, 0.0, 1.0]));
        // The blur of a plain picture changes nothing, so the greatest colour difference is met: 1.
        assert!((mean(&green, &blue) - 1.0).abs() < 1e-6);
        // The paper's own constant for it (c_max^0.7, from its published evaluator): 41.2760.
        assert!((hyab(hunt([0.0, 1.0, 0.0]), hunt([0.0, 0.0, 1.0])).powf(COLOUR_POWER) - 41.2760).abs() < 1e-2);
    }

    #[test]
    fn it_grows_with_the_difference_and_is_the_same_both_ways() {
        let base = plain([0.2, 0.2, 0.2]);
        let values: Vec<f64> = [0.21, 0.25, 0.4, 1.0].map(|x| mean(&base, &plain([x; 3]))).to_vec();
        assert!(values.windows(2).all(|pair| pair[0] < pair[1]), "{values:?}");
        assert!(values[0] > 0.005 && values[3] < 1.0, "{values:?}");
        assert_eq!(mean(&base, &plain([0.4; 3])), mean(&plain([0.4; 3]), &base));
    }

    #[test]
    fn a_moved_edge_shows_where_it_moved() {
        let edge = |at: usize| -> Vec<[f32; 3]> { (0..32 * 24).map(|i| [f32::from(i % 32 >= at); 3]).collect() };
        let map = flip(&edge(16), &edge(18), [32, 24]);
        let column = |x: usize| map[12 * 32 + x];
        assert!(column(17) > 0.5 && column(2) < 0.05 && column(30) < 0.05, "{} {} {}", column(17), column(2), column(30));
    }
}
