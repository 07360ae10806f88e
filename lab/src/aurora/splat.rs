//! From luminous points to a picture: Gaussians added up.

use super::sheet::Falls;
use super::walk::Point;

/// Photons of each of the four lines per pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct SplatPicture {
    /// Width and height, pixels.
    pub size: [usize; 2],
    /// Row by row.
    pub pixels: Vec<[f32; 4]>,
}

/// Splats reach this many standard deviations; beyond lies 1 % of the light.
pub const REACH: f32 = 3.0;
/// The narrowest splat, pixels: below, light would depend on where in its pixel a point is.
pub const LEAST_SIGMA: f32 = 0.5;
/// The widest, pixels: a point a kilometre before the camera must not take the whole frame's time.
const MOST_SIGMA: f32 = 40.0;
/// Entries of the tabulated Gaussian per standard deviation.
const ENTRIES: usize = 128;

/// The Gaussian of Sekiguchi et al. (equation 6) by distance in standard deviations, without its constant.
#[derive(Clone, Debug)]
pub struct Gaussian(Vec<f32>);

impl Default for Gaussian {
    fn default() -> Self {
        let last = (REACH * ENTRIES as f32) as usize + 1;
        Gaussian((0..=last).map(|k| (-0.5 * (k as f32 / ENTRIES as f32).powi(2)).exp()).collect())
    }
}

impl SplatPicture {
    /// A black one.
    pub fn new(size: [usize; 2]) -> Self {
        SplatPicture { size, pixels: vec![[0.0; 4]; size[0] * size[1]] }
    }

    /// Adds points, each a blob of light of standard deviation `radius` km.
    pub fn add(&mut self, points: &[Point], falls: &Falls, radius: f32, gaussian: &Gaussian) {
        for point in points {
            let sigma = (radius * point.scale).clamp(LEAST_SIGMA, MOST_SIGMA);
            // Light of a point goes as the square of its scale: 1/distance².
            let weight = point.count * point.scale * point.scale / (2.0 * std::f32::consts::PI * sigma * sigma);
            let light = falls.light[point.level as usize].map(|line| line * weight);
            if point.x.is_finite() && point.y.is_finite() && weight.is_finite() {
                self.add_point(point, sigma, light, gaussian);
            }
        }
    }

    /// Pixels from `low` to before `high` along one side.
    fn span(centre: f32, sigma: f32, side: usize) -> (usize, usize) {
        let low = (centre - REACH * sigma - 0.5).ceil().clamp(0.0, side as f32) as usize;
        let high = (centre + REACH * sigma + 0.5).ceil().clamp(0.0, side as f32) as usize;
        (low, high)
    }

    fn add_point(&mut self, point: &Point, sigma: f32, light: [f32; 4], gaussian: &Gaussian) {
        let (x0, x1) = Self::span(point.x, sigma, self.size[0]);
        let (y0, y1) = Self::span(point.y, sigma, self.size[1]);
        // A Gaussian is the product of one along x and one along y.
        const MOST: usize = (2.0 * REACH * MOST_SIGMA) as usize + 4;
        let mut columns = [0.0f32; MOST];
        let scale = ENTRIES as f32 / sigma;
        let last = gaussian.0.len() - 1;
        let table = |d: f32| gaussian.0[((d.abs() * scale + 0.5) as usize).min(last)];
        for (column, x) in columns.iter_mut().zip(x0..x1) {
            *column = table(x as f32 + 0.5 - point.x);
        }
        for y in y0..y1 {
            let g = table(y as f32 + 0.5 - point.y);
            let row = light.map(|line| line * g);
            let start = y * self.size[0];
            for (pixel, g) in self.pixels[start + x0..start + x1].iter_mut().zip(&columns) {
                for k in 0..4 {
                    pixel[k] += row[k] * g;
                }
            }
        }
    }

    /// Root mean square of the difference over that of the other, in the green line, after both have been brought to the same total.
    pub fn error(&self, truth: &SplatPicture) -> f64 {
        let green = |picture: &SplatPicture| picture.pixels.iter().map(|p| f64::from(p[0])).sum::<f64>();
        let scale = green(truth) / green(self).max(1e-300);
        let (mut difference, mut total) = (0.0, 0.0);
        for (a, b) in self.pixels.iter().zip(&truth.pixels) {
            let (a, b) = (f64::from(a[0]) * scale, f64::from(b[0]));
            difference += (a - b) * (a - b);
            total += b * b;
        }
        (difference / total.max(1e-300)).sqrt()
    }
}
