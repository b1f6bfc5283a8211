//! Motions that ways to the forward dynamics ask for, and what is made of them: once, however many ways ask.
//! In: accelerations, axes. Out: [`Moving`]. Never knows how a way goes.
//!
//! What is made again has the nodes that are there. To walk through it once more is what most of a derivation would be.

use std::cell::{OnceCell, RefCell};
use std::hash::Hash;
use std::rc::Rc;

use rustc_hash::FxHashMap;

use crate::expr::{Expr, ExprId, Scope, Section};

use super::dynamics::{Asked, BodyFields, Inertial, bias_forces_by, fields_of};
use super::fields::Shapes;
use super::kinematics::Acceleration;
use super::link_mass::LinkMass;
use super::loads::Loads;
use super::motion::Motion;
use super::relative_motion::Sums;
use super::turned::Axes;

/// Motion with certain accelerations, and the fields of the bodies that are taken by them.
pub struct Moving<'g> {
    pub motion: Motion<'g>,
    pub fields: Rc<Vec<Option<BodyFields<'g>>>>,
    pub axes: Axes,
    /// Of the other links what was made of it.
    pub inertial: Inertial<'g>,
    /// What all speeds feel of it, once asked for.
    felt: OnceCell<Vec<Expr<'g>>>,
}

impl<'g> Moving<'g> {
    fn new(motion: Motion<'g>, fields: Rc<Vec<Option<BodyFields<'g>>>>, axes: Axes) -> Self {
        Self { motion, fields, axes, inertial: Inertial::default(), felt: OnceCell::new() }
    }

    /// What all speeds feel of it.
    pub fn felt(&self, masses: &[LinkMass<'g>], loads: &Loads<'g>) -> &[Expr<'g>] {
        let way = (&self.fields[..], self.axes, &self.inertial);
        self.felt.get_or_init(|| bias_forces_by(&self.motion, masses, loads, way))
    }

    /// With the fields of some links made otherwise.
    pub fn with_fields(self: Rc<Self>, others: Vec<(usize, BodyFields<'g>)>) -> Rc<Self> {
        if others.is_empty() {
            return self;
        }
        let mut fields = self.fields.to_vec();
        for (link, by) in others {
            fields[link] = Some(by);
        }
        let (motion, axes) = (self.motion.clone(), self.axes);
        Rc::new(Self::new(motion, Rc::new(fields), axes))
    }
}

/// By what it is made of: something, and the section that was open when it was done.
type Made<K, V> = RefCell<FxHashMap<K, (Section, V)>>;

/// Accelerations, or whatever else, by their nodes.
type Nodes = Box<[ExprId]>;

/// What was made for one state of one mechanism.
#[derive(Default)]
pub struct Known<'g> {
    accelerated: Made<Nodes, Rc<Motion<'g>>>,
    fields: Made<Nodes, Rc<Vec<Option<BodyFields<'g>>>>>,
    moving: Made<(Nodes, Axes, bool, Asked), Rc<Moving<'g>>>,
    masses: Made<(bool, bool), Rc<Vec<Vec<Expr<'g>>>>>,
    biases: Made<(Nodes, bool, Sums), Vec<Expr<'g>>>,
    changed: Made<Nodes, Vec<Acceleration<'g>>>,
    operations: Made<Nodes, usize>,
}

impl<'g> Known<'g> {
    /// `motion` with other accelerations (`v`: speeds) along the given axes; bodies with `shapes` by these, and the modal
    /// equations of some links asked.
    pub fn moving(
        &self,
        motion: &Motion<'g>,
        (v, rates): (&[Expr<'g>], &[Expr<'g>]),
        shapes: &[Option<Rc<Shapes<'g>>>],
        (axes, asked, of): (Axes, Asked, &[usize]),
    ) -> Rc<Moving<'g>> {
        let g = motion.poses.geometry.g;
        once(&self.moving, g, (ids(rates), axes, !shapes.is_empty(), asked), || {
            let accelerated =
                once(&self.accelerated, g, ids(rates), || Rc::new(motion.accelerated(v, rates)));
            let motion = accelerated.along(axes);
            let mut fields = match shapes {
                [] => Rc::default(),
                _ => once(&self.fields, g, ids(rates), || Rc::new(fields_of(&motion, shapes))),
            };
            if asked != Asked::Nothing {
                let mut by_modes = fields.to_vec();
                let bodies = by_modes.iter_mut().enumerate().filter(|(at, _)| of.contains(at));
                bodies.filter_map(|(_, body)| body.as_mut()).for_each(|body| body.asked = asked);
                fields = Rc::new(by_modes);
            }
            Rc::new(Moving::new(motion, fields, axes))
        })
    }

    /// What changes of the speeds' derivatives change of the accelerations of `motion`, made along the given axes.
    pub fn changed(&self, motion: &Motion<'g>, change: &[Expr<'g>], axes: Axes) -> Vec<Acceleration<'g>> {
        let g = motion.poses.geometry.g;
        let changes = once(&self.changed, g, ids(change), || motion.changed(change));
        motion.changed_along(changes, axes)
    }

    /// The mass matrix along the given axes, with local modes eliminated or not.
    pub fn mass(
        &self,
        g: &'g Scope,
        (eliminated, axes): (bool, Axes),
        make: impl FnOnce() -> Vec<Vec<Expr<'g>>>,
    ) -> Rc<Vec<Vec<Expr<'g>>>> {
        once(&self.masses, g, (eliminated, axes.forces_in_ground), || Rc::new(make()))
    }

    /// Acceleration residuals of rows that are made by `sums`, for accelerations of the free speeds.
    pub fn biases(
        &self,
        g: &'g Scope,
        (accelerations, axes, sums): (&[Expr<'g>], Axes, Sums),
        make: impl FnOnce() -> Vec<Expr<'g>>,
    ) -> Vec<Expr<'g>> {
        once(&self.biases, g, (ids(accelerations), axes.accelerations_in_ground, sums), make)
    }

    /// Operations that these need.
    pub fn operations(&self, g: &'g Scope, roots: &[Expr<'g>]) -> usize {
        once(&self.operations, g, ids(roots), || g.operations(roots.iter().copied()))
    }
}

fn ids(rates: &[Expr<'_>]) -> Nodes {
    rates.iter().map(|rate| rate.id()).collect()
}

/// What `make` makes, or has made. Either way nodes that come next belong to the section that it leaves open.
fn once<K: Eq + Hash, V: Clone>(made: &Made<K, V>, g: &Scope, key: K, make: impl FnOnce() -> V) -> V {
    if let Some((section, value)) = made.borrow().get(&key) {
        g.enter(*section);
        return value.clone();
    }
    let value = make();
    made.borrow_mut().insert(key, (g.section(), value.clone()));
    value
}
