//! Bushing: an elastic mount between two bodies, stiff and damped along and about three axes.
//!
//! With d the second body's marker from the first's, along the first's axes, and phi the rotation vector between
//! both: `V = sum k_j d_j² / 2 + sum kr_j phi_j² / 2`, a force `-(k_j d_j + c_j d_j')` along the first's axes, a
//! moment `-A^T (kr phi) - cr omega` along the second's, where `phi' = A omega`, A as for closure `log`.

use crate::derive::element::Element;
use crate::derive::frame::Frame;
use crate::derive::joint_state::JointStates;
use crate::derive::loads::Loads;
use crate::derive::log_closure::Logarithm;
use crate::derive::relative_motion::{Marker, Place, RelativeMotion};
use crate::expr::{Scope, Vec3};
use crate::model::Bushing;

impl<'g> Element<'g> for Bushing {
    fn add_to(&self, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
        let (geometry, linkage) = (&state.geometry, state.geometry.linkage);
        let [x, y, z] = self.axes;
        let axes = Frame::from_axes(x, y, z);
        let markers = self.bodies.map(|body| {
            let link = linkage.link_at(body, self.at, true);
            let outer = link.map_or(Frame::IDENTITY, |at| linkage.links[at].frame);
            let frame = outer.transposed().times(&axes).snapped();
            Marker { link, point: geometry.local(link, self.at), frame }
        });
        let motion = RelativeMotion::between(&state.motion, markers, true, Place::Child);
        let rotation = motion.rotation();
        let logarithm = Logarithm::new(g, rotation, motion.distance);
        let [stiffness, damping, turning_stiffness, turning_damping] =
            [&self.stiffness, &self.damping, &self.turning_stiffness, &self.turning_damping]
                .map(|list| Vec3::from_fn(|j| state.lower(g, &list[j])));
        let (mut force, mut elastic, mut moment) = (g.zero_vector(), g.zero_vector(), g.zero_vector());
        for j in 0..3 {
            let axis = motion.parent_axis(j);
            let (displacement, speed) = (axis.dot(motion.distance), axis.dot(motion.slide));
            let (spring, damper) = (stiffness[j] * displacement, damping[j] * speed);
            force -= (spring + damper) * axis;
            elastic[j] = turning_stiffness[j] * logarithm.phi[j];
            loads.potential += 0.5 * (spring * displacement + elastic[j] * logarithm.phi[j]);
            loads.dissipated += damper * speed;
        }
        let elastic = logarithm.half_jacobian(g).transpose() * elastic;
        for j in 0..3 {
            let axis = motion.child_axis(j);
            let rate = axis.dot(motion.omega);
            let damper = turning_damping[j] * rate;
            moment -= (elastic[j] + damper) * axis;
            loads.dissipated += damper * rate;
        }
        loads.between(&motion, moment, force);
    }
}
