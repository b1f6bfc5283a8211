//! Newton-Euler passes, energies and forward dynamics, [CS (6)].
//! In: link motion, loads, closure rows. Out: generalised forces, accelerations, multipliers.
//! Never knows entry points or columns.
//!
//! Inertial wrench of a link with `spin = skew(alpha) + skew(omega)²` about its origin, from mass m, first
//! moment s and second moment P (the same form serves rigid and flexible links):
//!   force  = m a_O + spin s
//!   moment = s x a_O + axial(spin P),  axial(A)_x = A_zy - A_yz, and cyclic.

use crate::expr::{Expr, Scope, Vec3};

use super::closure::CutRows;
use super::composite::mass_matrix;
use super::inertia::{LinkMass, MassProperties};
use super::kinematics::Acceleration;
use super::linkage::Linkage;
use super::loads::Loads;
use super::motion::Motion;
use super::solve::{Solution, solve};
use super::wrench::Wrench;

/// Inertial wrench of a link about its origin, in its frame.
fn inertial_wrench<'g>(g: &'g Scope, motion: &Motion<'g>, masses: &[LinkMass<'g>], at: usize) -> Wrench<'g> {
    let frozen = frozen_wrench(g, &masses[at].frozen, &motion.accelerations[at]);
    match &masses[at].modal {
        Some(modal) => {
            let deforming = modal.wrench(g, &motion.twists[at], &motion.modes[at]);
            frozen.plus(g, deforming)
        }
        None => frozen,
    }
}

/// Inertial wrench of a link frozen in its present shape.
fn frozen_wrench<'g>(g: &'g Scope, own: &MassProperties<'g>, motion: &Acceleration<'g>) -> Wrench<'g> {
    let (weight, turned) = (g.scale3(own.mass, motion.origin), g.mul_vec3(motion.spin, own.first));
    let product = g.mul_mat3(motion.spin, own.second);
    let (lever, axial) = (g.cross3(own.first, motion.origin), product.axial());
    Wrench { moment: g.add3(lever, axial), force: g.add3(weight, turned) }
}

/// h: what every speed feels of inertia (for the accelerations that `motion` was built with), weight
/// and loads. Left side of [CS (6)].
pub fn bias_forces<'g>(
    g: &'g Scope,
    linkage: &Linkage,
    motion: &Motion<'g>,
    masses: &[LinkMass<'g>],
    loads: &Loads<'g>,
) -> Vec<Expr<'g>> {
    let mut forces = vec![g.zero(); linkage.speeds()];
    let none = Wrench::zero(g);
    let mut carried = vec![none; linkage.links.len()];
    for (at, link) in linkage.links.iter().enumerate().rev() {
        g.begin_section(format!("inertia, weight and loads of {}", link.name));
        let inertial = inertial_wrench(g, motion, masses, at);
        let applied = loads.external[at].plus(g, loads.reactions[at]);
        let applied = applied.negated(g);
        let sum = inertial.plus(g, applied);
        let total = sum.plus(g, carried[at]);
        let node = motion.poses.nodes[at].as_ref();
        let mut felt = total.generalised(g, link.freedom, node);
        if let Some(modal) = &masses[at].modal {
            let own = modal.modal_forces(g, &motion.twists[at], &motion.accelerations[at], &motion.modes[at]);
            felt = felt.into_iter().zip(own).map(|(held, own)| g.add(own, held)).collect();
        }
        for (speed, force) in link.speeds().zip(felt) {
            forces[speed] = g.add(forces[speed], force);
        }
        if let Some(parent) = link.parent {
            let passed = total.passed_inwards(g, link.freedom, &motion.poses.relative[at]);
            carried[parent] = carried[parent].plus(g, passed);
        }
    }
    forces.into_iter().zip(&loads.joint).map(|(force, joint)| g.sub(force, *joint)).collect()
}

/// Wrench that each link's inboard joint transmits to it (drive and joint forces included), about the
/// link's origin, in its frame. `external` is everything but joints of the tree.
pub fn joint_wrenches<'g>(
    g: &'g Scope,
    linkage: &Linkage,
    motion: &Motion<'g>,
    masses: &[LinkMass<'g>],
    external: &[Wrench<'g>],
) -> Vec<Wrench<'g>> {
    let none = Wrench::zero(g);
    let mut totals = vec![none; linkage.links.len()];
    for (at, link) in linkage.links.iter().enumerate().rev() {
        let inertial = inertial_wrench(g, motion, masses, at);
        let applied = external[at].negated(g);
        let sum = inertial.plus(g, applied);
        totals[at] = totals[at].plus(g, sum);
        if let (Some(parent), false) = (link.parent, link.freedom == super::linkage::Freedom::Free) {
            let passed = totals[at].on_parent(g, &motion.poses.relative[at]);
            totals[parent] = totals[parent].plus(g, passed);
        }
    }
    totals
}

/// Kinetic energy [J].
pub fn kinetic_energy<'g>(g: &'g Scope, masses: &[LinkMass<'g>], motion: &Motion<'g>) -> Expr<'g> {
    let half = g.constant(0.5);
    let mut sum = g.zero();
    for (at, (mass, twist)) in masses.iter().zip(&motion.twists).enumerate() {
        let own = &mass.frozen;
        let square = g.dot3(twist.origin, twist.origin);
        let translation = g.mul(own.mass, square);
        let turned = g.cross3(twist.omega, own.first);
        let mixed = g.dot3(twist.origin, turned);
        let two = g.constant(2.0);
        let mixed = g.mul(two, mixed);
        let inertia = super::inertia::inertia_of_second_moment(g, own.second);
        let momentum = g.mul_vec3(inertia, twist.omega);
        let rotation = g.dot3(twist.omega, momentum);
        for term in [translation, mixed, rotation] {
            sum = g.add(sum, term);
        }
        if let Some(modal) = &mass.modal {
            let deforming = modal.double_energy(g, twist, &motion.modes[at].v);
            sum = g.add(sum, deforming);
        }
    }
    g.mul(half, sum)
}

/// Potential energy of weight [J], zero at the origin of W.
pub fn weight_energy<'g>(
    g: &'g Scope,
    motion: &Motion<'g>,
    masses: &[LinkMass<'g>],
    gravity: Vec3<'g>,
) -> Expr<'g> {
    masses.iter().zip(&motion.poses.world).fold(g.zero(), |sum, (mass, pose)| {
        let own = &mass.frozen;
        sum - gravity.dot(own.mass * pose.offset + pose.rotation * own.first)
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
    /// Accelerations, multipliers, pivots.
    pub solution: Solution<'g>,
    /// Generalised force of every driver.
    pub drive: Vec<Expr<'g>>,
}

/// A kept row with its Jacobian by all speeds.
pub struct KeptRow<'g> {
    /// Columns by all speeds.
    pub jacobian: Vec<Expr<'g>>,
    /// Acceleration bias.
    pub bias: Expr<'g>,
    /// Position residual.
    pub residual: Expr<'g>,
    /// Velocity residual.
    pub rate: Expr<'g>,
}

/// Picks the rows that are kept, in order, with their Jacobians.
pub fn kept_rows<'g>(
    g: &'g Scope,
    linkage: &Linkage,
    motion: &Motion<'g>,
    cuts: &[CutRows<'g>],
    keep: &[bool],
) -> Vec<KeptRow<'g>> {
    let mut kept = Vec::new();
    let mut index = 0;
    for cut in cuts {
        for row in &cut.rows {
            if keep[index] {
                let jacobian = cut.jacobian(g, linkage, &motion.poses, row);
                kept.push(KeptRow { jacobian, bias: row.bias, residual: row.residual, rate: row.rate });
            }
            index += 1;
        }
    }
    kept
}

/// Forward dynamics by the structured elimination of [`solve`].
pub fn forward<'g>(
    g: &'g Scope,
    linkage: &Linkage,
    motion: &Motion<'g>,
    masses: &[LinkMass<'g>],
    loads: &Loads<'g>,
    (rows, partition): (&[KeptRow<'g>], &Partition),
) -> Forward<'g> {
    let h = bias_forces(g, linkage, motion, masses, loads);
    g.begin_section("mass matrix by composite bodies");
    let mass = mass_matrix(g, linkage, &motion.poses, masses);
    let free = &partition.free;
    let block: Vec<Vec<Expr<'g>>> =
        free.iter().map(|i| free.iter().map(|j| mass[*i][*j]).collect()).collect();
    let jacobian: Vec<Vec<Expr<'g>>> =
        rows.iter().map(|row| free.iter().map(|j| row.jacobian[*j]).collect()).collect();
    let force: Vec<Expr<'g>> = free.iter().map(|i| g.neg(h[*i])).collect();
    let target: Vec<Expr<'g>> = rows.iter().map(|row| g.neg(row.bias)).collect();
    let solution = solve(g, &block, &jacobian, &force, &target);
    g.begin_section("drive forces");
    let drive = partition
        .driven
        .iter()
        .map(|d| {
            let mut sum = h[*d];
            for (position, j) in free.iter().enumerate() {
                let product = g.mul(mass[*d][*j], solution.accelerations[position]);
                sum = g.add(sum, product);
            }
            for (row, multiplier) in rows.iter().zip(&solution.multipliers) {
                let product = g.mul(row.jacobian[*d], *multiplier);
                sum = g.sub(sum, product);
            }
            sum
        })
        .collect();
    Forward { solution, drive }
}
