//! A rigid body in space, free or with one of its points held in W. Parameter 0: gravity in -z [m/s²].

use super::{Model, Start, Terms};
use linkwear_runtime::Motion;
use nalgebra::{DMatrix, DVector, Matrix3, Quaternion, UnitQuaternion, Vector3};

/// A body whose frame sits in its centre of mass.
pub struct Body {
    pub mass: f64,
    /// Principal moments [kg m²].
    pub inertia: [f64; 3],
    /// Point of the body (in its own frame) that is held, and where in W.
    pub pin: Option<(Vector3<f64>, Vector3<f64>)>,
    /// Quaternion, position in W.
    pub start: [f64; 7],
    /// Angular velocity, velocity, both in the body's frame.
    pub speed: [f64; 6],
    /// Which coordinates are held.
    pub held: [bool; 7],
}

/// Rotation matrix of a quaternion of any length close to one, smooth in its components.
pub fn rotation(q: &[f64]) -> Matrix3<f64> {
    UnitQuaternion::new_unchecked(Quaternion::new(q[0], q[1], q[2], q[3])).to_rotation_matrix().into_inner()
}

/// `q̇ = q ∘ (0, omega) / 2`.
pub fn quaternion_rate(q: &[f64], w: &[f64]) -> [f64; 4] {
    [
        0.5 * (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2]),
        0.5 * (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]),
        0.5 * (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]),
        0.5 * (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]),
    ]
}

fn parts(v: &[f64]) -> (Vector3<f64>, Vector3<f64>) {
    (Vector3::new(v[0], v[1], v[2]), Vector3::new(v[3], v[4], v[5]))
}

impl Model for Body {
    fn motions(&self) -> Vec<Motion> {
        vec![Motion::Pose]
    }

    fn terms(&self, parameters: &[f64], q: &[f64], v: &[f64]) -> Terms {
        let (w, u) = parts(v);
        let turn = rotation(q);
        let momentum = Vector3::from(self.inertia).component_mul(&w);
        let weight = turn.transpose() * Vector3::new(0.0, 0.0, self.mass * parameters[0]);
        let m = if self.pin.is_some() { 3 } else { 0 };
        let mut terms = Terms {
            mass: DMatrix::zeros(6, 6),
            bias: DVector::zeros(6),
            phi: DVector::zeros(m),
            rows: DMatrix::zeros(m, 6),
            gamma: DVector::zeros(m),
        };
        for i in 0..3 {
            terms.mass[(i, i)] = self.inertia[i];
            terms.mass[(3 + i, 3 + i)] = self.mass;
        }
        terms.bias.rows_mut(0, 3).copy_from(&w.cross(&momentum));
        terms.bias.rows_mut(3, 3).copy_from(&(w.cross(&u) * self.mass + weight));
        if let Some((point, place)) = self.pin {
            terms.phi.copy_from(&(Vector3::new(q[4], q[5], q[6]) + turn * point - place));
            terms.rows.columns_mut(0, 3).copy_from(&(-turn * point.cross_matrix()));
            terms.rows.columns_mut(3, 3).copy_from(&turn);
            terms.gamma.copy_from(&(-turn * w.cross(&(u + w.cross(&point)))));
        }
        terms
    }

    fn energy(&self, parameters: &[f64], q: &[f64], v: &[f64]) -> (f64, f64) {
        let (w, u) = parts(v);
        let spin = Vector3::from(self.inertia).component_mul(&w).dot(&w);
        (0.5 * (spin + self.mass * u.norm_squared()), self.mass * parameters[0] * q[6])
    }

    fn start(&self) -> (Start, Start) {
        (self.start.into_iter().zip(self.held).collect(), self.speed.map(|v| (v, false)).to_vec())
    }

    fn channels(&self) -> Vec<(String, &'static str, bool)> {
        let names = ["q0", "q1", "q2", "q3", "x", "y", "z", "Lx", "Ly", "Lz", "px", "py", "pz"];
        names.iter().map(|name| ((*name).to_owned(), "1", false)).collect()
    }

    fn observe(&self, q: &[f64], v: &[f64], _: &[f64], _: &[f64]) -> Vec<f64> {
        let (w, u) = parts(v);
        let turn = rotation(q);
        let spin = turn * Vector3::from(self.inertia).component_mul(&w);
        let linear = turn * u * self.mass;
        [q, spin.as_slice(), linear.as_slice()].concat()
    }
}
