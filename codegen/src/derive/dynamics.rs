//! Newton-Euler passes and energies, [CS (6)].
//! In: link motion, loads. Out: generalised forces, energies.
//! Never knows entry points or columns.
//!
//! Inertial wrench of a link with `spin = skew(alpha) + skew(omega)²` about its origin, from mass m, first
//! moment s and second moment P (the same form serves rigid and flexible links):
//!   force  = m a_O + spin s
//!   moment = s x a_O + axial(spin P),  axial(A)_x = A_zy - A_yz, and cyclic.

use std::cell::{OnceCell, RefCell};
use std::rc::Rc;

use rustc_hash::FxHashMap;

use crate::expr::{Expr, ExprId, Mat3, Vec3};

use super::fields::{Fields, Shapes};
use super::geometry::Geometry;
use super::kinematics::Acceleration;
use super::link_mass::LinkMass;
use super::linkage::{Freedom, Link};
use super::loads::Loads;
use super::mass_properties::MassProperties;
use super::modal_moments::ByModes;
use super::motion::Motion;
use super::turned::Axes;
use super::wrench::Wrench;

/// What modal equations are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Asked {
    Nothing,
    /// What modes feel besides stiffness: it is summed up first.
    Loads,
    /// What they know of the wrench, too: modes have the accelerations that they give.
    Moments,
}

/// A flexible body by the accelerations of its shape functions.
#[derive(Clone)]
pub struct BodyFields<'g> {
    pub shapes: Rc<Shapes<'g>>,
    pub fields: Fields<'g>,
    pub asked: Asked,
    /// Wrenches that were made, by the motion of the frame: many ways ask for few of them.
    wrenches: RefCell<Vec<(Frame<'g>, Wrench<'g>)>>,
    /// Inertial forces of the modes, likewise.
    forces: RefCell<Vec<(ModalFrame<'g>, Vec<Expr<'g>>)>>,
}

/// Acceleration of the origin of a frame, its spin, and what the modes know.
type Frame<'g> = (Vec3<'g>, Mat3<'g>, ByModes<'g>);

/// The same two of a frame, and the accelerations of the modes.
type ModalFrame<'g> = (Vec3<'g>, Mat3<'g>, Vec<ExprId>);

impl<'g> BodyFields<'g> {
    pub fn new(shapes: &Rc<Shapes<'g>>, fields: Fields<'g>) -> Self {
        let (wrenches, forces) = Default::default();
        Self { shapes: Rc::clone(shapes), fields, asked: Asked::Nothing, wrenches, forces }
    }

    /// Inertial force of every mode, at accelerations of the modes.
    fn modal_forces(&self, frame: &Acceleration<'g>, v_dot: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let is_same = |(origin, spin, of): &ModalFrame<'g>| {
            is_frame(frame, (*origin, spin)) && of.iter().copied().eq(v_dot.iter().map(|entry| entry.id()))
        };
        let made = self.forces.borrow().iter().find(|(of, _)| is_same(of)).map(|(_, forces)| forces.clone());
        made.unwrap_or_else(|| {
            let forces = self.shapes.forces(&self.fields, frame, v_dot);
            let of = v_dot.iter().map(|entry| entry.id()).collect();
            self.forces.borrow_mut().push(((frame.origin, frame.spin, of), forces.clone()));
            forces
        })
    }

    /// Inertial wrench about the origin of the floating frame.
    fn wrench(&self, frame: &Acceleration<'g>, known: &ByModes<'g>) -> Wrench<'g> {
        let nodes = |known: &ByModes<'g>| known.map(|known| known.map(|known| known.id()));
        let by_modes = nodes(known);
        let is_same =
            |(origin, spin, known): &Frame<'g>| is_frame(frame, (*origin, spin)) && nodes(known) == by_modes;
        let made = self.wrenches.borrow().iter().find(|(of, _)| is_same(of)).map(|(_, wrench)| *wrench);
        made.unwrap_or_else(|| {
            let wrench = self.shapes.wrench(&self.fields, frame, known);
            self.wrenches.borrow_mut().push(((frame.origin, frame.spin, *known), wrench));
            wrench
        })
    }
}

/// Whether a frame moves so.
fn is_frame<'g>(frame: &Acceleration<'g>, (origin, spin): (Vec3<'g>, &Mat3<'g>)) -> bool {
    origin.is(frame.origin) && (0..3).all(|row| spin[row].is(frame.spin[row]))
}

/// Shape functions of every flexible body that has such, by link; nothing if none has.
pub fn shapes_of<'g>(masses: &[LinkMass<'g>]) -> Vec<Option<Rc<Shapes<'g>>>> {
    let of_link = |mass: &LinkMass<'g>| {
        let modal = mass.modal.as_ref()?;
        Shapes::new(modal.data).map(Rc::new)
    };
    let shapes: Vec<_> = masses.iter().map(of_link).collect();
    if shapes.iter().all(Option::is_none) { Vec::new() } else { shapes }
}

/// Fields of the bodies with `shapes` in a motion, the same along all axes.
pub fn fields_of<'g>(motion: &Motion<'g>, shapes: &[Option<Rc<Shapes<'g>>>]) -> Vec<Option<BodyFields<'g>>> {
    let Geometry { g, linkage, .. } = motion.poses.geometry;
    let links = shapes.iter().zip(&linkage.links).enumerate();
    let fields = links.map(|(at, (shapes, link))| {
        let shapes = shapes.as_ref()?;
        g.begin_section(format!("accelerations in {}", link.name));
        let fields = shapes.fields(motion.accelerations[at].spin, motion.twists[at].omega, &motion.modes[at]);
        Some(BodyFields::new(shapes, fields))
    });
    fields.collect()
}

/// The [`bias_forces_by`] every way along these axes.
pub fn all_bias_forces<'g>(
    motion: &Motion<'g>,
    masses: &[LinkMass<'g>],
    loads: &Loads<'g>,
    axes: &[Axes],
) -> Vec<Vec<Expr<'g>>> {
    let shapes = shapes_of(masses);
    let mut kinds = vec![&[][..]];
    if !shapes.is_empty() {
        kinds.push(&shapes[..]);
    }
    let forces = kinds.into_iter().flat_map(|shapes| {
        let fields = OnceCell::new();
        axes.iter()
            .map(|axes| {
                let motion = motion.along(*axes);
                let fields = fields.get_or_init(|| fields_of(&motion, shapes));
                bias_forces_by(&motion, masses, loads, (fields, *axes, &Inertial::default()))
            })
            .collect::<Vec<_>>()
    });
    forces.collect()
}

/// Inertial wrenches of links that were made for one motion, by link.
#[derive(Default)]
pub struct Inertial<'g>(RefCell<FxHashMap<usize, Wrench<'g>>>);

impl<'g> Inertial<'g> {
    fn of(&self, link: usize, make: impl FnOnce() -> Wrench<'g>) -> Wrench<'g> {
        *self.0.borrow_mut().entry(link).or_insert_with(make)
    }
}

/// Inertial wrench of a link about its origin, in its frame.
pub fn inertial_wrench<'g>(motion: &Motion<'g>, masses: &[LinkMass<'g>], at: usize) -> Wrench<'g> {
    let rigid = rigid_wrench(&masses[at].rigid, &motion.accelerations[at]);
    match &masses[at].modal {
        Some(modal) => rigid + modal.wrench(&motion.twists[at], &motion.modes[at]),
        None => rigid,
    }
}

/// Inertial wrench of a link that keeps its present shape.
fn rigid_wrench<'g>(mass: &MassProperties<'g>, motion: &Acceleration<'g>) -> Wrench<'g> {
    let (moved, turned) = (mass.mass * motion.origin, motion.spin * mass.first);
    let product = motion.spin * mass.second;
    let moment = mass.first.cross(motion.origin) + product.axial();
    Wrench { moment, force: moved + turned }
}

/// Whether a link's origin stays where it is on its parent link.
fn keeps_place(link: &Link) -> bool {
    match link.freedom {
        Freedom::Ball | Freedom::Weld => true,
        Freedom::Flexible { .. } => link.node.as_ref().is_none_or(|node| !node.moves()),
        Freedom::Rotation { advance, .. } => advance == 0.0,
        _ => false,
    }
}

/// The screw of a joint on the ground with one freedom.
fn screw_on_ground(link: &Link) -> Option<[[f64; 3]; 2]> {
    link.freedom.screw().filter(|_| link.parent.is_none())
}

/// Inertial force of a rigid link, weight included, less one in its frame, along the axes of W.
pub fn rigid_force_in_ground<'g>(
    motion: &Motion<'g>,
    masses: &[LinkMass<'g>],
    at: usize,
    less: Vec3<'g>,
) -> Vec3<'g> {
    let MassProperties { mass, first, .. } = masses[at].rigid;
    let frame = &motion.accelerations[at];
    let [ground, own] = frame.turned.parts();
    let own = mass * own + frame.spin * first - less;
    mass * (ground + motion.ground) + motion.poses.world[at].rotation * own
}

/// Of the forces of a link.
pub fn section_of(link: &Link) -> String {
    format!("inertia, weight and loads of {}", link.name)
}

/// h: what every speed feels of inertia (for the accelerations that `motion` was built with), weight
/// and loads. Left side of [CS (6)]. Links that have `fields` are taken by these in the place of their mass
/// properties, and forces are passed inwards along the given axes.
pub fn bias_forces_by<'g>(
    motion: &Motion<'g>,
    masses: &[LinkMass<'g>],
    loads: &Loads<'g>,
    way: (&[Option<BodyFields<'g>>], Axes, &Inertial<'g>),
) -> Vec<Expr<'g>> {
    forces_besides(motion, masses, (loads, &[]), way)
}

/// The same less what the wrenches of `rows` on each link, in its frame about its origin, leave over.
pub fn forces_besides<'g>(
    motion: &Motion<'g>,
    masses: &[LinkMass<'g>],
    (loads, rows): (&Loads<'g>, &[Wrench<'g>]),
    (fields, axes, made): (&[Option<BodyFields<'g>>], Axes, &Inertial<'g>),
) -> Vec<Expr<'g>> {
    let Geometry { g, linkage, .. } = motion.poses.geometry;
    let poses = &motion.poses;
    let mut forces = vec![g.zero(); linkage.speeds()];
    let mut joint = loads.joint.clone();
    let mut carried = vec![Wrench::zero(g); linkage.links.len()];
    // Force of a link and all outboard of it, along the axes of W.
    let mut in_ground = vec![g.zero_vector(); linkage.links.len()];
    // What of it moves with the joint of a link outboard, along the link's own axes; mass that moves with the link's origin.
    let (mut borne, mut at_origin) = (in_ground.clone(), vec![g.zero(); linkage.links.len()]);
    for (at, link) in linkage.links.iter().enumerate().rev() {
        g.begin_section(section_of(link));
        let (frame, modes) = (&motion.accelerations[at], &motion.modes[at]);
        let by_fields = fields.get(at).and_then(Option::as_ref);
        let known = match by_fields {
            Some(body) if body.asked == Asked::Moments => {
                // Nothing else moves with modes that are solved for in their body.
                let besides: Vec<Expr<'g>> =
                    link.speeds().map(|speed| loads.unstretched[speed] - forces[speed]).collect();
                body.shapes.by_modes(frame, modes, &besides)
            }
            _ => ByModes::default(),
        };
        let inertial = match by_fields {
            Some(body) => body.wrench(frame, &known),
            None => made.of(at, || inertial_wrench(motion, masses, at)),
        };
        let applied = loads.external[at] + loads.reactions[at];
        let held = rows.get(at).copied().unwrap_or_else(|| Wrench::zero(g));
        let mut total = inertial + -applied + -held + carried[at];
        let movable = keeps_place(link) && (by_fields.is_some() || masses[at].modal.is_none());
        let inboard = axes.masses_inboard && link.parent.is_some() && movable;
        // Inertial force where the joint stands still.
        let force_about_joint = || match by_fields {
            Some(body) => {
                let still = Acceleration { origin: g.zero_vector(), ..*frame };
                body.wrench(&still, &known).force
            }
            None => frame.spin * masses[at].rigid.first,
        };
        if axes.forces_in_ground {
            let turn = poses.world[at].rotation;
            let mut less = held.force - borne[at];
            if !inboard {
                less -= at_origin[at] * frame.origin;
            }
            let own = match (by_fields, &masses[at].modal) {
                _ if inboard => turn * (force_about_joint() - less),
                (None, None) => rigid_force_in_ground(motion, masses, at, less),
                _ => turn * (inertial.force - less),
            };
            let sum = in_ground[at] + (own - turn * applied.force);
            in_ground[at] = sum;
            total.force = turn.transpose() * sum;
        }
        let mut felt = total.generalised(link.freedom, poses.nodes[at].as_ref());
        if let Some(modal) = &masses[at].modal {
            let deforming = match by_fields {
                Some(body) => body.modal_forces(frame, &modes.v_dot),
                None => modal.modal_forces(&motion.twists[at], frame, modes),
            };
            felt = felt.into_iter().zip(deforming).map(|(held, deforming)| deforming + held).collect();
        }
        let apart = by_fields.is_some_and(|body| body.asked != Asked::Nothing);
        for (speed, force) in link.speeds().zip(felt) {
            forces[speed] += force;
            if apart {
                joint[speed] = loads.unstretched[speed] - loads.elastic[speed];
            }
        }
        if let Some(parent) = link.parent {
            let pose = &poses.relative[at];
            if axes.forces_in_ground && link.freedom != Freedom::Free {
                in_ground[parent] = in_ground[parent] + in_ground[at];
                let moment = if link.freedom == Freedom::Ball { g.zero_vector() } else { total.moment };
                let force = poses.world[parent].inwards(in_ground[at]);
                let mut moment = pose.rotation * moment + pose.offset.cross(force);
                let mass = masses[at].rigid.mass + at_origin[at];
                if inboard && pose.offset.into_iter().all(|x| x.is_zero()) {
                    at_origin[parent] += mass;
                } else if inboard {
                    let moved = mass * motion.accelerations[parent].at(pose.offset);
                    moment += pose.offset.cross(moved);
                    borne[parent] += moved;
                }
                carried[parent] += Wrench { moment, force: g.zero_vector() };
            } else if let Some(screw) =
                screw_on_ground(&linkage.links[parent]).filter(|_| axes.screws_outboard)
            {
                if movable {
                    // Mass at the joint moves with the parent link, along whose axes its power mostly vanishes.
                    let force = masses[at].rigid.mass * motion.accelerations[parent].at(pose.offset);
                    carried[parent] += Wrench { moment: pose.offset.cross(force), force };
                    total.force = force_about_joint() + -applied.force + -held.force + carried[at].force;
                }
                let screw = screw.map(|axis| g.vector(axis));
                forces[linkage.links[parent].first_speed] += total.felt_inboard(link.freedom, pose, screw);
            } else {
                carried[parent] += total.passed_inwards(link.freedom, pose);
            }
        }
    }
    forces.into_iter().zip(joint).map(|(force, joint)| force - joint).collect()
}

/// Wrench that each link's inboard joint transmits to it (drive and joint forces included), about the
/// link's origin, in its frame. `external` is everything but joints of the tree.
pub fn joint_wrenches<'g>(
    motion: &Motion<'g>,
    masses: &[LinkMass<'g>],
    external: &[Wrench<'g>],
) -> Vec<Wrench<'g>> {
    let Geometry { g, linkage, .. } = motion.poses.geometry;
    let mut totals = vec![Wrench::zero(g); linkage.links.len()];
    for (at, link) in linkage.links.iter().enumerate().rev() {
        totals[at] += inertial_wrench(motion, masses, at) + -external[at];
        if let (Some(parent), false) = (link.parent, link.freedom == Freedom::Free) {
            let passed = totals[at].on_parent(&motion.poses.relative[at]);
            totals[parent] += passed;
        }
    }
    totals
}

/// Kinetic energy [J].
pub fn kinetic_energy<'g>(masses: &[LinkMass<'g>], motion: &Motion<'g>) -> Expr<'g> {
    let g = motion.poses.geometry.g;
    let half = g.number(0.5);
    let mut sum = g.zero();
    for (at, (mass, twist)) in masses.iter().zip(&motion.twists).enumerate() {
        let MassProperties { mass: m, first, .. } = mass.rigid;
        let (omega, v) = (twist.omega, twist.origin);
        let translation = m * v.dot(v);
        let mixed = 2.0 * v.dot(omega.cross(first));
        let rotation = omega.dot(mass.rigid.inertia() * omega);
        for term in [translation, mixed, rotation] {
            sum += term;
        }
        if let Some(modal) = &mass.modal {
            sum += modal.double_energy(twist, &motion.modes[at].v);
        }
    }
    half * sum
}

/// Potential energy of weight [J], zero at the origin of W.
pub fn weight_energy<'g>(motion: &Motion<'g>, masses: &[LinkMass<'g>], gravity: Vec3<'g>) -> Expr<'g> {
    let none = motion.poses.geometry.g.zero();
    masses.iter().zip(&motion.poses.world).fold(none, |sum, (LinkMass { rigid, .. }, pose)| {
        sum - gravity.dot(rigid.mass * pose.offset + pose.rotation * rigid.first)
    })
}
