//! What each entry point of the runtime's contract returns, as blocks of expressions.
//! In: mechanism, topology, which constraint rows to keep. Out: [`Derived`].
//! Never knows tapes. The only place that knows all parts of the derivation.

mod description;

use linkwear_runtime::{Channel, Description, Entry, Sizes};

use crate::expr::{ExprId, Graph, Vec3};
use crate::id::JointId;
use crate::model::{Mechanism, Topology};

use super::{Block, Equations, Function};
use crate::derive::across::Motion;
use crate::derive::closure::{CutRows, cut_rows};
use crate::derive::dynamics::{Partition, bias_forces, forward, kept_rows, kinetic_energy, weight_energy};
use crate::derive::forces::{Loads, loads};
use crate::derive::inertia::{Geometry, MassProperties, mass_matrix};
use crate::derive::joint_state::JointStates;
use crate::derive::kinematics::{Poses, accelerations, twists};
use crate::derive::linkage::{Freedom, Linkage, linkage};
use crate::derive::lower::Inputs;
use crate::derive::observe::{Observed, channels};
use crate::derive::start::{StartValues, start_values};

/// The result: equations, their layout, and what they are called.
#[derive(Clone, Debug)]
pub struct Derived {
    /// Functions over one graph, in the order of [`Entry::ALL`].
    pub equations: Equations,
    /// Layout (`workspace` is still zero: back ends know it).
    pub sizes: Sizes,
    /// Names, units, rows, channels.
    pub description: Description,
    /// The tree of links it was derived on.
    pub linkage: Linkage,
}

/// How much is needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// All entry points.
    Everything,
    /// Positions, Jacobians and columns only, while redundant rows are still in: no elimination.
    Analysis,
}

/// Derives all entry points. `keep` says for every constraint row (cuts in topology order) whether it is
/// kept; `None` keeps all.
#[must_use]
pub fn derive(
    mechanism: &Mechanism,
    topology: &Topology,
    keep: Option<&[bool]>,
    purpose: Purpose,
) -> Derived {
    let defaults: Vec<f64> = mechanism.parameters.iter().map(|parameter| parameter.value).collect();
    let linkage = linkage(mechanism, topology, &defaults);
    let mut deriver = Deriver::new(mechanism, &linkage, keep);
    let functions = deriver.functions(purpose);
    let (sizes, description) = (deriver.sizes(), deriver.description());
    let equations = Equations { graph: deriver.g, functions };
    Derived { equations, sizes, description, linkage }
}

/// A prescribed coordinate with its place and its law.
struct Driver {
    joint: JointId,
    joint_coordinate: usize,
    coordinate: usize,
    speed: usize,
    /// Position, speed, acceleration over parameters and t.
    law: [ExprId; 3],
}

struct Deriver<'a> {
    g: Graph,
    mechanism: &'a Mechanism,
    linkage: &'a Linkage,
    inputs: Inputs,
    parameters: Vec<ExprId>,
    drivers: Vec<Driver>,
    /// Symbols of all coordinates and speeds, driven ones included.
    q_all: Vec<ExprId>,
    v_all: Vec<ExprId>,
    free_q: Vec<usize>,
    partition: Partition,
    v_dot: Vec<ExprId>,
    /// Multipliers of all rows.
    lambda: Vec<ExprId>,
    drive: Vec<ExprId>,
    keep: Vec<bool>,
    row_info: Vec<(JointId, String, bool)>,
    channels: Vec<Channel>,
    start: Option<StartValues>,
}

/// Link motion with what depends on it.
struct Instant {
    motion: Motion,
    loads: Loads,
    cuts: Vec<CutRows>,
}

impl<'a> Deriver<'a> {
    fn new(mechanism: &'a Mechanism, linkage: &'a Linkage, keep: Option<&[bool]>) -> Self {
        let mut g = Graph::new();
        g.begin_section("prescribed motion");
        let mut parameters = Vec::new();
        let all_parameters = mechanism
            .parameters
            .iter()
            .map(|parameter| {
                if parameter.tunable {
                    let symbol = g.symbol(parameter.name.clone());
                    parameters.push(symbol);
                    symbol
                } else {
                    g.constant(parameter.value)
                }
            })
            .collect();
        let time = g.symbol("t");
        let inputs = Inputs { parameters: all_parameters, time };
        let rows = linkage
            .cuts
            .iter()
            .map(|cut| crate::derive::closure::row_count(&mechanism.joint(cut.joint).kind, cut.closure));
        let rows: usize = rows.sum();
        let keep = keep.map_or_else(|| vec![true; rows], <[bool]>::to_vec);
        let mut own = Self {
            g,
            mechanism,
            linkage,
            inputs,
            parameters,
            drivers: Vec::new(),
            q_all: Vec::new(),
            v_all: Vec::new(),
            free_q: Vec::new(),
            partition: Partition::default(),
            v_dot: Vec::new(),
            lambda: Vec::new(),
            drive: Vec::new(),
            keep,
            row_info: Vec::new(),
            channels: Vec::new(),
            start: None,
        };
        own.find_drivers();
        own.make_symbols();
        own
    }

    fn find_drivers(&mut self) {
        for (index, joint) in self.mechanism.joints.iter().enumerate() {
            let id = JointId::new(index);
            for drive in &joint.drives {
                let Some(link) = self.linkage.link_of_coordinate(id, drive.coordinate) else { continue };
                let link = &self.linkage.links[link];
                let position = self.inputs.lower(&mut self.g, &drive.law);
                let speed = self.g.derivative(position, self.inputs.time);
                let acceleration = self.g.derivative(speed, self.inputs.time);
                self.drivers.push(Driver {
                    joint: id,
                    joint_coordinate: drive.coordinate,
                    coordinate: link.first_coordinate,
                    speed: link.first_speed,
                    law: [position, speed, acceleration],
                });
            }
        }
    }

    fn make_symbols(&mut self) {
        let names = description::variable_names(self.mechanism, self.linkage);
        for (name, _) in &names.0 {
            let symbol = self.g.symbol(name.replace('.', "_"));
            self.q_all.push(symbol);
        }
        for (name, _) in &names.1 {
            let symbol = self.g.symbol(name.replace('.', "_"));
            self.v_all.push(symbol);
        }
        self.free_q = (0..self.q_all.len())
            .filter(|index| self.drivers.iter().all(|driver| driver.coordinate != *index))
            .collect();
        self.partition = Partition {
            free: (0..self.v_all.len())
                .filter(|index| self.drivers.iter().all(|driver| driver.speed != *index))
                .collect(),
            driven: self.drivers.iter().map(|driver| driver.speed).collect(),
        };
        for index in self.partition.free.clone() {
            let symbol = self.g.symbol(names.1[index].0.replace('.', "_") + "_dot");
            self.v_dot.push(symbol);
        }
        let (mut kept, mut spare) = (0, 0);
        for keep in self.keep.clone() {
            let (name, count) = if keep { ("lambda", &mut kept) } else { ("spare_lambda", &mut spare) };
            *count += 1;
            let symbol = self.g.symbol(format!("{name}{count}"));
            self.lambda.push(symbol);
        }
        for driver in &self.drivers {
            let name = &self.mechanism.joint(driver.joint).name;
            let symbol = self.g.symbol(format!("{name}_drive"));
            self.drive.push(symbol);
        }
    }

    /// Coordinates, speeds and accelerations with the drivers' laws inserted.
    fn driven_state(&self) -> (Vec<ExprId>, Vec<ExprId>) {
        let (mut q, mut v) = (self.q_all.clone(), self.v_all.clone());
        for driver in &self.drivers {
            q[driver.coordinate] = driver.law[0];
            v[driver.speed] = driver.law[1];
        }
        (q, v)
    }

    fn geometry(&self) -> Geometry<'_> {
        Geometry { mechanism: self.mechanism, linkage: self.linkage, inputs: &self.inputs }
    }

    /// Runs `action` with the graph taken out of `self`, so that the rest stays readable.
    fn with_graph<R>(&mut self, action: impl FnOnce(&mut Graph, &Self) -> R) -> R {
        let mut g = std::mem::take(&mut self.g);
        let result = action(&mut g, self);
        self.g = g;
        result
    }

    fn gravity(&self, g: &mut Graph) -> Vec3 {
        self.inputs.lower3(g, &self.mechanism.gravity)
    }

    fn masses(&self, g: &mut Graph) -> Vec<MassProperties> {
        g.begin_section("mass properties");
        self.geometry().masses(g)
    }

    /// Link motion, loads and closure rows for the given state and accelerations.
    fn instant(&self, g: &mut Graph, q: &[ExprId], v: &[ExprId], v_dot: &[ExprId], exact: bool) -> Instant {
        let geometry = self.geometry();
        g.begin_section("poses of the links, [CS (2)]");
        let mounts: Vec<Vec3> = (0..self.linkage.links.len()).map(|at| geometry.mount(g, at)).collect();
        let poses = Poses::new(g, self.linkage, &mounts, q);
        self.label_poses(g, &poses, q);
        g.begin_section("twists of the links, [CS (5)]");
        let twists = twists(g, self.linkage, &poses, v);
        g.begin_section("accelerations of the links");
        let gravity = self.gravity(g);
        let ground = g.neg3(gravity);
        let accelerations = accelerations(g, self.linkage, &poses, &twists, (v, v_dot), ground);
        for (link, (twist, acceleration)) in self.linkage.links.iter().zip(twists.iter().zip(&accelerations))
        {
            for (axis, i) in ["x", "y", "z"].iter().zip(0..3) {
                g.label(twist.omega[i], format!("{}_w{axis}", link.name));
                g.label(twist.origin[i], format!("{}_v{axis}", link.name));
                g.label(acceleration.origin[i], format!("{}_a{axis}", link.name));
                g.label(acceleration.alpha[i], format!("{}_alpha_{axis}", link.name));
            }
        }
        let motion = Motion { poses, twists, accelerations, ground };
        let state = JointStates { geometry: &geometry, motion: &motion, q, v, v_dot };
        let loads = loads(g, &state);
        let cuts = cut_rows(g, &geometry, &motion, exact);
        Instant { motion, loads, cuts }
    }

    fn label_poses(&self, g: &mut Graph, poses: &Poses, q: &[ExprId]) {
        for (at, link) in self.linkage.links.iter().enumerate() {
            if let Freedom::Rotation { offset, .. } = link.freedom {
                let joint = &self.mechanism.joint(link.joint).name;
                let offset = g.constant(offset);
                let angle = g.add(q[link.first_coordinate], offset);
                let (sine, cosine) = (g.sin(angle), g.cos(angle));
                g.label(sine, format!("sin_{joint}"));
                g.label(cosine, format!("cos_{joint}"));
            }
            for (axis, component) in ["x", "y", "z"].iter().zip(poses.world[at].offset) {
                g.label(component, format!("{}_{axis}", link.name));
            }
        }
    }

    fn functions(&mut self, purpose: Purpose) -> Vec<Function> {
        let (q, v) = self.driven_state();
        let mut v_dot_known = vec![self.g.zero(); v.len()];
        for driver in &self.drivers {
            v_dot_known[driver.speed] = driver.law[2];
        }
        let masses = self.with_graph(|g, own| own.masses(g));
        let dynamic = self.with_graph(|g, own| own.instant(g, &q, &v, &v_dot_known, false));
        let list = vec![
            self.prescribed(),
            self.start(),
            match purpose {
                Purpose::Everything => self.forward_dynamics(&dynamic, &masses),
                Purpose::Analysis => self.function(Entry::ForwardDynamics, "", Vec::new(), Vec::new()),
            },
            self.rates(&q, &v, &dynamic),
            self.closure(&q, &v, &v_dot_known),
            self.energy(&dynamic, &masses),
            self.observe(&q, &v, &masses),
            self.equations_of_motion(&masses),
        ];
        debug_assert!(list.iter().zip(Entry::ALL).all(|(function, entry)| function.name == entry.name()));
        list
    }

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

    fn function(&self, entry: Entry, doc: &str, inputs: Vec<Block>, outputs: Vec<Block>) -> Function {
        Function { name: entry.name().to_owned(), doc: doc.to_owned(), inputs, outputs }
    }

    fn prescribed(&self) -> Function {
        let entries = self.drivers.iter().flat_map(|driver| driver.law).collect();
        let doc =
            "Position, speed and acceleration of every driver, driver by driver [rad or m, per s, per s²].";
        let outputs = vec![Block::matrix("prescribed", doc, "", self.drivers.len(), 3, entries)];
        self.function(Entry::Prescribed, "Motion that the drivers prescribe.", self.base_inputs(), outputs)
    }

    fn start(&mut self) -> Function {
        let driven: Vec<(usize, usize, [ExprId; 2])> = self
            .drivers
            .iter()
            .map(|driver| (driver.coordinate, driver.speed, [driver.law[0], driver.law[1]]))
            .collect();
        let values = self.with_graph(|g, own| {
            g.begin_section("start values");
            start_values(g, &own.geometry(), &driven)
        });
        let q = self.free_q.iter().map(|i| values.q[*i]).collect();
        let v = self.partition.free.iter().map(|i| values.v[*i]).collect();
        self.start = Some(values);
        let outputs = vec![
            Block::vector("q", "Start values of the free coordinates, before the loops are closed.", "", q),
            Block::vector("v", "Wishes for the free speeds.", "", v),
        ];
        self.function(Entry::Start, "Where assembly starts from.", self.base_inputs(), outputs)
    }

    fn forward_dynamics(&mut self, instant: &Instant, masses: &[MassProperties]) -> Function {
        let result = self.with_graph(|g, own| {
            g.begin_section("loop Jacobian");
            let rows = kept_rows(g, own.linkage, &instant.motion, &instant.cuts, &own.keep);
            forward(g, own.linkage, &instant.motion, masses, &instant.loads, (&rows, &own.partition))
        });
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
                "Pivots of the loop rows, positive; small next to 1 near a singular position.",
                "",
                result.solution.pivots,
            ),
        ];
        let doc = "Accelerations, multipliers and drive forces for a state that satisfies the closures.";
        self.function(Entry::ForwardDynamics, doc, self.state_inputs(), outputs)
    }

    fn rates(&mut self, q: &[ExprId], v: &[ExprId], instant: &Instant) -> Function {
        let drive = self.drive.clone();
        let (q_dot, supplied) = self.with_graph(|g, own| {
            g.begin_section("rates of the coordinates");
            let mut q_dot = Vec::new();
            for link in &own.linkage.links {
                let (first, speed) = (link.first_coordinate, link.first_speed);
                let q = &q[first..first + link.freedom.coordinates()];
                let v = &v[speed..speed + link.freedom.speeds()];
                q_dot.extend(coordinate_rates(g, link.freedom, q, v));
            }
            g.begin_section("power");
            let mut supplied = instant.loads.supplied;
            for (driver, force) in own.drivers.iter().zip(&drive) {
                let power = g.mul(*force, driver.law[1]);
                supplied = g.add(supplied, power);
            }
            (q_dot, supplied)
        });
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

    fn closure(&mut self, q: &[ExprId], v: &[ExprId], v_dot: &[ExprId]) -> Function {
        let (cuts, rows) = self.with_graph(|g, own| {
            let instant = own.instant(g, q, v, v_dot, true);
            let rows = kept_rows(g, own.linkage, &instant.motion, &instant.cuts, &own.keep);
            (instant.cuts, rows)
        });
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

    fn energies(&self, g: &mut Graph, instant: &Instant, masses: &[MassProperties]) -> [ExprId; 2] {
        g.begin_section("energies");
        let kinetic = kinetic_energy(g, masses, &instant.motion.twists);
        let gravity = self.gravity(g);
        let weight = weight_energy(g, self.linkage, &instant.motion, masses, gravity);
        [kinetic, g.add(weight, instant.loads.potential)]
    }

    fn energy(&mut self, instant: &Instant, masses: &[MassProperties]) -> Function {
        let [kinetic, potential] = self.with_graph(|g, own| own.energies(g, instant, masses));
        let outputs = vec![
            Block::vector("kinetic", "Kinetic energy [J].", "", vec![kinetic]),
            Block::vector("potential", "Energy of weight and springs [J].", "", vec![potential]),
        ];
        self.function(Entry::Energy, "Kinetic and potential energy.", self.state_inputs(), outputs)
    }

    fn observe(&mut self, q: &[ExprId], v: &[ExprId], masses: &[MassProperties]) -> Function {
        let mut v_dot = vec![self.g.zero(); v.len()];
        for (position, speed) in self.partition.free.iter().enumerate() {
            v_dot[*speed] = self.v_dot[position];
        }
        for driver in &self.drivers {
            v_dot[driver.speed] = driver.law[2];
        }
        let list = self.with_graph(|g, own| {
            let instant = own.instant(g, q, v, &v_dot, false);
            let energy = own.energies(g, &instant, masses);
            let geometry = own.geometry();
            let state = JointStates { geometry: &geometry, motion: &instant.motion, q, v, v_dot: &v_dot };
            let drives: Vec<(JointId, usize, ExprId)> = own
                .drivers
                .iter()
                .zip(&own.drive)
                .map(|(driver, force)| (driver.joint, driver.joint_coordinate, *force))
                .collect();
            let observed = Observed {
                state: &state,
                masses,
                loads: &instant.loads,
                cuts: &instant.cuts,
                multipliers: &own.lambda,
                keep: &own.keep,
                drives: &drives,
                energy,
            };
            channels(g, &observed)
        });
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
        let outputs = vec![Block::vector(
            "channels",
            "One value per output column, SI, components in W.",
            "",
            list.values,
        )];
        self.function(Entry::Observe, "Everything a user may want to see or record.", inputs, outputs)
    }

    fn equations_of_motion(&mut self, masses: &[MassProperties]) -> Function {
        let (q, v) = (self.q_all.clone(), self.v_all.clone());
        let n = v.len();
        let zeros = vec![self.g.zero(); n];
        let (mass, h, rows) = self.with_graph(|g, own| {
            let instant = own.instant(g, &q, &v, &zeros, false);
            let h = bias_forces(g, own.linkage, &instant.motion, masses, &instant.loads);
            g.begin_section("mass matrix by composite bodies");
            let mass = mass_matrix(g, own.linkage, &instant.motion.poses, masses);
            g.begin_section("loop Jacobian");
            // Dropped rows too: they stand in where the kept ones happen to lose rank.
            let all = vec![true; own.keep.len()];
            let rows = kept_rows(g, own.linkage, &instant.motion, &instant.cuts, &all);
            (mass, h, rows)
        });
        let triangle: Vec<ExprId> = (0..n).flat_map(|i| mass[i][i..].to_vec()).collect();
        let residuals = rows.iter().map(|row| row.residual).collect();
        let gamma = self.with_graph(|g, _| rows.iter().map(|row| g.neg(row.bias)).collect());
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
        let doc = "M v̇ + h = Q_drive + phi_qᵀ lambda, phi_q v̇ = gamma, with the drivers kept free.";
        self.function(Entry::EquationsOfMotion, doc, inputs, outputs)
    }
}

/// `q̇` of one link from its speeds.
fn coordinate_rates(g: &mut Graph, freedom: Freedom, q: &[ExprId], v: &[ExprId]) -> Vec<ExprId> {
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
