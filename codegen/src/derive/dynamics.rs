//! Newton-Euler passes, energies and forward dynamics, [CS (6)].
//! In: link motion, loads, closure rows. Out: generalised forces, accelerations, multipliers.
//! Never knows entry points or columns.
//!
//! Inertial wrench of a link with `spin = skew(alpha) + skew(omega)²` about its origin, from mass m, first
//! moment s and second moment P (the same form serves rigid and flexible links):
//!   force  = m a_O + spin s
//!   moment = s x a_O + axial(spin P),  axial(A)_x = A_zy - A_yz, and cyclic.

use nalgebra::DMatrix;

use crate::expr::{Expr, Scope, Vec3};

use super::closure::CutRows;
use super::geometry::Geometry;
use super::kinematics::Acceleration;
use super::link_mass::LinkMass;
use super::linkage::Freedom;
use super::loads::Loads;
use super::mass_matrix::mass_matrix;
use super::mass_properties::MassProperties;
use super::motion::Motion;
use super::plan::Plan;
use super::row::Row;
use super::rows::Block;
use super::solve::{Solution, solve};
use super::wrench::Wrench;

/// Inertial wrench of a link about its origin, in its frame.
fn inertial_wrench<'g>(motion: &Motion<'g>, masses: &[LinkMass<'g>], at: usize) -> Wrench<'g> {
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

/// h: what every speed feels of inertia (for the accelerations that `motion` was built with), weight
/// and loads. Left side of [CS (6)].
pub fn bias_forces<'g>(motion: &Motion<'g>, masses: &[LinkMass<'g>], loads: &Loads<'g>) -> Vec<Expr<'g>> {
    let Geometry { g, linkage, .. } = motion.poses.geometry;
    let mut forces = vec![g.zero(); linkage.speeds()];
    let mut carried = vec![Wrench::zero(g); linkage.links.len()];
    for (at, link) in linkage.links.iter().enumerate().rev() {
        g.begin_section(format!("inertia, weight and loads of {}", link.name));
        let inertial = inertial_wrench(motion, masses, at);
        let total = inertial + -(loads.external[at] + loads.reactions[at]) + carried[at];
        let mut felt = total.generalised(link.freedom, motion.poses.nodes[at].as_ref());
        if let Some(modal) = &masses[at].modal {
            let deforming =
                modal.modal_forces(&motion.twists[at], &motion.accelerations[at], &motion.modes[at]);
            felt = felt.into_iter().zip(deforming).map(|(held, deforming)| deforming + held).collect();
        }
        for (speed, force) in link.speeds().zip(felt) {
            forces[speed] += force;
        }
        if let Some(parent) = link.parent {
            carried[parent] += total.passed_inwards(link.freedom, &motion.poses.relative[at]);
        }
    }
    forces.into_iter().zip(&loads.joint).map(|(force, joint)| force - *joint).collect()
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

/// Which speeds are free and which are driven, by index among all.
#[derive(Clone, Debug, Default)]
pub struct Partition {
    /// Free speeds, in tree order.
    pub free: Vec<usize>,
    /// Driven speeds, in the order of the drivers.
    pub driven: Vec<usize>,
}

/// Accelerations of free speeds, multipliers of `rows`, and drive forces.
pub struct Forward<'g> {
    pub solution: Solution<'g>,
    /// Generalised force of every driver.
    pub drive: Vec<Expr<'g>>,
}

/// A kept row with its Jacobian by all speeds.
pub struct KeptRow<'a, 'g> {
    /// The row.
    pub row: &'a Row<'g>,
    /// Columns by all speeds.
    pub jacobian: Vec<Expr<'g>>,
}

/// Picks the rows that are kept, in order, with their Jacobians.
pub fn kept_rows<'a, 'g>(
    motion: &Motion<'g>,
    cuts: &'a [CutRows<'g>],
    keep: &[bool],
) -> Vec<KeptRow<'a, 'g>> {
    let rows = cuts.iter().flat_map(|cut| cut.rows.iter().map(move |row| (cut, row)));
    rows.zip(keep)
        .filter(|(_, keep)| **keep)
        .map(|((cut, row), _)| KeptRow { row, jacobian: cut.jacobian(&motion.poses, row) })
        .collect()
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
    pub partition: &'a Partition,
}

impl<'g> Problem<'_, 'g> {
    /// Loop Jacobian by the free speeds.
    pub fn jacobian(&self) -> Vec<Vec<Expr<'g>>> {
        self.rows.iter().map(|row| self.pick(&row.jacobian)).collect()
    }

    fn pick(&self, row: &[Expr<'g>]) -> Vec<Expr<'g>> {
        self.partition.free.iter().map(|j| row[*j]).collect()
    }

    /// gamma at any state.
    fn target(&self) -> Vec<Expr<'g>> {
        self.rows.iter().map(|kept| -kept.row.bias.whole).collect()
    }

    /// By the structured elimination of [`solve`] alone.
    pub fn saddle(&self) -> Forward<'g> {
        let (motion, partition) = (self.motion, self.partition);
        let g = motion.poses.geometry.g;
        let h = bias_forces(motion, self.masses, self.loads);
        g.begin_section("mass matrix by composite bodies");
        let mass = mass_matrix(&motion.poses, self.masses);
        let block: Vec<Vec<Expr<'g>>> = partition.free.iter().map(|i| self.pick(&mass[*i])).collect();
        let force: Vec<Expr<'g>> = partition.free.iter().map(|i| -h[*i]).collect();
        let solution = solve(g, &block, &self.jacobian(), &force, &self.target());
        g.begin_section("drive forces");
        let drive = partition
            .driven
            .iter()
            .map(|d| {
                let mut sum = h[*d];
                for (entry, acceleration) in self.pick(&mass[*d]).into_iter().zip(&solution.accelerations) {
                    sum += entry * *acceleration;
                }
                sum - self.of_loops(*d, &solution.multipliers)
            })
            .collect();
        Forward { solution, drive }
    }

    /// What a speed feels of the loops.
    fn of_loops(&self, speed: usize, multipliers: &[Expr<'g>]) -> Expr<'g> {
        let g = self.motion.poses.geometry.g;
        g.sum(self.rows.iter().zip(multipliers).map(|(row, multiplier)| row.jacobian[speed] * *multiplier))
    }

    /// Rows first, by a plan: the blocks from the rows, the rest by [`solve`], then multipliers and drives from
    /// inverse dynamics with all accelerations known.
    pub fn rows_first(&self, plan: &Plan) -> Forward<'g> {
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
        let right = |accelerations: &[Expr<'g>], row: usize| {
            let known = jacobian[row].iter().zip(accelerations);
            known.fold(target[row], |sum, (entry, acceleration)| sum - *entry * *acceleration)
        };
        for block in &blocks {
            let rights: Vec<Expr<'g>> =
                block.plan.rows.iter().map(|row| right(&accelerations, *row)).collect();
            for (speed, acceleration) in block.plan.speeds.iter().zip(block.solve(&rights)) {
                accelerations[*speed] = acceleration;
            }
        }
        let (mut multipliers, mut pivots) = (vec![zero; self.rows.len()], vec![zero; self.rows.len()]);
        let rest = &plan.rest;
        if !rest.speeds.is_empty() {
            let h = bias_forces(&self.moving(&accelerations), self.masses, self.loads);
            g.begin_section("mass matrix by composite bodies");
            let mass = mass_matrix(&self.motion.poses, self.masses);
            let free = |speed: &usize| self.partition.free[*speed];
            let of_rest = |row: &[Expr<'g>]| rest.speeds.iter().map(|speed| row[*speed]).collect();
            let block: Vec<Vec<Expr<'g>>> =
                rest.speeds.iter().map(|speed| of_rest(&self.pick(&mass[free(speed)]))).collect();
            let entries: Vec<Vec<Expr<'g>>> = rest.rows.iter().map(|row| of_rest(&jacobian[*row])).collect();
            let force: Vec<Expr<'g>> = rest.speeds.iter().map(|speed| -h[free(speed)]).collect();
            let rights: Vec<Expr<'g>> = rest.rows.iter().map(|row| right(&accelerations, *row)).collect();
            let solution = solve(g, &block, &entries, &force, &rights);
            for (speed, acceleration) in rest.speeds.iter().zip(solution.accelerations) {
                accelerations[*speed] = acceleration;
            }
            for ((row, multiplier), pivot) in rest.rows.iter().zip(solution.multipliers).zip(solution.pivots)
            {
                (multipliers[*row], pivots[*row]) = (multiplier, pivot);
            }
        }
        // J^T lambda carries what inertia and loads leave over.
        let felt = bias_forces(&self.moving(&accelerations), self.masses, self.loads);
        g.begin_section("multipliers");
        for block in blocks.iter().rev() {
            let rights: Vec<Expr<'g>> = block
                .plan
                .speeds
                .iter()
                .map(|speed| self.partition.free[*speed])
                .map(|speed| felt[speed] - self.of_loops(speed, &multipliers))
                .collect();
            let pivot = block.pivot();
            for (row, multiplier) in block.plan.rows.iter().zip(block.solve_transposed(&rights)) {
                (multipliers[*row], pivots[*row]) = (multiplier, pivot);
            }
        }
        g.begin_section("drive forces");
        let drive =
            self.partition.driven.iter().map(|d| felt[*d] - self.of_loops(*d, &multipliers)).collect();
        Forward { solution: Solution { accelerations, multipliers, pivots }, drive }
    }

    /// The motion with these accelerations of the free speeds.
    fn moving(&self, accelerations: &[Expr<'g>]) -> Motion<'g> {
        let mut rates = self.rates.to_vec();
        for (speed, acceleration) in self.partition.free.iter().zip(accelerations) {
            rates[*speed] = *acceleration;
        }
        self.motion.accelerated(self.v, &rates)
    }
}

impl<'g> Forward<'g> {
    /// All that it consists of.
    fn operations(&self, g: &'g Scope) -> usize {
        let Solution { accelerations, multipliers, pivots } = &self.solution;
        g.operations([accelerations, multipliers, pivots, &self.drive].into_iter().flatten().copied())
    }
}

/// Forward dynamics by the plan that takes the fewest operations: rows first where the loops fix accelerations, else, or
/// where that is dearer, by elimination alone.
pub fn forward<'g>(problem: &Problem<'_, 'g>, jacobians: &[DMatrix<f64>]) -> Forward<'g> {
    let pattern: Vec<Vec<bool>> = problem
        .jacobian()
        .into_iter()
        .map(|row| row.into_iter().map(|entry| !entry.is_zero()).collect())
        .collect();
    let g = problem.motion.poses.geometry.g;
    let saddle = problem.saddle();
    let plan = Plan::new(&pattern, problem.partition.free.len(), jacobians);
    if plan.blocks.is_empty() {
        return saddle;
    }
    let rows_first = problem.rows_first(&plan);
    if rows_first.operations(g) < saddle.operations(g) { rows_first } else { saddle }
}
