//! A start for joints with clearance: each journal touches where the reaction of an ideal joint would press it.
//! In: a mechanism, a time. Out: a consistent [`State`], and memories of contacts that rest.
//!
//! The journals are first put into the middle of their bearings without moving there. The contact forces that leave
//! them no acceleration are the ideal reactions: accelerations are linear in the wrenches, so unit forces tell. Each
//! journal then goes against its force, by the clearance and the penetration of a resting contact. A joint whose
//! offset is demanded in the file stays where the file puts it.

use super::consistent::assemble_with;
use super::held::frozen_speeds;
use super::offset::{offset_columns, offset_places};
use super::speeds;
use super::state::State;
use super::within_clearance::{self, DEEPEST_START};
use crate::error::{AssemblyError, SetupError};
use crate::evaluate::Evaluator;
use crate::linear::{Orthogonal, add_scaled, largest};
use crate::system::{CONTACT_MOTION, CONTACT_WRENCH};

/// Offsets [m] (or nothing, where they may be anything) that journals shall have.
type Targets = [Option<[f64; 3]>];

/// Singular values below this part of the largest count as zero.
const TOLERANCE: f64 = 1e-10;
const MAX_ITERATIONS: usize = 30;
/// Loops and offsets left by this [m, rad] after placing count as not placed.
const PLACED: f64 = 1e-11;
/// A speed that moves an offset by less than this [m/rad, 1] does not move it.
const MOVES: f64 = 1e-9;
/// Half width in time of the difference that gives the offsets' own accelerations [s].
const DIFFERENCE: f64 = 1e-6;

/// As [`assemble_with`]; where the mechanism has joints with clearance they touch as the file says, or rest on
/// the side to which the ideal reaction presses them. Where it does not close with centred journals they stay as
/// assembled, or as near to the middle as the loops let them. What contacts remember begins here.
///
/// # Errors
/// As [`assemble_with`]; [`SetupError::Clearance`] if a clearance is no clearance,
/// [`AssemblyError::OutsideClearance`] if the parts of a joint cannot be put together.
pub fn assemble_static_contact(evaluator: &mut Evaluator<'_>, t: f64) -> Result<State, AssemblyError> {
    let mut state = assemble_with(evaluator, t)?;
    if evaluator.clearances().is_empty() {
        return Ok(state);
    }
    check_clearances(evaluator, t, &state)?;
    let (resting, placeable) = rest(evaluator, t, &state);
    let rests = resting.is_some();
    state = resting.unwrap_or(state);
    if !rests && within_clearance::check(evaluator, t, &state, (&placeable, 0.0)).is_err() {
        // It may close thanks to its clearances alone.
        within_clearance::pull_in(evaluator, t, &mut state)?;
    }
    // Journals at rest are as deep as their load presses them.
    let asked: Vec<bool> = placeable.iter().map(|free| !(rests && *free)).collect();
    within_clearance::check(evaluator, t, &state, (&asked, DEEPEST_START))?;
    evaluator.evaluate_contacts(t, &state.q, &state.v);
    evaluator.clearances_mut().begin();
    Ok(state)
}

/// The state near a guess of coordinates and speeds at time `t` [s] in which the loops are closed and every journal rests
/// where the reaction of an ideal joint presses it; nothing, if the mechanism does not close with centred journals.
pub fn resting_contacts(evaluator: &mut Evaluator<'_>, t: f64, guess: &State) -> Option<State> {
    rest(evaluator, t, guess).0
}

/// The same, with the contacts whose journals are free to rest.
fn rest(evaluator: &mut Evaluator<'_>, t: f64, guess: &State) -> (Option<State>, Vec<bool>) {
    let columns = offset_columns(evaluator, t, &guess.q);
    let placeable = free_contacts(evaluator, &columns);
    let centred: Vec<Option<[f64; 3]>> = placeable.iter().map(|free| free.then_some([0.0; 3])).collect();
    let mut state = guess.clone();
    if !place(evaluator, t, &mut state, &centred) {
        return (None, placeable);
    }
    let forces = ideal_reactions(evaluator, t, &state, &placeable);
    let targets: Vec<_> = (0..placeable.len())
        .map(|index| placeable[index].then(|| resting_offset(evaluator, index, forces[index])))
        .collect();
    let rests = place(evaluator, t, &mut state, &targets);
    (rests.then_some(state), placeable)
}

/// Whether every clearance is above zero and below the radius of its journal.
///
/// # Errors
/// [`SetupError::Clearance`] for the first that is not.
pub fn check_clearances(evaluator: &mut Evaluator<'_>, t: f64, state: &State) -> Result<(), SetupError> {
    evaluator.evaluate_contacts(t, &state.q, &state.v);
    let description = evaluator.description();
    let clearances = evaluator.clearances();
    for (index, touch) in clearances.contacts().iter().enumerate() {
        let journal_radius = clearances.joints()[index].journal_radius();
        let fits = touch.clearance > 0.0 && touch.clearance < journal_radius;
        if !fits {
            let joint = description.contacts[index].joint.to_string();
            return Err(SetupError::Clearance { joint, clearance: touch.clearance, journal_radius });
        }
    }
    Ok(())
}

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

/// Contacts whose offset no demanded start value fixes.
fn free_contacts(evaluator: &Evaluator<'_>, columns: &[[Vec<f64>; 3]]) -> Vec<bool> {
    let fixed = frozen_speeds(evaluator);
    let moved = |column: &[Vec<f64>; 3], speed: usize| column.iter().any(|row| row[speed].abs() > MOVES);
    columns.iter().map(|column| !(0..fixed.len()).any(|speed| fixed[speed] && moved(column, speed))).collect()
}

/// Where a journal rests under an ideal reaction [N] on it.
fn resting_offset(evaluator: &Evaluator<'_>, index: usize, force: [f64; 3]) -> [f64; 3] {
    let clearances = evaluator.clearances();
    let [x, y, z] = force;
    let size = (x * x + y * y + z * z).sqrt();
    if size.is_nan() || size <= 0.0 {
        return [0.0; 3];
    }
    let clearance = clearances.contacts()[index].clearance;
    let normal = force.map(|component| -component / size);
    let penetration = clearances.joints()[index].resting_penetration(clearance, size);
    let distance = clearances.distance(index, normal, penetration);
    normal.map(|component| component * distance)
}

/// Forces [N] on the journals that leave their offsets without acceleration.
fn ideal_reactions(
    evaluator: &mut Evaluator<'_>,
    t: f64,
    state: &State,
    placeable: &[bool],
) -> Vec<[f64; 3]> {
    let (q, v) = (&state.q[..], &state.v[..]);
    let columns = offset_columns(evaluator, t, q);
    let places = offset_places(evaluator, |joint| placeable[joint]);
    evaluator.evaluate_contacts(t, q, v);
    let mut wrenches = evaluator.clearances().wrenches().to_vec();
    for (joint, wrench) in wrenches.chunks_exact_mut(CONTACT_WRENCH).enumerate() {
        if placeable[joint] {
            wrench.fill(0.0);
        }
    }
    let own = own_accelerations(evaluator, t, state, &places);
    let project = |accelerations: &[f64]| -> Vec<f64> {
        let along =
            |(joint, axis): &(usize, usize)| crate::linear::dot(&columns[*joint][*axis], accelerations);
        places.iter().map(along).collect()
    };
    let unloaded = project(evaluator.accelerations_under(t, q, v, &wrenches).values);
    let n = places.len();
    let mut matrix = vec![0.0; n * n];
    for (column, (joint, axis)) in places.iter().enumerate() {
        wrenches[joint * CONTACT_WRENCH + axis] += 1.0;
        let loaded = project(evaluator.accelerations_under(t, q, v, &wrenches).values);
        wrenches[joint * CONTACT_WRENCH + axis] -= 1.0;
        for row in 0..n {
            matrix[row * n + column] = loaded[row] - unloaded[row];
        }
    }
    let right: Vec<f64> = unloaded.iter().zip(&own).map(|(a, b)| -(a + b)).collect();
    let mut amounts = vec![0.0; n];
    let mut solver = Orthogonal::new(n, n);
    solver.factor(&matrix, n, n, TOLERANCE);
    solver.solve(&right, &mut amounts);
    let mut forces = vec![[0.0; 3]; placeable.len()];
    for ((joint, axis), amount) in places.iter().zip(&amounts) {
        forces[*joint][*axis] = *amount;
    }
    forces
}

/// Accelerations of the offsets without accelerations of the speeds, by a central difference along the motion.
fn own_accelerations(
    evaluator: &mut Evaluator<'_>,
    t: f64,
    state: &State,
    places: &[(usize, usize)],
) -> Vec<f64> {
    let mut rates = |step: f64| -> Vec<f64> {
        let mut q = state.q.clone();
        let moved: Vec<f64> = state.v.iter().map(|v| step * v).collect();
        evaluator.layout().advance(&mut q, &moved);
        let motion = evaluator.contact_motion(t + step, &q, &state.v);
        places.iter().map(|(joint, axis)| motion[joint * CONTACT_MOTION + 3 + axis]).collect()
    };
    let (after, before) = (rates(DIFFERENCE), rates(-DIFFERENCE));
    after.iter().zip(&before).map(|(a, b)| (a - b) / (2.0 * DIFFERENCE)).collect()
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
            for (right, (joint, axis)) in self.right[m..].iter_mut().zip(&self.places) {
                let wanted = targets[*joint].unwrap_or_default()[*axis];
                *right = wanted - motion[joint * CONTACT_MOTION + axis];
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
            for (right, (joint, axis)) in self.right[m..].iter_mut().zip(&self.places) {
                *right = rates[*joint][*axis] - motion[joint * CONTACT_MOTION + 3 + axis];
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
