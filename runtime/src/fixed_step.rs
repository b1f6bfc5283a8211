//! Steps of one length without std and without allocation: the classical Runge-Kutta method on the constraints, with clearance and
//! contact, in the bits that [`crate::Integrator::Rk4`] has. In: a mechanism, its tables, a flat state and arrays of the caller. Out:
//! the state at the end of the step. Never knows samples; what a step does is bounded.

mod closing;
mod contacts;
mod halt;
mod storage;

pub use contacts::StepContact;
pub use halt::Halt;

use crate::joint_laws::JointLaws;
use crate::linear::is_finite;
use crate::manifold::groups;
use crate::regularity::{PROJECTED_STAGES, note_pivots};
use crate::runge_kutta::{advance, inner_stages};
use crate::system::{Entry, Sizes, StageSum, System, TOTALS, WORKS};
use crate::tables::{AllTables, SAMPLE, Start, Tables};
use storage::{ANSWER, Storage};

/// Corrections of positions in a step at most.
pub const CORRECTIONS: usize = 6;

/// A mechanism that is stepped by one length, in arrays of the caller.
///
/// A flat state has [`Sizes::flat_state`] numbers: coordinates, speeds, work supplied and dissipated [J], then for every joint with
/// clearance its wear integral [J], depth [m], integral of the normal force [N s] and energy lost [J]. A step is four evaluations of
/// [`Entry::Derivative`], with clearance one of [`Entry::Contacts`] more, and at most one more than [`CORRECTIONS`] of
/// [`Entry::Closure`]. Nothing is allocated, and nothing is kept but in the arrays.
///
/// Bearings count as round: wear adds up in the state and is not fed back.
///
/// ```
/// use linkwear_runtime::{FixedStep, Halt};
///
/// mod fall {
///     // Generated code: `linkwear_runtime::include_mechanism!("fall")`. This one was written by hand.
///     include!(concat!(env!("CARGO_MANIFEST_DIR"), "/src/fall.rs.txt"));
/// }
///
/// fn main() -> Result<(), Halt> {
///     let mechanism = fall::Mechanism::default();
///     let mut numbers = [0.0; fall::SIZES.step_numbers()];
///     let mut laws = [const { None }; fall::SIZES.contacts];
///     let mut y = [0.0; fall::SIZES.flat_state()];
///     let parameters = mechanism.parameters();
///     let mut stepper = FixedStep::new(&mechanism, &fall::ALL_TABLES, &fall::START, &mut laws, &mut numbers)?;
///     stepper.begin(&parameters, &mut y)?;
///     for i in 0..100 {
///         stepper.step(&parameters, f64::from(i) * 0.01, 0.01, &mut y)?;
///     }
///     // Exact for a parabola, up to rounding.
///     assert!((y[0] - (20.0 - 0.5 * 9.81)).abs() < 1e-13);
///     let mut columns = [0.0; fall::SIZES.channels];
///     stepper.observe(&parameters, 1.0, &y, &mut columns)?;
///     assert_eq!(columns, [y[0]]);
///     Ok(())
/// }
/// ```
pub struct FixedStep<'m, S> {
    system: &'m S,
    all: &'m AllTables,
    tables: &'m Tables,
    start: &'m Start,
    laws: &'m [Option<JointLaws>],
    sizes: Sizes,
    storage: Storage<'m>,
}

impl Sizes {
    /// Length of the array that a [`FixedStep`] works in.
    pub const fn step_numbers(&self) -> usize {
        storage::numbers(self)
    }
}

impl<'m, S: System<f64>> FixedStep<'m, S> {
    /// A mechanism and what generated code says about it, in two arrays of the caller: [`Sizes::step_numbers`] numbers, zeros or those
    /// of a run that goes on, and a place for the laws of every joint with clearance,
    /// `[const { None }; SIZES.contacts]`.
    ///
    /// # Errors
    /// [`Halt::Length`] if one of them does not fit the mechanism, [`Halt::Samples`] if a controller acts at sampled times, [`Halt::Law`] if a constant of contact is out of range.
    pub fn new(
        system: &'m S,
        all: &'m AllTables,
        start: &'m Start,
        laws: &'m mut [Option<JointLaws>],
        numbers: &'m mut [f64],
    ) -> Result<Self, Halt> {
        let (sizes, tables) = (system.sizes(), all.tables);
        let fits = tables.rows.len() == sizes.all_rows
            && tables.contacts.len() == sizes.contacts
            && start.state.len() == sizes.coordinates + sizes.speeds
            && start.sizes.len() == sizes.speeds
            && laws.len() == sizes.contacts;
        if tables.channels.iter().any(|(name, ..)| name.starts_with(SAMPLE)) {
            return Err(Halt::Samples);
        }
        let storage = Storage::of(&sizes, numbers).filter(|_| fits).ok_or(Halt::Length)?;
        for (place, info) in laws.iter_mut().zip(tables.contacts) {
            *place = Some(JointLaws::new(info).map_err(Halt::Law)?);
        }
        for guide in all.guides {
            let place = laws.get_mut(*guide).ok_or(Halt::Length)?;
            *place = place.take().map(JointLaws::as_guide).transpose().map_err(Halt::Law)?;
        }
        for (joint, steps) in all.coefficients {
            let laws = laws.get(*joint).and_then(Option::as_ref).ok_or(Halt::Length)?;
            laws.check_factor(steps).map_err(Halt::Law)?;
        }
        Ok(Self { system, all, tables, start, laws, sizes, storage })
    }

    /// How far every bearing is worn from here on [m], on top of the clearances among the parameters; nothing where a run begins in
    /// zeros.
    ///
    /// # Errors
    /// If they are not as many as joints with clearance, or not finite.
    pub fn set_worn(&mut self, worn: &[f64]) -> Result<(), Halt> {
        if worn.len() != self.sizes.contacts {
            return Err(Halt::Length);
        }
        if !is_finite(worn) {
            return Err(Halt::NotFinite);
        }
        self.storage.worn.copy_from_slice(worn);
        Ok(())
    }

    /// Begins at the start that comes with the code, t = 0.
    ///
    /// # Errors
    /// As [`Self::begin_at`].
    pub fn begin(&mut self, parameters: &[f64], y: &mut [f64]) -> Result<(), Halt> {
        let Some(state) = y.get_mut(..self.start.state.len()) else { return Err(Halt::Length) };
        state.copy_from_slice(self.start.state);
        y[self.start.state.len()..].fill(0.0);
        self.begin_at(parameters, 0.0, y)
    }

    /// Begins at a flat state near the constraints: puts it onto them. Contacts that touch there take their present rates.
    ///
    /// # Errors
    /// If it cannot be put there.
    pub fn begin_at(&mut self, parameters: &[f64], t: f64, y: &mut [f64]) -> Result<(), Halt> {
        self.check(parameters, y)?;
        self.storage.forget();
        if self.sizes.contacts > 0 {
            self.evaluate_contacts(parameters, t, y);
            self.begin_contacts();
        }
        groups(self.tables.motions).filter(|group| group.is_free()).for_each(|group| group.normalize(y));
        if self.sizes.rows == 0 || self.is_closed(parameters, t, y) {
            return Ok(());
        }
        self.put_on((parameters, t), y, 1.0).map(drop)
    }

    /// A step of `length` [s] from `t` [s]. `parameters` with inputs behind them may differ from step to step.
    ///
    /// # Errors
    /// Why it cannot be made; `y` is then as it was.
    pub fn step(&mut self, parameters: &[f64], t: f64, length: f64, y: &mut [f64]) -> Result<(), Halt> {
        self.check(parameters, y)?;
        let mut stage = core::mem::take(&mut self.storage.stage);
        let mut slopes = core::mem::take(&mut self.storage.slopes);
        let (front, back) = slopes.split_at_mut(2 * y.len());
        let ((first, second), (third, fourth)) = (front.split_at_mut(y.len()), back.split_at_mut(y.len()));
        let outcome = self.advance((parameters, t, length), y, stage, [first, second, third, fourth]);
        if outcome.is_ok() {
            y.copy_from_slice(stage);
        }
        (self.storage.stage, self.storage.slopes) =
            (core::mem::take(&mut stage), core::mem::take(&mut slopes));
        outcome
    }

    fn advance(
        &mut self,
        (parameters, t, length): (&[f64], f64, f64),
        y: &[f64],
        stage: &mut [f64],
        [k1, k2, k3, k4]: [&mut [f64]; 4],
    ) -> Result<(), Halt> {
        let mut nearness = self.slope(parameters, t, y, k1)?;
        self.note_depths();
        let within = (&*k1, [&mut *k2, &mut *k3, &mut *k4]);
        inner_stages(([t + 0.5 * length, t + length], length), y, stage, within, &mut |t, y, slope| {
            nearness = self.slope(parameters, t, y, slope)?;
            Ok(())
        })?;
        advance(StageSum::EndsFirst, stage, y, length, [k1, k2, k3, k4]);
        let end = t + length;
        let moved = self.put_on((parameters, end), stage, nearness)?;
        if !is_finite(stage) {
            return Err(Halt::NotFinite);
        }
        self.check_moved(moved, y, stage)?;
        if self.sizes.contacts > 0 {
            self.evaluate_contacts(parameters, end, stage);
            self.remember_contacts();
        }
        Ok(())
    }

    /// Rates of a flat state, as integrators take them.
    ///
    /// # Errors
    /// If one is infinite or none, or the position is nearly singular.
    pub fn rates(&mut self, parameters: &[f64], t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), Halt> {
        self.check(parameters, y)?;
        if rates.len() != y.len() {
            return Err(Halt::Length);
        }
        self.slope(parameters, t, y, rates).map(drop)
    }

    /// One value per output column ([`Tables::channels`]) at a flat state, as `simulate` has them in its rows.
    ///
    /// # Errors
    /// As [`Self::rates`].
    pub fn observe(
        &mut self,
        parameters: &[f64],
        t: f64,
        y: &[f64],
        columns: &mut [f64],
    ) -> Result<(), Halt> {
        self.check(parameters, y)?;
        if columns.len() != self.sizes.channels {
            return Err(Halt::Length);
        }
        let mut slope = core::mem::take(&mut self.storage.stage);
        let seen = self.slope(parameters, t, y, slope);
        self.storage.stage = core::mem::take(&mut slope);
        seen?;
        let Sizes { coordinates, speeds, rows, all_rows, drivers, .. } = self.sizes;
        let Storage { question, answer, observed, workspace, .. } = &mut self.storage;
        let (state, after) = question.split_at(self.sizes.input(Entry::Contacts));
        let (wrenches, _) = after.split_at(self.sizes.input(Entry::ForwardDynamics) - state.len());
        let (before, rest) = observed.split_at_mut(state.len());
        before.copy_from_slice(state);
        let (accelerations, rest) = rest.split_at_mut(speeds);
        accelerations.copy_from_slice(&answer[coordinates..][..speeds]);
        let (multipliers, rest) = rest.split_at_mut(all_rows);
        let of_kept = &answer[coordinates + speeds..][..rows];
        for (place, (.., kept)) in multipliers.iter_mut().zip(self.tables.rows) {
            *place = kept.and_then(|kept| of_kept.get(kept)).map_or(0.0, |value| *value);
        }
        let (drives, rest) = rest.split_at_mut(drivers);
        drives.copy_from_slice(&answer[coordinates + speeds + rows..][..drivers]);
        rest.copy_from_slice(wrenches);
        self.system.evaluate(Entry::Observe, observed, columns, workspace);
        Ok(())
    }

    fn check(&self, parameters: &[f64], y: &[f64]) -> Result<(), Halt> {
        let fits = parameters.len() == self.sizes.parameters && y.len() == self.sizes.flat_state();
        if fits { Ok(()) } else { Err(Halt::Length) }
    }

    /// Writes parameters, time and state to the question.
    fn fill(&mut self, parameters: &[f64], t: f64, y: &[f64]) {
        let (places, rest) = self.storage.question.split_at_mut(parameters.len());
        places.copy_from_slice(parameters);
        rest[0] = t;
        let state = self.sizes.coordinates + self.sizes.speeds;
        rest[1..=state].copy_from_slice(&y[..state]);
    }

    /// Writes the rates of a flat state. Out: how regular the loops are.
    fn slope(&mut self, parameters: &[f64], t: f64, y: &[f64], slope: &mut [f64]) -> Result<f64, Halt> {
        if self.sizes.contacts > 0 {
            self.evaluate_contacts(parameters, t, y);
        } else {
            self.fill(parameters, t, y);
        }
        let question = self.sizes.input(Entry::Derivative);
        let Storage { question: all, answer, workspace, largest_pivots, answers, .. } = &mut self.storage;
        let answer = &mut answer[..self.sizes.output(Entry::Derivative)];
        self.system.evaluate(Entry::Derivative, &all[..question], answer, workspace);
        if !is_finite(answer) {
            return Err(Halt::NotFinite);
        }
        let state = self.sizes.coordinates + self.sizes.speeds;
        let (rest, powers) = answer.split_at(answer.len() - WORKS);
        let pivots = &rest[rest.len() - self.sizes.rows..];
        let nearness = if pivots.is_empty() { 1.0 } else { note_pivots(pivots, largest_pivots) };
        if nearness < PROJECTED_STAGES {
            return Err(Halt::NearlySingular);
        }
        slope[..state].copy_from_slice(&rest[..state]);
        slope[state..][..WORKS].copy_from_slice(powers);
        let totals = slope[state + WORKS..].chunks_exact_mut(TOTALS);
        for (totals, answer) in totals.zip(answers.chunks_exact(ANSWER)) {
            totals.copy_from_slice(&answer[..TOTALS]);
        }
        Ok(nearness)
    }
}
