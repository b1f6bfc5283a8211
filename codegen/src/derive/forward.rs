//! Forward dynamics, [CS (6)].
//! In: link motion, loads, closure rows, [`Plan`]. Out: accelerations, multipliers, drive forces.
//! Never knows entry points or columns.
//!
//! There are several ways to one solution, of which `shortest_way` chooses.

use std::rc::Rc;

use crate::expr::{Expr, Scope, Vec3};

use super::dynamics::{Asked, forces_besides, section_of};
use super::fields::Shapes;
use super::kept_rows::{KeptRow, Partition};
use super::link_mass::LinkMass;
use super::loads::Loads;
use super::local_modes::LocalModes;
use super::mass_matrix::mass_matrix;
use super::motion::Motion;
use super::moving::{Known, Moving};
use super::plan::Plan;
use super::relative_motion::{RelativeMotion, Sums};
use super::slid_drive::slid_drive;
use super::solve::{Order, Saddle, Solution, solve};
use super::turned::Axes;
use super::wrench::Wrench;

/// Accelerations of free speeds, multipliers of `rows`, and drive forces.
#[derive(Clone)]
pub struct Forward<'g> {
    pub solution: Solution<'g>,
    /// Generalised force of every driver.
    pub drive: Vec<Expr<'g>>,
    /// Whether all rows were taken with their biases of closed states.
    pub closed: bool,
    /// Whether a drive force comes from what slides of its bearing transmit.
    pub slid: bool,
}

/// Everything that forward dynamics is made of.
pub struct Problem<'a, 'g> {
    /// Motion with the accelerations of the driven speeds, and none of the free ones.
    pub motion: &'a Motion<'g>,
    /// All speeds.
    pub v: &'a [Expr<'g>],
    /// The accelerations that `motion` has.
    pub rates: &'a [Expr<'g>],
    pub masses: &'a [LinkMass<'g>],
    pub loads: &'a Loads<'g>,
    pub rows: &'a [KeptRow<'a, 'g>],
    /// How the rows of cuts were made, and which of all rows are kept.
    pub made: (Sums, &'a [bool]),
    pub partition: &'a Partition,
    /// What ways to it have made so far, and to the same with rows that are made in other ways.
    pub known: &'a Known<'g>,
}

/// A way to the solution.
#[derive(Clone, Copy)]
pub struct Way<'s, 'g> {
    /// What the rows fix comes from them, by a plan; nothing does else.
    pub rows_first: Option<&'s Plan>,
    /// Of a row, what known accelerations make of it comes from the motion that they make, else by the Jacobian.
    pub rows_moved: bool,
    /// What known multipliers do comes from the wrenches that they make on the links, else by the Jacobian.
    pub rows_push: bool,
    /// Bodies that are taken by the accelerations of their shape functions, by link; none if empty.
    pub shapes: &'s [Option<Rc<Shapes<'g>>>],
    /// Modes that are eliminated in their body.
    pub local: &'s [LocalModes],
    /// Their accelerations come from their equations once more, else from what the frame's acceleration adds.
    pub again: bool,
    /// What their equations tell.
    pub asked: Asked,
    /// Of what the equations of motion are left with.
    pub order: Order<'s>,
    /// Of accelerations and forces.
    pub axes: Axes,
    /// Drive forces come from what slides of their bearings transmit, where such are.
    pub slid: bool,
}

impl Way<'_, '_> {
    /// Whether it is the same way, where both have the shapes and local modes of one mechanism, or none.
    pub fn is(&self, other: &Self) -> bool {
        let key = |way: &Self| {
            let order = match way.order {
                Order::Leaves => 0,
                Order::Cheapest(_) => 1,
                Order::PairsFirst(_) => 2,
            };
            let plan = way.rows_first.map(std::ptr::from_ref);
            let of_rows = (plan, way.rows_moved, way.rows_push);
            let of_modes = (way.shapes.is_empty(), way.local.is_empty(), way.again, way.asked);
            (of_rows, of_modes, order, way.axes, way.slid)
        };
        key(self) == key(other)
    }
}

impl<'g> Problem<'_, 'g> {
    /// Loop Jacobian by the free speeds.
    pub fn jacobian(&self) -> Vec<Vec<Expr<'g>>> {
        self.rows.iter().map(|row| self.pick(&row.jacobian)).collect()
    }

    pub(super) fn pick(&self, row: &[Expr<'g>]) -> Vec<Expr<'g>> {
        self.partition.free.iter().map(|j| row[*j]).collect()
    }

    /// gamma: of closed states where something drives, else of any state.
    pub fn target(&self) -> Vec<Expr<'g>> {
        self.rows.iter().map(|kept| -kept.row.bias.of(self.is_driven())).collect()
    }

    /// What nothing drives passes singular positions.
    pub fn is_driven(&self) -> bool {
        !self.partition.driven.is_empty()
    }

    /// Motion with these accelerations of the free speeds.
    pub(super) fn moving(
        &self,
        accelerations: &[Expr<'g>],
        Way { shapes, axes, asked, local, .. }: Way<'_, 'g>,
    ) -> Rc<Moving<'g>> {
        let mut rates = self.rates.to_vec();
        for (speed, acceleration) in self.partition.free.iter().zip(accelerations) {
            rates[*speed] = *acceleration;
        }
        let of: Vec<usize> = local.iter().map(|body| body.link).collect();
        self.known.moving(self.motion, (self.v, &rates), shapes, (axes, asked, &of))
    }

    /// What all speeds feel at given accelerations.
    pub(super) fn felt<'m>(&self, moving: &'m Moving<'g>) -> &'m [Expr<'g>] {
        moving.felt(self.masses, self.loads)
    }

    /// What all speeds feel besides what the rows with these multipliers hold.
    pub(super) fn unheld(
        &self,
        moving: &Moving<'g>,
        multipliers: &[Expr<'g>],
        way: Way<'_, 'g>,
    ) -> Vec<Expr<'g>> {
        let poses = &self.motion.poses;
        let g = poses.geometry.g;
        let mut held = vec![Wrench::zero(g); self.masses.len()];
        let mut known: Vec<(&RelativeMotion<'g>, Vec3<'g>, Vec3<'g>)> = Vec::new();
        let mut by_jacobian = Vec::new();
        for (row, multiplier) in self.rows.iter().zip(multipliers) {
            let Some(between) = row.between.filter(|_| way.rows_push) else {
                by_jacobian.push((row, *multiplier));
                continue;
            };
            let (moment, force) = (*multiplier * row.row.moment, *multiplier * row.row.force);
            match known.iter_mut().find(|(other, ..)| std::ptr::eq(*other, between)) {
                Some((_, moments, forces)) => (*moments, *forces) = (*moments + moment, *forces + force),
                None => known.push((between, moment, force)),
            }
        }
        for (between, moment, force) in known {
            let turn = poses.world_of(g, between.beside()).rotation;
            let ends = between.link_wrenches(moment, force);
            for (marker, mut wrench) in [between.parent, between.child].into_iter().zip(ends) {
                let Some(at) = marker.link else { continue };
                if way.axes.forces_in_ground && marker.link != between.beside() {
                    let sign = if marker.link == between.parent.link { -1.0 } else { 1.0 };
                    let inwards = |vector: Vec3<'g>| sign * poses.world[at].inwards(turn * vector);
                    let force = inwards(force);
                    wrench = Wrench { moment: inwards(moment) + marker.point.cross(force), force };
                }
                held[at] += wrench;
            }
        }
        let felt = if way.rows_push {
            let fields = (&moving.fields[..], moving.axes, &moving.inertial);
            forces_besides(&moving.motion, self.masses, (self.loads, &held), fields)
        } else {
            self.felt(moving).to_vec()
        };
        if let Some(first) = poses.geometry.linkage.links.first() {
            g.begin_section(section_of(first));
        }
        // Of long chains nearly all entries are zero, and most multipliers not yet known.
        by_jacobian.retain(|(_, multiplier)| !multiplier.is_zero());
        let of_rows = |speed: usize| {
            let entries = by_jacobian.iter().map(|(row, multiplier)| (row.jacobian[speed], *multiplier));
            g.sum(entries.filter(|(entry, _)| !entry.is_zero()).map(|(entry, multiplier)| entry * multiplier))
        };
        felt.into_iter().enumerate().map(|(speed, felt)| felt - of_rows(speed)).collect()
    }

    /// The solution by one way.
    pub fn by(&self, way: Way<'_, 'g>) -> Forward<'g> {
        way.rows_first.map_or_else(|| self.saddle(way), |plan| self.rows_first(plan, way))
    }

    /// By the structured elimination of [`solve`] alone.
    fn saddle(&self, way: Way<'_, 'g>) -> Forward<'g> {
        let partition = self.partition;
        let g = self.motion.poses.geometry.g;
        let still = self.moving(&vec![g.zero(); partition.free.len()], way);
        let h = self.felt(&still);
        g.begin_section("mass matrix by composite bodies");
        let mass =
            self.known.mass(g, (false, way.axes), || mass_matrix(&self.motion.poses, self.masses, way.axes));
        let block: Vec<Vec<Expr<'g>>> = partition.free.iter().map(|i| self.pick(&mass[*i])).collect();
        let force: Vec<Expr<'g>> = partition.free.iter().map(|i| -h[*i]).collect();
        let (jacobian, target) = (self.jacobian(), self.target());
        let saddle = Saddle { mass: &block, jacobian: &jacobian, force: &force, target: &target };
        let solution = solve(g, &saddle, way.order);
        g.begin_section("drive forces");
        let moving = self.moving(&solution.accelerations, way);
        let mut slid = false;
        let drive = partition
            .driven
            .iter()
            .map(|d| {
                if let Some(drive) = self.slid_drive(&moving, way, *d) {
                    slid = true;
                    return drive;
                }
                let mut sum = h[*d];
                for (entry, acceleration) in self.pick(&mass[*d]).into_iter().zip(&solution.accelerations) {
                    sum += entry * *acceleration;
                }
                sum - self.of_loops(*d, &solution.multipliers)
            })
            .collect();
        Forward { solution, drive, closed: self.is_driven(), slid }
    }

    pub(super) fn slid_drive(
        &self,
        moving: &Moving<'g>,
        way: Way<'_, 'g>,
        driven: usize,
    ) -> Option<Expr<'g>> {
        let of = || slid_drive(&moving.motion, self.masses, self.loads, self.partition, driven);
        way.slid.then(of).flatten()
    }

    /// What a speed feels of the loops.
    fn of_loops(&self, speed: usize, multipliers: &[Expr<'g>]) -> Expr<'g> {
        let g = self.motion.poses.geometry.g;
        g.sum(self.rows.iter().zip(multipliers).map(|(row, multiplier)| row.jacobian[speed] * *multiplier))
    }
}

impl<'g> Forward<'g> {
    /// All that it consists of.
    pub fn all(&self) -> Vec<Expr<'g>> {
        let Solution { accelerations, multipliers, pivots } = &self.solution;
        [accelerations, multipliers, pivots, &self.drive].into_iter().flatten().copied().collect()
    }

    /// Operations of all that.
    pub fn operations(&self, g: &'g Scope) -> usize {
        g.operations(self.all())
    }
}
