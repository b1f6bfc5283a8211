//! Consistent states: placing bodies from joint coordinates, closing loops by Gauss-Newton, projecting
//! speeds. In: guesses and wishes. Out: states of all bodies. Never knows forces.

use linkwear_codegen::id::JointId;
use linkwear_codegen::model::Carrier;
use nalgebra::{DVector, Vector3};
use thiserror::Error;

use crate::frame::{BodyState, Frame, rotation_by};
use crate::jet::Jet;
use crate::joint::JointMotion;
use crate::least_norm::LeastNorm;
use crate::model::Oracle;
use crate::row::Row;
use crate::solve::Metric;

/// Steps of Gauss-Newton before giving up; from a fair guess five are enough.
const MAX_STEPS: usize = 60;
/// Residual [m or rad, m/s or rad/s] at which a state counts as consistent: some rounding errors of
/// mechanisms of size 1.
const CLOSED: f64 = 1e-13;
/// Residual that is accepted when steps no longer improve it.
const ACCEPTED: f64 = 1e-10;
/// Largest step of a body in one iteration [m and rad], so that Newton stays on its branch.
const LONGEST_STEP: f64 = 0.5;

/// A demand on one scalar coordinate of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wish {
    /// The joint.
    pub joint: JointId,
    /// Which of its coordinates.
    pub coordinate: usize,
    /// Position to reach [rad or m].
    pub position: Option<f64>,
    /// Speed to reach [rad/s or m/s].
    pub speed: Option<f64>,
}

/// Why no consistent state was found.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum AssemblyError {
    /// Positions do not close.
    #[error("loops stay open by {residual:.3e} (m or rad)")]
    Open {
        /// Largest residual left.
        residual: f64,
    },
    /// Speeds do not fit the constraints and wishes.
    #[error("speeds violate the constraints by {residual:.3e} (m/s or rad/s)")]
    Speeds {
        /// Largest residual left.
        residual: f64,
    },
}

impl Oracle {
    /// States of all bodies from the motions of some joints that connect them to the ground.
    /// Bodies that no given joint reaches rest in their reference pose.
    pub fn place(&self, motions: &[(JointId, JointMotion)]) -> Vec<BodyState> {
        let mut states = self.reference_states();
        let mut placed = vec![false; states.len()];
        while let Some((joint, motion)) = motions.iter().find(|(joint, _)| self.reaches(*joint, &placed)) {
            self.place_over(*joint, motion, &mut states, &mut placed);
        }
        states
    }

    /// The start of the file at time 0: joints at their start values (drives at their laws), placed
    /// outwards in file order, not yet closed.
    pub fn guess(&self) -> Vec<BodyState> {
        let mut states = self.reference_states();
        let mut placed = vec![false; states.len()];
        // Joints with a value first: they know best where their child is.
        let given = |joint: JointId| {
            let driven = !self.mechanism.joint(joint).drives.is_empty();
            driven || self.mechanism.starts.iter().any(|start| start.joint == joint)
        };
        let ids = || (0..self.joints.len()).map(JointId::new);
        loop {
            let open = |joint: &JointId| self.reaches(*joint, &placed);
            let next = ids().filter(open).find(|joint| given(*joint)).or_else(|| ids().find(open));
            let Some(joint) = next else { return states };
            let motion = self.start_motion(joint, &states);
            self.place_over(joint, &motion, &mut states, &mut placed);
        }
    }

    /// A consistent state at time 0 with the start values of the file; held ones are met exactly.
    ///
    /// # Errors
    /// If loops do not close or speeds do not fit.
    pub fn start(&self) -> Result<Vec<BodyState>, AssemblyError> {
        let held = self.mechanism.starts.iter().filter(|start| start.held);
        let wishes: Vec<Wish> = held
            .filter(|start| start.coordinate < self.joints[start.joint.index()].scalars())
            .map(|start| Wish {
                joint: start.joint,
                coordinate: start.coordinate,
                position: start.position.as_ref().map(|f| self.number(f)),
                speed: start.speed.as_ref().map(|f| self.number(f)),
            })
            .collect();
        self.assemble(0.0, &self.guess(), &wishes)
    }

    /// The consistent state at time `t` near `guess` that fulfils `wishes`: positions by Gauss-Newton,
    /// then speeds, both with least change in the metric of kinetic energy.
    ///
    /// # Errors
    /// If loops do not close or speeds do not fit.
    pub fn assemble(
        &self,
        t: f64,
        guess: &[BodyState],
        wishes: &[Wish],
    ) -> Result<Vec<BodyState>, AssemblyError> {
        let mut states = guess.to_vec();
        let mut last = f64::INFINITY;
        for step in 0..=MAX_STEPS {
            let rows = self.wished_rows(t, &states, wishes, |wish| wish.position);
            let residual = DVector::from_iterator(rows.len(), rows.iter().map(|(_, row)| row.residual));
            let worst = residual.amax();
            if worst < CLOSED || (worst < ACCEPTED && worst >= 0.5 * last) {
                break;
            }
            if step == MAX_STEPS || worst.is_nan() {
                return Err(AssemblyError::Open { residual: worst });
            }
            last = worst;
            self.step(&mut states, &rows, &residual);
        }
        let rows = self.wished_rows(t, &states, wishes, |wish| wish.speed);
        let metric = Metric::new(self, &states);
        let rates = DVector::from_iterator(rows.len(), rows.iter().map(|(_, row)| row.rate));
        let y = LeastNorm::new(metric.matrix(self, &rows), self.rank_tolerance).solve(&rates);
        for (body, state) in states.iter_mut().enumerate() {
            let (omega, velocity) = metric.twist(body, &y);
            state.omega -= omega;
            state.velocity -= velocity;
        }
        let rows = self.wished_rows(t, &states, wishes, |wish| wish.speed);
        let residual = rows.iter().fold(0.0_f64, |worst, (_, row)| worst.max(row.rate.abs()));
        // Speeds of order 1e3 (Andrews) leave 1e-10 by rounding.
        let fast = states.iter().fold(1.0_f64, |top, s| top.max(s.omega.amax()).max(s.velocity.amax()));
        if residual < ACCEPTED * fast { Ok(states) } else { Err(AssemblyError::Speeds { residual }) }
    }

    fn step(&self, states: &mut [BodyState], rows: &[(JointId, Row)], residual: &DVector<f64>) {
        let metric = Metric::new(self, states);
        let y = LeastNorm::new(metric.matrix(self, rows), self.rank_tolerance).solve(residual);
        let moves: Vec<_> = (0..states.len()).map(|body| metric.twist(body, &y)).collect();
        let longest = moves.iter().fold(0.0_f64, |top, (w, v)| top.max(w.norm()).max(v.norm()));
        let share = (LONGEST_STEP / longest).min(1.0);
        for (state, (turn, shift)) in states.iter_mut().zip(moves) {
            state.rotation = rotation_by(&(-share * turn)) * state.rotation;
            state.centre -= share * shift;
        }
    }

    /// Constraint rows and the wishes for which `value` gives a target, as further rows.
    fn wished_rows(
        &self,
        t: f64,
        states: &[BodyState],
        wishes: &[Wish],
        value: impl Fn(&Wish) -> Option<f64>,
    ) -> Vec<(JointId, Row)> {
        let mut rows = self.rows(t, states);
        let frames = self.frames(states);
        for wish in wishes {
            let Some(target) = value(wish) else { continue };
            let geometry = &self.joints[wish.joint.index()];
            let row = geometry.coordinate(wish.coordinate, &frames.pair(wish.joint));
            // Position and speed are never asked for at once: each sees its own target.
            let law = Jet { value: target, first: target, second: 0.0 };
            rows.push((wish.joint, self.driven(wish.joint, wish.coordinate, row, &law)));
        }
        rows
    }

    fn placed(carrier: Carrier, placed: &[bool]) -> bool {
        match carrier {
            Carrier::Ground => true,
            Carrier::Body(id) => placed[id.index()],
        }
    }

    /// Whether a joint connects a placed body to one that is not.
    fn reaches(&self, joint: JointId, placed: &[bool]) -> bool {
        let geometry = &self.joints[joint.index()];
        Self::placed(geometry.parent, placed) != Self::placed(geometry.child, placed)
    }

    fn place_over(
        &self,
        joint: JointId,
        motion: &JointMotion,
        states: &mut [BodyState],
        placed: &mut [bool],
    ) {
        let geometry = &self.joints[joint.index()];
        let outward = Self::placed(geometry.parent, placed);
        let (from, to) =
            if outward { (geometry.parent, geometry.child) } else { (geometry.child, geometry.parent) };
        let Carrier::Body(id) = to else { return };
        let known = match from {
            Carrier::Ground => Frame::ground(),
            Carrier::Body(b) => Frame { state: states[b.index()], reference: self.bodies[b.index()].centre },
        };
        let reference = self.bodies[id.index()].centre;
        states[id.index()] = geometry.place(&known, outward, &reference, motion);
        placed[id.index()] = true;
    }

    /// Start values of one joint; zero where the file says nothing.
    fn start_motion(&self, joint: JointId, states: &[BodyState]) -> JointMotion {
        let geometry = &self.joints[joint.index()];
        let first = geometry.scalars();
        let count = first + if geometry.kind.is_round() { 6 } else { 0 };
        let (mut position, mut speed) = (vec![0.0; count], vec![0.0; count]);
        for start in self.mechanism.starts.iter().filter(|start| start.joint == joint) {
            if let Some(formula) = &start.position {
                position[start.coordinate] = self.number(formula);
            }
            if let Some(formula) = &start.speed {
                speed[start.coordinate] = self.number(formula);
            }
        }
        for drive in &self.mechanism.joint(joint).drives {
            let law = self.law(&drive.law, 0.0, states);
            position[drive.coordinate] = law.value;
            speed[drive.coordinate] = law.first;
        }
        if geometry.kind.is_round() {
            let turn = Vector3::from_column_slice(&position[first..first + 3]);
            let half = 0.5 * turn.norm();
            // sin(x) / x at 0 is 1.
            let share = if half == 0.0 { 0.5 } else { 0.5 * half.sin() / half };
            let quaternion = [half.cos(), share * turn.x, share * turn.y, share * turn.z];
            position.splice(first..first + 3, quaternion);
        }
        JointMotion { position, speed }
    }
}
