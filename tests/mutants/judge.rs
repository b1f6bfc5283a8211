//! What a success must be: finite, balanced, closed, not pressed through its bearings. In: what the program printed and
//! wrote. Out: why not.

use std::fs;

use linkwear_codegen::compile::{Compiled, Options, compile};
use linkwear_codegen::source::SourceFile;
use linkwear_oracle::Oracle;
use serde_json::Value;

use crate::agreement::compare;

/// The program itself refuses from these parts on; a success beyond is a wrong number.
const ENERGY: f64 = 0.1;
const LOOPS: f64 = 1e-4;
const PENETRATION: f64 = 0.1;
/// Part of a quantity's scale by which accelerations, forces and energies may differ from the independent model's: both
/// are exact but for rounding, which sizes a million times apart and poorly closed states amplify.
const AGREEMENT: f64 = 1e-6;
/// Last places of the largest angle by which forces may differ, as a part of them: an angle of 1e11 rad stands in its turn to
/// 1e-5 rad only, both models take sums of several such angles, and where forces cancel a part of them is more.
const LAST_PLACES: f64 = 10.0;
/// Rounding of energies that cancel.
const ROUNDING: f64 = 1e-9;

/// A table of the program: titles without units, and rows.
struct Table {
    titles: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn read(file: &str) -> Result<Self, String> {
        let text = fs::read_to_string(file).map_err(|error| error.to_string())?;
        let mut lines = text.lines();
        let titles = lines.next().unwrap_or_default().split(',').map(str::to_owned).collect();
        let cell = |cell: &str| {
            let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
            value.ok_or_else(|| format!("`{cell}` in the table"))
        };
        let rows = lines.map(|line| line.split(',').map(cell).collect()).collect::<Result<_, _>>()?;
        Ok(Self { titles, rows })
    }

    /// Largest magnitude in columns of this name.
    fn largest(&self, is: impl Fn(&str) -> bool) -> f64 {
        let places: Vec<usize> = (0..self.titles.len()).filter(|at| is(&self.titles[*at])).collect();
        self.rows.iter().flat_map(|row| places.iter().map(|at| row[*at].abs())).fold(0.0, f64::max)
    }

    fn least(&self, title: &str) -> f64 {
        let place = self.titles.iter().position(|other| other == title);
        place.map_or(0.0, |at| self.rows.iter().map(|row| row[at]).fold(f64::INFINITY, f64::min))
    }
}

/// Every number of the object, and none missing.
fn finite(object: &Value, keys: &[&str]) -> Result<Vec<f64>, String> {
    let number = |key: &&str| {
        let value = object[*key].as_f64().filter(|value| value.is_finite());
        value.ok_or_else(|| format!("{key} is {}", object[*key]))
    };
    keys.iter().map(number).collect()
}

/// Whether `check` found nothing that is hardly meant: sizes, masses and materials as they occur.
pub fn is_plausible(check: &Value) -> bool {
    let warnings = check["warnings"].as_array().into_iter().flatten();
    !warnings
        .filter_map(|warning| warning["code"].as_str())
        .any(|code| ("W0111"..="W0116").contains(&code) || code == "W0119")
}

/// A run that ended well, with its table.
pub fn simulated(answer: &Value, table: &str, mechanism: &str, is_plausible: bool) -> Result<(), String> {
    let keys = ["time_s", "energy_error_J", "energy_throughput_J", "max_loop_error_m", "max_loop_error_rad"];
    let numbers = finite(answer, &keys)?;
    let [_, error, throughput, metres, radians] = numbers[..] else { return Err("numbers".into()) };
    for peak in answer["peaks"].as_array().ok_or("no peaks")? {
        finite(peak, &["force_N", "moment_N_m", "force_time_s", "moment_time_s"])?;
    }
    for turn in answer["turns"].as_array().ok_or("no turns")? {
        finite(
            turn,
            &["wear_integral_J", "depth_m", "mean_normal_force_N", "peak_normal_force_N", "loss_J"],
        )?;
    }
    let table = Table::read(table)?;
    let stored = table.largest(|title| title.starts_with("energy."));
    let moves = table.largest(|title| title.ends_with("/s]"));
    if moves > ROUNDING && error > ENERGY * throughput && error > ROUNDING * stored {
        return Err(format!("{error:e} J missing of {throughput:e} J"));
    }
    let size = table.largest(|title| [".x [m]", ".y [m]", ".z [m]"].iter().any(|end| title.ends_with(end)));
    if radians > LOOPS || (size > 0.0 && metres > LOOPS * size) {
        return Err(format!("loops open by {metres:e} m, {radians:e} rad at a size of {size:e} m"));
    }
    let text = fs::read_to_string(mechanism).map_err(|error| error.to_string())?;
    let source = SourceFile { name: mechanism.to_owned(), text };
    let compiled = compile(&source, &Options::default()).map_err(|error| error.to_string())?;
    for contact in compiled.description().contacts.iter() {
        let gap = table.least(&format!("{}.gap [m]", contact.joint));
        if gap < -PENETRATION * contact.journal_radius {
            return Err(format!("{} pressed in by {:e} m", contact.joint, -gap));
        }
    }
    // Absolute coordinates weigh every body, also one of 1e80 kg whose motion is given.
    if is_plausible { agrees(&compiled, &table) } else { Ok(()) }
}

/// Some rows against the independent model, which knows rigid bodies and ideal joints.
fn agrees(compiled: &Compiled, table: &Table) -> Result<(), String> {
    let mechanism = &compiled.mechanism;
    let is_rigid = mechanism.bodies.iter().all(|body| body.flexible.is_none());
    // It takes singular values of matrices of six rows a body: minutes for a hundred of them.
    if !is_rigid || mechanism.bodies.len() > 20 || !compiled.description().contacts.is_empty() {
        return Ok(());
    }
    let Ok(oracle) = Oracle::with_defaults(mechanism) else { return Ok(()) };
    let rows = table.rows.iter().step_by(table.rows.len().div_ceil(5)).map(|row| (row[0], &row[..]));
    let named = |name: &str| table.titles.iter().position(|title| title.split(" [").next() == Some(name));
    let allowed = AGREEMENT + LAST_PLACES * f64::EPSILON * table.largest(|title| title.ends_with("[rad]"));
    match compare(&oracle, rows, &named).worst(1.0) {
        Some((name, error)) if error > allowed => Err(format!("{name} ({error:.1e})")),
        _ => Ok(()),
    }
}

/// A life that ended well.
pub fn lived(answer: &Value) -> Result<(), String> {
    let [mean, std] = finite(answer, &["mean", "std"])?[..] else { return Err("numbers".into()) };
    let quantiles = finite(&answer["quantiles"], &["p10", "p50", "p90"])?;
    let in_order = quantiles.windows(2).all(|pair| pair[0] <= pair[1]) && quantiles[0] >= 0.0;
    if mean < 0.0 || std < 0.0 || !in_order {
        return Err(format!("mean {mean}, std {std}, quantiles {quantiles:?}"));
    }
    let mut worn: Vec<f64> = Vec::new();
    for cycle in answer["cycles"].as_array().ok_or("no cycles")? {
        for (at, joint) in cycle["joints"].as_array().ok_or("no joints")?.iter().enumerate() {
            let keys =
                ["clearance_m", "wear_m", "dLambda_m", "wear_integral_J", "mean_force_N", "peak_force_N"];
            let numbers = finite(joint, &keys)?;
            let before = worn.get(at).copied().unwrap_or_default();
            if numbers[1] < before || numbers.iter().any(|number| *number < 0.0) {
                return Err(format!("wear of {} after {before}", joint));
            }
            worn.resize(worn.len().max(at + 1), 0.0);
            worn[at] = numbers[1];
        }
    }
    Ok(())
}
