//! What each entry point of the runtime's contract returns, as blocks of expressions.
//! In: mechanism, topology, which constraint rows to keep. Out: [`Derived`].
//! Never knows tapes. The only place that knows all parts of the derivation.

mod description;
mod functions;

use linkwear_runtime::{Channel, Description, Entry, Sizes};

use crate::expr::{ExprId, Scope, Vec3};
use crate::id::JointId;
use crate::model::{Mechanism, Topology};

use super::{Equations, Function};
use crate::derive::across::{ModalState, Motion};
use crate::derive::closure::{CutRows, cut_rows};
use crate::derive::contacts::ContactWrench;
use crate::derive::dynamics::Partition;
use crate::derive::forces::{Loads, loads};
use crate::derive::inertia::{Geometry, LinkMass};
use crate::derive::joint_state::JointStates;
use crate::derive::kinematics::{Poses, accelerations, twists};
use crate::derive::linkage::{Freedom, Link, Linkage};
use crate::derive::linkage_build::linkage;
use crate::derive::lower::Inputs;
use crate::derive::start::StartValues;

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
    let scope = Scope::new();
    let mut deriver = Deriver::new(&scope, mechanism, &linkage, keep);
    let functions = deriver.functions(purpose);
    let (sizes, description) = (deriver.sizes(), deriver.description());
    let equations = Equations { graph: scope.into_graph(), functions };
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
    g: &'a Scope,
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
    /// Symbols of the wrenches that contact laws hand in.
    contacts: Vec<ContactWrench>,
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

fn modal_state(link: &Link, q: &[ExprId], v: &[ExprId], v_dot: &[ExprId]) -> ModalState {
    if !matches!(link.freedom, Freedom::Flexible { .. }) {
        return ModalState::default();
    }
    let (coordinates, speeds) = (link.coordinates(), link.speeds());
    ModalState { q: q[coordinates].to_vec(), v: v[speeds.clone()].to_vec(), v_dot: v_dot[speeds].to_vec() }
}

impl<'a> Deriver<'a> {
    fn new(g: &'a Scope, mechanism: &'a Mechanism, linkage: &'a Linkage, keep: Option<&[bool]>) -> Self {
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
            contacts: Vec::new(),
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
                let position = self.inputs.lower(self.g, &drive.law);
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
        for (index, joint) in self.mechanism.joints.iter().enumerate() {
            if joint.clearance.is_some() {
                let part = |what: &str| {
                    ["x", "y", "z"].map(|axis| self.g.symbol(format!("{}_contact_{what}{axis}", joint.name)))
                };
                let (force, moment) = (part("f"), part("m"));
                self.contacts.push(ContactWrench { joint: JointId::new(index), force, moment });
            }
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

    fn gravity(&self) -> Vec3 {
        self.inputs.lower3(self.g, &self.mechanism.gravity)
    }

    fn masses(&self) -> Vec<LinkMass> {
        let g = self.g;
        g.begin_section("mass properties");
        // Modes are never driven: the symbols of all coordinates are those of the free ones.
        self.geometry().masses(g, &self.q_all)
    }

    /// Link motion, loads and closure rows for the given state and accelerations.
    fn instant(&self, q: &[ExprId], v: &[ExprId], v_dot: &[ExprId], exact: bool) -> Instant {
        let g = self.g;
        let geometry = self.geometry();
        g.begin_section("poses of the links, [CS (2)]");
        let mounts: Vec<Vec3> = (0..self.linkage.links.len()).map(|at| geometry.mount(g, at)).collect();
        let poses = Poses::new(g, self.linkage, &mounts, q);
        self.label_poses(&poses, q);
        g.begin_section("twists of the links, [CS (5)]");
        let twists = twists(g, self.linkage, &poses, v);
        g.begin_section("accelerations of the links");
        let gravity = self.gravity();
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
        let modes = self.linkage.links.iter().map(|link| modal_state(link, q, v, v_dot)).collect();
        let motion = Motion { poses, twists, accelerations, ground, modes };
        let state = JointStates { geometry: &geometry, motion: &motion, q, v, v_dot };
        let loads = loads(g, &state, &self.contacts);
        let cuts = cut_rows(g, &geometry, &motion, exact);
        Instant { motion, loads, cuts }
    }

    fn label_poses(&self, poses: &Poses, q: &[ExprId]) {
        let g = self.g;
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
        let masses = self.masses();
        let dynamic = self.instant(&q, &v, &v_dot_known, false);
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
            self.contacts(&q, &v, &dynamic),
        ];
        debug_assert!(list.iter().zip(Entry::ALL).all(|(function, entry)| function.name == entry.name()));
        list
    }
}
