//! What numbers say about a mechanism before code is emitted: does it close, how many freedoms has it,
//! which constraint rows are redundant, which freedoms are idle, which reactions are not unique.
//! In: a derivation with all rows kept, run by the interpreter. Out: [`Analysis`] and the rows to keep.
//! Never knows Rust syntax.

mod contact_resonance;
mod failures;
mod idle;
mod immobile;
mod prescribed;
mod rank;
mod reactions;
mod resonance;
mod samples;

use linkwear_runtime::{AssemblyError, Description, System};

use crate::derive::Linkage;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::id::JointId;
use crate::model::{Mechanism, Start, Topology};
use crate::source::SourceFile;

pub use contact_resonance::contacts_near_modes;
pub use prescribed::check_prescribed;

use rank::Rows;
use samples::ClosedPositions;

/// A constraint row that says nothing new.
#[derive(Clone, Debug, PartialEq)]
pub struct Redundant {
    /// The cut joint it belongs to.
    pub joint: String,
    /// What it would forbid.
    pub row: String,
    /// Why it is not needed.
    pub reason: String,
}

/// Freedoms, redundancies, and what cannot be known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Analysis {
    /// Coordinates before drivers take freedoms away (4 for a quaternion).
    pub coordinates: usize,
    /// Speeds before drivers take freedoms away, those of modes included.
    pub speeds: usize,
    /// Modal coordinates of flexible bodies.
    pub modes: usize,
    /// Constraint rows before redundant ones are dropped.
    pub constraint_rows: usize,
    /// Rows that are independent in general positions.
    pub independent_rows: usize,
    /// Speeds less independent rows, with flexible bodies frozen: the true number of freedoms.
    pub mobility: usize,
    /// The Grübler-Kutzbach count, which knows no special geometry.
    pub grubler: i64,
    /// Driven joints.
    pub drivers: Vec<String>,
    /// Freedoms that move nothing but the body named.
    pub idle: Vec<String>,
    /// Rows dropped.
    pub redundant: Vec<Redundant>,
    /// Wrench components (`R1.Fx`) that redundant constraints leave undetermined.
    pub non_unique: Vec<String>,
    /// Cut joints, where loops are closed.
    pub cuts: Vec<String>,
}

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
    fn parameters(&self) -> Vec<f64> {
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
    fn closed_positions(&self) -> Result<(ClosedPositions, Option<AssemblyError>), AssemblyError> {
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
    fn drivers(&self) -> Vec<(JointId, usize)> {
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
#[must_use]
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

/// What is known after the analysis.
#[derive(Clone, Debug)]
pub struct Findings {
    /// For people and reports.
    pub analysis: Analysis,
    /// Which constraint rows to keep.
    pub keep: Vec<bool>,
    /// Remarks.
    pub warnings: Vec<Diagnostic>,
}

/// Analyses a mechanism.
///
/// # Errors
/// If loops cannot close, nothing can move, drivers contradict the loops or each other, or a motion has no inertia.
pub fn analyse(case: &Case<'_>) -> Result<Findings, Diagnostics> {
    let (mechanism, description) = (case.mechanism, case.description);
    let sizes = case.system.sizes();
    let drivers = case.drivers();
    let mut analysis = Analysis {
        coordinates: sizes.all_coordinates,
        speeds: sizes.all_speeds,
        constraint_rows: sizes.all_rows,
        grubler: grubler(mechanism),
        drivers: drivers.iter().map(|(joint, _)| mechanism.joint(*joint).name.clone()).collect(),
        cuts: case.topology.cuts.iter().map(|cut| mechanism.joint(*cut).name.clone()).collect(),
        ..Analysis::default()
    };
    let fail = |errors| Err(Diagnostics::from_list(errors).located(case.source));
    let (positions, refusal) = match case.closed_positions() {
        Ok(found) => found,
        Err(error) => return fail(vec![failures::cannot_close(mechanism, &error)]),
    };
    let rows = Rows::new(&positions, drivers.iter().map(|(_, speed)| *speed).collect());
    let keep = rows.independent();
    analysis.independent_rows = keep.iter().filter(|kept| **kept).count();
    let joint_speeds = case.linkage.joint_speeds();
    analysis.modes = analysis.speeds - joint_speeds.len();
    analysis.mobility = joint_speeds.len() - Rows::of_speeds(&positions, &joint_speeds).rank();
    for (info, _) in description.rows.iter().zip(&keep).filter(|(_, kept)| !**kept) {
        analysis.redundant.push(Redundant {
            joint: info.joint.to_string(),
            row: info.meaning.to_string(),
            reason: "in every position tried, the other rows of its loops already forbid it".to_owned(),
        });
    }
    let mut errors = failures::conflicts(mechanism, &drivers, &rows);
    if analysis.speeds == analysis.independent_rows {
        errors.insert(0, failures::locked(mechanism, &analysis));
    }
    if let Some(error) = refusal.filter(|_| errors.is_empty()) {
        errors.push(failures::out_of_reach(mechanism, &drivers, &error));
    }
    if let Some((joint, body)) = immobile::massless(case, &positions).filter(|_| errors.is_empty()) {
        errors.push(failures::massless(mechanism, joint, &body));
    }
    if !errors.is_empty() {
        return fail(errors);
    }
    let rigid = immobile::rigid_joints(case, &positions);
    let mut warnings =
        if rigid.is_empty() { Vec::new() } else { vec![failures::rigid_part(mechanism, &rigid)] };
    warnings.extend(resonance::near_resonance(mechanism));
    analysis.idle = idle::idle_freedoms(case, &positions);
    analysis.non_unique = reactions::non_unique(case, &positions);
    Ok(Findings { analysis, keep, warnings })
}

/// 6 (bodies) minus what every joint takes away.
fn grubler(mechanism: &Mechanism) -> i64 {
    let taken: usize = mechanism
        .joints
        .iter()
        .map(|joint| crate::derive::row_count(&joint.model, crate::model::Closure::Joint))
        .sum();
    6 * mechanism.bodies.len() as i64 - taken as i64
}
