//! The blocks of every entry point.
//! In: the deriver's symbols, link motion. Out: [`Function`]s in the order of [`Entry::ALL`].

use linkwear_runtime::Entry;

use super::{Deriver, Instant};
use crate::derive::composite::mass_matrix;
use crate::derive::contacts::contact_motion;
use crate::derive::dynamics::{bias_forces, forward, kept_rows, kinetic_energy, weight_energy};
use crate::derive::inertia::LinkMass;
use crate::derive::joint_state::JointStates;
use crate::derive::linkage::Freedom;
use crate::derive::observe::{Observed, channels};
use crate::derive::start::start_values;
use crate::derive::{Block, Function};
use crate::expr::{ExprId, Scope};
use crate::id::JointId;

impl Deriver<'_> {
    fn base_inputs(&self) -> Vec<Block> {
        vec![
            Block::vector("parameters", "Tunable parameters, SI.", "", self.parameters.clone()),
            Block::vector("t", "Time [s].", "", vec![self.inputs.time]),
        ]
    }

    fn state_inputs(&self) -> Vec<Block> {
        let q = self.free_q.iter().map(|i| self.q_all[*i]).collect();
        let v = self.partition.free.iter().map(|i| self.v_all[*i]).collect();
        let mut blocks = self.base_inputs();
        blocks.push(Block::vector("q", "Free coordinates [rad, m, quaternions].", "", q));
        blocks.push(Block::vector("v", "Free speeds [rad/s, m/s].", "", v));
        blocks
    }

    pub(super) fn function(
        &self,
        entry: Entry,
        doc: &str,
        inputs: Vec<Block>,
        outputs: Vec<Block>,
    ) -> Function {
        Function { name: entry.name().to_owned(), doc: doc.to_owned(), inputs, outputs }
    }

    pub(super) fn prescribed(&self) -> Function {
        let entries = self.drivers.iter().flat_map(|driver| driver.law).collect();
        let doc =
            "Position, speed and acceleration of every driver, driver by driver [rad or m, per s, per s²].";
        let outputs = vec![Block::matrix("prescribed", doc, "", self.drivers.len(), 3, entries)];
        self.function(Entry::Prescribed, "Motion that the drivers prescribe.", self.base_inputs(), outputs)
    }

    pub(super) fn start(&mut self) -> Function {
        let driven: Vec<(usize, usize, [ExprId; 2])> = self
            .drivers
            .iter()
            .map(|driver| (driver.coordinate, driver.speed, [driver.law[0], driver.law[1]]))
            .collect();
        let g = self.g;
        g.begin_section("start values");
        let values = start_values(g, &self.geometry(), &driven);
        let q = self.free_q.iter().map(|i| values.q[*i]).collect();
        let v = self.partition.free.iter().map(|i| values.v[*i]).collect();
        self.start = Some(values);
        let outputs = vec![
            Block::vector("q", "Start values of the free coordinates, before the loops are closed.", "", q),
            Block::vector("v", "Wishes for the free speeds.", "", v),
        ];
        self.function(Entry::Start, "Where assembly starts from.", self.base_inputs(), outputs)
    }

    pub(super) fn forward_dynamics(&mut self, instant: &Instant, masses: &[LinkMass]) -> Function {
        let g = self.g;
        g.begin_section("loop Jacobian");
        let rows = kept_rows(g, self.linkage, &instant.motion, &instant.cuts, &self.keep);
        let result =
            forward(g, self.linkage, &instant.motion, masses, &instant.loads, (&rows, &self.partition));
        let outputs = vec![
            Block::vector(
                "v_dot",
                "Accelerations of the free speeds [rad/s², m/s²].",
                "[CS (6)]",
                result.solution.accelerations,
            ),
            Block::vector(
                "lambda",
                "Multipliers of the kept rows [N, N m], on the joint's child.",
                "[CS (6)]",
                result.solution.multipliers,
            ),
            Block::vector(
                "drive",
                "Generalised force of every driver on the child [N m, N].",
                "",
                result.drive,
            ),
            Block::vector(
                "pivots",
                "Pivots of the loop rows, positive; small next to their usual size near a singular position.",
                "",
                result.solution.pivots,
            ),
        ];
        let doc = "Accelerations, multipliers and drive forces for a state that satisfies the closures.";
        let mut inputs = self.state_inputs();
        inputs.push(self.contact_input());
        self.function(Entry::ForwardDynamics, doc, inputs, outputs)
    }

    pub(super) fn rates(&mut self, q: &[ExprId], v: &[ExprId], instant: &Instant) -> Function {
        let drive = self.drive.clone();
        let g = self.g;
        g.begin_section("rates of the coordinates");
        let mut q_dot = Vec::new();
        for link in &self.linkage.links {
            let (first, speed) = (link.first_coordinate, link.first_speed);
            let q = &q[first..first + link.freedom.coordinates()];
            let v = &v[speed..speed + link.freedom.speeds()];
            q_dot.extend(coordinate_rates(g, link.freedom, q, v));
        }
        g.begin_section("power");
        let mut supplied = instant.loads.supplied;
        for (driver, force) in self.drivers.iter().zip(&drive) {
            let power = g.mul(*force, driver.law[1]);
            supplied = g.add(supplied, power);
        }
        let q_dot = self.free_q.iter().map(|i| q_dot[*i]).collect();
        let mut inputs = self.state_inputs();
        inputs.push(Block::vector("drive", "Drive forces from forward_dynamics.", "", drive));
        let outputs = vec![
            Block::vector("q_dot", "Rates of the free coordinates.", "", q_dot),
            Block::vector("supplied", "Power of drivers and applied forces [W].", "", vec![supplied]),
            Block::vector("dissipated", "Power lost in dampers [W].", "", vec![instant.loads.dissipated]),
        ];
        self.function(Entry::Rates, "Rates of the coordinates, power in and power lost.", inputs, outputs)
    }

    pub(super) fn closure(&mut self, q: &[ExprId], v: &[ExprId], v_dot: &[ExprId]) -> Function {
        let g = self.g;
        let instant = self.instant(q, v, v_dot, true);
        let rows = kept_rows(g, self.linkage, &instant.motion, &instant.cuts, &self.keep);
        let cuts = instant.cuts;
        self.row_info = cuts
            .iter()
            .flat_map(|cut| cut.rows.iter().map(move |row| (cut.cut.joint, row.meaning.clone(), row.angular)))
            .collect();
        let all: Vec<ExprId> = cuts.iter().flat_map(|cut| cut.rows.iter().map(|row| row.residual)).collect();
        let rates: Vec<ExprId> = rows.iter().map(|row| row.rate).collect();
        let free = &self.partition.free;
        let jacobian: Vec<ExprId> =
            rows.iter().flat_map(|row| free.iter().map(|j| row.jacobian[*j])).collect();
        let outputs = vec![
            Block::vector(
                "phi",
                "Position residuals of all rows, dropped ones included [rad, m].",
                "[CS (3)]",
                all,
            ),
            Block::vector("phi_dot", "Velocity residuals of the kept rows [rad/s, m/s].", "[CS (3)]", rates),
            Block::matrix(
                "phi_q",
                "Jacobian of the kept rows by the free speeds.",
                "[CS (3)]",
                rows.len(),
                free.len(),
                jacobian,
            ),
        ];
        let doc = "How well the loops close, and how the residuals change with the free speeds.";
        self.function(Entry::Closure, doc, self.state_inputs(), outputs)
    }

    fn energies(&self, instant: &Instant, masses: &[LinkMass]) -> [ExprId; 2] {
        let g = self.g;
        g.begin_section("energies");
        let kinetic = kinetic_energy(g, masses, &instant.motion);
        let gravity = self.gravity();
        let weight = weight_energy(g, self.linkage, &instant.motion, masses, gravity);
        [kinetic, g.add(weight, instant.loads.potential)]
    }

    pub(super) fn energy(&mut self, instant: &Instant, masses: &[LinkMass]) -> Function {
        let [kinetic, potential] = self.energies(instant, masses);
        let outputs = vec![
            Block::vector("kinetic", "Kinetic energy [J].", "", vec![kinetic]),
            Block::vector("potential", "Energy of weight and springs [J].", "", vec![potential]),
        ];
        self.function(Entry::Energy, "Kinetic and potential energy.", self.state_inputs(), outputs)
    }

    pub(super) fn observe(&mut self, q: &[ExprId], v: &[ExprId], masses: &[LinkMass]) -> Function {
        let mut v_dot = vec![self.g.zero(); v.len()];
        for (position, speed) in self.partition.free.iter().enumerate() {
            v_dot[*speed] = self.v_dot[position];
        }
        for driver in &self.drivers {
            v_dot[driver.speed] = driver.law[2];
        }
        let g = self.g;
        let instant = self.instant(q, v, &v_dot, false);
        let energy = self.energies(&instant, masses);
        let geometry = self.geometry();
        let state = JointStates { geometry: &geometry, motion: &instant.motion, q, v, v_dot: &v_dot };
        let drives: Vec<(JointId, usize, ExprId)> = self
            .drivers
            .iter()
            .zip(&self.drive)
            .map(|(driver, force)| (driver.joint, driver.joint_coordinate, *force))
            .collect();
        let observed = Observed {
            state: &state,
            masses,
            loads: &instant.loads,
            cuts: &instant.cuts,
            multipliers: &self.lambda,
            keep: &self.keep,
            drives: &drives,
            energy,
        };
        let list = channels(g, &observed);
        self.channels = list.channels;
        let mut inputs = self.state_inputs();
        inputs.push(Block::vector("v_dot", "Accelerations from forward_dynamics.", "", self.v_dot.clone()));
        inputs.push(Block::vector(
            "lambda",
            "Multipliers of all rows; zero for dropped rows except near positions where kept rows lose rank.",
            "",
            self.lambda.clone(),
        ));
        inputs.push(Block::vector("drive", "Drive forces from forward_dynamics.", "", self.drive.clone()));
        inputs.push(self.contact_input());
        let names = self.channels.iter().map(|channel| channel.name.to_string()).collect();
        let doc = "One value per output column, SI, components in W.";
        let outputs = vec![Block::vector("channels", doc, "", list.values).named(names)];
        self.function(Entry::Observe, "Everything a user may want to see or record.", inputs, outputs)
    }

    fn contact_input(&self) -> Block {
        let entries = self.contacts.iter().flat_map(|contact| [contact.force, contact.moment].concat());
        let doc =
            "Per joint with clearance: force on the journal and moment about its centre, bearing frame.";
        Block::vector("contact", doc, "[CS (17)]", entries.collect())
    }

    pub(super) fn contacts(&mut self, q: &[ExprId], v: &[ExprId], instant: &Instant) -> Function {
        let joints: Vec<JointId> = self.contacts.iter().map(|contact| contact.joint).collect();
        let g = self.g;
        let geometry = self.geometry();
        let v_dot = vec![g.zero(); v.len()];
        let state = JointStates { geometry: &geometry, motion: &instant.motion, q, v, v_dot: &v_dot };
        let mut entries = Vec::new();
        for joint in &joints {
            g.begin_section(format!("motion in the clearance of {}", self.mechanism.joint(*joint).name));
            entries.extend(contact_motion(g, &state, *joint));
        }
        let doc = "Offset, its rate, relative angular velocity (3 each, bearing frame), clearance; SI.";
        let outputs = vec![Block::matrix("contacts", doc, "[CS (7)-(12)]", joints.len(), 10, entries)];
        let doc = "How the journals of joints with clearance lie and move in their bearings.";
        self.function(Entry::Contacts, doc, self.state_inputs(), outputs)
    }

    pub(super) fn equations_of_motion(&mut self, masses: &[LinkMass]) -> Function {
        let (q, v) = (self.q_all.clone(), self.v_all.clone());
        let n = v.len();
        let zeros = vec![self.g.zero(); n];
        let g = self.g;
        let instant = self.instant(&q, &v, &zeros, false);
        let h = bias_forces(g, self.linkage, &instant.motion, masses, &instant.loads);
        g.begin_section("mass matrix by composite bodies");
        let mass = mass_matrix(g, self.linkage, &instant.motion.poses, masses);
        g.begin_section("loop Jacobian");
        // Dropped rows too: they stand in where the kept ones happen to lose rank.
        let all = vec![true; self.keep.len()];
        let rows = kept_rows(g, self.linkage, &instant.motion, &instant.cuts, &all);
        let triangle: Vec<ExprId> = (0..n).flat_map(|i| mass[i][i..].to_vec()).collect();
        let residuals = rows.iter().map(|row| row.residual).collect();
        let gamma = rows.iter().map(|row| g.neg(row.bias)).collect();
        let jacobian: Vec<ExprId> = rows.iter().flat_map(|row| row.jacobian.clone()).collect();
        let outputs = vec![
            Block::vector("mass", "Upper triangle of M, row by row [kg m², kg m, kg].", "[CS (6)]", triangle),
            Block::vector("h", "Left side besides M v̇: inertia, weight, springs, damping.", "[CS (6)]", h),
            Block::vector("phi", "Position residuals of all rows [rad, m].", "[CS (3)]", residuals),
            Block::matrix(
                "phi_q",
                "Jacobian of all rows by all speeds.",
                "[CS (3)]",
                rows.len(),
                n,
                jacobian,
            ),
            Block::vector("gamma", "Right side of phi_q v̇ = gamma.", "[CS (6)]", gamma),
        ];
        let mut inputs = self.base_inputs();
        inputs.push(Block::vector("q", "All coordinates, driven ones included.", "", q));
        inputs.push(Block::vector("v", "All speeds, driven ones included.", "", v));
        inputs.push(self.contact_input());
        let doc = "M v̇ + h = Q_drive + phi_qᵀ lambda, phi_q v̇ = gamma, with the drivers kept free.";
        self.function(Entry::EquationsOfMotion, doc, inputs, outputs)
    }
}

/// `q̇` of one link from its speeds.
fn coordinate_rates(g: &Scope, freedom: Freedom, q: &[ExprId], v: &[ExprId]) -> Vec<ExprId> {
    if !matches!(freedom, Freedom::Ball | Freedom::Free) {
        return v.to_vec();
    }
    // q̇ = q ∘ (0, omega) / 2 with omega in the link's own frame.
    let zero = g.zero();
    let turned =
        crate::derive::observe::quaternion_product(g, [q[0], q[1], q[2], q[3]], [zero, v[0], v[1], v[2]]);
    let half = g.constant(0.5);
    let mut rates: Vec<ExprId> = turned.into_iter().map(|x| g.mul(half, x)).collect();
    if freedom == Freedom::Free {
        let rotation = crate::derive::kinematics::rotation_of_quaternion(g, [q[0], q[1], q[2], q[3]]);
        rates.extend(g.mul_vec3(rotation, [v[3], v[4], v[5]]));
    }
    rates
}
