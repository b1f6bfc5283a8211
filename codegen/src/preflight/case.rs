//! What an analysis looks at.
//! In: a mechanism, its derivation run by the interpreter. Out: [`Case`]. Never knows what is asked of it.

use linkwear_runtime::{AssemblyError, Description, Entry, System};

use crate::derive::{Link, Linkage};
use crate::id::JointId;
use crate::model::{Mechanism, Start, Topology};
use crate::source::SourceFile;

use super::samples::{ClosedPositions, evaluate};

/// What an analysis looks at: a mechanism and its derivation with all rows kept and all drivers
/// [`released`], run by the interpreter.
pub struct Case<'a> {
    /// The file, for diagnostics.
    pub source: &'a SourceFile,
    /// The mechanism with its drivers.
    pub mechanism: &'a Mechanism,
    /// Tree and cuts.
    pub topology: &'a Topology,
    /// Links, for the places of driven speeds.
    pub linkage: &'a Linkage,
    /// Names of the released mechanism.
    pub description: &'a Description,
    /// The released mechanism.
    pub system: &'a dyn System<f64>,
}

impl Case<'_> {
    /// Default values of the tunable parameters.
    pub fn parameters(&self) -> Vec<f64> {
        self.description.parameters.iter().map(|parameter| parameter.default).collect()
    }

    /// Every driver's joint, and the link that it moves.
    fn driven_links(&self) -> impl Iterator<Item = (JointId, &Link)> {
        self.mechanism.drives().filter_map(|(joint, drive)| {
            let link = self.linkage.link_of_coordinate(joint, drive.coordinate)?;
            Some((joint, &self.linkage.links[link]))
        })
    }

    /// The description with what drivers prescribe at t = 0 as guesses.
    fn with_drivers_as_guesses(&self) -> Description {
        let mut description = self.description.clone();
        for (_, link) in self.driven_links() {
            description.coordinates.to_mut()[link.first_coordinate].held = false;
        }
        description
    }

    /// Closed positions; if the drivers' start positions are out of reach, such that drivers follow, with the reason.
    pub fn closed_positions(&self) -> Result<(ClosedPositions, Option<AssemblyError>), AssemblyError> {
        let parameters = self.parameters();
        let joint_speeds = self.linkage.joint_speeds();
        let walk = |description: &Description| {
            ClosedPositions::walk(description, self.system, &parameters, &joint_speeds)
        };
        let error = match walk(self.description) {
            Ok(positions) => return Ok((positions, None)),
            Err(error) => error,
        };
        match walk(&self.with_drivers_as_guesses()) {
            Ok(positions) => Ok((positions, Some(error))),
            Err(_) => Err(error),
        }
    }

    /// Joint and speed of every driver.
    pub fn drivers(&self) -> Vec<(JointId, usize)> {
        self.driven_links().map(|(joint, link)| (joint, link.first_speed)).collect()
    }

    /// All channels at t = 0 without accelerations.
    pub fn observe(&self, q: &[f64], v: &[f64], multipliers: &[f64]) -> Vec<f64> {
        let sizes = self.system.sizes();
        let accelerations = vec![0.0; sizes.speeds];
        let input = [&self.parameters(), &[0.0][..], q, v, &accelerations, multipliers].concat();
        let mut output = vec![0.0; sizes.channels];
        evaluate(self.system, Entry::Observe, &input, &mut output);
        output
    }
}

/// The mechanism with its drivers taken off: what they prescribe at t = 0 becomes a demanded start value.
pub fn released(mechanism: &Mechanism) -> Mechanism {
    let mut released = mechanism.clone();
    for (index, joint) in released.joints.iter_mut().enumerate() {
        for drive in joint.drives.drain(..) {
            let id = JointId::new(index);
            released.starts.retain(|start| start.joint != id || start.coordinate != drive.coordinate);
            released.starts.push(Start {
                joint: id,
                coordinate: drive.coordinate,
                position: Some(drive.law),
                speed: None,
                held: true,
                span: joint.span,
            });
        }
    }
    released
}
