//! Accelerations and constraint forces: `[M Gᵀ; G 0]` by singular values, Newton-Euler body by body.
//! In: a state. Out: [`Solution`]. Never knows trees or joint kinds.

use linkwear_codegen::id::JointId;
use linkwear_codegen::model::Carrier;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3, Vector6};

use crate::frame::{BodyState, Load};
use crate::least_norm::LeastNorm;
use crate::model::Oracle;
use crate::row::Row;

/// What a joint does to its child, W axes, at the joint's point on the child. Springs, dampers and
/// actuators in the joint are included, drives are not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench {
    /// Force by the parent on the child [N].
    pub force: Vector3<f64>,
    /// Moment by the parent on the child [N m].
    pub moment: Vector3<f64>,
    /// Whether each of force x, y, z and moment x, y, z is the same for every solution. What is not is
    /// one choice out of many (redundant constraints).
    pub unique: [bool; 6],
}

/// Accelerations and forces at one instant.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Angular accelerations [rad/s²], W axes, per body.
    pub alpha: Vec<Vector3<f64>>,
    /// Accelerations of the mass centres [m/s²], per body.
    pub acceleration: Vec<Vector3<f64>>,
    /// Per joint, file order.
    pub wrenches: Vec<Wrench>,
    /// Force or torque of each drive along its coordinate [N or N m], joint by joint in file order.
    pub drives: Vec<f64>,
    /// By drives, actuators and applied forces [W].
    pub power_supplied: f64,
    /// Taken by dampers [W].
    pub power_dissipated: f64,
    /// Constraint rows, drives included.
    pub rows: usize,
    /// How many of them are independent.
    pub rank: usize,
    /// Smallest singular value kept; rows have length 1 in the metric of kinetic energy.
    pub smallest_kept: f64,
    /// Largest singular value taken for zero.
    pub largest_dropped: f64,
    /// Largest acceleration that the loads alone would give a body [m/s² or rad/s²]: constraints cancel it, and leave last places
    /// of it.
    pub unconstrained: f64,
}

/// Body coordinates in which kinetic energy is half the sum of squares: `twist = whiten * y`.
pub(crate) struct Metric {
    /// Per body: mass to the power -1/2 and a factor `A` with `A Aᵀ = inertia^-1`, W axes.
    factors: Vec<(f64, Matrix3<f64>)>,
}

impl Metric {
    pub fn new(oracle: &Oracle, states: &[BodyState]) -> Self {
        let factor = |(index, state): (usize, &BodyState)| {
            let body = &oracle.bodies[index];
            // `Oracle::new` has checked that the inertia is positive definite.
            let lower = body.inertia.cholesky().map_or_else(Matrix3::zeros, |c| c.l());
            let inverse = lower.transpose().try_inverse().unwrap_or_else(Matrix3::zeros);
            (body.mass.powf(-0.5), state.rotation * inverse)
        };
        Self { factors: states.iter().enumerate().map(factor).collect() }
    }

    /// The rows `coefficients . twist` as a matrix on `y`.
    pub fn matrix(&self, oracle: &Oracle, rows: &[(JointId, Row)]) -> DMatrix<f64> {
        let mut matrix = DMatrix::zeros(rows.len(), 6 * self.factors.len());
        for (i, (joint, row)) in rows.iter().enumerate() {
            let geometry = &oracle.joints[joint.index()];
            for (carrier, load) in [(geometry.parent, &row.parent), (geometry.child, &row.child)] {
                let Carrier::Body(id) = carrier else { continue };
                let whitened = self.whiten(id.index(), load);
                for (k, value) in whitened.iter().enumerate() {
                    matrix[(i, 6 * id.index() + k)] += value;
                }
            }
        }
        matrix
    }

    fn whiten(&self, body: usize, load: &Load) -> Vector6<f64> {
        let (linear, angular) = &self.factors[body];
        let (torque, force) = (angular.transpose() * load.torque, load.force * *linear);
        Vector6::new(torque.x, torque.y, torque.z, force.x, force.y, force.z)
    }

    /// Loads on `y`; dividing by the mass matrix is then the identity.
    pub fn load(&self, loads: &[Load]) -> DVector<f64> {
        let mut y = DVector::zeros(6 * loads.len());
        for (index, load) in loads.iter().enumerate() {
            y.fixed_rows_mut::<6>(6 * index).copy_from(&self.whiten(index, load));
        }
        y
    }

    /// Angular and linear part of a body's twist.
    pub fn twist(&self, body: usize, y: &DVector<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let (linear, angular) = &self.factors[body];
        let y = y.fixed_rows::<6>(6 * body);
        (angular * y.fixed_rows::<3>(0), *linear * y.fixed_rows::<3>(3))
    }
}

impl Oracle {
    /// Accelerations, joint wrenches and drive forces at time `t`.
    ///
    /// The state must satisfy the constraints in position and speed (see [`Oracle::assemble`]).
    pub fn accelerations(&self, t: f64, states: &[BodyState]) -> Solution {
        self.solve(t, states, None)
    }

    /// Independent rows at a consistent state.
    pub(crate) fn rank(&self, t: f64, states: &[BodyState]) -> usize {
        let matrix = Metric::new(self, states).matrix(self, &self.rows(t, states));
        LeastNorm::new(matrix, self.rank_tolerance).rank()
    }

    /// As `accelerations`, but trusts `rank`: between projections a state is not quite closed, and then rows
    /// that depend on each other seem not to.
    pub(crate) fn solve(&self, t: f64, states: &[BodyState], rank: Option<usize>) -> Solution {
        let rows = self.rows(t, states);
        let applied = self.applied(t, states);
        let metric = Metric::new(self, states);
        let matrix = metric.matrix(self, &rows);
        let mut loads = applied.loads.clone();
        for (index, state) in states.iter().enumerate() {
            let momentum = self.inertia_now(index, state) * state.omega;
            loads[index].torque -= state.omega.cross(&momentum);
        }
        let free = metric.load(&loads);
        let bias = DVector::from_iterator(rows.len(), rows.iter().map(|(_, row)| row.bias));
        let rhs = -bias - &matrix * &free;
        let factors = match rank {
            Some(rank) => LeastNorm::with_rank(matrix, rank),
            None => LeastNorm::new(matrix, self.rank_tolerance),
        };
        let correction = factors.solve(&rhs);
        let lambda = factors.multipliers(&correction);
        let largest = |(angular, linear): (Vector3<f64>, Vector3<f64>)| angular.amax().max(linear.amax());
        let unconstrained = (0..states.len()).map(|body| largest(metric.twist(body, &free)));
        let unconstrained = unconstrained.fold(0.0, f64::max);
        let y = free + correction;
        let (alpha, acceleration) = (0..states.len()).map(|body| metric.twist(body, &y)).unzip();
        let (wrenches, drives) = self.joint_forces(states, &rows, &lambda, &applied.passive, &factors);
        let driven = self.drive_rates(states).into_iter().zip(&drives).map(|(rate, force)| rate * force);
        Solution {
            alpha,
            acceleration,
            wrenches,
            power_supplied: applied.power_supplied + driven.sum::<f64>(),
            drives,
            power_dissipated: applied.power_dissipated,
            rows: rows.len(),
            rank: factors.rank(),
            smallest_kept: factors.smallest(),
            largest_dropped: factors.dropped,
            unconstrained,
        }
    }

    /// Accelerations of a joint's scalar coordinates [rad/s² or m/s²]; none for spherical, fixed and free.
    pub fn joint_accelerations(&self, joint: JointId, states: &[BodyState], solution: &Solution) -> Vec<f64> {
        let geometry = &self.joints[joint.index()];
        let pair = self.frames(states).pair(joint);
        let part = |carrier: Carrier, load: &Load| match carrier {
            Carrier::Ground => 0.0,
            Carrier::Body(id) => {
                let body = id.index();
                load.torque.dot(&solution.alpha[body]) + load.force.dot(&solution.acceleration[body])
            }
        };
        (0..geometry.scalars())
            .map(|k| geometry.coordinate(k, &pair))
            .map(|row| part(geometry.parent, &row.parent) + part(geometry.child, &row.child) + row.bias)
            .collect()
    }

    /// Speeds of the driven coordinates.
    fn drive_rates(&self, states: &[BodyState]) -> Vec<f64> {
        let frames = self.frames(states);
        let mut rates = Vec::new();
        for (index, joint) in self.mechanism.joints.iter().enumerate() {
            let pair = frames.pair(JointId::new(index));
            let rate = |k| self.joints[index].coordinate(k, &pair).rate;
            rates.extend(joint.drives.iter().map(|drive| rate(drive.coordinate)));
        }
        rates
    }

    fn joint_forces(
        &self,
        states: &[BodyState],
        rows: &[(JointId, Row)],
        lambda: &DVector<f64>,
        passive: &[Load],
        factors: &LeastNorm,
    ) -> (Vec<Wrench>, Vec<f64>) {
        let mut wrenches = Vec::new();
        let mut drives = Vec::new();
        let mut at = 0;
        for (index, on_child) in passive.iter().enumerate() {
            let joint = JointId::new(index);
            let arm = self.frames(states).pair(joint).child_point.arm;
            let count = rows[at..].iter().take_while(|(owner, _)| *owner == joint).count();
            let fixed = count - self.mechanism.joints[index].drives.len();
            let mut total = wrench_at(on_child, &arm);
            let mut weights = vec![DVector::zeros(rows.len()); 6];
            for i in at..at + fixed {
                let unit = wrench_at(&rows[i].1.child, &arm);
                total += lambda[i] * unit;
                for (k, weight) in weights.iter_mut().enumerate() {
                    // Coefficients are of order 1, or zero up to rounding, which must not count.
                    weight[i] = if unit[k].abs() > 1e-12 { unit[k] } else { 0.0 };
                }
            }
            // Redundant rows leave order 1, rounding in the factors about 1e-13.
            let unique = [0, 1, 2, 3, 4, 5].map(|k| factors.freedom(&weights[k]) < 1e-6);
            let (force, moment) = (total.fixed_rows::<3>(0).into(), total.fixed_rows::<3>(3).into());
            wrenches.push(Wrench { force, moment, unique });
            drives.extend((at + fixed..at + count).map(|i| lambda[i]));
            at += count;
        }
        (wrenches, drives)
    }
}

/// Force and moment about the end of `arm`, of a load about the mass centre.
fn wrench_at(load: &Load, arm: &Vector3<f64>) -> Vector6<f64> {
    let moment = load.torque - arm.cross(&load.force);
    Vector6::new(load.force.x, load.force.y, load.force.z, moment.x, moment.y, moment.z)
}
