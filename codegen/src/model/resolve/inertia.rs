//! Inertia given as numbers: whether a body can have it. And the small vector algebra of the checks.

use nalgebra::{Matrix3, SymmetricEigen};

use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::model::Formula;
use crate::spec::{At, BodySpec, Dimension, Name, Quantity, Triple};

pub(super) const AXES_OF_W: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

pub(super) fn between(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|at| b[at] - a[at])
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    dot(between(a, b), between(a, b)).sqrt()
}

/// The direction of a vector; none for zero and for what is not finite.
pub(super) fn unit(vector: [f64; 3]) -> Option<[f64; 3]> {
    // Scaled first, so that neither tiny nor huge components are lost when squared.
    let largest = vector.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let scaled = vector.map(|x| x / largest);
    let norm = dot(scaled, scaled).sqrt();
    norm.is_finite().then(|| scaled.map(|x| x / norm))
}

/// What is left of `vector` across the unit vector `along`.
pub(super) fn perpendicular_part(vector: [f64; 3], along: [f64; 3]) -> [f64; 3] {
    let length = dot(vector, along);
    std::array::from_fn(|at| vector[at] - length * along[at])
}

/// A unit vector across `along`: the part of e_x, or of e_y where e_x is nearly along.
pub(super) fn any_perpendicular(along: [f64; 3]) -> [f64; 3] {
    let start = if along[0].abs() < 0.9 { AXES_OF_W[0] } else { AXES_OF_W[1] };
    unit(perpendicular_part(start, along)).unwrap_or(AXES_OF_W[2])
}

impl Resolver<'_> {
    /// Six entries of the inertia and its axes; zero for a point mass.
    pub(super) fn given_inertia(&mut self, name: &Name, spec: &BodySpec) -> ([Formula; 6], [[f64; 3]; 3]) {
        let dimension = Dimension::of(2, 1, 0);
        let mut entries: [Formula; 6] = std::array::from_fn(|_| Formula::number(0.0, dimension));
        let axes = spec.axes.as_ref().map_or(AXES_OF_W, |axes| self.axes(name, axes));
        let Some(written) = &spec.inertia else { return (entries, axes) };
        let what = place("inertia", "body", name);
        if !matches!(written.value.len(), 3 | 6) {
            self.wrong_count(
                written.span,
                written.value.len(),
                "3 (xx, yy, zz) or 6 (xx, yy, zz, xy, xz, yz)",
                &what,
            );
            return (entries, axes);
        }
        for (entry, quantity) in entries.iter_mut().zip(&written.value) {
            *entry = self.formula(quantity, Some(dimension), Allowed::PARAMETERS, &what);
        }
        self.check_inertia(&entries, written, &what);
        (entries, axes)
    }

    fn check_inertia(&mut self, entries: &[Formula; 6], written: &At<Vec<Quantity>>, what: &str) {
        let [xx, yy, zz, xy, xz, yz] = self.values_of(entries);
        let matrix = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        if matrix.iter().any(|x| !x.is_finite()) {
            return;
        }
        let mut principal: Vec<f64> = SymmetricEigen::new(matrix).eigenvalues.iter().copied().collect();
        principal.sort_by(f64::total_cmp);
        let (small, middle, large) = (principal[0], principal[1], principal[2]);
        // Slender rods and point masses have moments of exactly zero and sums that are exactly equal; numbers printed
        // with six digits miss both by about 1e-6.
        let slack = 2e-6 * large.abs();
        let fault = if small < -slack {
            Some((
                format!("{what} has a negative principal moment, {small} kg m^2"),
                "moments of inertia are positive",
            ))
        } else if small + middle < large - slack {
            Some((
                format!(
                    "{what}: one principal moment, {large} kg m^2, exceeds the sum of the others, {} kg m^2",
                    small + middle
                ),
                "no body has such an inertia; for motion in a plane give `I/2, I/2, I` where only I about the normal matters",
            ))
        } else {
            None
        };
        if let Some((message, help)) = fault {
            self.refuse(Code::ImpossibleInertia, written.span, message).help(help);
        }
    }

    /// Unit vectors along the axes in which the inertia is given.
    pub(super) fn axes(&mut self, name: &Name, written: &At<Vec<Triple>>) -> [[f64; 3]; 3] {
        self.right_handed(written, &place("axes", "body", name))
    }

    /// Two or three directions at right angles: axes x, y and z.
    pub(super) fn right_handed(&mut self, written: &At<Vec<Triple>>, what: &str) -> [[f64; 3]; 3] {
        if !matches!(written.value.len(), 2 | 3) {
            self.wrong_count(written.span, written.value.len(), "2 or 3 directions", what);
            return AXES_OF_W;
        }
        let directions: Vec<_> = written.value.iter().map(|triple| self.direction(triple, what)).collect();
        let Some(directions) = directions.into_iter().collect::<Option<Vec<_>>>() else { return AXES_OF_W };
        let third = cross(directions[0], directions[1]);
        let given = directions.get(2).copied().unwrap_or(third);
        // Directions written with six digits are at right angles within about 1e-6.
        if dot(directions[0], directions[1]).abs() > 1e-5 || distance(third, given) > 1e-5 {
            let message = format!("{what} are not at right angles, x before y before z");
            self.refuse(Code::NotPerpendicular, written.span, message)
                .help("give the first two, at right angles to each other; the third follows");
        }
        let third = unit(third).unwrap_or(AXES_OF_W[2]);
        let second = cross(third, directions[0]);
        [directions[0], second, third]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unit_survives_tiny_and_huge_vectors() {
        assert_eq!(unit([0.0, 3e-300, 0.0]), Some([0.0, 1.0, 0.0]));
        assert_eq!(unit([1e300, 0.0, 0.0]), Some([1.0, 0.0, 0.0]));
        assert_eq!(unit([0.0; 3]), None);
        assert_eq!(unit([f64::NAN, 1.0, 0.0]), None);
    }

    #[test]
    fn a_perpendicular_is_found_for_every_direction() {
        for along in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [0.96, 0.28, 0.0]] {
            let across = any_perpendicular(along);
            // A few roundings of numbers of size 1.
            assert!(dot(across, along).abs() < 1e-15 && (dot(across, across) - 1.0).abs() < 1e-15);
        }
    }
}
