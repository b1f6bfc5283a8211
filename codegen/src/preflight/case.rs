//! What an analysis looks at.
//! In: a mechanism, its derivation run by the interpreter. Out: [`Case`]. Never knows what is asked of it.

use linkwear_runtime::{AssemblyError, Description, System};

use crate::derive::Linkage;
use crate::id::JointId;
use crate::model::{Mechanism, Start, Topology};
use crate::source::SourceFile;

use super::samples::ClosedPositions;

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

    /// The description with what drivers prescribe at t = 0 as guesses.
    fn with_drivers_as_guesses(&self) -> Description {
        let mut description = self.description.clone();
        for (index, joint) in self.mechanism.joints.iter().enumerate() {
            for drive in &joint.drives {
                if let Some(link) = self.linkage.link_of_coordinate(JointId::new(index), drive.coordinate) {
                    let coordinate = self.linkage.links[link].first_coordinate;
                    description.coordinates.to_mut()[coordinate].held = false;
                }
            }
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
        let mut drivers = Vec::new();
        for (index, joint) in self.mechanism.joints.iter().enumerate() {
            for drive in &joint.drives {
                let id = JointId::new(index);
                if let Some(link) = self.linkage.link_of_coordinate(id, drive.coordinate) {
                    drivers.push((id, self.linkage.links[link].first_speed));
                }
            }
        }
        drivers
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
