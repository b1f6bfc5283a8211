//! What a closed surface of triangles encloses: volume, centre, second moments, by tetrahedra from one point. In: triangles. Out: numbers,
//! or why they enclose nothing. Never knows files.

use std::collections::HashMap;

use super::mass::Mass;
use super::place::{cross, dot};
use super::shells::{bounds, hole_in_nothing, key};
use super::stl::Triangle;

/// A volume below this share of the cube of its size is rounding of coordinates with seven digits.
const NO_VOLUME: f64 = 1e-9;
/// A product of inertia below this share of the trace is rounding.
const ROUNDING: f64 = 1e-15;

/// A solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// [m^3]
    pub volume: f64,
    /// Its mass at 1 kg/m^3.
    unit: Mass,
    /// Whether its triangles face inwards.
    pub is_inside_out: bool,
}

impl Solid {
    /// Enclosed by triangles [m].
    pub fn enclosed(triangles: &[Triangle]) -> Result<Self, String> {
        closed(triangles)?;
        let (low, high) = bounds(triangles);
        let size = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
        // From the middle, so that little is taken away from much.
        let middle: [f64; 3] = std::array::from_fn(|i| 0.5 * (low[i] + high[i]));
        let (mut six, mut first, mut second) = (0.0, [0.0; 3], [[0.0; 3]; 3]);
        for triangle in triangles {
            let corners = triangle.map(|corner| std::array::from_fn(|i| (corner[i] - middle[i]) / size));
            let [a, b, c]: [[f64; 3]; 3] = corners;
            let volume = dot(a, cross(b, c));
            let sum: [f64; 3] = std::array::from_fn(|i| a[i] + b[i] + c[i]);
            six += volume;
            for i in 0..3 {
                first[i] += volume * sum[i] / 24.0;
                for j in 0..3 {
                    let own = a[i] * a[j] + b[i] * b[j] + c[i] * c[j];
                    second[i][j] += volume * (own + sum[i] * sum[j]) / 120.0;
                }
            }
        }
        let volume = six / 6.0;
        if volume.is_nan() || volume.abs() <= NO_VOLUME {
            return Err("it encloses no volume".to_owned());
        }
        let centre = first.map(|x| x / volume);
        let sign = volume.signum();
        let about =
            |i: usize, j: usize| sign * size.powi(5) * (second[i][j] - volume * centre[i] * centre[j]);
        let trace: f64 = (0..3).map(|i| about(i, i)).sum();
        let inertia = std::array::from_fn(|i| {
            std::array::from_fn(|j| match (i == j, -about(i, j)) {
                (true, own) => trace + own,
                // What is left of a symmetry.
                (false, product) if product.abs() < ROUNDING * trace => 0.0,
                (false, product) => product,
            })
        });
        if let Some([x, y, z]) = hole_in_nothing(triangles) {
            return Err(format!(
                "a part of its surface faces inwards and lies in no other (at {x:.4e}, {y:.4e}, {z:.4e} m): a hole in nothing"
            ));
        }
        let volume = volume.abs() * size.powi(3);
        let unit =
            Mass { mass: volume, centre: std::array::from_fn(|i| middle[i] + size * centre[i]), inertia };
        let all = unit.inertia.iter().flatten().chain(&unit.centre);
        if !(volume.is_finite() && volume > 0.0 && all.clone().all(|x| x.is_finite())) {
            return Err(format!("its size, {size:e} m, is beyond what can be computed"));
        }
        Ok(Self { volume, unit, is_inside_out: sign < 0.0 })
    }

    /// At a density [kg/m^3].
    pub fn of_density(&self, density: f64) -> Mass {
        self.unit.scaled(density)
    }

    /// Of a mass [kg].
    pub fn of_mass(&self, mass: f64) -> Mass {
        Mass { mass, ..self.unit.scaled(mass / self.volume) }
    }
}

/// Whether every edge has a triangle on both sides, which go along it in opposite directions.
fn closed(triangles: &[Triangle]) -> Result<(), String> {
    let mut numbers = HashMap::new();
    let mut edges: HashMap<(usize, usize), (i64, i64)> = HashMap::new();
    for triangle in triangles {
        let corners = triangle.map(|corner| {
            let next = numbers.len();
            *numbers.entry(key(corner)).or_insert(next)
        });
        let [a, b, c] = corners;
        // Of two equal corners no edge is left, and the other two are one.
        if a == b || b == c || c == a {
            continue;
        }
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let edge = edges.entry((from.min(to), from.max(to))).or_default();
            edge.0 += 1;
            edge.1 += if from < to { 1 } else { -1 };
        }
    }
    let open = edges.values().filter(|(count, _)| count % 2 != 0).count();
    let turned = edges.values().filter(|(count, balance)| count % 2 == 0 && *balance != 0).count();
    if open > 0 {
        return Err(format!(
            "it is not closed: {open} of {} edges have a triangle on one side only",
            edges.len()
        ));
    }
    if turned > 0 {
        let all = edges.len();
        return Err(format!(
            "its triangles do not all face outwards: along {turned} of {all} edges they turn over"
        ));
    }
    Ok(())
}
