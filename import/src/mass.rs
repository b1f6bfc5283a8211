//! Masses: put together, seen from another frame, of plain shapes. In and out: numbers. Never knows what has them.

use std::f64::consts::PI;

use super::place::{Matrix, Place};

/// Mass of a part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass {
    /// [kg]
    pub mass: f64,
    /// In the part's frame [m].
    pub centre: [f64; 3],
    /// About the centre, by axes parallel to the part's frame [kg m^2].
    pub inertia: Matrix,
}

impl Mass {
    /// In the frame in which the part's is at a place.
    pub fn seen_from(&self, place: &Place) -> Self {
        Self { mass: self.mass, centre: place.point(self.centre), inertia: place.tensor(&self.inertia) }
    }

    /// With another mass at the same places.
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            mass: factor * self.mass,
            centre: self.centre,
            inertia: self.inertia.map(|row| row.map(|entry| factor * entry)),
        }
    }
}

/// Two masses as one: Steiner's theorem.
pub fn together(a: &Mass, b: &Mass) -> Mass {
    let mass = a.mass + b.mass;
    let centre = std::array::from_fn(|i| (a.mass * a.centre[i] + b.mass * b.centre[i]) / mass);
    let about = |part: &Mass| -> Matrix {
        let d: [f64; 3] = std::array::from_fn(|i| part.centre[i] - centre[i]);
        let square: f64 = d.iter().map(|x| x * x).sum();
        let more = |i: usize, j: usize| part.mass * (if i == j { square } else { 0.0 } - d[i] * d[j]);
        std::array::from_fn(|i| std::array::from_fn(|j| part.inertia[i][j] + more(i, j)))
    };
    let (first, second) = (about(a), about(b));
    Mass {
        mass,
        centre,
        inertia: std::array::from_fn(|i| std::array::from_fn(|j| first[i][j] + second[i][j])),
    }
}

/// A plain solid about its centre [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    Sphere {
        radius: f64,
    },
    /// Along z; half of the cylinder between the caps.
    Capsule {
        radius: f64,
        half: f64,
    },
    /// Along z.
    Cylinder {
        radius: f64,
        half: f64,
    },
    Ellipsoid {
        half: [f64; 3],
    },
    Box {
        half: [f64; 3],
    },
}

impl Shape {
    /// Volume [m^3].
    pub fn volume(&self) -> f64 {
        match *self {
            Self::Sphere { radius } => 4.0 / 3.0 * PI * radius.powi(3),
            Self::Capsule { radius, half } => PI * radius * radius * (4.0 / 3.0 * radius + 2.0 * half),
            Self::Cylinder { radius, half } => 2.0 * PI * radius * radius * half,
            Self::Ellipsoid { half: [a, b, c] } => 4.0 / 3.0 * PI * a * b * c,
            Self::Box { half: [a, b, c] } => 8.0 * a * b * c,
        }
    }

    /// Of this mass [kg], evenly spread.
    pub fn of_mass(&self, mass: f64) -> Mass {
        let diagonal = match *self {
            Self::Sphere { radius } => [0.4 * mass * radius * radius; 3],
            Self::Cylinder { radius, half } => {
                let across = mass * (radius * radius / 4.0 + half * half / 3.0);
                [across, across, 0.5 * mass * radius * radius]
            }
            Self::Capsule { radius: r, half: h } => {
                let caps = mass * 2.0 * r / (2.0 * r + 3.0 * h);
                let between = mass - caps;
                // A half ball has its centre 3/8 r behind its plane.
                let across =
                    between * (r * r / 4.0 + h * h / 3.0) + caps * (0.4 * r * r + h * h + 0.75 * h * r);
                [across, across, 0.5 * between * r * r + 0.4 * caps * r * r]
            }
            Self::Ellipsoid { half: [a, b, c] } => {
                [b * b + c * c, a * a + c * c, a * a + b * b].map(|square| mass * square / 5.0)
            }
            Self::Box { half: [a, b, c] } => {
                [b * b + c * c, a * a + c * c, a * a + b * b].map(|square| mass * square / 3.0)
            }
        };
        Mass { mass, centre: [0.0; 3], inertia: diagonal_matrix(diagonal) }
    }
}

/// With these entries, else 0.
pub fn diagonal_matrix(entries: [f64; 3]) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { entries[i] } else { 0.0 }))
}
