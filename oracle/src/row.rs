//! Scalar quantities between two bodies, with the coefficients of their rate: what constraint rows and
//! joint coordinates are made of. In: two moving frames. Out: [`Row`]. Never knows joint kinds.

use nalgebra::Vector3;

use crate::frame::{Frame, Load, MovingPoint, across};

/// A scalar `s` of the relative motion of two bodies:
/// `ṡ = parent . twist + child . twist`, `s̈ = (the same with accelerations) + bias`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Row {
    pub parent: Load,
    pub child: Load,
    /// `s` itself.
    pub residual: f64,
    /// `ṡ`.
    pub rate: f64,
    /// Part of `s̈` without accelerations.
    pub bias: f64,
}

impl Row {
    /// `self + scale * other`, for quantities that are linear in their rows.
    pub fn plus(mut self, scale: f64, other: &Self) -> Self {
        self.parent.add(scale, &other.parent);
        self.child.add(scale, &other.child);
        self.residual += scale * other.residual;
        self.rate += scale * other.rate;
        self.bias += scale * other.bias;
        self
    }
}

/// Two frames and the joint's point on each.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    pub parent: Frame,
    pub child: Frame,
    pub parent_point: MovingPoint,
    pub child_point: MovingPoint,
}

impl Pair {
    pub fn new(parent: Frame, child: Frame, points: &[Vector3<f64>; 2]) -> Self {
        Self { parent, child, parent_point: parent.point(&points[0]), child_point: child.point(&points[1]) }
    }

    pub fn relative_omega(&self) -> Vector3<f64> {
        self.child.state.omega - self.parent.state.omega
    }

    /// Distance of the child's point from the parent's along `reference`, a direction fixed in the parent.
    pub fn slide(&self, reference: &Vector3<f64>) -> Row {
        let [a, a_rate, a_bias] = self.parent.direction(reference);
        let (p, c) = (&self.parent_point, &self.child_point);
        let d = c.position - p.position;
        let d_rate = c.velocity - p.velocity;
        // The parent feels the opposite force at the child's point: its arm is p.arm + d.
        let parent = Load::at(&(p.arm + d), &-a);
        Row {
            parent,
            child: Load::at(&c.arm, &a),
            residual: a.dot(&d),
            rate: a_rate.dot(&d) + a.dot(&d_rate),
            bias: a_bias.dot(&d) + 2.0 * a_rate.dot(&d_rate) + a.dot(&(c.bias - p.bias)),
        }
    }

    /// Distance of the child's point from the parent's along the fixed direction `n` in W.
    fn gap(&self, n: &Vector3<f64>) -> Row {
        let (p, c) = (&self.parent_point, &self.child_point);
        Row {
            parent: Load::at(&p.arm, &-n),
            child: Load::at(&c.arm, n),
            residual: n.dot(&(c.position - p.position)),
            rate: n.dot(&(c.velocity - p.velocity)),
            bias: n.dot(&(c.bias - p.bias)),
        }
    }

    /// The two points stay together.
    pub fn together(&self) -> [Row; 3] {
        [Vector3::x(), Vector3::y(), Vector3::z()].map(|n| self.gap(&n))
    }

    /// Cosine between `in_parent` and `in_child`, directions fixed in the bodies, minus `cosine`.
    pub fn cosine(&self, in_parent: &Vector3<f64>, in_child: &Vector3<f64>, cosine: f64) -> Row {
        let [a, a_rate, a_bias] = self.parent.direction(in_parent);
        let [b, b_rate, b_bias] = self.child.direction(in_child);
        let lever = b.cross(&a);
        Row {
            parent: Load { force: Vector3::zeros(), torque: -lever },
            child: Load { force: Vector3::zeros(), torque: lever },
            residual: a.dot(&b) - cosine,
            rate: lever.dot(&self.relative_omega()),
            bias: a_bias.dot(&b) + 2.0 * a_rate.dot(&b_rate) + a.dot(&b_bias),
        }
    }

    /// `axis` of the parent and `child_axis` of the child stay parallel: two rows.
    pub fn parallel(&self, axis: &Vector3<f64>, child_axis: &Vector3<f64>) -> [Row; 2] {
        across(axis).map(|t| self.cosine(&t, child_axis, 0.0))
    }

    /// An angle `value` whose rate is the relative angular velocity along `w`, itself changing at `w_rate`.
    pub fn turn(&self, value: f64, w: &Vector3<f64>, w_rate: &Vector3<f64>) -> Row {
        Row {
            parent: Load { force: Vector3::zeros(), torque: -w },
            child: Load { force: Vector3::zeros(), torque: *w },
            residual: value,
            rate: w.dot(&self.relative_omega()),
            bias: w_rate.dot(&self.relative_omega()),
        }
    }
}
