//! Forward dynamics, [CS (6)].
//! In: link motion, loads, closure rows, [`Plan`]. Out: accelerations, multipliers, drive forces.
//! Never knows entry points or columns.
//!
//! There are several ways to one solution, of which `shortest_way` chooses.

use std::rc::Rc;

use crate::expr::{Expr, Scope, Vec3};

use super::dynamics::{BodyFields, forces_besides, section_of};
use super::fields::Shapes;
use super::kept_rows::{KeptRow, Partition, closed_biases};
use super::link_mass::LinkMass;
use super::loads::Loads;
use super::local_modes::LocalModes;
use super::mass_matrix::{Eliminated, mass_matrix, reduced_mass_matrix};
use super::motion::Motion;
use super::moving::{Known, Moving};
use super::plan::{Plan, PlanBlock};
use super::relative_motion::{RelativeMotion, Sums};
use super::rows::Block;
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
            (of_rows, way.shapes.is_empty(), way.local.is_empty(), way.again, order, way.axes, way.slid)
        };
        key(self) == key(other)
    }
}

impl<'g> Problem<'_, 'g> {
    /// Loop Jacobian by the free speeds.
    pub fn jacobian(&self) -> Vec<Vec<Expr<'g>>> {
        self.rows.iter().map(|row| self.pick(&row.jacobian)).collect()
    }

    fn pick(&self, row: &[Expr<'g>]) -> Vec<Expr<'g>> {
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
    fn moving(&self, accelerations: &[Expr<'g>], Way { shapes, axes, .. }: Way<'_, 'g>) -> Rc<Moving<'g>> {
        let mut rates = self.rates.to_vec();
        for (speed, acceleration) in self.partition.free.iter().zip(accelerations) {
            rates[*speed] = *acceleration;
        }
        self.known.moving(self.motion, (self.v, &rates), shapes, axes)
    }

    /// What all speeds feel at given accelerations.
    fn felt<'m>(&self, moving: &'m Moving<'g>) -> &'m [Expr<'g>] {
        moving.felt(self.masses, self.loads)
    }

    /// What all speeds feel besides what the rows with these multipliers hold.
    fn unheld(&self, moving: &Moving<'g>, multipliers: &[Expr<'g>], way: Way<'_, 'g>) -> Vec<Expr<'g>> {
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
            let fields = (&moving.fields[..], moving.axes);
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

    fn slid_drive(&self, moving: &Moving<'g>, way: Way<'_, 'g>, driven: usize) -> Option<Expr<'g>> {
        let of = || slid_drive(&moving.motion, self.masses, self.loads, self.partition, driven);
        way.slid.then(of).flatten()
    }

    /// What a speed feels of the loops.
    fn of_loops(&self, speed: usize, multipliers: &[Expr<'g>]) -> Expr<'g> {
        let g = self.motion.poses.geometry.g;
        g.sum(self.rows.iter().zip(multipliers).map(|(row, multiplier)| row.jacobian[speed] * *multiplier))
    }

    /// Rows first, by a plan: the blocks from the rows, the rest by [`solve`], then multipliers and drives from
    /// inverse dynamics with all accelerations known.
    fn rows_first(&self, plan: &Plan, way: Way<'_, 'g>) -> Forward<'g> {
        let g = self.motion.poses.geometry.g;
        let (jacobian, mut target) = (self.jacobian(), self.target());
        for row in plan.blocks.iter().flat_map(|block| &block.rows) {
            target[*row] = -self.rows[*row].row.bias.closed;
        }
        g.begin_section("accelerations that the loops fix");
        let blocks: Vec<Block<'_, 'g>> =
            plan.blocks.iter().map(|block| Block::new(g, block, &jacobian)).collect();
        let zero = g.zero();
        let mut accelerations = vec![zero; self.partition.free.len()];
        let right = |accelerations: &[Expr<'g>], moved: &[Expr<'g>], row: usize| {
            if let Some(bias) = moved.get(row) {
                return -*bias;
            }
            let known = jacobian[row].iter().zip(accelerations);
            known.fold(target[row], |sum, (entry, acceleration)| sum - *entry * *acceleration)
        };
        for block in &blocks {
            let moved = self.moved_biases(&accelerations, way);
            let rights: Vec<Expr<'g>> =
                block.plan.rows.iter().map(|row| right(&accelerations, &moved, *row)).collect();
            for (speed, acceleration) in block.plan.speeds.iter().zip(block.solve(&rights)) {
                accelerations[*speed] = acceleration;
            }
        }
        let (mut multipliers, mut pivots) = (vec![zero; self.rows.len()], vec![zero; self.rows.len()]);
        let mut last = None;
        if !plan.rest.speeds.is_empty() {
            let moved = self.moved_biases(&accelerations, way);
            let rights: Vec<Expr<'g>> =
                plan.rest.rows.iter().map(|row| right(&accelerations, &moved, *row)).collect();
            let moving = self.with_local_modes(&mut accelerations, way);
            let before = accelerations.clone();
            let rest = self.rest(&plan.rest, &moving, way, &jacobian, &rights);
            for (speed, acceleration) in rest.speeds.iter().zip(&rest.solution.accelerations) {
                accelerations[*speed] = *acceleration;
            }
            let rows = plan.rest.rows.iter().zip(rest.solution.multipliers).zip(rest.solution.pivots);
            for ((row, multiplier), pivot) in rows {
                (multipliers[*row], pivots[*row]) = (multiplier, pivot);
            }
            if way.again {
                self.with_local_modes(&mut accelerations, way);
            } else {
                last = Some(self.followed(&mut accelerations, &before, &moving, way));
            }
        }
        // J^T lambda carries what inertia and loads leave over.
        let moving = last.unwrap_or_else(|| self.moving(&accelerations, way));
        for block in blocks.iter().rev() {
            let felt = self.unheld(&moving, &multipliers, way);
            g.begin_section("multipliers");
            let rights: Vec<Expr<'g>> =
                block.plan.speeds.iter().map(|speed| felt[self.partition.free[*speed]]).collect();
            let of_rows = block.pivots();
            let solved = block.solve_transposed(&rights).into_iter().zip(of_rows);
            for (row, (multiplier, pivot)) in block.plan.rows.iter().zip(solved) {
                (multipliers[*row], pivots[*row]) = (multiplier, pivot);
            }
        }
        let felt = self.unheld(&moving, &multipliers, way);
        g.begin_section("drive forces");
        let slides: Vec<_> =
            self.partition.driven.iter().map(|d| self.slid_drive(&moving, way, *d)).collect();
        let drive = self.partition.driven.iter().zip(&slides).map(|(d, slid)| slid.unwrap_or(felt[*d]));
        let drive = drive.collect();
        let slid = slides.iter().any(Option::is_some);
        let solution = Solution { accelerations, multipliers, pivots };
        Forward { solution, drive, closed: self.is_driven() || plan.rest.rows.is_empty(), slid }
    }

    /// Acceleration residuals of the rows of cuts in the motion that these accelerations make; none where the Jacobian does.
    fn moved_biases(&self, accelerations: &[Expr<'g>], way: Way<'_, 'g>) -> Vec<Expr<'g>> {
        if !way.rows_moved || accelerations.iter().all(|acceleration| acceleration.is_zero()) {
            return Vec::new();
        }
        let (sums, keep) = self.made;
        let make = || {
            let moving = self.moving(accelerations, Way { shapes: &[], ..way });
            closed_biases(&moving.motion, sums, keep)
        };
        self.known.biases(self.motion.poses.geometry.g, (accelerations, way.axes, sums), make)
    }

    /// Puts in the accelerations that local modes have while all others are as they stand.
    fn with_local_modes(&self, accelerations: &mut [Expr<'g>], way: Way<'_, 'g>) -> Rc<Moving<'g>> {
        let g = self.motion.poses.geometry.g;
        let local = way.local;
        for speed in local.iter().flat_map(|body| &body.speeds) {
            accelerations[*speed] = g.zero();
        }
        let moving = self.moving(accelerations, way);
        if local.is_empty() {
            return moving;
        }
        let felt = self.felt(&moving);
        g.begin_section("accelerations of the modes");
        for body in local {
            let forces: Vec<Expr<'g>> =
                body.speeds.iter().map(|speed| felt[self.partition.free[*speed]]).collect();
            for (speed, row) in body.speeds.iter().zip(&body.reduced.inverse) {
                accelerations[*speed] = -g.weighted(row.iter().copied(), &forces);
            }
        }
        self.moving(accelerations, way)
    }

    /// What rows do not fix, local modes left out.
    fn rest(
        &self,
        plan: &PlanBlock,
        moving: &Moving<'g>,
        Way { local, order, axes, .. }: Way<'_, 'g>,
        jacobian: &[Vec<Expr<'g>>],
        rights: &[Expr<'g>],
    ) -> Rest<'g> {
        let g = self.motion.poses.geometry.g;
        let is_local = |speed: &usize| local.iter().any(|body| body.speeds.contains(speed));
        let speeds: Vec<usize> = plan.speeds.iter().copied().filter(|speed| !is_local(speed)).collect();
        let h = self.felt(moving);
        g.begin_section("mass matrix by composite bodies");
        let mass = self.known.mass(g, (!local.is_empty(), axes), || {
            let eliminated: Vec<Eliminated<'g>> =
                local.iter().map(|body| body.eliminated(g, &self.motion.modes[body.link].q)).collect();
            reduced_mass_matrix(&self.motion.poses, self.masses, &eliminated, axes)
        });
        let free = |speed: &usize| self.partition.free[*speed];
        let of_rest = |row: &[Expr<'g>]| speeds.iter().map(|speed| row[*speed]).collect();
        let block: Vec<Vec<Expr<'g>>> =
            speeds.iter().map(|speed| of_rest(&self.pick(&mass[free(speed)]))).collect();
        let entries: Vec<Vec<Expr<'g>>> = plan.rows.iter().map(|row| of_rest(&jacobian[*row])).collect();
        let force: Vec<Expr<'g>> = speeds.iter().map(|speed| -h[free(speed)]).collect();
        let of_plan = |list: &[Vec<bool>]| -> Vec<Vec<bool>> {
            plan.rows.iter().map(|row| speeds.iter().map(|speed| list[*row][*speed]).collect()).collect()
        };
        let constant;
        let order = match order {
            Order::Leaves => order,
            Order::Cheapest(all) => {
                constant = of_plan(all);
                Order::Cheapest(&constant)
            }
            Order::PairsFirst(all) => {
                constant = of_plan(all);
                Order::PairsFirst(&constant)
            }
        };
        let saddle = Saddle { mass: &block, jacobian: &entries, force: &force, target: rights };
        let solution = solve(g, &saddle, order);
        Rest { speeds, solution }
    }

    /// Local modes follow the change of their frames' accelerations since `before`, when the motion was `moving`.
    fn followed(
        &self,
        accelerations: &mut [Expr<'g>],
        before: &[Expr<'g>],
        moving: &Moving<'g>,
        way: Way<'_, 'g>,
    ) -> Rc<Moving<'g>> {
        let g = self.motion.poses.geometry.g;
        let mut change = vec![g.zero(); self.v.len()];
        for (at, speed) in self.partition.free.iter().enumerate() {
            change[*speed] = accelerations[at] - before[at];
        }
        let change = self.known.changed(self.motion, &change, way.axes);
        let mut followed = Vec::new();
        for body in way.local {
            g.begin_section("accelerations of the modes");
            let moved = &change[body.link];
            let columns = body.columns(&self.masses[body.link]);
            let felt: Vec<Expr<'g>> =
                columns.into_iter().map(|column| column.power(moved.alpha, moved.origin)).collect();
            let own: Vec<Expr<'g>> =
                body.reduced.inverse.iter().map(|row| -g.weighted(row.iter().copied(), &felt)).collect();
            for (speed, own) in body.speeds.iter().zip(&own) {
                accelerations[*speed] += *own;
            }
            if let Some(Some(by)) = moving.fields.get(body.link) {
                let fields = by.shapes.changed(&by.fields, moved.alpha, &own);
                followed.push((body.link, BodyFields::new(&by.shapes, fields)));
            }
        }
        self.moving(accelerations, way).with_fields(followed)
    }
}

/// What is left to the equations of motion.
struct Rest<'g> {
    /// Speeds, by number among the free ones.
    speeds: Vec<usize>,
    solution: Solution<'g>,
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
