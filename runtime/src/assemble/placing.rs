//! Journals are put where they are wanted. In: a state, offsets and their rates. Out: the state in which loops are closed and journals
//! are there. Never knows why they are wanted there.

use super::held::frozen_speeds;
use super::offset::{offset_columns, offset_places, place_in_motion};
use super::speeds;
use super::state::State;
use crate::evaluate::Evaluator;
use crate::linear::{Orthogonal, add_scaled, largest};
use crate::scalar::cross;

/// Offsets [m] (or nothing, where they may be anything) that journals shall have.
pub(super) type Targets = [Option<[f64; 3]>];

/// Singular values below this part of the largest count as zero.
pub(super) const TOLERANCE: f64 = 1e-10;
const MAX_ITERATIONS: usize = 30;
/// Loops and offsets left by this [m, rad] after placing count as not placed.
const PLACED: f64 = 1e-11;

/// Moves journals to wanted offsets, at rest in their bearings, and everything else as little as possible.
/// Returns whether that was possible; if not, the state is as it was.
pub fn place(evaluator: &mut Evaluator<'_>, t: f64, state: &mut State, targets: &Targets) -> bool {
    place_moving(evaluator, t, state, (targets, &vec![[0.0; 3]; targets.len()]))
}

/// As [`place`], with journals that move in their bearings at these rates [m/s].
pub(crate) fn place_moving(
    evaluator: &mut Evaluator<'_>,
    t: f64,
    state: &mut State,
    (targets, rates): (&Targets, &[[f64; 3]]),
) -> bool {
    let mut placed = state.clone();
    let mut solver = Placing::new(evaluator, targets);
    let fits = solver.close(evaluator, t, &mut placed, targets);
    if !fits {
        return false;
    }
    solver.steer(evaluator, t, &mut placed, rates);
    // A guide may hold a journal still whose bearing turns: it moves there as the loops have it.
    if let Some(v) = speeds::where_open(evaluator, t, &placed) {
        placed.v = v;
    }
    *state = placed;
    true
}

/// Where a journal rests [m] along a unit vector, pressed into its bearing by this force [N].
pub(super) fn pressed_along(
    evaluator: &Evaluator<'_>,
    index: usize,
    direction: [f64; 3],
    force: f64,
) -> [f64; 3] {
    let clearances = evaluator.clearances();
    let clearance = clearances.contacts()[index].clearance;
    let penetration = clearances.joints()[index].resting_penetration(clearance, force);
    let distance = clearances.distance(index, direction, penetration);
    direction.map(|component| component * distance)
}

/// Rates [m/s] of offsets [m] that turn so fast [rad/s].
pub(super) fn carried(turns: &[[f64; 3]], targets: &Targets) -> Vec<[f64; 3]> {
    turns.iter().zip(targets).map(|(turn, target)| cross(*turn, target.unwrap_or_default())).collect()
}

/// Newton on kept rows and offsets together.
struct Placing {
    /// Speeds along which nothing may be moved, and speeds that may not change.
    frozen: [Vec<bool>; 2],
    /// (joint, axis) of every offset that is wanted.
    places: Vec<(usize, usize)>,
    matrix: Vec<f64>,
    right: Vec<f64>,
    delta: Vec<f64>,
    solver: Orthogonal,
}

impl Placing {
    fn new(evaluator: &Evaluator<'_>, targets: &Targets) -> Self {
        let places = offset_places(evaluator, |joint| targets[joint].is_some());
        let (m, n) = (evaluator.sizes().rows + places.len(), evaluator.sizes().speeds);
        let held = evaluator.description().speeds.iter().map(|speed| speed.held).collect();
        Self {
            frozen: [frozen_speeds(evaluator), held],
            places,
            matrix: vec![0.0; m * n],
            right: vec![0.0; m],
            delta: vec![0.0; n],
            solver: Orthogonal::new(m, n),
        }
    }

    fn close(&mut self, evaluator: &mut Evaluator<'_>, t: f64, state: &mut State, targets: &Targets) -> bool {
        let m = evaluator.sizes().rows;
        let mut before = f64::INFINITY;
        for _ in 0..MAX_ITERATIONS {
            self.load(evaluator, t, state, 0);
            let positions = evaluator.last_closure().positions;
            for (right, row) in self.right.iter_mut().zip(evaluator.kept()) {
                *right = -positions[*row];
            }
            let motion = evaluator.contact_motion(t, &state.q, &state.v);
            for (right, place) in self.right[m..].iter_mut().zip(&self.places) {
                let (joint, axis) = *place;
                *right = targets[joint].unwrap_or_default()[axis] - motion[place_in_motion(*place)];
            }
            let size = largest(&self.right);
            if size == 0.0 || (size > 0.5 * before && size < PLACED) {
                return true;
            }
            if size.is_nan() {
                return false;
            }
            before = size;
            self.solver.solve(&self.right, &mut self.delta);
            evaluator.layout().advance(&mut state.q, &self.delta);
            evaluator.layout().normalize(&mut state.q);
        }
        false
    }

    /// Speeds nearest to the present ones with closed loops and journals that move in their bearings at these rates [m/s].
    fn steer(&mut self, evaluator: &mut Evaluator<'_>, t: f64, state: &mut State, rates: &[[f64; 3]]) {
        let m = evaluator.sizes().rows;
        // The second pass removes what rounding of a large first correction left.
        for _ in 0..2 {
            self.load(evaluator, t, state, 1);
            for (right, speed) in self.right.iter_mut().zip(evaluator.last_closure().speeds) {
                *right = -speed;
            }
            let motion = evaluator.contact_motion(t, &state.q, &state.v);
            for (right, place) in self.right[m..].iter_mut().zip(&self.places) {
                let (joint, axis) = *place;
                *right = rates[joint][axis] - motion[place_in_motion(*place) + 3];
            }
            self.solver.solve(&self.right, &mut self.delta);
            add_scaled(&mut state.v, 1.0, &self.delta);
        }
    }

    /// Rows of the loops and of the offsets by the speeds that may move.
    fn load(&mut self, evaluator: &mut Evaluator<'_>, t: f64, state: &State, kind: usize) {
        let (m, n) = (evaluator.sizes().rows, evaluator.sizes().speeds);
        let columns = offset_columns(evaluator, t, &state.q);
        let closure = evaluator.closure(t, &state.q, &state.v);
        self.matrix[..m * n].copy_from_slice(closure.jacobian);
        for (row, (joint, axis)) in self.matrix[m * n..].chunks_exact_mut(n.max(1)).zip(&self.places) {
            row.copy_from_slice(&columns[*joint][*axis]);
        }
        for row in self.matrix.chunks_exact_mut(n.max(1)) {
            row.iter_mut().zip(&self.frozen[kind]).filter(|(_, frozen)| **frozen).for_each(|(x, _)| *x = 0.0);
        }
        self.solver.factor(&self.matrix, m + self.places.len(), n, TOLERANCE);
    }
}
