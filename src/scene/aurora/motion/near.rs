//! The near field of charges whose far field is on a grid: the difference between the field of a charge as thick as the sheet and that of
//! the Gaussian cloud on the grid.
//!
//! A line of charge q/ε₀ (mV/m times km) spread by a Gaussian of standard deviation w has the field q (1 − exp(−r²/2w²))/(2πr) in closed
//! form. The grid has w = σ, about a cell; the charge itself is as thick as the sheet, w = d. The difference, q (exp(−r²/2σ²) −
//! exp(−r²/2d²))/(2πr), vanishes beyond a few σ and is summed over pairs (Ewald's split of the sum, in two dimensions). Charges that are
//! neighbours on a curve are taken together, six at a time, if they are seen under a small angle (Barnes and Hut).

use std::f64::consts::TAU;

use glam::DVec2;

/// The near field is left out beyond so many σ, where it is 1/450 of the charge's.
const REACH: f64 = 3.5;
/// Entries of the table of the field. Linear interpolation is right to 1e-3 of the greatest value if d is five steps of it or more.
const TABLE: usize = 2048;
/// Charges that may be taken together, and their largest distance from their middle over that to the point: then the error of second order,
/// which has both signs along the curve, is below 1/100 of the field.
const TOGETHER: usize = 6;
const OPENING: f64 = 0.25;

/// A charge at a place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Charge {
    /// Place in the plane across the field, km.
    pub place: DVec2,
    /// Charge per length along the field over ε₀, mV/m times km.
    pub amount: f64,
}

/// Neighbouring charges: which, their sum at their middle, and the square of the distance from which on it stands for them.
#[derive(Clone, Copy, Debug, Default)]
struct ChargeCluster {
    all: Charge,
    open: f64,
    first: usize,
    last: usize,
}

impl ChargeCluster {
    fn new(charges: &[Charge], first: usize, last: usize) -> Self {
        let own = &charges[first..last];
        let amount: f64 = own.iter().map(|charge| charge.amount).sum();
        let mean = own.iter().map(|charge| charge.place).sum::<DVec2>() / own.len() as f64;
        // Charges of one sign have their middle among them; without charge any point will do.
        let middle = own.iter().map(|charge| charge.place * (charge.amount / amount)).sum::<DVec2>();
        let place = if middle.is_finite() { middle } else { mean };
        let radius = own.iter().map(|charge| charge.place.distance_squared(place)).fold(0.0, f64::max);
        ChargeCluster { all: Charge { place, amount }, open: radius / (OPENING * OPENING), first, last }
    }
}

/// Charges sorted into square cells, and the field that each has near it.
#[derive(Clone, Debug)]
pub struct Near {
    sigma: f64,
    thickness: f64,
    /// Field over distance and charge, in km⁻², at evenly spaced distances up to the reach.
    table: Vec<f64>,
    low: DVec2,
    /// Cells along a side, each as wide as the reach.
    cells: usize,
    /// First cluster of each cell, row by row, and their number after the last.
    starts: Vec<usize>,
    sorted: Vec<ChargeCluster>,
    charges: Vec<Charge>,
}

impl Near {
    /// For charges of thickness d (km) within a square of side `side` around `centre`. On the grid they are Gaussians of `sigma` (km).
    pub fn new(thickness: f64, sigma: f64, centre: DVec2, side: f64) -> Self {
        let cells = ((side / (REACH * sigma)).ceil() as usize).max(1);
        let mut near = Near {
            sigma,
            thickness: 0.0,
            table: Vec::new(),
            low: centre - 0.5 * side,
            cells,
            starts: vec![0; cells * cells + 1],
            sorted: Vec::new(),
            charges: Vec::new(),
        };
        near.thicken(thickness);
        near
    }

    /// Sets the thickness d, in km. It is never more than σ; at σ nothing is left to the pairs.
    pub fn thicken(&mut self, thickness: f64) {
        let thickness = thickness.min(self.sigma);
        if thickness == self.thickness {
            return;
        }
        self.thickness = thickness;
        let (wide, thin) = (0.5 / self.sigma.powi(2), 0.5 / thickness.powi(2));
        let value = |k: usize| {
            let square = (REACH * self.sigma * k as f64 / (TABLE - 1) as f64).powi(2);
            if square == 0.0 { (thin - wide) / TAU } else { ((-wide * square).exp() - (-thin * square).exp()) / (TAU * square) }
        };
        self.table = (0..TABLE).map(value).collect();
    }

    /// The thickness d, km.
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// The charges that are there.
    pub fn charges(&self) -> &[Charge] {
        &self.charges
    }

    /// Takes new charges, curve after curve. `curves` has the first of each curve and their number after the last. Charges outside of the
    /// square count as in its outermost cells.
    pub fn sort(&mut self, charges: Vec<Charge>, curves: &[usize]) {
        self.charges = charges;
        // Each curve begins a new cluster: the middle of a cluster with parts of two curves would be far from both, maybe in a cell with
        // none of its charges.
        let of_curve = |curve: &[usize]| {
            let last = curve[1];
            (curve[0]..last).step_by(TOGETHER).map(move |first| (first, (first + TOGETHER).min(last)))
        };
        let clusters: Vec<ChargeCluster> =
            curves.windows(2).flat_map(of_curve).map(|(first, last)| ChargeCluster::new(&self.charges, first, last)).collect();
        let index = |cluster: &ChargeCluster| {
            let (column, row) = self.cell(cluster.all.place);
            row * self.cells + column
        };
        let mut starts = vec![0; self.starts.len()];
        for cluster in &clusters {
            starts[index(cluster) + 1] += 1;
        }
        for k in 1..starts.len() {
            starts[k] += starts[k - 1];
        }
        let mut next = starts.clone();
        let mut sorted = vec![ChargeCluster::default(); clusters.len()];
        for cluster in &clusters {
            let slot = &mut next[index(cluster)];
            sorted[*slot] = *cluster;
            *slot += 1;
        }
        (self.starts, self.sorted) = (starts, sorted);
    }

    /// The near field at a place, mV/m.
    pub fn field_at(&self, place: DVec2) -> DVec2 {
        let (column, row) = self.cell(place);
        let reach = (REACH * self.sigma).powi(2);
        let mut field = DVec2::ZERO;
        for row in row.saturating_sub(1)..(row + 2).min(self.cells) {
            // Neighbouring cells of a row are one run of clusters.
            let first = row * self.cells + column.saturating_sub(1);
            let last = row * self.cells + (column + 2).min(self.cells);
            for cluster in &self.sorted[self.starts[first]..self.starts[last]] {
                let away = place - cluster.all.place;
                let square = away.length_squared();
                if square > cluster.open {
                    // Most clusters of the cells around are out of reach.
                    if square < reach {
                        field += away * (self.over_distance(away) * cluster.all.amount);
                    }
                } else {
                    for charge in &self.charges[cluster.first..cluster.last] {
                        let away = place - charge.place;
                        field += away * (self.over_distance(away) * charge.amount);
                    }
                }
            }
        }
        field
    }

    /// The near field of a charge of one over its distance.
    fn over_distance(&self, away: DVec2) -> f64 {
        let x = away.length() * ((TABLE - 1) as f64 / (REACH * self.sigma));
        let k = x as usize;
        match self.table.get(k..k + 2) {
            Some(values) => values[0] + (values[1] - values[0]) * (x - k as f64),
            None => 0.0,
        }
    }

    fn cell(&self, place: DVec2) -> (usize, usize) {
        let p = (place - self.low) / (REACH * self.sigma);
        let within = |x: f64| (x.max(0.0) as usize).min(self.cells - 1);
        (within(p.x), within(p.y))
    }
}
