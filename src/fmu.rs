//! Units of FMI 3.0 of a mechanism: one file that tools of other makers load and run. In: a compiled mechanism. Out: its bytes.
//!
//! The library inside is the same for every mechanism and comes with this program, which needs no compiler to make a unit.

mod archive;
mod description;
mod names;
mod si;
mod sources;

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use hmac_sha256::Hash;
use linkwear_codegen::Compiled;
use linkwear_fmu::{Constant, PROGRAM_FILE, Unit};
use linkwear_runtime::{Description, Integrator, SINGULAR_PIVOT, TurnRunner};
use linkwear_tape::Program;
use linkwear_tape::stored::Damage;
use thiserror::Error;

use archive::Archive;

/// The library, for the processor that this program was built for.
static LIBRARY: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/unit-library"));

/// Length of a run of a mechanism that does not turn [s].
const ONE_SECOND: f64 = 1.0;

/// Why there is no unit.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum UnitError {
    /// This program came without the library.
    #[error("this linkwear was built without the library for units; build it from its repository")]
    NoLibrary,
    /// The equations do not fit together.
    #[error(transparent)]
    Program(#[from] Damage),
}

/// What a unit is called where: the folder of the library tells the platform.
fn platform() -> String {
    let system = match std::env::consts::OS {
        "macos" => "darwin",
        other => other,
    };
    format!("{}-{system}", std::env::consts::ARCH)
}

/// A unit of a mechanism, as bytes of a file that ends in `.fmu`.
///
/// # Errors
/// [`UnitError`].
pub fn unit(mechanism: &Compiled) -> Result<Vec<u8>, UnitError> {
    if LIBRARY.is_empty() {
        return Err(UnitError::NoLibrary);
    }
    let program = Program::new(in_angles(mechanism), mechanism.tapes().to_vec())?;
    let folded = mechanism.mechanism.parameters.iter().filter(|one| !one.tunable && !one.input);
    let constants = folded.map(|one| Constant {
        name: one.name.clone(),
        unit: one.dimension.unit_counting(one.turning),
        value: one.value,
    });
    let mut unit = Unit { program, constants: constants.collect(), instantiation_token: String::new() };
    unit.instantiation_token = instantiation_token(&unit);
    let name = &unit.program.description().name;
    let stop = turn(mechanism).unwrap_or(ONE_SECOND);
    let mut archive = Archive::new();
    archive.add("modelDescription.xml", description::model_description(&unit, stop).as_bytes());
    archive.add(&format!("binaries/{}/{name}{}", platform(), std::env::consts::DLL_SUFFIX), LIBRARY);
    archive.add(&format!("resources/{PROGRAM_FILE}"), &unit.to_bytes());
    for (name, text) in sources::sources(mechanism, &unit, stop) {
        archive.add(&format!("sources/{name}"), text.as_bytes());
    }
    archive.add("documentation/index.html", description::documentation(&unit).as_bytes());
    Ok(archive.finish())
}

/// What is known of a mechanism, with parameters in rad, rad/s or Hz where the file says that they count these: a tool cannot ask.
fn in_angles(mechanism: &Compiled) -> Description {
    let mut description = mechanism.description().clone();
    for info in description.parameters.to_mut() {
        if let Some(known) = mechanism.mechanism.parameters.iter().find(|known| *known.name == *info.name) {
            info.unit = known.dimension.unit_counting(known.turning).into();
        }
    }
    description
}

/// Whether a file is a unit, by how it begins.
pub fn is_unit(file: &Path) -> bool {
    let mut head = [0; 50];
    let read = File::open(file).and_then(|mut file| file.read_exact(&mut head));
    read.is_ok() && head[..4] == *b"PK\x03\x04" && head[30..] == *b"modelDescription.xml"
}

/// Tells a unit from all others, by what is in it.
fn instantiation_token(unit: &Unit) -> String {
    let digest = Hash::hash(&unit.to_bytes());
    let hex: String = digest.iter().take(16).map(|byte| format!("{byte:02x}")).collect();
    format!("{{{}-{}-{}-{}-{}}}", &hex[..8], &hex[8..12], &hex[12..16], &hex[16..20], &hex[20..])
}

/// How long a turn lasts [s], if turns last equally long.
fn turn(mechanism: &Compiled) -> Option<f64> {
    let (description, system): (&Description, _) = (mechanism.description(), mechanism.interpreter());
    let integrator = Integrator::adaptive(description, None);
    let parameters = mechanism.parameters();
    TurnRunner::new(system.on_numbers(), description, &parameters, integrator, SINGULAR_PIVOT)
        .ok()?
        .seconds_per_turn()
        .ok()?
}
