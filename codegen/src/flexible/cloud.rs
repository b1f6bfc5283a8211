//! Bodies made of mass points, for tests: their tables and their motion by plain sums.

use super::data::{ModalData, Mode};

/// A mass point: mass, place, values of the shape functions.
pub struct Point {
    pub mass: f64,
    pub place: [f64; 3],
    pub shapes: Vec<f64>,
}

/// A body whose mode k moves a point by `sum_j directions[k][j] shapes[j]`.
pub struct Cloud {
    pub points: Vec<Point>,
    pub directions: Vec<Vec<[f64; 3]>>,
}

/// Numbers between -1 and 1 that repeat.
pub fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(2).wrapping_add(1);
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

fn add(sum: &mut [f64; 3], factor: f64, vector: [f64; 3]) {
    (0..3).for_each(|i| sum[i] += factor * vector[i]);
}

impl Cloud {
    /// Both planes of a rod: a mode of each plane moves points across by one function and along by one of its own. Points
    /// come in pairs that make products of deflection and tilt vanish; deflections are symmetric about the middle, so that
    /// all have their weight there.
    pub fn rod(modes: usize, seed: u64) -> Self {
        let mut next = numbers(seed);
        let mut points = Vec::new();
        let masses: Vec<f64> = (0..4).map(|_| 0.2 + 0.1 * next()).collect();
        let deflections: Vec<Vec<f64>> = (0..4).map(|_| (0..modes).map(|_| next()).collect()).collect();
        for at in 0..7_usize {
            let (x, mirrored) = (0.1 * at as f64 + 0.3, at.min(6 - at));
            let (mass, deflection) = (masses[mirrored], &deflections[mirrored]);
            let tilt: Vec<f64> = (0..modes).map(|_| next()).collect();
            for plane in 0..2 {
                for side in [-1.0, 1.0] {
                    let mut place = [x, 0.0, 0.0];
                    place[1 + plane] = 0.05 * side;
                    let mut shapes = deflection.clone();
                    for tilted in 0..2 {
                        let lever = if tilted == plane { 0.05 * side } else { 0.0 };
                        shapes.extend(tilt.iter().map(|tilt| lever * tilt));
                    }
                    points.push(Point { mass, place, shapes });
                }
            }
        }
        let mut directions = Vec::new();
        for k in 0..modes {
            for plane in 0..2 {
                let mut row = vec![[0.0; 3]; 3 * modes];
                row[k][1 + plane] = 1.0;
                row[(1 + plane) * modes + k][0] = -1.0;
                directions.push(row);
            }
        }
        Self { points, directions }
    }

    /// Shapes that have nothing in common but one function.
    pub fn any(modes: usize, seed: u64) -> Self {
        let mut next = numbers(seed);
        let functions = modes + 1;
        let points = (0..9).map(|_| Point {
            mass: 1.5 + next(),
            place: [next(), next(), next()],
            shapes: (0..functions).map(|_| next()).collect(),
        });
        let points = points.collect();
        let directions = (0..modes).map(|k| {
            let mut row = vec![[0.0; 3]; functions];
            row[k] = [0.0, 1.0, 0.0];
            row[k][k % 2 * 2] = 0.75;
            row[modes][(k + 1) % 3] = if k == 0 { 1.0 } else { -0.5 };
            row
        });
        Self { directions: directions.collect(), points }
    }

    /// Displacement of a point per unit of a mode.
    pub fn shape(&self, mode: usize, point: &Point) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (direction, value) in self.directions[mode].iter().zip(&point.shapes) {
            add(&mut sum, *value, *direction);
        }
        sum
    }

    /// `sum_k x_k` times shape k at a point.
    pub fn moved(&self, x: &[f64], point: &Point) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (mode, x) in x.iter().enumerate() {
            add(&mut sum, *x, self.shape(mode, point));
        }
        sum
    }

    /// The tables.
    pub fn data(&self) -> ModalData {
        let n = self.directions.len();
        // Pairs of points first, so that what cancels between them is exactly zero.
        let sum = |value: &dyn Fn(&Point) -> f64| -> f64 {
            let pairs = self.points.chunks(2);
            pairs.map(|pair| pair.iter().map(|point| point.mass * value(point)).sum::<f64>()).sum()
        };
        let vector = |value: &dyn Fn(&Point, usize) -> f64| [0, 1, 2].map(|i| sum(&|point| value(point, i)));
        let matrix = |value: &dyn Fn(&Point, usize, usize) -> f64| {
            [0, 1, 2].map(|i| [0, 1, 2].map(|j| sum(&|point| value(point, i, j))))
        };
        let coupling: Vec<Vec<[[f64; 3]; 3]>> = (0..n)
            .map(|k| {
                (0..n)
                    .map(|l| matrix(&|point, i, j| self.shape(k, point)[i] * self.shape(l, point)[j]))
                    .collect()
            })
            .collect();
        let trace = |m: &[[f64; 3]; 3]| m[0][0] + m[1][1] + m[2][2];
        ModalData {
            mass: sum(&|_| 1.0),
            first_moment: vector(&|point, i| point.place[i]),
            second_moment: matrix(&|point, i, j| point.place[i] * point.place[j]),
            modes: (0..n).map(|k| Mode { name: format!("m{k}"), frequency: 0.0 }).collect(),
            gamma: (0..n).map(|k| vector(&|point, i| self.shape(k, point)[i])).collect(),
            moment: (0..n).map(|k| matrix(&|point, i, j| point.place[i] * self.shape(k, point)[j])).collect(),
            mass_matrix: coupling.iter().map(|row| row.iter().map(trace).collect()).collect(),
            coupling,
            stiffness: vec![vec![0.0; n]; n],
            damping: vec![vec![0.0; n]; n],
            ..ModalData::default()
        }
    }
}
