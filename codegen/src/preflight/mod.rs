//! What numbers say about a mechanism before code is emitted: does it close, how many freedoms has it,
//! which constraint rows are redundant, which freedoms are idle, which reactions are not unique.
//! In: a derivation with all rows kept, run by the interpreter. Out: [`Analysis`] and the rows to keep.
//! Never knows Rust syntax.

mod idle;
mod rank;
mod reactions;
mod samples;

use linkwear_runtime::{AssemblyError, Description, System};

use crate::derive::Linkage;
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::id::JointId;
use crate::model::{Mechanism, Start, Topology};
use crate::source::SourceFile;

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
    /// Speeds before drivers take freedoms away.
    pub speeds: usize,
    /// Constraint rows before redundant ones are dropped.
    pub constraint_rows: usize,
    /// Rows that are independent in general positions.
    pub independent_rows: usize,
    /// Speeds less independent rows: the true number of freedoms.
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

/// Analyses a mechanism. Returns the analysis and which constraint rows to keep.
///
/// # Errors
/// If loops cannot close, nothing can move, or drivers contradict the loops or each other.
pub fn analyse(case: &Case<'_>) -> Result<(Analysis, Vec<bool>), Diagnostics> {
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
    let positions = ClosedPositions::walk(description, case.system, &case.parameters())
        .map_err(|error| cannot_close(case.source, mechanism, &error))?;
    let rows = Rows::new(&positions, drivers.iter().map(|(_, speed)| *speed).collect());
    let keep = rows.independent();
    analysis.independent_rows = keep.iter().filter(|kept| **kept).count();
    analysis.mobility = analysis.speeds - analysis.independent_rows;
    for (info, _) in description.rows.iter().zip(&keep).filter(|(_, kept)| !**kept) {
        analysis.redundant.push(Redundant {
            joint: info.joint.to_string(),
            row: info.meaning.to_string(),
            reason: "in every position tried, the other rows of its loops already forbid it".to_owned(),
        });
    }
    let errors = if analysis.mobility == 0 {
        vec![locked(mechanism, &analysis)]
    } else {
        conflicts(mechanism, &drivers, &rows)
    };
    if !errors.is_empty() {
        return Err(Diagnostics::from_list(errors).located(case.source));
    }
    analysis.idle = idle::idle_freedoms(case, &positions);
    analysis.non_unique = reactions::non_unique(case, &positions);
    Ok((analysis, keep))
}

/// 6 (bodies) minus what every joint takes away.
fn grubler(mechanism: &Mechanism) -> i64 {
    let taken: usize = mechanism
        .joints
        .iter()
        .map(|joint| crate::derive::row_count(&joint.kind, crate::model::Closure::Joint))
        .sum();
    6 * mechanism.bodies.len() as i64 - taken as i64
}

fn cannot_close(source: &SourceFile, mechanism: &Mechanism, error: &AssemblyError) -> Diagnostics {
    let code = match error {
        AssemblyError::HeldPositions { .. } | AssemblyError::HeldSpeeds { .. } => Code::StartImpossible,
        AssemblyError::NonFinite { .. } | AssemblyError::Setup(_) => Code::StartNotFinite,
        _ => Code::LoopDoesNotClose,
    };
    let mut diagnostic = Diagnostic::new(code, error.to_string());
    let named = match error {
        AssemblyError::NoConvergence { joint, .. }
        | AssemblyError::HeldSpeeds { joint, .. }
        | AssemblyError::SpeedsImpossible { joint, .. } => Some(joint),
        _ => None,
    };
    if let Some(joint) = named.and_then(|name| mechanism.joints.iter().find(|joint| joint.name == *name)) {
        diagnostic = diagnostic.at(joint.span, "this loop stays open");
    }
    diagnostic = diagnostic
        .help("check lengths and points, or start Newton nearer to the wanted assembly with [assembly]");
    Diagnostics::from_list(vec![diagnostic]).located(source)
}

fn locked(mechanism: &Mechanism, analysis: &Analysis) -> Diagnostic {
    let names: Vec<&str> = mechanism.joints.iter().map(|joint| joint.name.as_str()).collect();
    let mut diagnostic = Diagnostic::new(
        Code::Locked,
        format!(
            "nothing can move: {} speeds are held by {} independent constraint rows",
            analysis.speeds, analysis.independent_rows
        ),
    )
    .help(format!(
        "the joints {} form a structure; free one of them (for instance make a revolute spherical) \
         or correct axes that should be parallel or meet in a point",
        names.join(", ")
    ));
    if let Some(joint) =
        analysis.cuts.first().and_then(|cut| mechanism.joints.iter().find(|j| j.name == *cut))
    {
        diagnostic = diagnostic.at(joint.span, "the loop closed here is rigid");
    }
    diagnostic
}

/// Drivers must prescribe independent freedoms.
fn conflicts(mechanism: &Mechanism, drivers: &[(JointId, usize)], rows: &Rows) -> Vec<Diagnostic> {
    let mut errors = Vec::new();
    for group in rows.driver_conflicts() {
        let names: Vec<&str> =
            group.iter().map(|driver| mechanism.joint(drivers[*driver].0).name.as_str()).collect();
        let (code, message) = if names.len() == 1 {
            (
                Code::DriverOnDependentCoordinate,
                format!("the loops leave joint `{}` no motion to drive", names[0]),
            )
        } else {
            (
                Code::DriversInConflict,
                format!(
                    "the loops couple the driven joints {}: they cannot all be prescribed",
                    names.join(", ")
                ),
            )
        };
        let mut diagnostic =
            Diagnostic::new(code, message).help("keep as many drivers as there are freedoms to drive");
        for name in &names {
            if let Some(joint) = mechanism.joints.iter().find(|joint| joint.name == **name) {
                diagnostic = diagnostic.at(joint.span, "driven here");
            }
        }
        errors.push(diagnostic);
    }
    errors
}
