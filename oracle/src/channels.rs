//! States from named numbers, as linkwear's output columns carry them.
//! In: a look-up by name. Out: states of all bodies. Never knows how the numbers were made.

use linkwear_codegen::id::JointId;
use linkwear_codegen::model::Carrier;
use nalgebra::Vector3;

use crate::frame::BodyState;
use crate::joint::JointMotion;
use crate::kind::Kind;
use crate::model::Oracle;

impl Oracle {
    /// States of all bodies from output columns: `R4.q`, `R4.v` (`q1`, `v1` and so on where a joint has
    /// several), `S2.q0` to `S2.q3` (`e0` to `e3` where a joint has `q1` besides), `coupler.wx` to `coupler.wz`, and for a free joint `.x`, `.vx` and so
    /// on. Bodies are placed outwards over the first joints, in file order, whose columns are there.
    /// `None` if some body cannot be reached.
    pub fn states_from(&self, value: &dyn Fn(&str) -> Option<f64>) -> Option<Vec<BodyState>> {
        let motions: Vec<(JointId, JointMotion)> = (0..self.joints.len())
            .map(JointId::new)
            .filter_map(|joint| Some((joint, self.motion_from(joint, value)?)))
            .collect();
        let mut reached = vec![false; self.bodies.len()];
        // As many rounds as bodies reach everything that can be reached.
        for _ in 0..self.bodies.len() {
            for (joint, _) in &motions {
                let joint = &self.joints[joint.index()];
                let known = |c: Carrier, reached: &[bool]| match c {
                    Carrier::Ground => true,
                    Carrier::Body(id) => reached[id.index()],
                };
                if known(joint.parent, &reached) || known(joint.child, &reached) {
                    for carrier in [joint.parent, joint.child] {
                        if let Carrier::Body(id) = carrier {
                            reached[id.index()] = true;
                        }
                    }
                }
            }
        }
        reached.iter().all(|reached| *reached).then(|| self.place(&motions))
    }

    fn motion_from(&self, joint: JointId, value: &dyn Fn(&str) -> Option<f64>) -> Option<JointMotion> {
        let geometry = &self.joints[joint.index()];
        if Kind::OF_PLACES.contains(&geometry.kind) {
            return None;
        }
        let name = &self.mechanism.joint(joint).name;
        let column = |suffix: &str| value(&format!("{name}.{suffix}"));
        let count = geometry.scalars();
        let suffix = |k: usize| if count > 1 { (k + 1).to_string() } else { String::new() };
        let all = |letter: &str| -> Option<Vec<f64>> {
            (0..count).map(|k| column(&format!("{letter}{}", suffix(k)))).collect()
        };
        let (mut position, mut speed) = (all("q")?, all("v")?);
        if !geometry.kind.is_round() {
            return Some(JointMotion { position, speed });
        }
        let omega = |carrier: Carrier| -> Option<Vector3<f64>> {
            let Carrier::Body(_) = carrier else { return Some(Vector3::zeros()) };
            let body = self.mechanism.carrier_name(carrier);
            let [x, y, z] = ["wx", "wy", "wz"].map(|axis| value(&format!("{body}.{axis}")));
            Some(Vector3::new(x?, y?, z?))
        };
        let letter = if count > 1 { "e" } else { "q" };
        for k in 0..4 {
            position.push(column(&format!("{letter}{k}"))?);
        }
        speed.extend((omega(geometry.child)? - omega(geometry.parent)?).iter());
        if geometry.kind == Kind::Free {
            for axis in ["x", "y", "z"] {
                position.push(column(axis)?);
                speed.push(column(&format!("v{axis}"))?);
            }
        }
        Some(JointMotion { position, speed })
    }
}
