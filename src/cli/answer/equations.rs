//! Answers of what writes or counts equations: `equations`, `cost`, `generate`, `fmu`, `new`, `completions` and `man`, each with
//! `--format json`.

#[cfg(test)]
use std::collections::BTreeMap;

use linkwear_codegen::tape::Operations;
use serde::Serialize;
use serde_json::{Map, Value};
#[cfg(test)]
use {super::common::Remark, schemars::JsonSchema};

use super::common::OperationsAnswer;
use crate::cost::{EntryCost, Nanoseconds};

/// The symbolic equations.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct EquationsAnswer<'a> {
    /// Name of the mechanism.
    pub name: &'a str,
    /// Outputs of functions.
    pub outputs: Vec<OutputAnswer<'a>>,
    /// The equations in the notation that was asked for.
    pub text: &'a str,
    /// Whether the mass matrix is left out of `equations_of_motion`, as it is of long mechanisms: zeros stand in its place.
    pub mass_left_out: bool,
    /// Remarks on the file.
    #[cfg_attr(test, schemars(with = "Vec<Remark>"))]
    pub warnings: Vec<Value>,
}

/// An output of a function.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct OutputAnswer<'a> {
    /// Its name.
    pub name: &'a str,
    /// The function.
    pub function: &'a str,
    /// Its rows.
    pub rows: usize,
    /// Its columns.
    pub cols: usize,
    /// Operations, shared ones counted once.
    pub operations: OperationsAnswer,
    /// Operations, shared ones counted wherever they stand.
    pub operations_unshared: OperationsAnswer,
}

/// What the equations cost here.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct CostAnswer<'a> {
    /// Name of the mechanism.
    pub name: &'a str,
    /// Entry points by name: `forward_dynamics` (accelerations, multipliers, drive), `accelerations` (those alone),
    /// `equations_of_motion` (matrices and vectors), ..
    #[cfg_attr(test, schemars(with = "BTreeMap<String, EntryAnswer>"))]
    pub entry_points: Map<String, Value>,
    /// A turn of the first driven revolute joint, else (without one, or where it swings) a second, by the adaptive method.
    pub turn: TurnCost,
    /// Remarks on the file.
    #[cfg_attr(test, schemars(with = "Vec<Remark>"))]
    pub warnings: Vec<Value>,
}

/// What an entry point costs.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct EntryAnswer<'a> {
    /// Its operations.
    operations: OperationsAnswer,
    /// Its operations by what they are for.
    sections: Vec<SectionAnswer<'a>>,
    /// Time of a call.
    ns: NanosecondsAnswer,
}

/// A section of an entry point.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
struct SectionAnswer<'a> {
    /// What it is for.
    name: &'a str,
    /// Its operations.
    operations: OperationsAnswer,
}

/// Time of a call on each back end; null where one is missing.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
struct NanosecondsAnswer {
    /// The interpreter [ns].
    interpreter: Option<f64>,
    /// Machine code written now [ns].
    native: Option<f64>,
    /// Code that was compiled in [ns].
    compiled: Option<f64>,
    /// Machine code for four states side by side, per state [ns].
    lanes4: Option<f64>,
    /// Machine code for eight states side by side, per state [ns].
    lanes8: Option<f64>,
}

impl<'a> From<&'a EntryCost> for EntryAnswer<'a> {
    fn from(cost: &'a EntryCost) -> Self {
        let section = |(name, operations): &'a (String, Operations)| SectionAnswer {
            name,
            operations: operations.into(),
        };
        let Nanoseconds { interpreter, native, compiled, lanes4, lanes8 } = cost.ns;
        Self {
            operations: (&cost.operations).into(),
            sections: cost.sections.iter().map(section).collect(),
            ns: NanosecondsAnswer { interpreter, native, compiled, lanes4, lanes8 },
        }
    }
}

/// A turn.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct TurnCost {
    /// What ran the equations.
    pub backend: &'static str,
    /// Length of the turn [s].
    pub time_s: f64,
    /// Accepted steps.
    pub steps: u64,
    /// Evaluations of the equations.
    pub evaluations: u64,
    /// Time that it took here [ms].
    pub milliseconds: f64,
}

/// Generated code.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct GenerateAnswer<'a> {
    /// Name of the mechanism.
    pub name: &'a str,
    /// Operations of all functions.
    pub operations: OperationsAnswer,
    /// Number of functions.
    pub functions: usize,
    /// Statements of generated code.
    pub statements: usize,
    /// Time that generation took here [s].
    pub seconds: f64,
    /// Each function.
    pub entry_points: Vec<FunctionAnswer<'a>>,
    /// Whether the mass matrix is left out of `equations_of_motion`, as it is of long mechanisms: zeros stand in its place.
    pub mass_left_out: bool,
    /// Remarks on the file.
    #[cfg_attr(test, schemars(with = "Vec<Remark>"))]
    pub warnings: Vec<Value>,
    /// Files written, or compared with `--check`.
    pub files: Vec<String>,
    /// The source, where no file was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
}

/// A function of generated code.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct FunctionAnswer<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its operations.
    pub operations: OperationsAnswer,
    /// Its statements.
    pub statements: usize,
    /// Functions that its code is split into.
    pub parts: usize,
}

/// A unit of FMI 3.0.
#[cfg(any(feature = "fmu", test))]
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct FmuAnswer<'a> {
    /// Name of the mechanism.
    pub name: &'a str,
    /// The file.
    pub file: String,
    /// Its size.
    pub bytes: usize,
    /// Time that it took here [s].
    pub seconds: f64,
    /// Remarks on the mechanism's file.
    #[cfg_attr(test, schemars(with = "Vec<Remark>"))]
    pub warnings: Vec<Value>,
}

/// A page or a picture of a mechanism.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[cfg_attr(not(feature = "page"), expect(dead_code, reason = "the schemas of all outputs are kept"))]
pub struct PageAnswer {
    /// The file.
    pub file: String,
    /// Its size.
    pub bytes: usize,
    /// Time that it took here [s].
    pub seconds: f64,
}

/// A starter file.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct NewAnswer {
    /// The file.
    pub file: String,
    /// Commands to go on with, in this order.
    pub next: Vec<String>,
}

/// A mechanism file made from another format.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct ImportAnswer {
    /// The file.
    pub file: String,
    /// Name of the mechanism.
    pub name: String,
    /// Its bodies.
    pub bodies: usize,
    /// Its joints.
    pub joints: usize,
    /// What was not carried over, or was changed on the way.
    pub left_out: Vec<String>,
    /// What a part is; absent for robots.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<PartAnswer>,
}

/// A part made from a mesh.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct PartAnswer {
    /// Triangles of the mesh.
    pub triangles: usize,
    /// Its extent along the axes of the mesh [m].
    pub size_m: [f64; 3],
    /// Volume [m^3].
    pub volume_m3: f64,
    /// Density [kg/m^3].
    pub density_kg_m3: f64,
    /// Mass [kg].
    pub mass_kg: f64,
    /// Centre of mass, in the frame of the mesh [m].
    pub centre_m: [f64; 3],
    /// About the centre, along the axes of the mesh: xx, yy, zz, xy, xz, yz as entries of the matrix [kg m^2].
    pub inertia_kg_m2: [f64; 6],
}

/// Manual pages.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct PagesAnswer {
    /// The page (troff); absent where pages are written to files.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub text: Option<String>,
    /// Files that were written; absent where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<String>,
}

/// A text: a completion script.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct TextAnswer {
    /// It.
    pub text: String,
}
