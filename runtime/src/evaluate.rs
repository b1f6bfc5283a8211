//! Asking a mechanism its questions without allocating: one set of parameters, one buffer per answer.
//! In: a [`System`], its [`Description`], parameter values. Out: slices by [`Entry`].
//! Never knows integrators.

mod answers;
mod closed;

pub use answers::{Closure, Equations, Forward, LoopError, Rates};
pub use closed::{CLOSED, CLOSED_AT_START};

use crate::clearance_joint::Clearances;
use crate::description::Description;
use crate::error::SetupError;
use crate::layout::Layout;
use crate::linear::dot;
use crate::system::{Entry, Sizes, System};

/// A mechanism with fixed parameters and the storage to evaluate it.
pub struct Evaluator<'a> {
    system: &'a dyn System<f64>,
    description: &'a Description,
    layout: Layout,
    sizes: Sizes,
    /// Row of the description behind each kept row.
    kept: Vec<usize>,
    /// Longest length that each kept row of the Jacobian has had.
    row_lengths: Vec<f64>,
    row_scales: Vec<f64>,
    /// Multipliers of all rows; those of kept rows are filled in when they are asked for.
    multipliers: Vec<f64>,
    clearances: Clearances,
    /// Time, coordinates, speeds and wrenches of the last forward dynamics; empty if its answer is not there any more.
    last_forward_at: Vec<f64>,
    input: Vec<f64>,
    workspace: Vec<f64>,
    outputs: [Vec<f64>; Entry::ALL.len()],
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
        let kept: Vec<usize> = (0..sizes.rows)
            .filter_map(|k| description.rows.iter().position(|row| row.kept == Some(k)))
            .collect();
        let same = |what, expected, found| {
            if expected == found { Ok(()) } else { Err(SetupError::Length { what, expected, found }) }
        };
        same("parameters", sizes.parameters, parameters.len())?;
        same("parameters in its description", sizes.parameters, description.parameters.len())?;
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
        if let Some(at) = parameters.iter().position(|value| !value.is_finite()) {
            let name = description.parameters[at].name.to_string();
            return Err(SetupError::Parameter { name, value: parameters[at] });
        }
        let longest = Entry::ALL.iter().map(|entry| sizes.input(*entry)).max().unwrap_or(0);
        let mut input = vec![0.0; longest];
        input[..parameters.len()].copy_from_slice(parameters);
        Ok(Self {
            system,
            description,
            layout,
            sizes,
            kept,
            row_lengths: vec![0.0; sizes.rows],
            row_scales: vec![1.0; sizes.rows],
            multipliers: vec![0.0; sizes.all_rows],
            clearances: Clearances::new(&description.contacts)?,
            last_forward_at: Vec::new(),
            input,
            workspace: vec![0.0; sizes.workspace],
            outputs: Entry::ALL.map(|entry| vec![0.0; sizes.output(entry)]),
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

    fn ask(&mut self, entry: Entry, t: f64, blocks: &[&[f64]]) -> &[f64] {
        let mut at = self.sizes.parameters;
        self.input[at] = t;
        at += 1;
        for block in blocks {
            self.input[at..at + block.len()].copy_from_slice(block);
            at += block.len();
        }
        debug_assert_eq!(at, self.sizes.input(entry));
        let output = &mut self.outputs[entry as usize];
        self.system.evaluate(entry, &self.input[..at], output, &mut self.workspace);
        output
    }

    /// Position, speed and acceleration of every driver, driver by driver.
    pub fn prescribed(&mut self, t: f64) -> &[f64] {
        self.ask(Entry::Prescribed, t, &[])
    }

    /// Guess of the free coordinates and wish for the free speeds.
    pub fn start(&mut self, t: f64) -> (&[f64], &[f64]) {
        let n = self.sizes.coordinates;
        self.ask(Entry::Start, t, &[]).split_at(n)
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
        self.ask(Entry::Contacts, t, &[q, v])
    }

    /// Evaluates the contacts; their wrenches go into every answer from here on. Nothing to do without clearance.
    pub fn evaluate_contacts(&mut self, t: f64, q: &[f64], v: &[f64]) {
        if self.sizes.contacts > 0 {
            self.ask(Entry::Contacts, t, &[q, v]);
            self.clearances.evaluate(&self.outputs[Entry::Contacts as usize]);
        }
    }

    /// Accelerations, multipliers, drive forces and pivots, with the forces of the contacts at this state. Asked again
    /// for the same state, as by a step that begins where one was looked at, it has the answer.
    pub fn forward(&mut self, t: f64, q: &[f64], v: &[f64]) -> Forward<'_> {
        self.evaluate_contacts(t, q, v);
        let clearances = core::mem::take(&mut self.clearances);
        let time = [t];
        let at = || [&time[..], q, v, clearances.wrenches()].into_iter().flatten();
        let same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits();
        if self.last_forward_at.len() == at().count() && self.last_forward_at.iter().zip(at()).all(same) {
            self.multipliers.fill(0.0);
        } else {
            self.forward_under(t, q, v, clearances.wrenches());
            self.last_forward_at.extend(at());
        }
        self.clearances = clearances;
        self.last_forward()
    }

    /// The same with given wrenches of the contacts, whatever the laws say.
    pub fn forward_under(&mut self, t: f64, q: &[f64], v: &[f64], wrenches: &[f64]) -> Forward<'_> {
        self.multipliers.fill(0.0);
        self.last_forward_at.clear();
        self.ask(Entry::ForwardDynamics, t, &[q, v, wrenches]);
        self.last_forward()
    }

    /// The last answer of [`Self::forward`] or the numbers put in its place.
    pub fn last_forward(&self) -> Forward<'_> {
        let output = &self.outputs[Entry::ForwardDynamics as usize];
        let (accelerations, rest) = output.split_at(self.sizes.speeds);
        let (multipliers, rest) = rest.split_at(self.sizes.rows);
        let (drives, pivots) = rest.split_at(self.sizes.drivers);
        Forward { accelerations, multipliers, drives, pivots }
    }

    /// Writable storage of accelerations, multipliers and drive forces, for a solve done elsewhere.
    pub fn forward_mut(&mut self) -> &mut [f64] {
        self.multipliers.fill(0.0);
        self.last_forward_at.clear();
        &mut self.outputs[Entry::ForwardDynamics as usize]
    }

    /// Writable multipliers of all rows, zero after [`Self::forward`] and [`Self::forward_mut`]: a solve done
    /// elsewhere puts those of dropped rows here.
    pub fn multipliers_mut(&mut self) -> &mut [f64] {
        &mut self.multipliers
    }

    /// Rates of the coordinates and powers, with the drive forces of the last forward dynamics.
    pub fn rates(&mut self, t: f64, q: &[f64], v: &[f64]) -> Rates<'_> {
        let first = self.sizes.speeds + self.sizes.rows;
        let forward = core::mem::take(&mut self.outputs[Entry::ForwardDynamics as usize]);
        self.ask(Entry::Rates, t, &[q, v, &forward[first..first + self.sizes.drivers]]);
        self.outputs[Entry::ForwardDynamics as usize] = forward;
        let (coordinates, powers) = self.outputs[Entry::Rates as usize].split_at(self.sizes.coordinates);
        Rates { coordinates, supplied: powers[0], dissipated: powers[1] }
    }

    /// Residuals of the loops and their Jacobian.
    pub fn closure(&mut self, t: f64, q: &[f64], v: &[f64]) -> Closure<'_> {
        self.ask(Entry::Closure, t, &[q, v]);
        self.note_row_lengths();
        self.last_closure()
    }

    /// Factors that make the kept rows of the Jacobian at most about as long as one, so that metres and
    /// radians count alike when rank is judged. They follow the longest each row has been: a row that
    /// vanishes at a singular position must not be blown up.
    pub fn row_scales(&self) -> &[f64] {
        &self.row_scales
    }

    /// Passes all numbers that an answer can depend on besides its question, to be read or written.
    pub(crate) fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.row_lengths.iter_mut().chain(&mut self.row_scales).for_each(visit);
    }

    fn note_row_lengths(&mut self) {
        let n = self.sizes.speeds.max(1);
        let first = self.sizes.all_rows + self.sizes.rows;
        let jacobian = &self.outputs[Entry::Closure as usize][first..];
        let mut grown = false;
        for (length, row) in self.row_lengths.iter_mut().zip(jacobian.chunks_exact(n)) {
            let now = dot(row, row).sqrt();
            if now > *length {
                (*length, grown) = (now, true);
            }
        }
        if !grown {
            return;
        }
        let mut most = [0.0_f64; 2];
        for (length, row) in self.row_lengths.iter().zip(&self.kept) {
            let kind = usize::from(self.description.rows[*row].angular);
            most[kind] = most[kind].max(*length);
        }
        for ((scale, length), row) in self.row_scales.iter_mut().zip(&self.row_lengths).zip(&self.kept) {
            let kind = usize::from(self.description.rows[*row].angular);
            // A row that starts at a singular position has no length of its own yet.
            *scale = 1.0 / length.max(1e-3 * most[kind]).max(f64::MIN_POSITIVE);
        }
    }

    /// The last answer of [`Self::closure`].
    pub fn last_closure(&self) -> Closure<'_> {
        let (positions, rest) = self.outputs[Entry::Closure as usize].split_at(self.sizes.all_rows);
        let (speeds, jacobian) = rest.split_at(self.sizes.rows);
        Closure { positions, speeds, jacobian }
    }

    /// Loop error of the last answer of [`Self::closure`].
    pub fn loop_error(&self) -> LoopError {
        let mut error = LoopError::default();
        let mut most = 0.0;
        for (i, (row, residual)) in
            self.description.rows.iter().zip(self.last_closure().positions).enumerate()
        {
            let size = residual.abs();
            let side = if row.angular { &mut error.radians } else { &mut error.metres };
            // What is not a number wins.
            if size.is_nan() || size > *side {
                *side = size;
            }
            if size.is_nan() || size > most {
                (most, error.worst) = (size, i);
            }
        }
        error
    }

    /// Kinetic and potential energy [J].
    pub fn energy(&mut self, t: f64, q: &[f64], v: &[f64]) -> (f64, f64) {
        let output = self.ask(Entry::Energy, t, &[q, v]);
        (output[0], output[1])
    }

    /// One value per channel, with the last forward dynamics.
    pub fn observe(&mut self, t: f64, q: &[f64], v: &[f64]) -> &[f64] {
        let (n, m) = (self.sizes.speeds, self.sizes.rows);
        let forward = core::mem::take(&mut self.outputs[Entry::ForwardDynamics as usize]);
        let mut multipliers = core::mem::take(&mut self.multipliers);
        for (row, multiplier) in self.kept.iter().zip(&forward[n..n + m]) {
            multipliers[*row] = *multiplier;
        }
        let drives = &forward[n + m..n + m + self.sizes.drivers];
        let clearances = core::mem::take(&mut self.clearances);
        let wrenches = clearances.wrenches();
        self.ask(Entry::Observe, t, &[q, v, &forward[..n], &multipliers, drives, wrenches]);
        self.clearances = clearances;
        self.outputs[Entry::ForwardDynamics as usize] = forward;
        self.multipliers = multipliers;
        &self.outputs[Entry::Observe as usize]
    }

    /// Fills the slices of all coordinates and speeds from the free ones and the drivers; leaves the
    /// drivers' values in [`Self::last_prescribed`].
    pub fn expand(&mut self, t: f64, q: &[f64], v: &[f64], all_q: &mut [f64], all_v: &mut [f64]) {
        self.prescribed(t);
        self.layout.expand((q, v), self.last_prescribed(), (all_q, all_v));
    }

    /// The last answer of [`Self::prescribed`].
    pub fn last_prescribed(&self) -> &[f64] {
        &self.outputs[Entry::Prescribed as usize]
    }

    /// Mass matrix, bias, constraint rows of all coordinates, under the wrenches of the last [`Self::evaluate_contacts`].
    pub fn equations(&mut self, t: f64, all_q: &[f64], all_v: &[f64]) -> Equations<'_> {
        let (n, m) = (self.sizes.all_speeds, self.sizes.all_rows);
        let clearances = core::mem::take(&mut self.clearances);
        self.ask(Entry::EquationsOfMotion, t, &[all_q, all_v, clearances.wrenches()]);
        self.clearances = clearances;
        let output = &self.outputs[Entry::EquationsOfMotion as usize];
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
