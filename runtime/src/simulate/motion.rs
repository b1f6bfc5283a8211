//! The mechanism as an initial value problem on its constraints: state = coordinates, speeds, work
//! supplied, work dissipated, and per joint with clearance the [`Totals`]. In: states. Out: derivatives,
//! projected states. Never knows samples.

mod problem;

use std::ops::Range;

use super::modal_sizes::ModalSizes;
use super::slopes::Slopes;
use crate::assemble::{State, motion_sizes};
use crate::bundle::{TOTALS, WORKS, is_energy};
use crate::clearance_joint::ContactState;
use crate::dynamics::Dynamics;
use crate::error::RunError;
use crate::evaluate::Evaluator;
use crate::ledger::{Energies, sum};
use crate::linear::{add_scaled, is_finite, largest, replace};
use crate::projection::{Correction, POSITION_TOLERANCE, Projector};
pub(super) use crate::regularity::PROJECTED_STAGES;
use crate::tables::Motion;

/// A projection may move coordinates or speeds by this part of what the step itself moved them...
pub const BRANCH_PART: f64 = 0.1;
/// ...or by this much [rad, m, rad/s, m/s], relative to values above 1.
pub const JUMP_FLOOR: f64 = 1e-6;

/// Starts smaller than this [m, rad, m/s, rad/s] are rounding of assembly.
const AT_REST: f64 = 1e-10;

/// Steps from regular states do not end below this regularity: put onto the constraints there, for rounding alone, the direction
/// that is nearly lost turns the speeds. Of 240 tolerances of the N four-bar with two cells none is then off by more than 4e-9 m;
/// without it, or at 1e-4, by 4e-8 to 6e-8.
const SHUNNED_END: f64 = 1e-5;
/// Steps with a tolerance may leave loops open by this part of it [m, rad]. A turn with clearance of 4,200 steps at 1e-5 corrects
/// its loops 16 times then, and its wear integral changes by 2e-7 of itself.
const LEFT_OPEN: f64 = 1e-5;

/// Rounding may be this many times what one sample of it shows: 27 was seen with forty loops in a row.
const SAMPLED: f64 = 100.0;

/// Times that slopes of several states are told one by one: as many take about as long as to write code for several at once.
const ASKED_ALONE: u32 = 200;

/// Energies smaller than this [J] are noise to the step control.
const ENERGY_FLOOR: f64 = 1e-9;

/// Offsets of a journal are judged relative to the clearance, their rates relative to the clearance times this
/// [1/s]: contacts ring at some kilohertz.
const CONTACT_RATE: f64 = 1e4;

/// What a contact has done since the state was joined.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Totals {
    /// Wear integral [J].
    pub(super) wear: f64,
    /// Depth by the contact area [m].
    pub(super) depth: f64,
    /// Integral of the normal force [N s].
    pub(super) impulse: f64,
    /// Energy lost in damping and friction [J].
    pub(super) loss: f64,
}

impl Totals {
    pub(super) fn of(values: &[f64]) -> Self {
        Self { wear: values[0], depth: values[1], impulse: values[2], loss: values[3] }
    }

    /// What came on top of `before`.
    pub(super) fn since(self, before: Self) -> Self {
        Self {
            wear: self.wear - before.wear,
            depth: self.depth - before.depth,
            impulse: self.impulse - before.impulse,
            loss: self.loss - before.loss,
        }
    }
}

/// Dynamics and projection of one mechanism, with what was counted.
pub(super) struct ConstrainedMotion<'a> {
    pub(super) dynamics: Dynamics<'a>,
    pub(super) projections: u64,
    pub(super) projector: Projector,
    stage: Vec<f64>,
    /// A state beside another, and its slope.
    beside: Vec<f64>,
    coordinates: usize,
    speeds: usize,
    contacts: usize,
    /// Natural size of every coordinate and speed, 1 unless it moves a journal in its bearing.
    scales: Vec<f64>,
    /// Longest lever arm of the loops [m].
    pub(super) arm: f64,
    /// Natural size of the motion along every free speed.
    pub(super) sizes: Vec<f64>,
    /// Largest kinetic energy so far [J]: the scale of the work quadratures.
    pub(super) energy_scale: f64,
    /// How many times slopes of several states are still told one by one before they are told at once: code for several is
    /// written when it is asked for first.
    alone: u32,
    /// What tells them then.
    slopes: Option<Slopes<'a>>,
    /// Sizes of deflections, if steps are to go by them.
    modal: ModalSizes,
    /// Factor on how far loops may stay open after a step, in regular positions.
    looseness: f64,
    /// Kinetic and potential energy [J] at a time [s], if they were evaluated elsewhere.
    known_energy: Option<(f64, (f64, f64))>,
    /// Regularity of the last state that counted.
    regularity_reached: f64,
}

/// The natural size of coordinates and speeds of a mechanism that nothing drives: the largest of its start, below 1 m, rad, m/s, rad/s.
/// What swings by a micrometre is asked for beside a micrometre. Nothing of what is driven, of bodies that turn freely, and from rest,
/// where a start tells nothing.
fn small_motion(evaluator: &Evaluator<'_>, state: &State) -> Option<f64> {
    let turns_freely = evaluator.layout().free().any(|group| !matches!(group.motion, Motion::Scalar { .. }));
    let size = largest(&state.q).max(largest(&state.v));
    let tells = !turns_freely && evaluator.description().drivers.is_empty() && (AT_REST..1.0).contains(&size);
    tells.then_some(size)
}

impl<'a> ConstrainedMotion<'a> {
    pub(super) fn new(dynamics: Dynamics<'a>) -> Self {
        let sizes = dynamics.evaluator.sizes();
        let projector = Projector::new(&dynamics.evaluator);
        let state = sizes.flat_state();
        Self {
            dynamics,
            projections: 0,
            projector,
            stage: vec![0.0; state],
            beside: vec![0.0; 2 * state],
            coordinates: sizes.coordinates,
            speeds: sizes.speeds,
            contacts: sizes.contacts,
            scales: vec![1.0; sizes.coordinates + sizes.speeds],
            arm: 1.0,
            sizes: vec![1.0; sizes.speeds],
            energy_scale: ENERGY_FLOOR,
            alone: ASKED_ALONE,
            slopes: None,
            modal: ModalSizes::default(),
            looseness: 1.0,
            known_energy: None,
            regularity_reached: 1.0,
        }
    }

    /// Lets steps leave loops open by what is nothing beside their tolerance.
    pub(super) fn loosen(&mut self, tolerance: f64) {
        self.looseness = (LEFT_OPEN * tolerance / POSITION_TOLERANCE).max(1.0);
    }

    /// Has errors of deflections judged beside the deflections that loads of their size hold.
    pub(super) fn judge_modes(&mut self, t: f64, y: &[f64]) {
        let (q, v) = y[..self.first_integral()].split_at(self.coordinates);
        self.modal = ModalSizes::new(&mut self.dynamics.evaluator, (t, q, v));
    }

    /// As [`Self::visit_memory`], with sizes before: they are those of a start, which may have had other parameters.
    pub(super) fn visit_sizes_and_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        visit(&mut self.arm);
        self.scales.iter_mut().chain(&mut self.sizes).for_each(&mut *visit);
        self.modal.visit_modes(visit);
        self.use_sizes();
        self.visit_memory(visit);
    }

    /// As [`crate::Evaluator::visit_memory`], of all that it stands on too.
    pub(super) fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.dynamics.visit_memory(visit);
        self.modal.visit_memory(visit);
        self.modal.write(self.scales.split_at_mut(self.coordinates));
        visit(&mut self.energy_scale);
        visit(&mut self.regularity_reached);
    }

    /// Kinetic and potential energy of a flat state [J].
    pub(super) fn energy(&mut self, t: f64, y: &[f64]) -> (f64, f64) {
        if let Some((known_at, energy)) = self.known_energy.take()
            && known_at.to_bits() == t.to_bits()
        {
            return energy;
        }
        let (q, v, _) = self.split(y);
        self.dynamics.evaluator.energy(t, q, v)
    }

    /// Takes over what was evaluated elsewhere at the one state that will be asked for at time `t`: energies, contacts.
    pub(super) fn take_over(
        &mut self,
        t: f64,
        energy: (f64, f64),
        contact: impl Fn(usize, &ContactState) -> ContactState,
    ) {
        self.known_energy = Some((t, energy));
        self.dynamics.evaluator.take_over_contacts(t, contact);
    }

    /// Forgets it.
    pub(super) fn forget(&mut self) {
        self.known_energy = None;
        self.dynamics.evaluator.forget_contacts();
    }

    /// Natural sizes of coordinates and speeds.
    pub(super) fn state_scales(&self) -> &[f64] {
        &self.scales
    }

    /// Factor on how far loops may stay open after a step, in regular positions.
    pub(super) fn looseness(&self) -> f64 {
        self.looseness
    }

    /// Takes over the residuals of all rows at a step's end that needs no projection.
    pub(super) fn take_over_loops(&mut self, positions: &[f64]) {
        self.projector.take_over(self.dynamics.evaluator.loop_error_of(positions));
    }

    /// The flat state of a start without any work done.
    pub(super) fn join(&self, state: &State) -> Vec<f64> {
        [&state.q[..], &state.v, &vec![0.0; WORKS + TOTALS * self.contacts]].concat()
    }

    /// Place of the work in a flat state; everything from there on is a plain integral.
    pub(super) fn first_integral(&self) -> usize {
        self.coordinates + self.speeds
    }

    /// What the contacts have done, of a flat state, joint by joint.
    pub(super) fn totals<'y>(&self, y: &'y [f64]) -> impl Iterator<Item = Totals> + 'y {
        y[self.first_integral() + WORKS..].chunks_exact(TOTALS).map(Totals::of)
    }

    /// All energies of a flat state [J]; the wrenches of contacts are then those of this state.
    pub(super) fn energies(&mut self, t: f64, y: &[f64]) -> Energies<f64> {
        let (q, v, (supplied, dissipated)) = self.split(y);
        self.dynamics.evaluator.evaluate_contacts(t, q, v);
        let known = self.dynamics.evaluator.energy_of_step();
        let (kinetic, potential) = known.unwrap_or_else(|| self.energy(t, y));
        Energies {
            kinetic,
            potential,
            supplied,
            dissipated,
            elastic: self.dynamics.evaluator.clearances().elastic_energy(),
            contact_loss: sum(self.totals(y).map(|totals| totals.loss)),
        }
    }

    /// Work of wear of all contacts until a flat state [J].
    pub(super) fn worn(&self, y: &[f64]) -> f64 {
        self.totals(y).map(|totals| totals.wear).sum()
    }

    /// Penetration of one contact at a flat state [m].
    pub(super) fn penetration(&mut self, joint: usize, t: f64, y: &[f64]) -> f64 {
        let (q, v) = y[..self.first_integral()].split_at(self.coordinates);
        self.dynamics.evaluator.evaluate_contacts(t, q, v);
        self.dynamics.evaluator.clearances().contacts()[joint].penetration()
    }

    /// Learns at a state how large the mechanism is, and how small the motion in its clearances.
    pub(super) fn learn_sizes(&mut self, t: f64, state: &State) {
        self.arm = self.dynamics.evaluator.longest_arm(t, &state.q, &state.v);
        if self.contacts == 0 {
            if let Some(size) = small_motion(&self.dynamics.evaluator, state) {
                self.scales.fill(size);
            }
            self.use_sizes();
            return;
        }
        self.sizes = motion_sizes(&mut self.dynamics.evaluator, t, state);
        let (evaluator, sizes) = (&self.dynamics.evaluator, &self.sizes);
        let (coordinates, speeds) = self.scales.split_at_mut(self.coordinates);
        for (scale, size) in speeds.iter_mut().zip(sizes) {
            *scale = (size * CONTACT_RATE).min(1.0);
        }
        for group in evaluator.layout().free() {
            let own = |from: usize, to: usize| {
                sizes[group.speed + from..group.speed + to]
                    .iter()
                    .fold(1.0_f64, |least, size| least.min(*size))
            };
            let places = &mut coordinates[group.coordinate..];
            match group.motion {
                Motion::Scalar { .. } => places[0] = own(0, 1),
                Motion::Rotation => places[..4].fill(own(0, 3)),
                Motion::Pose => {
                    places[..4].fill(own(0, 3));
                    places[4..7].fill(own(3, 6));
                }
            }
        }
        self.use_sizes();
    }

    /// Projections go by the sizes that are known now.
    fn use_sizes(&mut self) {
        for projector in [&mut self.projector, &mut self.dynamics.passage.projector] {
            projector.set_arm(self.arm);
            if self.contacts > 0 {
                projector.set_sizes(&self.sizes);
            }
        }
    }

    /// Coordinates, speeds, and (work supplied, work dissipated) of a flat state.
    pub(super) fn split<'y>(&self, y: &'y [f64]) -> (&'y [f64], &'y [f64], (f64, f64)) {
        let (q, rest) = y.split_at(self.coordinates);
        let (v, work) = rest.split_at(self.speeds);
        (q, v, (work[0], work[1]))
    }

    /// Coordinates, and speeds to be written to, of a flat state.
    pub(super) fn split_mut<'y>(&self, y: &'y mut [f64]) -> (&'y [f64], &'y mut [f64]) {
        let (q, rest) = y.split_at_mut(self.coordinates);
        (q, &mut rest[..self.speeds])
    }

    /// Names and values of all angles that count turns: free ones of a flat state, and those of drivers, prescribed last.
    pub(super) fn angles<'y>(&'y self, y: &'y [f64]) -> impl Iterator<Item = (&'y str, f64)> {
        let description = self.dynamics.evaluator.description();
        let free = description.coordinates.iter().zip(self.split(y).0);
        let free = free.filter(|(info, _)| info.unit == "rad").map(|(info, angle)| (&*info.name, *angle));
        let laws = self.dynamics.evaluator.last_prescribed().chunks_exact(3);
        let driven = description.drivers.iter().zip(laws).filter(|(driver, _)| driver.angular);
        free.chain(driven.map(|(driver, law)| (&*driver.joint, law[0])))
    }

    /// Puts a state onto the constraints, however far it moves.
    pub(super) fn put_on(&mut self, t: f64, y: &mut [f64]) -> Result<Correction, RunError> {
        self.put_within(t, y, 1.0)
    }

    /// The same, up to a factor on the tolerances.
    fn put_within(&mut self, t: f64, y: &mut [f64], looseness: f64) -> Result<Correction, RunError> {
        let (q, rest) = y.split_at_mut(self.coordinates);
        let v = &mut rest[..self.speeds];
        let regularity = if self.dynamics.is_near_singular() { 0.0 } else { self.dynamics.nearness() };
        let evaluator = &mut self.dynamics.evaluator;
        let correction =
            self.projector.project(evaluator, t, (q, v), regularity * looseness).map_err(|open| {
                let error = open.error;
                let joint = evaluator.joint_of_row(error.worst);
                if error.metres.is_nan() || error.radians.is_nan() {
                    return RunError::NonFinite { t, what: format!("loop residual of {joint}") };
                }
                RunError::LostAssembly { t, joint, residual_m: error.metres, residual_rad: error.radians }
            })?;
        self.projections += u64::from(correction.moved());
        Ok(correction)
    }

    /// The same of a state that no step has evaluated: how regular it is has to be seen first, or the nearly lost
    /// directions would be corrected that another state still held.
    pub(super) fn put_sample_on(&mut self, t: f64, y: &mut [f64]) -> Result<Correction, RunError> {
        if self.dynamics.evaluator.sizes().rows > 0 {
            let (q, v, _) = self.split(y);
            self.dynamics.see_nearness(t, q, v);
        }
        self.put_on(t, y)
    }

    /// After a projection: moves the state along free directions so that the projection changed no momentum there. What it
    /// takes away near a singular position are errors of large joint forces, by rounding or by the step, and those go
    /// with the masses; the shortest way back onto the constraints does not.
    fn keep_momentum(&mut self, t: f64, y: &mut [f64]) -> Result<(), RunError> {
        let (q, rest) = y.split_at_mut(self.coordinates);
        let v = &mut rest[..self.speeds];
        let Dynamics { evaluator, solver, .. } = &mut self.dynamics;
        let [positions, speeds] = self.projector.moved();
        solver.keep_momentum(evaluator, (t, q, v), [positions, speeds]);
        evaluator.layout().advance(q, positions);
        add_scaled(v, 1.0, speeds);
        self.put_on(t, y).map(drop)
    }

    /// Writes rates of the coordinates, and powers of drivers, forces and contacts at the last forward dynamics:
    /// wear grows with the state and by its method, [CS (18)-(20)].
    pub(super) fn powers(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
        coordinates: &mut [f64],
        powers: &mut [f64],
    ) {
        let rates = self.dynamics.evaluator.rates(t, q, v);
        coordinates.copy_from_slice(rates.coordinates);
        (powers[0], powers[1]) = (rates.supplied, rates.dissipated);
        self.contact_powers(&mut powers[WORKS..]);
    }

    /// Whether all are numbers, and none is infinite.
    fn contact_powers(&self, powers: &mut [f64]) -> bool {
        let touches = self.dynamics.evaluator.clearances().contacts();
        let mut finite = true;
        for (powers, touch) in powers.as_chunks_mut::<TOTALS>().0.iter_mut().zip(touches) {
            let rates = [touch.wear_power, touch.depth_rate, touch.normal_force, touch.loss];
            finite &= is_finite(&rates);
            *powers = rates;
        }
        finite
    }

    /// Whether what a projection did to the end of a step, kept in `stage` as it was, is as small as errors of a step are.
    fn check_correction(&self, t: f64, before: &[f64], correction: &Correction) -> Result<(), RunError> {
        let moved = |range: Range<usize>| {
            let ends = before[range.clone()].iter().zip(&self.stage[range]);
            ends.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
        };
        let q_range = 0..self.coordinates;
        let v_range = self.coordinates..self.coordinates + self.speeds;
        let limit = |own: f64, values: &[f64]| (BRANCH_PART * own).max(JUMP_FLOOR * largest(values).max(1.0));
        let q_limit = limit(moved(q_range.clone()), &before[q_range]);
        // Speeds may stand still while the mechanism moves on: they count by their size as well.
        let v_size = largest(&before[v_range.clone()]);
        let v_limit = limit(moved(v_range.clone()).max(v_size), &before[v_range]);
        let name = |index| self.dynamics.evaluator.speed_name(index);
        if correction.position > q_limit {
            let variable = name(correction.worst);
            return Err(RunError::BranchChange { t, variable, jump: correction.position });
        }
        if correction.speed > v_limit {
            let variable = format!("speed {}", name(correction.worst_speed));
            return Err(RunError::BranchChange { t, variable, jump: correction.speed });
        }
        Ok(())
    }

    /// Writes rates of coordinates, accelerations of the last forward dynamics, and powers.
    fn write_derivative(&mut self, t: f64, y: &[f64], derivative: &mut [f64]) -> Result<(), RunError> {
        let (state, work) = derivative.split_at_mut(self.first_integral());
        let finite = if let Some((rates, powers)) = self.dynamics.evaluator.last_derivative() {
            let (of_all, of_contacts) = work.split_at_mut(WORKS);
            replace(state, rates);
            of_all.copy_from_slice(&powers);
            is_finite(&powers) & self.contact_powers(of_contacts)
        } else {
            let (q, v, _) = self.split(y);
            let (coordinates, accelerations) = state.split_at_mut(self.coordinates);
            accelerations.copy_from_slice(self.dynamics.evaluator.last_forward().accelerations);
            self.powers(t, q, v, coordinates, work);
            is_finite(work)
        };
        if finite { Ok(()) } else { Err(self.infinite_power(t, &derivative[self.first_integral()..])) }
    }

    /// By the rates of all integrals.
    #[cold]
    fn infinite_power(&self, t: f64, rates: &[f64]) -> RunError {
        let contact =
            rates.iter().position(|rate| !rate.is_finite()).and_then(|place| place.checked_sub(WORKS));
        let contacts = &self.dynamics.evaluator.description().contacts;
        let what = match contact.and_then(|place| contacts.get(place / TOTALS)) {
            Some(contact) => format!("wear of {}", contact.joint),
            None => "power of drivers and forces".to_owned(),
        };
        RunError::NonFinite { t, what }
    }
}
