//! Elastic mounts between two bodies: the wrench of one, and what it does to energy.
//! In: link motion. Out: expressions. Never knows loads and columns.

use crate::expr::{Expr, Scope, Vec3};
use crate::model::{Force, Formula};

use super::formula_to_expr::Inputs;
use super::frame::Frame;
use super::geometry::Geometry;
use super::log_closure::Logarithm;
use super::motion::Motion;
use super::relative_motion::{Marker, Place, RelativeMotion, Side, Sums};

/// What a mount consists of by axis, in the order of its values.
const BY_AXIS: usize = 6;

/// Elastic mount between two bodies, stiff and damped along and about three axes, at rest in the reference pose.
///
/// With d the second body's marker from the first's, along the first's axes, phi the rotation vector between both, and
/// `x = (d, phi)`: `V = x K x / 2 + P x`, a force `-(K x + P)_d` along the first's axes, a moment `-A^T (K x + P)_phi` along
/// the second's, where `phi' = A omega`, A as for closure `log`. Damping takes `r C r` of the rates `r = (d', omega)`, omega along the
/// second's axes.
pub struct Mount<'g> {
    /// Of the second body's marker relative to the first's; moment and force are in its frame.
    pub motion: RelativeMotion<'g>,
    /// On the second body, about its marker [N m].
    pub moment: Vec3<'g>,
    /// On the second body [N].
    pub force: Vec3<'g>,
    /// Parts of the energy that it stores [J].
    pub stored: Vec<Expr<'g>>,
    /// Parts of the power that its dampers take [W].
    pub dissipated: Vec<Expr<'g>>,
}

impl<'g> Mount<'g> {
    /// The mount at this instant.
    pub fn new(element: &Force, links: &Motion<'g>) -> Self {
        let geometry = links.poses.geometry;
        let Geometry { g, linkage, inputs, .. } = geometry;
        let [x, y, z] = element.directions;
        let axes = Frame::from_axes(x, y, z);
        let markers = [0, 1].map(|i| {
            let (body, at) = (element.bodies[i], element.at[i]);
            let link = linkage.link_at(body, at, true);
            let outer = link.map_or(Frame::IDENTITY, |at| linkage.links[at].frame);
            let frame = outer.transposed().times(&axes).snapped();
            Marker { link, point: geometry.local(link, at), frame }
        });
        let motion = RelativeMotion::between(links, markers, Side::Child, (Place::Child, Sums::Links));
        let rotation = motion.rotation();
        let logarithm = Logarithm::new(g, rotation, motion.distance);
        let [stiffness, damping, turning_stiffness, turning_damping, preload, turning_preload] =
            element.triples::<BY_AXIS>().map(|list| Vec3::from_fn(|j| inputs.lower(&list[j])));
        let coupled = Coupled::new(g, inputs, element, &motion, logarithm.phi);
        let (mut force, mut elastic, mut moment) = (g.zero_vector(), g.zero_vector(), g.zero_vector());
        let (mut stored, mut dissipated) = (Vec::new(), Vec::new());
        for j in 0..3 {
            let axis = motion.parent_axis(j);
            let (displacement, speed) = (axis.dot(motion.distance), axis.dot(motion.slide));
            let (spring, damper) =
                (stiffness[j] * displacement + coupled.spring[j], damping[j] * speed + coupled.damper[j]);
            force -= ((spring + preload[j]) + damper) * axis;
            let turning = turning_stiffness[j] * logarithm.phi[j] + coupled.spring[j + 3];
            stored.push(0.5 * (spring * displacement + turning * logarithm.phi[j]));
            stored.push(preload[j] * displacement + turning_preload[j] * logarithm.phi[j]);
            dissipated.push(damper * speed);
            elastic[j] = turning + turning_preload[j];
        }
        let elastic = logarithm.half_jacobian(g).transpose() * elastic;
        for j in 0..3 {
            let axis = motion.child_axis(j);
            let rate = axis.dot(motion.omega);
            let damper = turning_damping[j] * rate + coupled.damper[j + 3];
            moment -= (elastic[j] + damper) * axis;
            dissipated.push(damper * rate);
        }
        Self { motion, moment, force, stored, dissipated }
    }

    /// Force and moment on the second body, about its marker, along the axes of W.
    pub fn in_ground(&self, links: &Motion<'g>) -> [Vec3<'g>; 2] {
        let rotation = links.poses.world_of(links.poses.geometry.g, self.motion.beside()).rotation;
        [self.force, self.moment].map(|part| rotation * part)
    }
}

/// What full matrices give: `K x` and `C r`; zero without them.
struct Coupled<'g> {
    spring: [Expr<'g>; 6],
    damper: [Expr<'g>; 6],
}

impl<'g> Coupled<'g> {
    fn new(
        g: &'g Scope,
        inputs: &Inputs<'g>,
        element: &Force,
        motion: &RelativeMotion<'g>,
        phi: Vec3<'g>,
    ) -> Self {
        let matrices = &element.formulas[3 * BY_AXIS..];
        let entries = |formulas: &[Formula]| -> Vec<Expr<'g>> {
            formulas.iter().map(|formula| inputs.lower(formula)).collect()
        };
        let (stiffness, damping) = matrices.split_at(matrices.len() / 2);
        let (stiffness, damping) = (entries(stiffness), entries(damping));
        let is_none = |entries: &[Expr<'g>]| entries.iter().all(|entry| entry.is_zero());
        let times = |entries: &[Expr<'g>], vector: &dyn Fn(usize) -> Expr<'g>| {
            if is_none(entries) {
                return [g.zero(); 6];
            }
            let vector: [Expr<'g>; 6] = std::array::from_fn(vector);
            std::array::from_fn(|i| {
                let terms = entries[6 * i..6 * (i + 1)].iter().zip(vector);
                g.sum(terms.map(|(entry, of)| *entry * of))
            })
        };
        let displacement = |i: usize| {
            if i < 3 { motion.parent_axis(i).dot(motion.distance) } else { phi[i - 3] }
        };
        let rate = |i: usize| {
            if i < 3 {
                motion.parent_axis(i).dot(motion.slide)
            } else {
                motion.child_axis(i - 3).dot(motion.omega)
            }
        };
        Self { spring: times(&stiffness, &displacement), damper: times(&damping, &rate) }
    }
}
