//! What the lanes of a bundle have in common: states, questions to the equations, their answers, checked lane by lane.
//! In: lengths of steps. Out: ends of steps, which lanes are still ordinary. Never knows turns.

use std::ops::Range;

use crate::bundle::{Bundle, CONTACT_ANSWER, CONTACT_MEMORY, TOTALS, WORKS, contact_state};
use crate::clearance_joint::{Clearances, ContactState};
use crate::dynamics::Dynamics;
use crate::evaluate::Evaluator;
use crate::integrate::{PARTS, Rk43Lanes, Room, SLOPES};
use crate::layout::Layout;
use crate::simulate::motion::PROJECTED_STAGES;
use crate::system::{Entry, Sizes};

/// Part of the square of a row's length that is rounding: nobody asks lanes for more.
const ROUNDED: f64 = 1e-12;

/// Steps that are tried, one in each lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steps<const N: usize> {
    /// Where they begin [s].
    pub(super) begins: [f64; N],
    /// Their lengths [s]; zero in lanes without a turn.
    pub(super) lengths: [f64; N],
    /// Where they end [s].
    pub(super) ends: [f64; N],
    /// Lanes that had nothing but regular positions and finite numbers.
    pub(super) ordinary: [bool; N],
}

/// States, slopes and answers of all lanes.
pub(super) struct Lanes<'a, const N: usize> {
    bundle: &'a dyn Bundle<N>,
    pub(super) sizes: Sizes,
    pub(super) method: Rk43Lanes<N>,
    question: Room<N>,
    workspace: Room<N>,
    /// Natural sizes of the numbers of a state.
    pub(super) scales: Room<N>,
    /// Answers of [`Entry::Closure`] and [`Entry::Energy`] at the ends of the steps.
    closure: Room<N>,
    energy: Room<N>,
    /// Square of the longest length that each row of the Jacobian has had, but for some rounding.
    row_lengths: Room<N>,
    largest_pivots: Room<N>,
    noise: [f64; N],
    /// How regular the loops were at the last evaluation.
    pub(super) nearness: [f64; N],
}

impl<'a, const N: usize> Lanes<'a, N> {
    pub(super) fn new(bundle: &'a dyn Bundle<N>, parameters: &[f64]) -> Self {
        let sizes = bundle.sizes();
        let mut question = Room::new(sizes.bundle_question());
        (0..N).for_each(|lane| question.put(lane, 0, parameters));
        Self {
            bundle,
            sizes,
            method: Rk43Lanes::new(sizes.flat_state(), sizes.bundle_answer()),
            question,
            workspace: Room::new(sizes.workspace),
            scales: Room::new(sizes.flat_state()),
            closure: Room::new(sizes.output(Entry::Closure)),
            energy: Room::new(sizes.output(Entry::Energy)),
            row_lengths: Room::new(sizes.rows),
            largest_pivots: Room::new(sizes.rows),
            noise: [0.0; N],
            nearness: [1.0; N],
        }
    }

    /// Takes over where a trajectory is: its state, and the slope there.
    pub(super) fn put_state(&mut self, lane: usize, y: &[f64], slope: &[f64]) {
        self.method.y.put(lane, 0, y);
        self.method.answers[0].put(lane, 0, slope);
    }

    /// Takes over what contacts remember and how far joints are worn.
    pub(super) fn put_memory(&mut self, lane: usize, clearances: &Clearances) {
        let first = self.sizes.input(Entry::Contacts);
        let joints = clearances.states().iter().zip(clearances.contacts());
        for (joint, (state, touch)) in joints.enumerate() {
            let memory = state.memory;
            let numbers: [f64; CONTACT_MEMORY] =
                [state.worn, touch.stiffness, memory.touching, memory.closing_speed];
            self.question.put(lane, first + CONTACT_MEMORY * joint, &numbers);
        }
    }

    /// Takes over the largest pivots so far.
    pub(super) fn put_pivots(&mut self, lane: usize, dynamics: &Dynamics<'_>) {
        let (values, noise) = dynamics.largest_pivots();
        self.largest_pivots.put(lane, 0, values);
        self.noise[lane] = noise;
    }

    /// Takes over how long rows of the Jacobian have been.
    pub(super) fn put_row_lengths(&mut self, lane: usize, evaluator: &Evaluator<'_>) {
        for (squares, length) in self.row_lengths.all_mut().iter_mut().zip(evaluator.row_lengths()) {
            squares[lane] = (1.0 - ROUNDED) * length * length;
        }
    }

    /// Kinetic and potential energy of a lane at the end of its step [J].
    pub(super) fn energy(&self, lane: usize) -> (f64, f64) {
        let energy = self.energy.all();
        (energy[0][lane], energy[1][lane])
    }

    /// A contact of a lane at the end of its step, by what it was at another instant.
    pub(super) fn contact(&self, lane: usize, joint: usize, before: &ContactState) -> ContactState {
        let answer = self.method.answers[SLOPES - 1].all();
        let totals = self.sizes.coordinates + self.sizes.speeds + WORKS + TOTALS * joint;
        let contact =
            self.sizes.flat_state() + 2 * self.sizes.rows + self.sizes.drivers + CONTACT_ANSWER * joint;
        let rates = std::array::from_fn(|at| answer[totals + at][lane]);
        contact_state(before, rates, std::array::from_fn(|at| answer[contact + at][lane]))
    }

    /// Residuals of all rows of a lane at the end of its step.
    pub(super) fn residuals(&self, lane: usize, positions: &mut [f64]) {
        self.closure.get(lane, 0, positions);
    }

    /// Whether the ends of the steps need no projection, as far as lanes can tell: residuals of positions and speeds are below
    /// these, and no row is longer than ever.
    pub(super) fn are_closed(
        &mut self,
        layout: &Layout,
        kept: &[usize],
        untouched: &[(f64, f64); N],
    ) -> [bool; N] {
        let state = self.state_places();
        let Sizes { coordinates, speeds, rows, all_rows, .. } = self.sizes;
        self.ask_ends(state.clone());
        layout.normalize_all(&mut self.question.all_mut()[state.start..][..coordinates]);
        self.bundle.evaluate(
            Entry::Closure,
            self.question.all(),
            self.closure.all_mut(),
            self.workspace.all_mut(),
        );
        let (positions, rest) = self.closure.all().split_at(all_rows);
        let (rates, jacobian) = rest.split_at(rows);
        let mut closed = [true; N];
        for (row, rate) in kept.iter().zip(rates) {
            for lane in 0..N {
                let (position, speed) = untouched[lane];
                closed[lane] &= (positions[*row][lane].abs() <= position) & (rate[lane].abs() <= speed);
            }
        }
        for (row, longest) in jacobian.chunks_exact(speeds.max(1)).zip(self.row_lengths.all()) {
            let mut squares = [0.0; N];
            for value in row {
                for lane in 0..N {
                    squares[lane] += value[lane] * value[lane];
                }
            }
            for lane in 0..N {
                closed[lane] &= squares[lane] <= longest[lane];
            }
        }
        closed
    }

    /// The end of a lane's step is the one with quaternions of unit length: it needs no projection.
    pub(super) fn take_normalized(&mut self, lane: usize) {
        let coordinates = &self.question.all()[self.state_places()][..self.sizes.coordinates];
        for (next, asked) in self.method.next.all_mut().iter_mut().zip(coordinates) {
            next[lane] = asked[lane];
        }
    }

    fn ask_ends(&mut self, state: Range<usize>) {
        let length = state.len();
        self.question.all_mut()[state].copy_from_slice(&self.method.next.all()[..length]);
    }

    /// The inner stages of a step, and its ends before they are put onto the constraints; `grown` hears of lanes with a
    /// pivot that is larger than ever, and says how regular it is.
    pub(super) fn stages(&mut self, steps: &mut Steps<N>, grown: Grown<'_>) {
        let state = self.state_places();
        for (stage, part) in (1..).zip(PARTS) {
            self.question.all_mut()[state.start - 1] = std::array::from_fn(|lane| {
                if part == 1.0 { steps.ends[lane] } else { steps.begins[lane] + part * steps.lengths[lane] }
            });
            self.method.stage(stage, &steps.lengths, &mut self.question.all_mut()[state.clone()]);
            self.evaluate(stage, steps, grown);
        }
        self.method.finish(&steps.lengths);
        self.question.all_mut()[state.start - 1] = steps.ends;
    }

    /// The slopes at the ends of the steps, and the errors of these, by parts of the tolerances.
    pub(super) fn errors(
        &mut self,
        steps: &mut Steps<N>,
        tolerances: &[f64; N],
        grown: Grown<'_>,
    ) -> [f64; N] {
        self.ask_ends(self.state_places());
        self.evaluate(SLOPES - 1, steps, grown);
        self.bundle.evaluate(
            Entry::Energy,
            self.question.all(),
            self.energy.all_mut(),
            self.workspace.all_mut(),
        );
        self.method.errors(&steps.lengths, tolerances, self.scales.all())
    }

    /// Places of coordinates and speeds in a question; the time stands before them.
    fn state_places(&self) -> Range<usize> {
        self.sizes.parameters + 1..self.sizes.input(Entry::Contacts)
    }

    fn evaluate(&mut self, slope: usize, steps: &mut Steps<N>, grown: Grown<'_>) {
        let answer = self.method.answers[slope].all_mut();
        self.bundle.derivative(self.question.all(), answer, self.workspace.all_mut());
        let Sizes { coordinates, rows, drivers, .. } = self.sizes;
        let pivots = self.sizes.flat_state() + rows + drivers;
        // Zero, unless a number is infinite or none.
        let mut nothing = [0.0; N];
        for value in &answer[coordinates..pivots] {
            for lane in 0..N {
                nothing[lane] += 0.0 * value[lane];
            }
        }
        let pivots = &answer[pivots..][..rows];
        let (mut smallest, mut has_grown) = ([1.0_f64; N], [false; N]);
        for (pivot, most) in pivots.iter().zip(self.largest_pivots.all()) {
            for lane in 0..N {
                has_grown[lane] |= pivot[lane] > most[lane];
                let part = pivot[lane] / most[lane];
                let part = if pivot[lane] < smallest[lane] * most[lane] { part } else { smallest[lane] };
                smallest[lane] = if pivot[lane] > self.noise[lane] { part } else { 0.0 };
            }
        }
        for lane in (0..N).filter(|lane| has_grown[*lane] && steps.ordinary[*lane]) {
            let pivots: Vec<f64> = pivots.iter().map(|pivot| pivot[lane]).collect();
            let (regularity, values, noise) = grown(lane, &pivots);
            self.largest_pivots.put(lane, 0, &values);
            (smallest[lane], self.noise[lane]) = (regularity, noise);
        }
        for lane in 0..N {
            steps.ordinary[lane] &= nothing[lane] == 0.0 && smallest[lane] >= PROJECTED_STAGES;
        }
        self.nearness = smallest;
    }
}

/// Hears of a lane's pivots that have grown: how regular they are, the largest values now, up to where pivots are noise.
type Grown<'g> = &'g mut dyn FnMut(usize, &[f64]) -> (f64, Vec<f64>, f64);
