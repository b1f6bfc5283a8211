//! Chances of a law by its density, at places half a part apart. In: the terms of the density. Out: masses of parts, chances to go from
//! a part to a part, where the density is smooth. Never knows readings.
//!
//! A chance is the mean of the density under a triangle of two parts, a mass that over one part: both by the five nodes around the
//! middle, exactly for polynomials of degree five.

/// Weights of the middle and of the nodes on either side, in parts: under the triangle, ...
const TRIANGLE: [f64; 3] = [13.0 / 30.0, 4.0 / 15.0, 1.0 / 60.0];
/// ... and over a part.
const PART: [f64; 3] = [19.0 / 30.0, 17.0 / 90.0, -1.0 / 180.0];
/// Sixth root of the sixth derivative in parts, beside the density, up to which that holds: what is left is 1e-5 of its sixth power,
/// 1e-9.
const SMOOTH: f64 = 0.215;

/// The density of a law: terms c, p, r of its logarithm c + p ln wear - r wear, and from where on it is smooth.
#[derive(Clone, Copy)]
pub(super) struct Density {
    terms: [f64; 3],
    /// Wear below which it is not.
    least: f64,
}

/// Densities at nodes that are half a part apart.
pub(super) struct Nodes {
    densities: Vec<f64>,
    part: f64,
    /// The first node from which on the density is smooth.
    first: usize,
}

impl Density {
    /// None where it is smooth nowhere.
    pub fn new(terms: [f64; 3], part: f64) -> Option<Self> {
        // (P / wear + r)^6 is no less than the sixth derivative beside the density.
        let [_, power, rate] = terms;
        let mut falling = 1.0_f64;
        let root = |j: i32| {
            falling *= (power - f64::from(j)).abs();
            libm::pow(falling, 1.0 / f64::from(j + 1))
        };
        let most = (0..6).map(root).fold(0.0, f64::max);
        let left = SMOOTH - rate * part;
        (left > 0.0).then(|| Self { terms, least: (most * part / left).max(0.5 * part) })
    }
}

impl Nodes {
    /// From the first node's wear and the logarithms of all; None where the density is smooth at none of them.
    pub fn new(density: Density, part: f64, wear: f64, logs: &[f64]) -> Option<Self> {
        let Density { terms: [constant, power, rate], least } = density;
        let half = 0.5 * part;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let first = libm::ceil((least - wear) / half).max(0.0) as usize;
        let density = |(at, ln): (usize, &f64)| {
            if at < first { 0.0 } else { libm::exp(constant + power * ln - rate * (wear + half * at as f64)) }
        };
        (first + 5 <= logs.len()).then(|| Self {
            densities: logs.iter().enumerate().map(density).collect(),
            part,
            first,
        })
    }

    /// Whether node `at` may be the middle of a chance or a mass.
    pub fn is_smooth(&self, at: usize) -> bool {
        at >= self.first + 2
    }

    /// The chance to go on by the wear of node `at`, from a part to a part.
    pub fn chance(&self, at: usize) -> f64 {
        self.mean(at, TRIANGLE)
    }

    /// The mass of the part around node `at`.
    pub fn mass(&self, at: usize) -> f64 {
        self.mean(at, PART)
    }

    fn mean(&self, at: usize, [middle, near, far]: [f64; 3]) -> f64 {
        let d = &self.densities[at - 2..=at + 2];
        self.part * (middle * d[2] + near * (d[1] + d[3]) + far * (d[0] + d[4]))
    }
}
