//! Asking a mechanism its questions without allocating: one set of parameters, one buffer per answer.
//! In: a [`System`], its [`Description`], parameter values. Out: slices by [`Entry`].
//! Never knows integrators.

mod answers;
mod closed;
mod closure;
mod derivative;
mod held;
mod inside;
mod parameters;
mod questions;
mod sampled;
mod step;
mod step_code;

pub use answers::{Accelerations, Closure, Equations, Forward, LoopError, Rates};
pub use closed::{CLOSED, CLOSED_AT_START};
pub(crate) use closure::put_back;

use crate::clearance_joint::{Clearances, ContactState};
use crate::description::Description;
use crate::error::SetupError;
use crate::flat_laws::in_words;
use crate::layout::Layout;
use crate::row_scales::RowScales;
use crate::system::{CONTACT_MOTION, Entry, STATES, Sizes, System};
use derivative::Derivative;
pub(crate) use derivative::Known;
use questions::Questions;
use sampled::{Sampled, sampled};
pub(crate) use step_code::StepLimits;

/// A mechanism with fixed parameters and the storage to evaluate it.
pub struct Evaluator<'a> {
    description: &'a Description,
    layout: Layout,
    sizes: Sizes,
    /// Row of the description behind each kept row.
    kept: Vec<usize>,
    /// Of every row, whether its residual is one in radians.
    angular: Vec<bool>,
    /// Scales of the kept rows of the Jacobian.
    rows: RowScales,
    /// Multipliers of all rows; those of kept rows are filled in when they are asked for.
    multipliers: Vec<f64>,
    /// Whether any of them may be other than zero for dropped rows.
    has_dropped: bool,
    clearances: Clearances,
    /// Columns that tell which pieces of formulas hold: conditions, rows of tables.
    pieces: [std::ops::Range<usize>; 2],
    /// Controllers that act at sampled times.
    sampled: Vec<Sampled>,
    /// Bits of a time at which contacts were taken over.
    contacts_known_at: Option<u64>,
    derivative: Derivative<'a>,
    questions: Questions<'a>,
}

impl<'a> Evaluator<'a> {
    /// Checks that the numbers fit and prepares the storage.
    ///
    /// # Errors
    /// If the parameters are not finite, or lengths disagree between system, description and parameters.
    pub fn new(
        system: &'a dyn System<f64>,
        description: &'a Description,
        parameters: &[f64],
    ) -> Result<Self, SetupError> {
        let sizes = system.sizes();
        let layout = Layout::new(&description.motions);
        let kept = description.kept_rows(sizes.rows);
        let same = |what, expected, found| {
            if expected == found { Ok(()) } else { Err(SetupError::Length { what, expected, found }) }
        };
        same("parameters in its description", sizes.parameters, description.parameters.len())?;
        same("inputs at most", description.inputs.len().min(sizes.parameters), description.inputs.len())?;
        same("coordinates in its motions", sizes.coordinates, layout.coordinates)?;
        same("speeds in its motions", sizes.speeds, layout.speeds)?;
        same("coordinates in all its motions", sizes.all_coordinates, layout.all_coordinates)?;
        same("speeds in all its motions", sizes.all_speeds, layout.all_speeds)?;
        same("described coordinates", sizes.coordinates, description.coordinates.len())?;
        same("described speeds", sizes.speeds, description.speeds.len())?;
        same("described rows", sizes.all_rows, description.rows.len())?;
        same("kept rows", sizes.rows, kept.len())?;
        same("described drivers", sizes.drivers, description.drivers.len())?;
        same("described channels", sizes.channels, description.channels.len())?;
        // The rate of an angle that wraps is the next column.
        let rates = description.channels.iter().rposition(|channel| channel.wraps).map_or(0, |last| last + 2);
        same("channels with the rates of angles", rates.max(sizes.channels), sizes.channels)?;
        same("described joints with clearance", sizes.contacts, description.contacts.len())?;
        Self::check_parameters(description, parameters)?;
        let clearances = Clearances::of(description)?;
        // Segments of missions and studies change laws, not equations.
        let inside = system.laws_inside().filter(|code| code.laws() == in_words(clearances.joints()));
        Ok(Self {
            description,
            layout,
            sizes,
            angular: description.rows.iter().map(|row| row.angular).collect(),
            rows: RowScales::new(kept.iter().map(|row| description.rows[*row].angular).collect()),
            kept,
            multipliers: vec![0.0; sizes.all_rows],
            has_dropped: false,
            pieces: description.pieces(),
            sampled: sampled(system, description, parameters)?,
            clearances,
            contacts_known_at: None,
            derivative: Derivative::new(sizes, inside, parameters),
            questions: Questions::new(system, parameters, &description.inputs),
        })
    }

    /// The counts of the mechanism.
    pub fn sizes(&self) -> Sizes {
        self.sizes
    }

    /// The mechanism's description.
    pub fn description(&self) -> &'a Description {
        self.description
    }

    /// Places of the coordinates and speeds.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// For every kept row, its row in the description.
    pub fn kept(&self) -> &[usize] {
        &self.kept
    }

    /// Position, speed and acceleration of every driver, driver by driver.
    pub fn prescribed(&mut self, t: f64) -> &[f64] {
        self.questions.ask(Entry::Prescribed, t, &[])
    }

    /// Guess of the free coordinates and wish for the free speeds.
    pub fn start(&mut self, t: f64) -> (&[f64], &[f64]) {
        let n = self.sizes.coordinates;
        self.questions.ask(Entry::Start, t, &[]).split_at(n)
    }

    /// Joints with clearance: their laws, states, and contacts at the last evaluation.
    pub fn clearances(&self) -> &Clearances {
        &self.clearances
    }

    /// The same, to restore what they remember or to change their wear.
    pub fn clearances_mut(&mut self) -> &mut Clearances {
        &mut self.clearances
    }

    /// Motion of every joint with clearance, [`crate::CONTACT_MOTION`] values each.
    pub fn contact_motion(&mut self, t: f64, q: &[f64], v: &[f64]) -> &[f64] {
        &self.questions.ask(Entry::Contacts, t, &[q, v])[..CONTACT_MOTION * self.sizes.contacts]
    }

    /// Evaluates the contacts; their wrenches go into every answer from here on. Nothing to do without clearance.
    pub fn evaluate_contacts(&mut self, t: f64, q: &[f64], v: &[f64]) {
        let is_known = self.contacts_known_at == Some(t.to_bits()) && !self.clearances.has_changed();
        if self.sizes.contacts > 0 && !is_known {
            self.contacts_known_at = None;
            self.derivative.contacts(&mut self.questions, &mut self.clearances, (t, q, v));
        }
    }

    /// Takes over contacts that were evaluated elsewhere, at the one state that will be asked for at time `t`, until others are
    /// evaluated or [`Self::forget_contacts`].
    pub(crate) fn take_over_contacts(
        &mut self,
        t: f64,
        state: impl Fn(usize, &ContactState) -> ContactState,
    ) {
        self.clearances.take_over(state);
        self.derivative.forget();
        self.contacts_known_at = Some(t.to_bits());
    }

    /// Contacts are asked for at any state from here on.
    pub(crate) fn forget_contacts(&mut self) {
        self.contacts_known_at = None;
    }

    /// Accelerations, multipliers, drive forces and pivots, with the forces of the contacts at this state. Asked again
    /// for the same state, as by a step that begins where one was looked at, it has the answer.
    pub fn forward(&mut self, t: f64, q: &[f64], v: &[f64]) -> Forward<'_> {
        self.evaluate(t, q, v);
        self.derivative.forward()
    }

    /// As [`Self::forward`]; the pivots alone.
    pub(crate) fn pivots(&mut self, t: f64, q: &[f64], v: &[f64]) -> &[f64] {
        self.evaluate(t, q, v);
        self.derivative.pivots()
    }

    /// The answer of [`Self::forward`] that is known for the state evaluated last, if it still holds.
    pub(crate) fn known(&self) -> Option<Known> {
        let holds = self.contacts_known_at.is_none() && !self.clearances.has_changed();
        self.derivative.known().filter(|_| holds)
    }

    /// The same of the state where contacts were evaluated last; nothing without contacts.
    pub(crate) fn known_of_contacts(&self) -> Option<Known> {
        self.known().filter(|_| self.sizes.contacts > 0)
    }

    /// Whether this is still what [`Self::forward`] has for the state that it was known for.
    pub(crate) fn holds(&mut self, known: Known) -> bool {
        let holds = self.known() == Some(known);
        if holds {
            self.forget_dropped();
        }
        holds
    }

    /// Whether this is what [`Self::forward`] has for a state.
    pub(crate) fn holds_at(&mut self, known: Known, state: (f64, &[f64], &[f64])) -> bool {
        self.holds(known) && self.derivative.is_at(state)
    }

    fn evaluate(&mut self, t: f64, q: &[f64], v: &[f64]) {
        self.forget_dropped();
        self.contacts_known_at = None;
        self.derivative.evaluate(&mut self.questions, &mut self.clearances, (t, q, v));
    }

    /// Accelerations and pivots alone, with the forces of the contacts at this state. Leaves the forward dynamics as it is.
    pub fn accelerations(&mut self, t: f64, q: &[f64], v: &[f64]) -> Accelerations<'_> {
        self.evaluate_contacts(t, q, v);
        let wrenches = self.clearances.wrenches();
        Accelerations::of(self.questions.ask(Entry::Accelerations, t, &[q, v, wrenches]), self.sizes.speeds)
    }

    /// The same under given wrenches of the contacts, whatever the laws say.
    pub fn accelerations_under(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
        wrenches: &[f64],
    ) -> Accelerations<'_> {
        Accelerations::of(self.questions.ask(Entry::Accelerations, t, &[q, v, wrenches]), self.sizes.speeds)
    }

    /// The last answer of [`Self::forward`] or the numbers put in its place.
    pub fn last_forward(&self) -> Forward<'_> {
        self.derivative.forward()
    }

    /// Accelerations, multipliers and drive forces of [`Self::last_forward`], one behind the other.
    pub(crate) fn last_solution(&self) -> &[f64] {
        self.derivative.solution()
    }

    /// Writable storage of accelerations, multipliers and drive forces, for a solve done elsewhere.
    pub fn forward_mut(&mut self) -> &mut [f64] {
        self.forget_dropped();
        self.derivative.forward_mut()
    }

    /// Writable multipliers of all rows, those of dropped rows zero after [`Self::forward`] and [`Self::forward_mut`]: a solve
    /// done elsewhere puts them here.
    pub fn multipliers_mut(&mut self) -> &mut [f64] {
        self.has_dropped = true;
        &mut self.multipliers
    }

    fn forget_dropped(&mut self) {
        if std::mem::take(&mut self.has_dropped) {
            self.multipliers.fill(0.0);
        }
    }

    /// Rates of the coordinates and powers at the state of the last forward dynamics, with its drive forces or those put in
    /// their place.
    pub fn rates(&mut self, t: f64, q: &[f64], v: &[f64]) -> Rates<'_> {
        if self.derivative.rates().is_none() {
            let drives = self.derivative.forward().drives;
            self.questions.ask(Entry::Rates, t, &[q, v, drives]);
        }
        let n = self.sizes.coordinates;
        let (coordinates, [supplied, dissipated]) = self.derivative.rates().unwrap_or_else(|| {
            let (coordinates, powers) = self.questions.last(Entry::Rates).split_at(n);
            (coordinates, [powers[0], powers[1]])
        });
        Rates { coordinates: &coordinates[..n], supplied, dissipated }
    }

    /// Rates of the coordinates, then accelerations; power supplied and dissipated: at the state of the last forward dynamics,
    /// unless other forces were put in their place.
    pub(crate) fn last_derivative(&self) -> Option<(&[f64], [f64; 2])> {
        self.derivative.rates()
    }

    /// Kinetic and potential energy [J].
    pub fn energy(&mut self, t: f64, q: &[f64], v: &[f64]) -> (f64, f64) {
        let output = self.questions.ask(Entry::Energy, t, &[q, v]);
        (output[0], output[1])
    }

    /// One value per channel, with the last forward dynamics.
    pub fn observe(&mut self, t: f64, q: &[f64], v: &[f64]) -> &[f64] {
        let Forward { accelerations, multipliers, drives, .. } = self.derivative.forward();
        put_kept(&self.kept, multipliers, &mut self.multipliers);
        let wrenches = self.clearances.wrenches();
        self.questions.ask(Entry::Observe, t, &[q, v, accelerations, &self.multipliers, drives, wrenches])
    }

    /// Whether formulas change their piece, by conditions or at rows of tables.
    pub(crate) fn has_switches(&self) -> bool {
        self.pieces.iter().any(|columns| !columns.is_empty())
    }

    /// Which pieces of formulas hold at a state: values of conditions, which hold below zero, and how many rows of tables have been
    /// passed.
    pub(crate) fn pieces(&mut self, t: f64, q: &[f64], v: &[f64]) -> [&[f64]; 2] {
        let pieces = self.pieces.clone();
        // They depend on no force: those of the last forward dynamics will do.
        let columns = self.observe(t, q, v);
        pieces.map(|range| &columns[range])
    }

    /// What answers the questions.
    pub(crate) fn system(&self) -> &'a dyn System<f64> {
        self.questions.system
    }

    /// Writes the question of [`Self::observe`] as that of one of several states, but for the parameters.
    pub(crate) fn write_question(
        &mut self,
        (t, q, v): (f64, &[f64], &[f64]),
        state: usize,
        question: &mut [[f64; STATES]],
    ) {
        let Forward { accelerations, multipliers, drives, .. } = self.derivative.forward();
        put_kept(&self.kept, multipliers, &mut self.multipliers);
        let (time, wrenches) = ([t], self.clearances.wrenches());
        let first = self.questions.inputs.start;
        let inputs = self.questions.inputs_at(t);
        let parts = [inputs, &time, q, v, accelerations, &self.multipliers, drives, wrenches];
        let mut left = &mut question[first..];
        // One of them: no place is checked again.
        let state = state % STATES;
        for part in parts {
            let (places, rest) = left.split_at_mut(part.len());
            let ((fours, others), (four_values, other_values)) =
                (places.as_chunks_mut::<4>(), part.as_chunks::<4>());
            for (places, values) in fours.iter_mut().zip(four_values) {
                for i in 0..4 {
                    places[i][state] = values[i];
                }
            }
            others.iter_mut().zip(other_values).for_each(|(place, value)| place[state] = *value);
            left = rest;
        }
    }

    /// Fills the slices of all coordinates and speeds from the free ones and the drivers; leaves the
    /// drivers' values in [`Self::last_prescribed`].
    pub fn expand(&mut self, t: f64, q: &[f64], v: &[f64], all_q: &mut [f64], all_v: &mut [f64]) {
        self.prescribed(t);
        self.layout.expand((q, v), self.last_prescribed(), (all_q, all_v));
    }

    /// The last answer of [`Self::prescribed`].
    pub fn last_prescribed(&self) -> &[f64] {
        self.questions.last(Entry::Prescribed)
    }

    /// Mass matrix, bias, constraint rows of all coordinates, under the wrenches of the last [`Self::evaluate_contacts`].
    pub fn equations(&mut self, t: f64, all_q: &[f64], all_v: &[f64]) -> Equations<'_> {
        let (n, m) = (self.sizes.all_speeds, self.sizes.all_rows);
        let wrenches = self.clearances.wrenches();
        let output = self.questions.ask(Entry::EquationsOfMotion, t, &[all_q, all_v, wrenches]);
        let (mass, rest) = output.split_at(n * (n + 1) / 2);
        let (bias, rest) = rest.split_at(n);
        let (positions, rest) = rest.split_at(m);
        let (jacobian, gamma) = rest.split_at(m * n);
        Equations { mass, bias, positions, jacobian, gamma }
    }

    /// Name of the free speed `index`.
    pub fn speed_name(&self, index: usize) -> String {
        self.description.speeds[index].name.to_string()
    }

    /// Name of the joint of row `index` of the description.
    pub fn joint_of_row(&self, index: usize) -> String {
        self.description.rows.get(index).map(|row| row.joint.to_string()).unwrap_or_default()
    }
}

/// Puts the multipliers of the kept rows at their places among all rows.
fn put_kept(kept: &[usize], of_kept: &[f64], all: &mut [f64]) {
    for (row, multiplier) in kept.iter().zip(of_kept) {
        all[*row] = *multiplier;
    }
}
