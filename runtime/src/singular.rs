//! Forward dynamics without elimination, for positions where the loop rows lose rank.
//! In: [`crate::Entry::EquationsOfMotion`] at a state. Out: accelerations, multipliers, drive forces in
//! the layout of [`crate::Entry::ForwardDynamics`]. Never decides when it is needed.
//!
//! `M v̇ + h = Phi_qᵀ lambda + drive`, `Phi_q v̇ = gamma`, driven accelerations known: a minimum-norm
//! acceleration that meets the rows, plus motion in their null space from the masses (principle of Gauss).

use crate::Evaluator;
use crate::linear::{Orthogonal, dot};

/// Singular values of the constraint rows below this part of the largest one count as zero: the
/// acceleration in that direction then follows from the masses alone.
pub const RANK_TOLERANCE: f64 = 1e-10;

/// Storage of the solve.
pub struct SingularSolver {
    all_q: Vec<f64>,
    all_v: Vec<f64>,
    all_a: Vec<f64>,
    /// For each free speed, its place among all speeds.
    free: Vec<usize>,
    /// For each driver, the place of its speed among all speeds.
    driven: Vec<usize>,
    mass: Vec<f64>,
    bias: Vec<f64>,
    jacobian: Vec<f64>,
    free_jacobian: Vec<f64>,
    right: Vec<f64>,
    null: Vec<f64>,
    reduced: Vec<f64>,
    residual: Vec<f64>,
    scratch: Vec<f64>,
    acceleration: Vec<f64>,
    multipliers: Vec<f64>,
    constraints: Orthogonal,
    inertia: Orthogonal,
}

impl SingularSolver {
    /// Storage for the evaluator's mechanism.
    #[must_use]
    pub fn new(evaluator: &Evaluator<'_>) -> Self {
        let sizes = evaluator.sizes();
        let (n, all, m) = (sizes.speeds, sizes.all_speeds, sizes.rows);
        let mut free = Vec::with_capacity(n);
        let mut driven = vec![0; sizes.drivers];
        for group in &evaluator.layout().groups {
            match group.motion.driver() {
                Some(driver) => driven[driver] = group.all_speed,
                None => free.extend((0..group.motion.lengths().1).map(|i| group.all_speed + i)),
            }
        }
        Self {
            all_q: vec![0.0; sizes.all_coordinates],
            all_v: vec![0.0; all],
            all_a: vec![0.0; all],
            free,
            driven,
            mass: vec![0.0; all * all],
            bias: vec![0.0; all],
            jacobian: vec![0.0; m * all],
            free_jacobian: vec![0.0; m * n],
            right: vec![0.0; m],
            null: vec![0.0; n * n],
            reduced: vec![0.0; n * n],
            residual: vec![0.0; n],
            scratch: vec![0.0; n],
            acceleration: vec![0.0; n],
            multipliers: vec![0.0; m],
            constraints: Orthogonal::new(m, n),
            inertia: Orthogonal::new(n, n),
        }
    }

    /// Replaces accelerations, multipliers and drive forces of the last forward dynamics.
    pub fn solve(&mut self, evaluator: &mut Evaluator<'_>, t: f64, q: &[f64], v: &[f64]) {
        self.load(evaluator, t, q, v);
        let (n, m, all) = (self.free.len(), self.right.len(), self.all_a.len());
        self.constraints.factor(&self.free_jacobian, m, n, RANK_TOLERANCE);
        self.constraints.solve(&self.right, &mut self.acceleration);
        self.put_acceleration();
        self.add_free_motion();
        self.imbalance();
        self.constraints.solve_transposed(&self.residual, &mut self.multipliers);
        let output = evaluator.forward_mut();
        output[..n].copy_from_slice(&self.acceleration);
        output[n..n + m].copy_from_slice(&self.multipliers);
        for (driver, place) in self.driven.iter().enumerate() {
            let reaction: f64 = (0..m).map(|k| self.jacobian[k * all + place] * self.multipliers[k]).sum();
            let inertia = dot(&self.mass[place * all..][..all], &self.all_a);
            output[n + m + driver] = inertia + self.bias[*place] - reaction;
        }
    }

    fn load(&mut self, evaluator: &mut Evaluator<'_>, t: f64, q: &[f64], v: &[f64]) {
        let (n, all) = (self.free.len(), self.all_a.len());
        evaluator.expand(t, q, v, &mut self.all_q, &mut self.all_v);
        self.all_a.fill(0.0);
        for (place, law) in self.driven.iter().zip(evaluator.last_prescribed().chunks_exact(3)) {
            self.all_a[*place] = law[2];
        }
        let equations = evaluator.equations(t, &self.all_q, &self.all_v);
        equations.unpack_mass(all, &mut self.mass);
        self.bias.copy_from_slice(equations.bias);
        self.jacobian.copy_from_slice(equations.jacobian);
        for (k, row) in equations.jacobian.chunks_exact(all.max(1)).enumerate() {
            for (j, place) in self.free.iter().enumerate() {
                self.free_jacobian[k * n + j] = row[*place];
            }
            self.right[k] = equations.gamma[k] - dot(row, &self.all_a);
        }
    }

    fn put_acceleration(&mut self) {
        for (place, a) in self.free.iter().zip(&self.acceleration) {
            self.all_a[*place] = *a;
        }
    }

    /// `residual = M v̇ + h` on the free speeds.
    fn imbalance(&mut self) {
        let all = self.all_a.len();
        for (residual, place) in self.residual.iter_mut().zip(&self.free) {
            *residual = dot(&self.mass[place * all..][..all], &self.all_a) + self.bias[*place];
        }
    }

    /// Adds the motion in the null space that leaves no imbalance there.
    fn add_free_motion(&mut self) {
        let (n, all) = (self.free.len(), self.all_a.len());
        let freedoms = n - self.constraints.rank();
        for (index, direction) in self.null.chunks_exact_mut(n.max(1)).take(freedoms).enumerate() {
            self.constraints.null_direction(index, direction);
        }
        self.imbalance();
        for i in 0..freedoms {
            let direction = &self.null[i * n..][..n];
            for (value, place) in self.scratch.iter_mut().zip(&self.free) {
                let row = &self.mass[place * all..][..all];
                *value = self.free.iter().zip(direction).map(|(place, x)| row[*place] * x).sum();
            }
            for j in 0..freedoms {
                self.reduced[i * freedoms + j] = dot(&self.null[j * n..][..n], &self.scratch);
            }
        }
        for i in 0..freedoms {
            self.scratch[i] = -dot(&self.null[i * n..][..n], &self.residual);
        }
        self.inertia.factor(&self.reduced, freedoms, freedoms, f64::EPSILON);
        self.inertia.solve(&self.scratch, &mut self.residual);
        for (amount, direction) in self.residual.iter().zip(self.null.chunks_exact(n.max(1))).take(freedoms) {
            crate::linear::add_scaled(&mut self.acceleration, *amount, direction);
        }
        self.put_acceleration();
    }
}
