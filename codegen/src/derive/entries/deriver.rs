//! The symbols of one mechanism, and its motion, loads and closure rows at an instant.
//! In: [`Geometry`], which constraint rows to keep. Out: [`Instant`]s. Never knows what entry points return.

use std::rc::Rc;

use crate::expr::{Expr, Scope, Section, Vec3};
use crate::id::{JointId, ParameterId};
use crate::model::Mechanism;
use crate::sparse_rows::SparseRows;

use super::names::{INPUT_RATES, variable_names};
use super::own_states::{OwnState, own_states};
use crate::derive::accelerations::accelerations;
use crate::derive::closure::{CutRows, cut_rows, row_count};
use crate::derive::contact_wrench::ContactWrench;
use crate::derive::couplings::{CouplingRow, coupling_rows};
use crate::derive::elements::loads;
use crate::derive::formula_to_expr::Inputs;
use crate::derive::geometry::Geometry;
use crate::derive::joint_state::JointStates;
use crate::derive::kept_rows::Partition;
use crate::derive::kinematics::{Poses, Twist, twists};
use crate::derive::link_mass::{LinkMass, link_masses};
use crate::derive::linkage::{Freedom, Link};
use crate::derive::loads::Loads;
use crate::derive::motion::{ModalState, Motion};
use crate::derive::plan::Guide;
use crate::derive::relative_motion::Sums;
use crate::derive::responses::Responses;

/// Symbols that every entry point takes besides the time: of tunable parameters, and of inputs with the rates that
/// drives need.
pub struct Given<'g> {
    pub tunable: Vec<Expr<'g>>,
    pub inputs: Vec<Expr<'g>>,
}

/// Symbols of tunable parameters, inputs and time, numbers for the other parameters; and what is given from outside.
pub fn inputs<'g>(g: &'g Scope, mechanism: &Mechanism) -> (Inputs<'g>, Given<'g>) {
    let mut given = Given { tunable: Vec::new(), inputs: Vec::new() };
    let (mut parameters, mut rates) = (Vec::new(), Vec::new());
    for (at, parameter) in mechanism.parameters.iter().enumerate() {
        let symbol = |suffix: &str| g.symbol(parameter.name.clone() + suffix);
        if parameter.input {
            let input = symbol("");
            given.inputs.push(input);
            if mechanism.drives_follow(ParameterId::new(at)) {
                let [first, second] = INPUT_RATES.map(|suffix| symbol(&suffix.replace('.', "_")));
                given.inputs.extend([first, second]);
                rates.push([input, first, second]);
            }
            parameters.push(input);
        } else if parameter.tunable {
            given.tunable.push(symbol(""));
            parameters.push(given.tunable[given.tunable.len() - 1]);
        } else {
            parameters.push(g.number(parameter.value));
        }
    }
    (Inputs { parameters, rates, time: g.symbol("t") }, given)
}

/// A prescribed coordinate with its place and its law.
pub struct Driver<'g> {
    pub joint: JointId,
    /// Its number among the joint's coordinates.
    pub joint_coordinate: usize,
    pub coordinate: usize,
    pub speed: usize,
    /// Position, speed, acceleration over parameters and t.
    pub law: [Expr<'g>; 3],
}

/// A mechanism with the symbols of its equations.
pub struct Deriver<'g> {
    pub geometry: Geometry<'g>,
    /// Symbols of tunable parameters and inputs.
    pub given: Given<'g>,
    pub drivers: Vec<Driver<'g>>,
    /// Symbols of all coordinates, driven ones included.
    pub q_all: Vec<Expr<'g>>,
    /// Symbols of all speeds, driven ones included.
    pub v_all: Vec<Expr<'g>>,
    /// Free coordinates, by index among all.
    pub free_q: Vec<usize>,
    pub partition: Partition,
    /// Symbols of the accelerations of the free speeds.
    pub v_dot: Vec<Expr<'g>>,
    /// Symbols of the multipliers of all rows.
    pub lambda: Vec<Expr<'g>>,
    pub drive: Vec<Expr<'g>>,
    /// Symbols of the wrenches that contact laws hand in.
    pub contacts: Vec<ContactWrench<'g>>,
    pub keep: Vec<bool>,
    /// Of the kept rows by the free speeds, at closed positions.
    pub jacobians: Vec<SparseRows>,
    /// See [`Guide::link_by_link`].
    pub link_by_link: bool,
    /// See [`Guide::whole_equations`].
    pub whole_equations: bool,
    /// States of the file's own; none where positions alone are asked for.
    pub own: Vec<OwnState<'g>>,
    /// Whether the shortest of several ways to the same values is asked for.
    pub compares: bool,
    /// What forces ask of the solution of the instant.
    pub responses: Rc<Responses<'g>>,
}

/// Link motion with what depends on it.
pub struct Instant<'g> {
    pub state: JointStates<'g>,
    pub loads: Loads<'g>,
    pub cuts: Vec<CutRows<'g>>,
    pub couplings: Vec<CouplingRow<'g>>,
    /// Rates of the file's own states.
    pub own_rates: Vec<Expr<'g>>,
    /// Laws of the forces that ask for the solution.
    pub laws: Vec<Expr<'g>>,
    /// The section that was open when all of it was there.
    pub section: Section,
}

impl<'g> Instant<'g> {
    /// What `by` makes of the rows of the `cuts`, with its operations if it is to count them: of those whose terms are summed
    /// up along the axes of the links, or of W where that is shorter. `compare`: whether the second way is tried at all.
    pub fn by_shorter_rows<T>(
        &self,
        cuts: &[CutRows<'g>],
        exact_or_apart: (bool, bool),
        compare: bool,
        by: impl Fn(&[CutRows<'g>], bool) -> (usize, T),
    ) -> T {
        let mut shortest = by(cuts, compare && self.has_other_rows());
        for (_, cuts) in self.other_rows(exact_or_apart, compare) {
            let next = by(&cuts, true);
            if next.0 < shortest.0 {
                shortest = next;
            }
        }
        shortest.1
    }

    /// The rows of the cuts, exact or not, in the other ways to sum up what they are made of; none unless `compare`. What a
    /// branch has `apart`, forces want, and a closure has none.
    pub fn other_rows(
        &self,
        (exact, apart): (bool, bool),
        compare: bool,
    ) -> impl Iterator<Item = (Sums, Vec<CutRows<'g>>)> + '_ {
        let ways = match (compare, apart) {
            (false, _) => &[][..],
            (true, false) => &[Sums::Ground],
            (true, true) => &[Sums::Ground, Sums::Apart],
        };
        ways.iter().filter_map(move |sums| Some((*sums, self.cuts_by(exact, *sums)?)))
    }

    /// The rows of the cuts with what they are made of summed up along other axes; nothing if that makes no difference.
    fn cuts_by(&self, exact: bool, sums: Sums) -> Option<Vec<CutRows<'g>>> {
        self.has_other_rows().then(|| cut_rows(&self.state.motion, exact, sums))
    }

    fn has_other_rows(&self) -> bool {
        let linkage = self.state.geometry.linkage;
        linkage.cuts.iter().any(|cut| !(cut.plane && linkage.rows_in_ground))
    }
}

fn modal_state<'g>(link: &Link, q: &[Expr<'g>], v: &[Expr<'g>], v_dot: &[Expr<'g>]) -> ModalState<'g> {
    if !matches!(link.freedom, Freedom::Flexible { .. }) {
        return ModalState::default();
    }
    let (coordinates, speeds) = (link.coordinates(), link.speeds());
    ModalState { q: q[coordinates].to_vec(), v: v[speeds.clone()].to_vec(), v_dot: v_dot[speeds].to_vec() }
}

/// The driven coordinates with their laws.
fn drivers<'g>(geometry: &Geometry<'g>) -> Vec<Driver<'g>> {
    let mut drivers = Vec::new();
    for (index, joint) in geometry.mechanism.joints.iter().enumerate() {
        let id = JointId::new(index);
        for drive in &joint.drives {
            let Some(link) = geometry.linkage.link_of_coordinate(id, drive.coordinate) else { continue };
            let link = &geometry.linkage.links[link];
            let position = geometry.inputs.lower(&drive.law);
            let speed = geometry.inputs.rate(position);
            let acceleration = geometry.inputs.rate(speed);
            drivers.push(Driver {
                joint: id,
                joint_coordinate: drive.coordinate,
                coordinate: link.first_coordinate,
                speed: link.first_speed,
                law: [position, speed, acceleration],
            });
        }
    }
    drivers
}

impl<'g> Deriver<'g> {
    /// Makes the symbols; without a guide all constraint rows are kept.
    /// `with_own`: with the states of the file's own, which else keep their start values, and by the shortest of several ways.
    pub fn new(geometry: Geometry<'g>, given: Given<'g>, guide: Option<&Guide>, with_own: bool) -> Self {
        let Geometry { g, mechanism, linkage, .. } = geometry;
        let rows = linkage.cuts.iter().map(|cut| row_count(&mechanism.joint(cut.joint).model, cut.closure));
        let keep = guide.map_or_else(
            || vec![true; rows.sum::<usize>() + mechanism.rigid_couplings().count()],
            |guide| guide.keep.clone(),
        );
        let drivers = drivers(&geometry);
        let names = variable_names(mechanism, linkage);
        let symbol = |name: &str, suffix: &str| g.symbol(name.replace('.', "_") + suffix);
        let q_all: Vec<Expr<'g>> = names.0.iter().map(|(name, _)| symbol(name, "")).collect();
        let v_all: Vec<Expr<'g>> = names.1.iter().map(|(name, _)| symbol(name, "")).collect();
        let driven: Vec<usize> = drivers.iter().map(|driver| driver.speed).collect();
        let free = (0..v_all.len()).filter(|index| !driven.contains(index)).collect();
        let partition = Partition { free, driven };
        let kept: Vec<usize> = (0..keep.len()).filter(|row| keep[*row]).collect();
        let numbers = guide.map_or(&[][..], |guide| &guide.jacobians);
        let jacobians = numbers.iter().map(|all| all.select_rows(&kept).select_columns(&partition.free));
        let jacobians = jacobians.collect();
        let v_dot = partition.free.iter().map(|index| symbol(&names.1[*index].0, "_dot")).collect();
        let (mut kept, mut spare) = (0, 0);
        let lambda = keep
            .iter()
            .map(|keep| {
                let (name, count) = if *keep { ("lambda", &mut kept) } else { ("spare_lambda", &mut spare) };
                *count += 1;
                g.symbol(format!("{name}{count}"))
            })
            .collect();
        let drive = drivers
            .iter()
            .map(|driver| g.symbol(format!("{}_drive", mechanism.joint(driver.joint).name)))
            .collect();
        let with_clearance =
            mechanism.joints.iter().enumerate().filter(|(_, joint)| joint.clearance.is_some());
        let contacts = with_clearance
            .flat_map(|(index, joint)| {
                let places = joint.contact_places();
                let count = places.len();
                places.into_iter().enumerate().map(move |(at, place)| {
                    let number = if count > 1 { (at + 1).to_string() } else { String::new() };
                    let symbol = |what: &str, axis: &str| {
                        g.symbol(format!("{}_contact{number}_{what}{axis}", joint.name))
                    };
                    let part = |what: &str| Vec3(["x", "y", "z"].map(|axis| symbol(what, axis)));
                    let (force, moment) = (part("f"), part("m"));
                    ContactWrench { joint: JointId::new(index), along: place.along, force, moment }
                })
            })
            .collect();
        Self {
            geometry,
            given,
            free_q: (0..q_all.len())
                .filter(|index| drivers.iter().all(|driver| driver.coordinate != *index))
                .collect(),
            drivers,
            q_all,
            v_all,
            partition,
            v_dot,
            lambda,
            drive,
            contacts,
            keep,
            jacobians,
            link_by_link: guide.is_some_and(|guide| guide.link_by_link),
            whole_equations: guide.is_some_and(|guide| guide.whole_equations),
            own: if with_own { own_states(g, mechanism) } else { Vec::new() },
            compares: with_own,
            responses: Rc::default(),
        }
    }

    /// Coordinates, speeds and accelerations with the drivers' laws inserted; `v_dot` of the free speeds.
    pub fn driven_state(&self, v_dot: &[Expr<'g>]) -> [Vec<Expr<'g>>; 3] {
        let (mut q, mut v) = (self.q_all.clone(), self.v_all.clone());
        let mut rates = vec![self.geometry.g.zero(); v.len()];
        for (speed, rate) in self.partition.free.iter().zip(v_dot) {
            rates[*speed] = *rate;
        }
        for driver in &self.drivers {
            [q[driver.coordinate], v[driver.speed], rates[driver.speed]] = driver.law;
        }
        [q, v, rates]
    }

    /// Acceleration of gravity in W [m/s²].
    pub fn gravity(&self) -> Vec3<'g> {
        self.geometry.inputs.lower3(&self.geometry.mechanism.gravity)
    }

    pub fn masses(&self) -> Vec<LinkMass<'g>> {
        self.geometry.g.begin_section("mass properties");
        // Modes are never driven: the symbols of all coordinates are those of the free ones.
        link_masses(&self.geometry, &self.q_all)
    }

    /// Link motion, loads and closure rows for the given coordinates, speeds and accelerations.
    pub fn instant(&self, [q, v, v_dot]: [Vec<Expr<'g>>; 3]) -> Instant<'g> {
        let geometry = self.geometry;
        let g = geometry.g;
        g.begin_section("poses of the links, [CS (2)]");
        let poses = Poses::new(geometry, &q);
        self.label_poses(&poses, &q);
        g.begin_section("twists of the links, [CS (5)]");
        let twists = twists(&poses, &v);
        self.moved((poses, twists), [q, v, v_dot])
    }

    /// The same with other accelerations of the free speeds: positions and speeds are made once.
    pub fn accelerated(&self, instant: &Instant<'g>, free: &[Expr<'g>]) -> Instant<'g> {
        let Motion { poses, twists, .. } = &instant.state.motion;
        self.moved((poses.clone(), twists.clone()), self.driven_state(free))
    }

    fn moved(
        &self,
        (poses, twists): (Poses<'g>, Vec<Twist<'g>>),
        [q, v, v_dot]: [Vec<Expr<'g>>; 3],
    ) -> Instant<'g> {
        let geometry = self.geometry;
        let Geometry { g, linkage, .. } = geometry;
        g.begin_section("accelerations of the links");
        let ground = -self.gravity();
        let accelerations = accelerations(&poses, &twists, (&v, &v_dot), ground);
        for (link, (twist, acceleration)) in linkage.links.iter().zip(twists.iter().zip(&accelerations)) {
            for (axis, i) in ["x", "y", "z"].iter().zip(0..3) {
                twist.omega[i].label(format!("{}_w{axis}", link.name));
                twist.origin[i].label(format!("{}_v{axis}", link.name));
                acceleration.origin[i].label(format!("{}_a{axis}", link.name));
                acceleration.alpha[i].label(format!("{}_alpha_{axis}", link.name));
            }
        }
        let modes = linkage.links.iter().map(|link| modal_state(link, &q, &v, &v_dot)).collect();
        let motion = Motion { poses, twists, accelerations, ground, modes };
        let own = if self.own.is_empty() { self.starts_of_states() } else { self.own_values().collect() };
        let responses = Rc::clone(&self.responses);
        let state = JointStates { geometry, motion, q, v, v_dot, own, responses, points_in_ground: true };
        let loads = loads(g, &state, &self.contacts);
        let cuts = cut_rows(&state.motion, false, Sums::Links);
        let couplings = coupling_rows(g, &state);
        let laws = self.responses.take_laws();
        let rates = geometry.mechanism.states.iter().take(self.own.len());
        let own_rates = rates
            .map(|own| {
                g.begin_section(format!("rate of {}", own.name));
                state.lower(g, &own.rate)
            })
            .collect();
        Instant { state, loads, cuts, couplings, own_rates, laws, section: g.section() }
    }

    pub(super) fn own_integrals(&self) -> impl Iterator<Item = Expr<'g>> {
        self.own.iter().map(|own| own.integral)
    }

    pub(super) fn own_values(&self) -> impl Iterator<Item = Expr<'g>> {
        self.own.iter().map(|own| own.value)
    }

    pub(super) fn own_rates(&self) -> impl Iterator<Item = Expr<'g>> {
        self.own.iter().map(|own| own.rate)
    }

    /// Start values of all states that the file has.
    pub(super) fn starts_of_states(&self) -> Vec<Expr<'g>> {
        let states = self.geometry.mechanism.states.iter();
        states.map(|state| self.geometry.inputs.lower(&state.initial)).collect()
    }

    fn label_poses(&self, poses: &Poses<'g>, q: &[Expr<'g>]) {
        let Geometry { mechanism, linkage, .. } = self.geometry;
        for (at, link) in linkage.links.iter().enumerate() {
            if let Freedom::Rotation { offset, .. } = link.freedom {
                let joint = &mechanism.joint(link.joint).name;
                let angle = q[link.first_coordinate] + offset;
                angle.sin().label(format!("sin_{joint}"));
                angle.cos().label(format!("cos_{joint}"));
            }
            for (axis, component) in ["x", "y", "z"].iter().zip(poses.world[at].offset) {
                component.label(format!("{}_{axis}", link.name));
            }
        }
    }
}
