//! The blocks of every entry point.
//! In: the deriver's symbols, link motion. Out: [`Function`]s in the order of [`Entry::ALL`].

use linkwear_runtime::{Channel, Entry, RowInfo};

use super::deriver::{Deriver, Instant};
use crate::derive::contacts::contact_motion;
use crate::derive::dynamics::{bias_forces, forward, kept_rows, kinetic_energy, weight_energy};
use crate::derive::geometry::Geometry;
use crate::derive::link_mass::LinkMass;
use crate::derive::linkage::Freedom;
use crate::derive::mass_matrix::mass_matrix;
use crate::derive::observe::{Observed, channels};
use crate::derive::orientation::{quaternion_product, rotation_of_quaternion};
use crate::derive::start::{StartValues, start_values};
use crate::derive::{Block, Function};
use crate::expr::{Expr, Vec3};
use crate::id::JointId;

impl<'g> Deriver<'g> {
    fn base_inputs(&self) -> Vec<Block> {
        vec![
            Block::vector("parameters", "Tunable parameters, SI.", "", self.parameters.iter().copied()),
            Block::vector("t", "Time [s].", "", [self.geometry.inputs.time]),
        ]
    }

    fn state_inputs(&self) -> Vec<Block> {
        let q = self.free_q.iter().map(|i| self.q_all[*i]);
        let v = self.partition.free.iter().map(|i| self.v_all[*i]);
        let mut blocks = self.base_inputs();
        blocks.push(Block::vector("q", "Free coordinates [rad, m, quaternions].", "", q));
        blocks.push(Block::vector("v", "Free speeds [rad/s, m/s].", "", v));
        blocks
    }

    fn drive_input(&self) -> Block {
        Block::vector("drive", "Drive forces from forward_dynamics.", "", self.drive.iter().copied())
    }

    fn contact_input(&self) -> Block {
        let entries =
            self.contacts.iter().flat_map(|contact| contact.force.into_iter().chain(contact.moment));
        let doc =
            "Per joint with clearance: force on the journal and moment about its centre, bearing frame.";
        Block::vector("contact", doc, "[CS (17)]", entries)
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
        let entries = self.drivers.iter().flat_map(|driver| driver.law);
        let doc =
            "Position, speed and acceleration of every driver, driver by driver [rad or m, per s, per s²].";
        let outputs = vec![Block::matrix("prescribed", doc, "", (self.drivers.len(), 3), entries)];
        self.function(Entry::Prescribed, "Motion that the drivers prescribe.", self.base_inputs(), outputs)
    }

    pub(super) fn start(&self) -> (Function, StartValues<'g>) {
        let driven: Vec<(usize, usize, [Expr<'g>; 2])> = self
            .drivers
            .iter()
            .map(|driver| (driver.coordinate, driver.speed, [driver.law[0], driver.law[1]]))
            .collect();
        self.geometry.g.begin_section("start values");
        let values = start_values(&self.geometry, &driven);
        let q = self.free_q.iter().map(|i| values.q[*i]);
        let v = self.partition.free.iter().map(|i| values.v[*i]);
        let outputs = vec![
            Block::vector("q", "Start values of the free coordinates, before the loops are closed.", "", q),
            Block::vector("v", "Wishes for the free speeds.", "", v),
        ];
        let function =
            self.function(Entry::Start, "Where assembly starts from.", self.base_inputs(), outputs);
        (function, values)
    }

    pub(super) fn forward_dynamics(&self, instant: &Instant<'g>, masses: &[LinkMass<'g>]) -> Function {
        let Geometry { g, linkage, .. } = self.geometry;
        let motion = &instant.state.motion;
        g.begin_section("loop Jacobian");
        let rows = kept_rows(g, linkage, motion, &instant.cuts, &self.keep);
        let result = forward(g, linkage, motion, masses, &instant.loads, (&rows, &self.partition));
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

    pub(super) fn rates(&self, instant: &Instant<'g>) -> Function {
        let (q, v) = (&instant.state.q, &instant.state.v);
        self.geometry.g.begin_section("rates of the coordinates");
        let mut q_dot = Vec::new();
        for link in &self.geometry.linkage.links {
            let (first, speed) = (link.first_coordinate, link.first_speed);
            let (q, v) = (&q[first..][..link.freedom.coordinates()], &v[speed..][..link.freedom.speeds()]);
            q_dot.extend(coordinate_rates(link.freedom, q, v));
        }
        self.geometry.g.begin_section("power");
        let mut supplied = instant.loads.supplied;
        for (driver, force) in self.drivers.iter().zip(&self.drive) {
            supplied += *force * driver.law[1];
        }
        let q_dot = self.free_q.iter().map(|i| q_dot[*i]);
        let mut inputs = self.state_inputs();
        inputs.push(self.drive_input());
        let outputs = vec![
            Block::vector("q_dot", "Rates of the free coordinates.", "", q_dot),
            Block::vector("supplied", "Power of drivers and applied forces [W].", "", [supplied]),
            Block::vector("dissipated", "Power lost in dampers [W].", "", [instant.loads.dissipated]),
        ];
        self.function(Entry::Rates, "Rates of the coordinates, power in and power lost.", inputs, outputs)
    }

    pub(super) fn closure(&self) -> (Function, Vec<RowInfo>) {
        let Instant { state, cuts, .. } = self.instant(self.driven_state(&[]), true);
        let rows = kept_rows(self.geometry.g, self.geometry.linkage, &state.motion, &cuts, &self.keep);
        let all = cuts.iter().flat_map(|cut| cut.rows.iter().map(|row| row.residual));
        let free = &self.partition.free;
        let jacobian = rows.iter().flat_map(|row| free.iter().map(|j| row.jacobian[*j]));
        let outputs = vec![
            Block::vector(
                "phi",
                "Position residuals of all rows, dropped ones included [rad, m].",
                "[CS (3)]",
                all,
            ),
            Block::vector(
                "phi_dot",
                "Velocity residuals of the kept rows [rad/s, m/s].",
                "[CS (3)]",
                rows.iter().map(|row| row.rate),
            ),
            Block::matrix(
                "phi_q",
                "Jacobian of the kept rows by the free speeds.",
                "[CS (3)]",
                (rows.len(), free.len()),
                jacobian,
            ),
        ];
        let doc = "How well the loops close, and how the residuals change with the free speeds.";
        (self.function(Entry::Closure, doc, self.state_inputs(), outputs), self.row_infos(&cuts))
    }

    fn energies(&self, instant: &Instant<'g>, masses: &[LinkMass<'g>]) -> [Expr<'g>; 2] {
        let (g, motion) = (self.geometry.g, &instant.state.motion);
        g.begin_section("energies");
        let kinetic = kinetic_energy(g, masses, motion);
        let weight = weight_energy(g, motion, masses, self.gravity());
        [kinetic, weight + instant.loads.potential]
    }

    pub(super) fn energy(&self, instant: &Instant<'g>, masses: &[LinkMass<'g>]) -> Function {
        let [kinetic, potential] = self.energies(instant, masses);
        let outputs = vec![
            Block::vector("kinetic", "Kinetic energy [J].", "", [kinetic]),
            Block::vector("potential", "Energy of weight and springs [J].", "", [potential]),
        ];
        self.function(Entry::Energy, "Kinetic and potential energy.", self.state_inputs(), outputs)
    }

    pub(super) fn observe(&self, masses: &[LinkMass<'g>]) -> (Function, Vec<Channel>) {
        let instant = self.instant(self.driven_state(&self.v_dot), false);
        let energy = self.energies(&instant, masses);
        let drives: Vec<(JointId, usize, Expr<'g>)> = self
            .drivers
            .iter()
            .zip(&self.drive)
            .map(|(driver, force)| (driver.joint, driver.joint_coordinate, *force))
            .collect();
        let list = channels(
            self.geometry.g,
            &Observed {
                state: &instant.state,
                masses,
                loads: &instant.loads,
                cuts: &instant.cuts,
                multipliers: &self.lambda,
                keep: &self.keep,
                drives: &drives,
                energy,
            },
        );
        let mut inputs = self.state_inputs();
        let rates = self.v_dot.iter().copied();
        inputs.push(Block::vector("v_dot", "Accelerations from forward_dynamics.", "", rates));
        inputs.push(Block::vector(
            "lambda",
            "Multipliers of all rows; zero for dropped rows except near positions where kept rows lose rank.",
            "",
            self.lambda.iter().copied(),
        ));
        inputs.push(self.drive_input());
        inputs.push(self.contact_input());
        let names = list.channels.iter().map(|channel| channel.name.to_string()).collect();
        let doc = "One value per output column, SI, components in W.";
        let outputs = vec![Block::vector("channels", doc, "", list.values).named(names)];
        let doc = "Everything a user may want to see or record.";
        (self.function(Entry::Observe, doc, inputs, outputs), list.channels)
    }

    pub(super) fn contacts(&self, instant: &Instant<'g>) -> Function {
        let mut entries = Vec::new();
        for contact in &self.contacts {
            let name = &self.geometry.mechanism.joint(contact.joint).name;
            self.geometry.g.begin_section(format!("motion in the clearance of {name}"));
            entries.extend(contact_motion(self.geometry.g, &instant.state, contact.joint));
        }
        let doc = "Offset, its rate, relative angular velocity (3 each, bearing frame), clearance; SI.";
        let shape = (self.contacts.len(), 10);
        let outputs = vec![Block::matrix("contacts", doc, "[CS (7)-(12)]", shape, entries)];
        let doc = "How the journals of joints with clearance lie and move in their bearings.";
        self.function(Entry::Contacts, doc, self.state_inputs(), outputs)
    }

    pub(super) fn equations_of_motion(&self, masses: &[LinkMass<'g>]) -> Function {
        let Geometry { g, linkage, .. } = self.geometry;
        let (q, v) = (self.q_all.clone(), self.v_all.clone());
        let n = v.len();
        let instant = self.instant([q, v, vec![g.zero(); n]], false);
        let motion = &instant.state.motion;
        let h = bias_forces(g, linkage, motion, masses, &instant.loads);
        g.begin_section("mass matrix by composite bodies");
        let mass = mass_matrix(g, linkage, &motion.poses, masses);
        g.begin_section("loop Jacobian");
        // Dropped rows too: they stand in where the kept ones happen to lose rank.
        let rows = kept_rows(g, linkage, motion, &instant.cuts, &vec![true; self.keep.len()]);
        let outputs = vec![
            Block::vector(
                "mass",
                "Upper triangle of M, row by row [kg m², kg m, kg].",
                "[CS (6)]",
                (0..n).flat_map(|i| mass[i][i..].to_vec()),
            ),
            Block::vector("h", "Left side besides M v̇: inertia, weight, springs, damping.", "[CS (6)]", h),
            Block::vector(
                "phi",
                "Position residuals of all rows [rad, m].",
                "[CS (3)]",
                rows.iter().map(|row| row.residual),
            ),
            Block::matrix(
                "phi_q",
                "Jacobian of all rows by all speeds.",
                "[CS (3)]",
                (rows.len(), n),
                rows.iter().flat_map(|row| row.jacobian.iter().copied()),
            ),
            Block::vector(
                "gamma",
                "Right side of phi_q v̇ = gamma.",
                "[CS (6)]",
                rows.iter().map(|row| -row.bias),
            ),
        ];
        let mut inputs = self.base_inputs();
        let (q, v) = (instant.state.q, instant.state.v);
        inputs.push(Block::vector("q", "All coordinates, driven ones included.", "", q));
        inputs.push(Block::vector("v", "All speeds, driven ones included.", "", v));
        inputs.push(self.contact_input());
        let doc = "M v̇ + h = Q_drive + phi_qᵀ lambda, phi_q v̇ = gamma, with the drivers kept free.";
        self.function(Entry::EquationsOfMotion, doc, inputs, outputs)
    }
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
