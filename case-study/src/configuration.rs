//! Fig. 3: the assembled mechanism as points and lines. In: the mechanism. Out: [`Configuration`].
//! Never knows how it is drawn.

use linkwear_codegen::Compiled;
use linkwear_codegen::model::Carrier;
use serde::Serialize;

use super::error::StudyError;
use super::model::Model;
use super::workers::Workers;

/// Crank positions of the traces.
const TRACE: usize = 73;

/// A joint where it is at t = 0.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JointPlace {
    /// Its name.
    pub name: String,
    /// Position in the ground frame [m].
    pub at: [f64; 3],
    /// One of its bodies is the ground.
    pub on_ground: bool,
    /// Where it goes over a turn [m]; empty if it stays.
    pub trace: Vec<[f64; 3]>,
}

/// A body as a line through its joints.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Link {
    /// Its name.
    pub name: String,
    /// It bends.
    pub flexible: bool,
    /// Its joints [m], in the order of the file.
    pub through: Vec<[f64; 3]>,
}

/// The mechanism at t = 0.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Configuration {
    /// Joints in the order of the file.
    pub joints: Vec<JointPlace>,
    /// Bodies in the order of the file.
    pub links: Vec<Link>,
}

/// The assembled mechanism over one turn with ideal joints, which moves as that with clearance to 10 µm.
pub(super) fn configuration(compiled: &Compiled, workers: &Workers<'_>) -> Result<Configuration, StudyError> {
    let run = Model::Ideal.turn(0, 1e-4, TRACE, workers)?;
    let mechanism = &compiled.mechanism;
    let mut joints = Vec::new();
    for joint in &mechanism.joints {
        let path = run.vector(&format!("{}.", mechanism.point(joint.at).name))?;
        // Less than a thousandth of a millimetre is the play of a bearing.
        let moves = path.iter().any(|at| (0..3).any(|i| (at[i] - path[0][i]).abs() > 1e-6));
        joints.push(JointPlace {
            name: joint.name.clone(),
            at: path[0],
            on_ground: joint.parent == Carrier::Ground || joint.child == Carrier::Ground,
            trace: if moves { path } else { Vec::new() },
        });
    }
    let links = mechanism.bodies.iter().map(|body| {
        let is_here = |carrier: Carrier| mechanism.carrier_name(carrier) == body.name;
        let here = mechanism.joints.iter().zip(&joints);
        let here = here.filter(|(joint, _)| is_here(joint.parent) || is_here(joint.child));
        Link {
            name: body.name.clone(),
            flexible: body.flexible.is_some(),
            through: here.map(|(_, place)| place.at).collect(),
        }
    });
    Ok(Configuration { links: links.collect(), joints })
}
