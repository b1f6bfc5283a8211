//! What an analysis looks at.
//! In: a mechanism, its derivation run by the interpreter. Out: [`Case`]. Never knows what is asked of it.

use linkwear_runtime::{AssemblyError, Description, Entry, Layout, System};

use crate::derive::{Link, Linkage};
use crate::id::JointId;
use crate::model::{Carrier, Mechanism, Start, Topology};
use crate::source::SourceFile;

use super::own_units::OwnUnits;
use super::samples::{ClosedPositions, RowsAt, Walker, evaluate};

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
    /// Of its equations of motion the position residuals and the Jacobian of all rows.
    pub rows: &'a RowsAt<'a>,
    /// What its lengths are measured in.
    pub units: OwnUnits,
}

impl Case<'_> {
    /// Default values of the tunable parameters.
    pub fn parameters(&self) -> Vec<f64> {
        self.description.parameters.iter().map(|parameter| parameter.default).collect()
    }

    /// The mechanism, to be moved.
    pub fn walker(&self) -> Walker<'_> {
        Walker {
            system: self.system,
            rows: self.rows,
            parameters: self.parameters(),
            layout: Layout::new(&self.description.motions),
            joint_speeds: self.linkage.joint_speeds(),
            units: &self.units,
        }
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

    /// The description with nothing demanded.
    fn with_guesses_only(&self) -> Description {
        let mut description = self.description.clone();
        description.coordinates.to_mut().iter_mut().for_each(|coordinate| coordinate.held = false);
        description.speeds.to_mut().iter_mut().for_each(|speed| speed.held = false);
        description
    }

    /// Closed positions; if what drivers and the file demand of the start is out of reach, such that it follows, with the
    /// reason.
    pub fn closed_positions(&self) -> Result<(ClosedPositions, Option<AssemblyError>), AssemblyError> {
        let walker = self.walker();
        let walk = |description: &Description| ClosedPositions::walk(&walker, description);
        let error = match walk(self.description) {
            Ok(positions) => return Ok((positions, None)),
            Err(error) => error,
        };
        match walk(&self.with_drivers_as_guesses()).or_else(|_| walk(&self.with_guesses_only())) {
            Ok(positions) => Ok((positions, Some(error))),
            Err(_) => Err(error),
        }
    }

    /// Joint and speed of every driver.
    pub fn drivers(&self) -> Vec<(JointId, usize)> {
        self.driven_links().map(|(joint, link)| (joint, link.first_speed)).collect()
    }

    /// Speed and coordinate of every offset and tilt that clearance adds.
    pub fn play(&self) -> impl Iterator<Item = (usize, usize)> {
        let joints = self.mechanism.joints.iter().enumerate();
        let offsets = joints.flat_map(|(at, joint)| joint.model.loose().map(move |offset| (at, offset)));
        offsets.filter_map(|(at, offset)| {
            let link = self.linkage.link_of_coordinate(JointId::new(at), offset)?;
            let link = &self.linkage.links[link];
            Some((link.first_speed, link.first_coordinate))
        })
    }

    /// Scalar coordinates whose start value the file demands: their joints and speeds.
    pub fn demanded(&self) -> Vec<(JointId, usize)> {
        let demanded = self.mechanism.starts.iter().filter(|start| start.held && start.position.is_some());
        demanded
            .filter_map(|start| {
                let link = self.linkage.link_of_coordinate(start.joint, start.coordinate)?;
                Some((start.joint, self.linkage.links[link].first_speed))
            })
            .collect()
    }

    /// Amounts of all speeds that are `amounts`, in own units, of the speeds listed, and else zero; SI.
    pub fn speeds_of<'a>(&self, listed: &[usize], amounts: impl IntoIterator<Item = &'a f64>) -> Vec<f64> {
        let mut all = vec![0.0; self.system.sizes().all_speeds];
        for (speed, amount) in listed.iter().zip(amounts) {
            all[*speed] = amount * self.units.speeds[*speed];
        }
        all
    }

    /// What drives against every speed at a time, in own units: inertia forces at these speeds, gravity, springs, dampers
    /// and forces by expression.
    pub fn resistance(&self, t: f64, q: &[f64], v: &[f64]) -> Vec<f64> {
        let sizes = self.system.sizes();
        let input = [&self.parameters(), &[t][..], q, v].concat();
        let mut output = vec![0.0; sizes.output(Entry::EquationsOfMotion)];
        evaluate(self.system, Entry::EquationsOfMotion, &input, &mut output);
        let n = sizes.all_speeds;
        let bias = output[n * (n + 1) / 2..].iter().zip(&self.units.speeds);
        bias.map(|(force, unit)| force * unit).collect()
    }

    /// Indices of a body's angular velocity among the channels, where the file's names are all different.
    pub fn turn_channels(&self, carrier: Carrier) -> Option<[usize; 3]> {
        let Carrier::Body(body) = carrier else { return None };
        let name = &self.mechanism.body(body).name;
        let channel = |axis: &str| self.channel(&format!("{name}.w{axis}"));
        Some([channel("x")?, channel("y")?, channel("z")?])
    }

    /// Index of the channel with this name.
    pub fn channel(&self, name: &str) -> Option<usize> {
        self.description.channels.iter().position(|channel| channel.name == name)
    }

    /// All channels at t = 0 without accelerations, SI.
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
