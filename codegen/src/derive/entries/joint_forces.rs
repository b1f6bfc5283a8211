//! Wrenches in joints: of cuts by their multipliers, of the tree by Newton-Euler from the leaves to the root.
//! In: link motion with true accelerations, multipliers, drive forces. Out: moments and forces in W. Never knows columns.

use super::deriver::{Deriver, Instant};
use crate::derive::closure::CutRows;
use crate::derive::couplings::{Multiplied, given, mesh_wrenches};
use crate::derive::dynamics::joint_wrenches;
use crate::derive::link_mass::LinkMass;
use crate::derive::linkage::Freedom;
use crate::derive::relative_motion::RelativeMotion;
use crate::derive::wrench::Wrench;
use crate::expr::{Expr, Vec3};
use crate::id::JointId;
use crate::model::Coupling;

/// The wrenches of one instant.
pub(super) struct JointForces<'a, 'g> {
    /// Multipliers and drive forces.
    deriver: &'a Deriver<'g>,
    /// Motion with the true accelerations.
    instant: &'a Instant<'g>,
    /// On every link all but joints of the tree.
    external: Vec<Wrench<'g>>,
    /// Moment and force of the constraints of every cut.
    at_cuts: Vec<[Vec3<'g>; 2]>,
}

impl<'a, 'g> JointForces<'a, 'g> {
    /// With what the loops do; couplings are still to be added.
    pub(super) fn new(deriver: &'a Deriver<'g>, instant: &'a Instant<'g>) -> Self {
        let geometry = deriver.geometry;
        geometry.g.begin_section("constraint forces of the loops");
        let mut external = instant.loads.external.clone();
        let mut multipliers = deriver.lambda.iter();
        let mut at_cuts = Vec::new();
        for cut in &instant.cuts {
            let mut sum = [geometry.g.zero_vector(); 2];
            for (row, multiplier) in cut.rows.iter().zip(&mut multipliers) {
                let [moment, force] = [row.moment, row.force].map(|part| *multiplier * part);
                sum = [sum[0] + moment, sum[1] + force];
            }
            at_cuts.push(sum);
            let [parent, child] = cut.motion.link_wrenches(sum[0], sum[1]);
            for (link, wrench) in [(cut.motion.child.link, child), (cut.motion.parent.link, parent)] {
                if let Some(at) = link {
                    external[at] += wrench;
                }
            }
        }
        Self { deriver, instant, external, at_cuts }
    }

    /// All couplings with their forces.
    pub(super) fn couplings(&self) -> Vec<(&'a Coupling, Multiplied<'g>)> {
        let geometry = self.deriver.geometry;
        let forces = self.coupling_forces();
        let couplings = geometry.mechanism.couplings.iter().zip(forces);
        couplings
            .map(|(coupling, force)| {
                geometry.g.begin_section(format!("force of {}", coupling.name));
                (coupling, Multiplied::new(force))
            })
            .collect()
    }

    /// Adds what a coupling does to its wheels; what others give way with is among the loads.
    pub(super) fn add(&mut self, coupling: &Coupling, by: &Multiplied<'g>) {
        if coupling.compliance.is_some() {
            return;
        }
        for (link, wrench) in mesh_wrenches(&self.instant.state, coupling, by) {
            if let Some(at) = link {
                self.external[at] += wrench;
            }
        }
    }

    /// Wrench that the inboard joint of every link transmits.
    pub(super) fn transmitted(&self, masses: &[LinkMass<'g>]) -> Vec<Wrench<'g>> {
        self.deriver.geometry.g.begin_section("joint wrenches, from the leaves of the tree to its root");
        joint_wrenches(&self.instant.state.motion, masses, &self.external)
    }

    /// Moment and force of the parent on the child in W, about the child's joint point.
    pub(super) fn wrench(&self, joint: JointId, transmitted: &[Wrench<'g>]) -> [Vec3<'g>; 2] {
        let geometry = self.deriver.geometry;
        geometry.g.begin_section(format!("wrench at {}", geometry.mechanism.joint(joint).name));
        match geometry.linkage.link_of_joint[joint.index()] {
            Some(at) => self.tree_wrench(joint, at, transmitted[at]),
            None => {
                let position = self.instant.cuts.iter().position(|cut| cut.cut.joint == joint);
                #[expect(clippy::expect_used, reason = "the spanning tree takes every joint or cuts it")]
                let position = position.expect("a joint is in the tree or a cut");
                self.cut_wrench(&self.instant.cuts[position], self.at_cuts[position])
            }
        }
    }

    /// Moment of the drive of a ball on the child, in W; nothing of other joints.
    pub(super) fn drive_moment(&self, joint: JointId, transmitted: &[Wrench<'g>]) -> Option<Vec3<'g>> {
        let linkage = self.deriver.geometry.linkage;
        let at = linkage.link_of_joint[joint.index()]?;
        let is_driven = self.deriver.geometry.mechanism.joint(joint).model.is_driven_ball();
        let moment = self.instant.state.motion.poses.world[at].rotation * transmitted[at].moment;
        is_driven.then_some(if linkage.reversed[joint.index()] { -moment } else { moment })
    }

    /// Forces of all couplings: multipliers, whose rows are behind those of the cuts, and what others give way with.
    fn coupling_forces(&self) -> Vec<Expr<'g>> {
        let (g, state) = (self.deriver.geometry.g, &self.instant.state);
        let lambda = &self.deriver.lambda;
        let mut multipliers = lambda[lambda.len() - self.instant.couplings.len()..].iter();
        let couplings = self.deriver.geometry.mechanism.couplings.iter();
        couplings
            .filter_map(|coupling| match &coupling.compliance {
                Some(law) => Some(given(g, state, coupling, law).force),
                None => multipliers.next().copied(),
            })
            .collect()
    }

    /// Wrench by parent on child in W at the child's joint point, without the drives and the forces of relations.
    fn tree_wrench(&self, joint: JointId, at: usize, total: Wrench<'g>) -> [Vec3<'g>; 2] {
        let (poses, geometry) = (&self.instant.state.motion.poses, self.deriver.geometry);
        let linkage = geometry.linkage;
        let pose = poses.world[at];
        let mut moment = pose.rotation * total.moment;
        let mut force = pose.rotation * total.force;
        let reversed = linkage.reversed[joint.index()];
        let data = geometry.mechanism.joint(joint);
        if reversed && data.model.slides() {
            // The joint's child is inboard: all is about its own joint point, and there the drive acts too.
            let link = linkage.link_at(data.child, data.at, true);
            let place = poses.position(link, geometry.local(link, data.at));
            moment += (pose.offset - place).cross(force);
        }
        if data.model.is_driven_ball() {
            // Such a joint passes on no moment but that of its drive.
            moment = geometry.g.zero_vector();
        }
        for (driver, drive) in self.deriver.drivers.iter().zip(&self.deriver.drive) {
            if driver.joint != joint || data.model.is_driven_ball() {
                continue;
            }
            let Some(link) = linkage.link_of_coordinate(joint, driver.joint_coordinate) else { continue };
            let along = |axis: [f64; 3]| *drive * (poses.world[link].rotation * geometry.g.vector(axis));
            match linkage.links[link].freedom {
                Freedom::Translation { axis } => force -= along(axis),
                _ => moment -= along([0.0, 0.0, 1.0]),
            }
        }
        for (coupling, multiplier) in geometry.mechanism.couplings.iter().zip(self.coupling_forces()) {
            let felt = coupling.meshes.is_empty();
            for term in coupling.terms.iter().filter(|term| felt && term.joint == joint) {
                let Some(link) = linkage.link_of_coordinate(joint, term.coordinate) else { continue };
                let amount = multiplier * self.instant.state.lower(geometry.g, &term.factor);
                let along = |axis: [f64; 3]| amount * (poses.world[link].rotation * geometry.g.vector(axis));
                match linkage.links[link].freedom {
                    Freedom::Translation { axis } => force -= along(axis),
                    _ => moment -= along([0.0, 0.0, 1.0]),
                }
            }
        }
        // The child of a reversed joint feels the opposite.
        if reversed { [-moment, -force] } else { [moment, force] }
    }

    fn cut_wrench(&self, cut: &CutRows<'g>, [mut moment, mut force]: [Vec3<'g>; 2]) -> [Vec3<'g>; 2] {
        let (g, state) = (self.deriver.geometry.g, &self.instant.state);
        let rotation = |motion: &RelativeMotion<'g>| state.motion.poses.world_of(g, motion.beside()).rotation;
        let own = state.relative_motion(cut.cut.joint);
        let same = cut.motion.beside() == own.beside();
        let mut apart = [g.zero_vector(); 2];
        for (joint, own_moment, own_force) in &self.instant.loads.in_cuts {
            if *joint == cut.cut.joint {
                let [m, f] = if same {
                    [&mut moment, &mut force]
                } else {
                    let [m, f] = &mut apart;
                    [m, f]
                };
                *m += *own_moment;
                *f += *own_force;
            }
        }
        let turned = [moment, force].map(|part| rotation(&cut.motion) * part);
        let apart = apart.map(|part| rotation(&own) * part);
        [turned[0] + apart[0], turned[1] + apart[1]]
    }
}
