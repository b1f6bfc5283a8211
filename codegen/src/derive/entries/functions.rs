//! The blocks of every entry point but the equations of motion.
//! In: the deriver's symbols, link motion. Out: [`Function`]s in the order of [`Entry::ALL`].

use linkwear_runtime::{Channel, Entry, ROW, RowInfo, SWITCH};

use super::deriver::{Deriver, Given, Instant};
use super::observe::Channels;
use super::row_axes::MOST_TO_COMPARE;
use crate::derive::closure::{CutRows, cut_rows};
use crate::derive::contacts::contact_motion;
use crate::derive::dynamics::{kinetic_energy, weight_energy};
use crate::derive::forward::{Forward, Problem};
use crate::derive::kept_rows::kept_rows;
use crate::derive::link_mass::LinkMass;
use crate::derive::linkage::Freedom;
use crate::derive::moving::Known;
use crate::derive::orientation::{quaternion_product, rotation_of_quaternion};
use crate::derive::relative_motion::Sums;
use crate::derive::shortest_way::{Shortest, forward};
use crate::derive::solve::Solution;
use crate::derive::start::{StartValues, start_values};
use crate::derive::{Block, Function};
use crate::expr::{Expr, Vec3};

pub(super) fn function(entry: Entry, doc: &str, inputs: Vec<Block>, outputs: Vec<Block>) -> Function {
    Function { name: entry.name().to_owned(), doc: doc.to_owned(), inputs, outputs, goes_on: false }
}

/// What the state does next, apart from its accelerations.
pub(super) struct StateRates<'g> {
    /// Of the free coordinates.
    coordinates: Vec<Expr<'g>>,
    /// Of the file's own states.
    own: Vec<Expr<'g>>,
    /// Power of applied forces, without drivers.
    supplied: Expr<'g>,
    dissipated: Expr<'g>,
}

impl<'g> Deriver<'g> {
    pub(super) fn base_inputs(&self) -> Vec<Block> {
        let Given { tunable, inputs } = &self.given;
        let mut blocks =
            vec![Block::vector("parameters", tunable.iter().copied()).doc("Tunable parameters, SI.")];
        if !inputs.is_empty() {
            let doc = "Inputs, SI; behind one that a drive follows its first and second rate in time.";
            blocks.push(Block::vector("inputs", inputs.iter().copied()).doc(doc));
        }
        blocks.push(Block::vector("t", [self.geometry.inputs.time]).doc("Time [s]."));
        blocks
    }

    /// Inputs of the entry points that ask for the state, and those after it.
    fn state_inputs(&self, further: impl IntoIterator<Item = Block>) -> Vec<Block> {
        let q = self.free_q.iter().map(|i| self.q_all[*i]);
        let v = self.partition.free.iter().map(|i| self.v_all[*i]);
        let mut blocks = self.base_inputs();
        blocks.push(
            Block::vector("q", q.chain(self.own_integrals())).doc("Free coordinates [rad, m, quaternions]."),
        );
        blocks.push(Block::vector("v", v.chain(self.own_values())).doc("Free speeds [rad/s, m/s]."));
        blocks.extend(further);
        blocks
    }

    fn drive_input(&self) -> Block {
        Block::vector("drive", self.drive.iter().copied()).doc("Drive forces from forward_dynamics.")
    }

    pub(super) fn contact_input(&self) -> Block {
        let wrenches = self.contacts.iter().flat_map(|contact| [contact.force.0, contact.moment.0].concat());
        Block::vector("contact", wrenches)
            .doc("Per joint with clearance: force on the journal and moment about its centre, bearing frame.")
            .cites("[CS (17)]")
    }

    pub(super) fn prescribed(&self) -> Function {
        let entries = self.drivers.iter().flat_map(|driver| driver.law);
        let doc =
            "Position, speed and acceleration of every driver, driver by driver [rad or m, per s, per s²].";
        let outputs = vec![Block::matrix("prescribed", (self.drivers.len(), 3), entries).doc(doc)];
        function(Entry::Prescribed, "Motion that the drivers prescribe.", self.base_inputs(), outputs)
    }

    pub(super) fn start(&self) -> (Function, StartValues<'g>) {
        let driven = self.drivers.iter().map(|driver| (driver.coordinate, driver.speed, driver.law));
        self.geometry.g.begin_section("start values");
        let values = start_values(&self.geometry, driven);
        let own = if self.own.is_empty() { Vec::new() } else { self.starts_of_states() };
        let unstarted = own.iter().map(|_| self.geometry.g.zero());
        let q = self.free_q.iter().map(|i| values.q[*i]).chain(unstarted);
        let v = self.partition.free.iter().map(|i| values.v[*i]).chain(own.iter().copied());
        let outputs = vec![
            Block::vector("q", q).doc("Start values of the free coordinates, before the loops are closed."),
            Block::vector("v", v).doc("Wishes for the free speeds."),
        ];
        (function(Entry::Start, "Where assembly starts from.", self.base_inputs(), outputs), values)
    }

    /// Whether several ways to the same values are compared. Of longer chains one alone is derived: the others take as long as
    /// all the rest of a check.
    pub(super) fn is_short(&self) -> bool {
        self.compares && self.partition.free.len() + self.keep.len() <= MOST_TO_COMPARE
    }

    /// Accelerations, multipliers and drive forces as expressions of the state.
    pub(super) fn solution(&self, instant: &Instant<'g>, masses: &[LinkMass<'g>]) -> Shortest<'g> {
        let motion = &instant.state.motion;
        let known = Known::default();
        let with = |sums, cuts: &[CutRows<'g>], solve: &mut dyn FnMut(&Problem<'_, 'g>)| {
            self.geometry.g.begin_section("loop Jacobian");
            solve(&Problem {
                motion,
                v: &instant.state.v,
                rates: &instant.state.v_dot,
                masses,
                loads: &instant.loads,
                rows: &kept_rows(motion, (cuts, &instant.couplings), &self.keep),
                made: (sums, &self.keep),
                partition: &self.partition,
                known: &known,
            });
        };
        let others = |solve: &mut dyn FnMut(&Problem<'_, 'g>)| {
            for (sums, cuts) in instant.other_rows((false, true), self.is_short()) {
                with(sums, &cuts, solve);
            }
        };
        let mut solved = None;
        with(Sums::Links, &instant.cuts, &mut |problem| {
            solved = Some(forward(problem, others, (&self.jacobians, self.link_by_link)));
        });
        #[expect(clippy::expect_used, reason = "the problem is solved where it is made")]
        solved.expect("a solution")
    }

    pub(super) fn forward_dynamics(&self, solved: &Forward<'g>, own_rates: &[Expr<'g>]) -> Function {
        let doc = "Accelerations, multipliers and drive forces for a state that satisfies the closures.";
        let inputs = self.state_inputs([self.contact_input()]);
        function(Entry::ForwardDynamics, doc, inputs, solution_blocks(solved, own_rates).into())
    }

    pub(super) fn accelerations(&self, alone: &Solution<'g>, own_rates: &[Expr<'g>]) -> Function {
        let [accelerations, _, pivots] = blocks(alone, own_rates);
        let doc = "Accelerations alone, where nobody asks for multipliers and drive forces.";
        let inputs = self.state_inputs([self.contact_input()]);
        function(Entry::Accelerations, doc, inputs, vec![accelerations, pivots])
    }

    pub(super) fn state_rates(&self, instant: &Instant<'g>) -> StateRates<'g> {
        let (q, v) = (&instant.state.q, &instant.state.v);
        self.geometry.g.begin_section("rates of the coordinates");
        let mut q_dot = Vec::new();
        for link in &self.geometry.linkage.links {
            let (first, speed) = (link.first_coordinate, link.first_speed);
            let (q, v) = (&q[first..][..link.freedom.coordinates()], &v[speed..][..link.freedom.speeds()]);
            q_dot.extend(coordinate_rates(link.freedom, q, v));
        }
        StateRates {
            coordinates: self.free_q.iter().map(|i| q_dot[*i]).chain(self.own_values()).collect(),
            own: instant.own_rates.clone(),
            supplied: instant.loads.supplied,
            dissipated: instant.loads.dissipated,
        }
    }

    /// Rates of the coordinates, and powers with these drive forces.
    fn rate_blocks(&self, rates: &StateRates<'g>, drive: &[Expr<'g>]) -> [Block; 3] {
        self.geometry.g.begin_section("power");
        let mut supplied = rates.supplied;
        for (driver, force) in self.drivers.iter().zip(drive) {
            supplied += *force * driver.law[1];
        }
        [
            Block::vector("q_dot", rates.coordinates.iter().copied()).doc("Rates of the free coordinates."),
            Block::vector("supplied", [supplied]).doc("Power of drivers and applied forces [W]."),
            Block::vector("dissipated", [rates.dissipated]).doc("Power lost in dampers [W]."),
        ]
    }

    pub(super) fn rates(&self, rates: &StateRates<'g>) -> Function {
        let doc = "Rates of the coordinates, power in and power lost.";
        let outputs = self.rate_blocks(rates, &self.drive).into();
        function(Entry::Rates, doc, self.state_inputs([self.drive_input()]), outputs)
    }

    pub(super) fn derivative(&self, solved: &Forward<'g>, rates: &StateRates<'g>) -> Function {
        let [accelerations, multipliers, drive, pivots] = solution_blocks(solved, &rates.own);
        let [q_dot, supplied, dissipated] = self.rate_blocks(rates, &solved.drive);
        let outputs = vec![q_dot, accelerations, multipliers, drive, pivots, supplied, dissipated];
        let doc =
            "What a state does next: forward_dynamics and rates in one, after contacts at the same state.";
        let inputs = self.state_inputs([self.contact_input()]);
        Function { goes_on: true, ..function(Entry::Derivative, doc, inputs, outputs) }
    }

    pub(super) fn closure(&self, instant: &Instant<'g>) -> (Function, Vec<RowInfo>) {
        let g = self.geometry.g;
        let exact = cut_rows(&instant.state.motion, true, Sums::Links);
        g.enter(instant.section);
        let free = &self.partition.free;
        // States of the file's own are in no loop.
        let beside = || self.own.iter().map(|_| g.zero());
        let by = |cuts: &[CutRows<'g>], counts: bool| {
            let of_cuts = cuts.iter().flat_map(|cut| &cut.rows);
            let of_couplings = instant.couplings.iter().map(|coupling| &coupling.row);
            let all: Vec<Expr<'g>> = of_cuts.chain(of_couplings).map(|row| row.residual).collect();
            let rows = kept_rows(&instant.state.motion, (cuts, &instant.couplings), &self.keep);
            let rates: Vec<Expr<'g>> = rows.iter().map(|kept| kept.row.rate).collect();
            let mut jacobian: Vec<Expr<'g>> = Vec::with_capacity(rows.len() * (free.len() + self.own.len()));
            for row in &rows {
                jacobian.extend(free.iter().map(|j| row.jacobian[*j]).chain(beside()));
            }
            // Zeros, which are most of the Jacobian, take no operations.
            let entries = || [&all, &rates, &jacobian].into_iter().flatten().copied();
            let operations =
                if counts { g.operations(entries().filter(|entry| !entry.is_zero())) } else { 0 };
            (operations, [all, rates, jacobian])
        };
        let [all, rates, jacobian] = instant.by_shorter_rows(&exact, (true, false), self.compares, by);
        let outputs = vec![
            Block::vector("phi", all)
                .doc("Position residuals of all rows, dropped ones included [rad, m].")
                .cites("[CS (3)]"),
            Block::vector("phi_dot", rates.iter().copied())
                .doc("Velocity residuals of the kept rows [rad/s, m/s].")
                .cites("[CS (3)]"),
            Block::matrix("phi_q", (rates.len(), free.len() + self.own.len()), jacobian)
                .doc("Jacobian of the kept rows by the free speeds.")
                .cites("[CS (3)]"),
        ];
        let doc = "How well the loops close, and how the residuals change with the free speeds.";
        (function(Entry::Closure, doc, self.state_inputs([]), outputs), self.row_infos(instant))
    }

    fn energies(&self, instant: &Instant<'g>, masses: &[LinkMass<'g>]) -> [Expr<'g>; 2] {
        let motion = &instant.state.motion;
        self.geometry.g.begin_section("energies");
        let kinetic = kinetic_energy(masses, motion);
        let weight = weight_energy(motion, masses, self.gravity());
        [kinetic, weight + instant.loads.potential]
    }

    pub(super) fn energy(&self, instant: &Instant<'g>, masses: &[LinkMass<'g>]) -> Function {
        let [kinetic, potential] = self.energies(instant, masses);
        let outputs = vec![
            Block::vector("kinetic", [kinetic]).doc("Kinetic energy [J]."),
            Block::vector("potential", [potential]).doc("Energy of weight and springs [J]."),
        ];
        function(Entry::Energy, "Kinetic and potential energy.", self.state_inputs([]), outputs)
    }

    /// `switches`: values whose signs say which pieces of formulas hold; `rows`: how many of each table have been passed.
    pub(super) fn observe(
        &self,
        (dynamic, masses): (&Instant<'g>, &[LinkMass<'g>]),
        with_poses: bool,
        (switches, rows): (&[Expr<'g>], &[Expr<'g>]),
    ) -> (Function, Vec<Channel>) {
        let g = self.geometry.g;
        let mut instant = self.accelerated(dynamic, &self.v_dot);
        let list = |instant: &Instant<'g>| {
            let mut list = Channels::new(self, instant, masses, self.energies(instant, masses));
            if with_poses {
                list.poses();
            }
            let operations = if self.is_short() { g.operations(list.values.iter().copied()) } else { 0 };
            (operations, (list.channels, list.values))
        };
        let in_ground = list(&instant);
        instant.state.points_in_ground = false;
        let in_links = self.is_short().then(|| list(&instant));
        let (mut channels, mut values) =
            in_links.filter(|in_links| in_links.0 < in_ground.0).unwrap_or(in_ground).1;
        for (prefix, pieces) in [(SWITCH, switches), (ROW, rows)] {
            for (number, value) in pieces.iter().enumerate() {
                let name = format!("{prefix}{}", number + 1).into();
                channels.push(Channel { name, unit: "1".into(), wraps: false });
                values.push(*value);
            }
        }
        let inputs = self.state_inputs([
            Block::vector("v_dot", self.v_dot.iter().copied().chain(self.own_rates())).doc("Accelerations from forward_dynamics."),
            Block::vector("lambda", self.lambda.iter().copied()).doc(
                "Multipliers of all rows; zero for dropped rows except near positions where kept rows lose rank.",
            ),
            self.drive_input(),
            self.contact_input(),
        ]);
        let names = channels.iter().map(|channel| channel.name.to_string()).collect();
        let values =
            Block::vector("channels", values).doc("One value per output column, SI, components in W.");
        let doc = "Everything a user may want to see or record.";
        (function(Entry::Observe, doc, inputs, vec![Block { names, ..values }]), channels)
    }

    pub(super) fn contacts(&self, instant: &Instant<'g>) -> Function {
        let mut entries = Vec::new();
        for contact in &self.contacts {
            let name = &self.geometry.mechanism.joint(contact.joint).name;
            self.geometry.g.begin_section(format!("motion in the clearance of {name}"));
            entries.extend(contact_motion(self.geometry.g, &instant.state, contact));
        }
        let outputs = Block::matrix("contacts", (self.contacts.len(), 10), entries)
            .doc("Offset, its rate, relative angular velocity (3 each, bearing frame), clearance; SI.")
            .cites("[CS (7)-(12)]");
        let doc = "How the journals of joints with clearance lie and move in their bearings.";
        function(Entry::Contacts, doc, self.state_inputs([]), vec![outputs])
    }
}

/// Accelerations with the rates of the file's own states behind them, multipliers, drive forces, pivots.
fn solution_blocks<'g>(solved: &Forward<'g>, own_rates: &[Expr<'g>]) -> [Block; 4] {
    let [accelerations, multipliers, pivots] = blocks(&solved.solution, own_rates);
    let drive = Block::vector("drive", solved.drive.iter().copied())
        .doc("Generalised force of every driver on the child [N m, N].");
    [accelerations, multipliers, drive, pivots]
}

/// Accelerations with the rates of the file's own states behind them, multipliers, pivots.
fn blocks<'g>(solution: &Solution<'g>, own_rates: &[Expr<'g>]) -> [Block; 3] {
    [
        Block::vector("v_dot", solution.accelerations.iter().chain(own_rates).copied())
            .doc("Accelerations of the free speeds [rad/s², m/s²].")
            .cites("[CS (6)]"),
        Block::vector("lambda", solution.multipliers.iter().copied())
            .doc("Multipliers of the kept rows [N, N m], on the joint's child.")
            .cites("[CS (6)]"),
        Block::vector("pivots", solution.pivots.iter().copied()).doc(
            "Pivots of the loop rows, positive; small next to their usual size near a singular position.",
        ),
    ]
}

/// `q̇` of one link from its speeds.
fn coordinate_rates<'g>(freedom: Freedom, q: &[Expr<'g>], v: &[Expr<'g>]) -> Vec<Expr<'g>> {
    if !matches!(freedom, Freedom::Ball | Freedom::Free) {
        return v.to_vec();
    }
    // q̇ = q ∘ (0, omega) / 2 with omega in the link's own frame.
    let orientation = [q[0], q[1], q[2], q[3]];
    let turned = quaternion_product(orientation, [q[0].scope().zero(), v[0], v[1], v[2]]);
    let mut rates = turned.map(|x| 0.5 * x).to_vec();
    if freedom == Freedom::Free {
        rates.extend(rotation_of_quaternion(orientation) * Vec3::first_of(&v[3..]));
    }
    rates
}
