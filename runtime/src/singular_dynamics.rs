//! Forward dynamics without elimination, for positions where the loop rows lose rank.
//! In: [`crate::Entry::EquationsOfMotion`] at a state. Out: accelerations, multipliers, drive forces in
//! the layout of [`crate::Entry::ForwardDynamics`]. Never decides when it is needed.
//!
//! `M v̇ + h = Phi_qᵀ lambda + drive`, `Phi_q v̇ = gamma`, driven accelerations known. All rows take part, dropped
//! ones too: of three parallel cranks any two pass positions in which their rows alone lose rank, and the third
//! takes over. What is known of the rows falls apart:
//! - regular directions: a minimum-norm acceleration meets them;
//! - nearly lost directions: dividing by their small singular value would blow errors up until the
//!   mechanism leaves its branch; states before and after tell its accelerations (a branch is smooth), see [`crate::passage`];
//! - free directions: the masses decide (principle of Gauss), and they do in all others where no branch is known.
//!
//! Multipliers are the smallest ones that balance the regular directions. In lost directions ideal joints may need infinite
//! forces; their part, also of the drives, is left out here, and told by the states beside ([`crate::passage`]).

use crate::evaluate::Evaluator;
use crate::linear::{Orthogonal, add_scaled, dot, largest};

/// Singular values of the constraint rows (scaled to unit length) below this part of the largest one mark
/// nearly lost directions.
pub const NEARLY_LOST: f64 = 1e-3;

/// Below this part they are noise, and lost directions cannot be told from free ones.
pub const LOST_RANK: f64 = 1e-11;

/// Below this part projections leave a direction alone (their first level but for the nearest states), so corrections count it as free.
const FREE: f64 = 1e-4;

/// Dropped rows shorter than this part of the longest row are rounding errors (1e-16) and say nothing.
const ROUNDING: f64 = 1e-9;

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
    scales: Vec<f64>,
    /// For each row in use, its row in the description.
    live: Vec<usize>,
    /// For each row of the description, its place among the kept ones.
    kept: Vec<Option<usize>>,
    /// Longest length that each row has had.
    lengths: Vec<f64>,
    lost_rows: Vec<f64>,
    amounts: Vec<f64>,
    free_directions: Vec<f64>,
    acceleration: Vec<f64>,
    multipliers: Vec<f64>,
    /// Whether the equations come without masses.
    mass_left_out: bool,
    constraints: Orthogonal,
    lost: Orthogonal,
    inertia: Orthogonal,
}

impl SingularSolver {
    /// As [`Evaluator::visit_memory`].
    pub(crate) fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.lengths.iter_mut().for_each(visit);
    }

    /// Whether the last solve had no masses, so that its answers are no numbers.
    pub fn is_without_masses(&self) -> bool {
        self.mass_left_out
    }

    /// Storage for the evaluator's mechanism.
    pub fn new(evaluator: &Evaluator<'_>) -> Self {
        let sizes = evaluator.sizes();
        let (n, all, m) = (sizes.speeds, sizes.all_speeds, sizes.all_rows);
        let (free, driven) = evaluator.layout().speed_places(sizes.drivers);
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
            scales: vec![0.0; m],
            live: Vec::with_capacity(m),
            kept: evaluator.description().rows.iter().map(|row| row.kept).collect(),
            lengths: vec![0.0; m],
            lost_rows: vec![0.0; m * n],
            amounts: vec![0.0; n],
            free_directions: vec![0.0; n * n],
            acceleration: vec![0.0; n],
            multipliers: vec![0.0; m],
            mass_left_out: false,
            constraints: Orthogonal::new(m, n),
            lost: Orthogonal::new(m, n),
            inertia: Orthogonal::new(n, n),
        }
    }

    /// Replaces accelerations, multipliers and drive forces of the last forward dynamics. `branch`: accelerations of the
    /// branch that the motion is on; the regular rows are met from there. True if the rows have lost rank, so that
    /// the forces are those of the regular directions only.
    pub fn solve(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        state: (f64, &[f64], &[f64]),
        branch: Option<&[f64]>,
    ) -> bool {
        let freedoms = self.load_directions(evaluator, state, NEARLY_LOST);
        let (n, kept) = (self.free.len(), evaluator.sizes().rows);
        if self.mass_left_out {
            let answers = n + kept + evaluator.sizes().drivers;
            evaluator.forward_mut()[..answers].fill(f64::NAN);
            return true;
        }
        // As many independent directions as in general positions: nothing is lost.
        let lost = self.constraints.rank() < kept;
        let branch = branch.filter(|_| lost);
        if let Some(branch) = branch {
            for (right, row) in self.right.iter_mut().zip(self.free_jacobian.chunks_exact(n.max(1))) {
                *right -= dot(row, branch);
            }
        }
        self.constraints.solve(&self.right, &mut self.acceleration);
        if let Some(branch) = branch {
            add_scaled(&mut self.acceleration, 1.0, branch);
            self.put_acceleration();
        } else {
            let freedoms = if lost { self.solve_lost_directions(freedoms) } else { freedoms };
            self.put_acceleration();
            self.add_free_motion(freedoms);
        }
        self.imbalance();
        self.constraints.solve_transposed(&self.residual, &mut self.multipliers);
        for (multiplier, scale) in self.multipliers.iter_mut().zip(&self.scales) {
            *multiplier *= scale;
        }
        self.store(evaluator, kept);
        lost
    }

    /// Replaces corrections of positions and of speeds by the motion along free directions that has to come on top, so that
    /// the momentum along these stays as it was: joint forces change none, whatever their errors.
    pub fn keep_momentum(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        state: (f64, &[f64], &[f64]),
        corrections: [&mut [f64]; 2],
    ) {
        let freedoms = self.load_directions(evaluator, state, FREE);
        if self.mass_left_out {
            // What is asked for next ends the run.
            corrections.into_iter().for_each(|correction| correction.fill(0.0));
            return;
        }
        self.all_a.fill(0.0);
        self.bias.fill(0.0);
        for correction in corrections {
            self.acceleration.copy_from_slice(correction);
            self.put_acceleration();
            self.add_free_motion(freedoms);
            for (correction, whole) in correction.iter_mut().zip(&self.acceleration) {
                *correction = whole - *correction;
            }
        }
    }

    /// Puts accelerations, multipliers and drive forces where the forward dynamics puts them.
    fn store(&self, evaluator: &mut Evaluator<'_>, kept: usize) {
        let (n, m, all) = (self.free.len(), self.live.len(), self.all_a.len());
        let output = evaluator.forward_mut();
        output[..n].copy_from_slice(&self.acceleration);
        for (multiplier, row) in self.multipliers.iter().zip(&self.live) {
            if let Some(place) = self.kept[*row] {
                output[n + place] = *multiplier;
            }
        }
        for (driver, place) in self.driven.iter().enumerate() {
            let reaction: f64 = (0..m).map(|k| self.jacobian[k * all + place] * self.multipliers[k]).sum();
            let inertia = dot(&self.mass[place * all..][..all], &self.all_a);
            output[n + kept + driver] = inertia + self.bias[*place] - reaction;
        }
        for (multiplier, row) in self.multipliers.iter().zip(&self.live) {
            evaluator.multipliers_mut()[*row] = *multiplier;
        }
    }

    /// Within the null space of the regular rows: meets the nearly lost ones as well as they can be, and leaves a basis of
    /// the free directions in `null`. Returns their number.
    fn solve_lost_directions(&mut self, freedoms: usize) -> usize {
        let (n, m) = (self.free.len(), self.live.len());
        let null = |i: usize| i * n..(i + 1) * n;
        for k in 0..m {
            let row = &self.free_jacobian[k * n..][..n];
            for i in 0..freedoms {
                self.lost_rows[k * freedoms + i] = dot(row, &self.null[null(i)]);
            }
        }
        if largest(&self.lost_rows[..m * freedoms]) <= LOST_RANK {
            return freedoms;
        }
        for k in 0..m {
            self.right[k] -= dot(&self.free_jacobian[k * n..][..n], &self.acceleration);
        }
        self.lost.factor(&self.lost_rows, m, freedoms, NEARLY_LOST);
        self.lost.solve(&self.right, &mut self.amounts[..freedoms]);
        let left = freedoms - self.lost.rank();
        for i in 0..freedoms {
            add_scaled(&mut self.acceleration, self.amounts[i], &self.null[i * n..][..n]);
        }
        for index in 0..left {
            self.lost.null_direction(index, &mut self.amounts[..freedoms]);
            let direction = &mut self.free_directions[index * n..][..n];
            direction.fill(0.0);
            for i in 0..freedoms {
                add_scaled(direction, self.amounts[i], &self.null[i * n..][..n]);
            }
        }
        self.null[..left * n].copy_from_slice(&self.free_directions[..left * n]);
        left
    }

    /// Loads the equations and leaves the directions that rows below `least` do not hold in `null`. Returns their number.
    fn load_directions(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        (t, q, v): (f64, &[f64], &[f64]),
        least: f64,
    ) -> usize {
        self.load(evaluator, t, q, v);
        let (n, m) = (self.free.len(), self.live.len());
        self.constraints.factor(&self.free_jacobian, m, n, least);
        let freedoms = n - self.constraints.rank();
        for (index, direction) in self.null.chunks_exact_mut(n.max(1)).take(freedoms).enumerate() {
            self.constraints.null_direction(index, direction);
        }
        freedoms
    }

    fn load(&mut self, evaluator: &mut Evaluator<'_>, t: f64, q: &[f64], v: &[f64]) {
        let (n, all) = (self.free.len(), self.all_a.len());
        evaluator.expand(t, q, v, &mut self.all_q, &mut self.all_v);
        self.all_a.fill(0.0);
        for (place, law) in self.driven.iter().zip(evaluator.last_prescribed().chunks_exact(3)) {
            self.all_a[*place] = law[2];
        }
        for (row, kept) in self.kept.iter().enumerate() {
            self.scales[row] = kept.map_or(0.0, |kept| evaluator.row_scales()[kept]);
        }
        let equations = evaluator.equations(t, &self.all_q, &self.all_v);
        equations.unpack_mass(all, &mut self.mass);
        self.mass_left_out = equations.is_without_masses();
        self.bias.copy_from_slice(equations.bias);
        for (length, row) in self.lengths.iter_mut().zip(equations.jacobian.chunks_exact(all.max(1))) {
            *length = length.max(dot(row, row).sqrt());
        }
        let rounding = ROUNDING * largest(&self.lengths);
        self.live.clear();
        for (index, row) in equations.jacobian.chunks_exact(all.max(1)).enumerate() {
            let scale = match self.kept[index] {
                Some(_) => self.scales[index],
                None if self.lengths[index] > rounding => 1.0 / self.lengths[index],
                None => continue,
            };
            let k = self.live.len();
            self.live.push(index);
            self.scales[k] = scale;
            self.jacobian[k * all..][..all].copy_from_slice(row);
            for (entry, place) in self.free_jacobian[k * n..].iter_mut().zip(&self.free) {
                *entry = scale * row[*place];
            }
            self.right[k] = scale * (equations.gamma[index] - dot(row, &self.all_a));
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

    /// Adds the motion along the free directions that leaves no imbalance there.
    fn add_free_motion(&mut self, freedoms: usize) {
        let (n, all) = (self.free.len(), self.all_a.len());
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
        self.inertia.solve(&self.scratch, &mut self.amounts);
        for (amount, direction) in self.amounts.iter().zip(self.null.chunks_exact(n.max(1))).take(freedoms) {
            add_scaled(&mut self.acceleration, *amount, direction);
        }
        self.put_acceleration();
    }
}
