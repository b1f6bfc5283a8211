//! `identify`: parameters of a mechanism from what was measured of its machine.

mod arguments;
mod output;
mod read;

use std::path::Path;

use linkwear_codegen::spec::unit_size;
use linkwear_runtime::{Integrator, RevolutionSettings};
use serde_json::{Map, Value, json};

pub use self::arguments::IdentifyArguments;
use super::answer::Answer;
use super::failure::Failure;
use super::input::{options, print_remarks};
#[cfg(feature = "page")]
use super::picture;
use super::simulate::method;
use crate::identify::{Clocks, Free, IdentifyError, IdentifySettings, Inspections, Machine, identify};
use crate::mechanism::read_source;
use crate::progress::watched;
use crate::provenance::Provenance;
use crate::study::{Cases, Points};

pub fn run(arguments: &IdentifyArguments) -> Result<Answer, Failure> {
    let file = &arguments.input.file;
    #[cfg(feature = "page")]
    picture::check_plot(&[file], arguments.plot.as_deref(), arguments.replace)?;
    let method = method(arguments.integrator, (arguments.step, arguments.tol))?;
    let free = free(arguments)?;
    let points = Points::sobol(arguments.free.clone(), 1, arguments.seed.into());
    let points = points.map_err(|error| Failure::usage(format!("--free: {error}"), RANGE))?;
    let choice = arguments.equations;
    let cases = Cases::new(
        &read_source(file)?,
        &options(&arguments.input, choice.rigid),
        choice.backend,
        ("--free", &points),
    )?;
    let base = cases.base();
    print_remarks(base);
    let integrator = method.unwrap_or_else(|| Integrator::adaptive(&base.description, arguments.tol));
    let curve = read::curve(arguments, &base.description, integrator)?;
    let inspections = read::inspections(arguments, &base.description)?;
    let hashes: Vec<String> =
        curve.iter().map(|(_, hash)| hash).chain(inspections.iter().map(|(_, hash)| hash)).cloned().collect();
    let inspections: Vec<Inspections> = inspections.into_iter().map(|(one, _)| one).collect();
    let revolutions = revolutions(method);
    let machine =
        Machine::new(&cases, &free, (curve.map(|(curve, _)| curve), inspections.clone()), revolutions);
    let readings = machine.readings().map_err(|error| failed(arguments, error))?;
    let units: Vec<(f64, String)> = free.iter().map(|one| unit(one, &cases)).collect();
    let settings = IdentifySettings {
        starts: arguments.starts,
        seed: arguments.seed,
        profiles: !arguments.no_profile,
        begin: begin(&free, &cases, &units),
    };
    let found = watched("search", |watch| identify(&free, &readings, &machine, &settings, watch));
    let found = found.map_err(|error| failed(arguments, error))?;
    let of_wear = found.groups.iter().skip(readings.groups().len() - inspections.len());
    let clocks = of_wear.map(|group| Clocks::of(group, free.len())).collect::<Result<Vec<_>, _>>();
    let clocks: Vec<Clocks> =
        clocks.map_err(|error| failed(arguments, error))?.into_iter().flatten().collect();
    #[cfg(feature = "page")]
    picture::write_plot(arguments.plot.as_deref(), || crate::page::identified_picture(&found))?;
    let told = output::Told { name: &base.description.name, found: &found, clocks: &clocks, units: &units };
    Ok(output::answer(&told, &provenance(arguments, &cases, (&hashes, integrator))))
}

const RANGE: &str = "write --free NAME=LO..HI, as --free c0=\"5um..50um\"";

fn free(arguments: &IdentifyArguments) -> Result<Vec<Free>, Failure> {
    let set = arguments.input.overrides.iter().map(|(name, _)| name);
    if let Some(name) = set.into_iter().find(|name| arguments.free.iter().any(|axis| axis.name == **name)) {
        return Err(Failure::usage(format!("`{name}` is set and free"), "leave --set or --free out"));
    }
    let wrong = |error| Failure::usage(format!("--free: {error}"), RANGE);
    arguments.free.iter().map(|axis| Free::new(axis).map_err(wrong)).collect()
}

/// Revolutions of lives by the method that was asked for.
fn revolutions(method: Option<Integrator>) -> RevolutionSettings {
    let default = RevolutionSettings::default();
    RevolutionSettings { integrator: method.unwrap_or(default.integrator), ..default }
}

/// Size of the unit of a parameter's bounds, and the SI unit.
fn unit(free: &Free, cases: &Cases) -> (f64, String) {
    let size = unit_size(&free.unit).map_or(1.0, |unit| unit.size());
    let column = cases.parameters().iter().find(|column| column.name == free.name);
    (size, column.map_or_else(String::new, |column| column.unit.clone()))
}

/// The values of the file, if all of them are known.
fn begin(free: &[Free], cases: &Cases, units: &[(f64, String)]) -> Option<Vec<f64>> {
    let mechanism = cases.base();
    let known = mechanism.description.parameters.iter().zip(&mechanism.parameters);
    let value = |(free, (size, _)): (&Free, &(f64, String))| {
        let found = known.clone().find(|(info, _)| *info.name == *free.name);
        found.map(|(_, value)| value / size)
    };
    free.iter().zip(units).map(value).collect()
}

fn provenance(
    arguments: &IdentifyArguments,
    cases: &Cases,
    (hashes, integrator): (&[String], Integrator),
) -> Provenance {
    let free: Map<_, _> =
        arguments.free.iter().map(|axis| (axis.name.clone(), json!(axis.written))).collect();
    let noise: Map<_, _> = arguments.noise.iter().map(|(name, level)| (name.clone(), json!(level))).collect();
    let options = json!({
        "bounds": free,
        "measurements_sha256": hashes,
        "of": (!arguments.of.is_empty()).then_some(&arguments.of),
        "noise": (!noise.is_empty()).then_some(noise),
        "settle_turns": arguments.settle,
        "time": arguments.time,
        "revolutions": arguments.revolutions,
        "wear": arguments.wear,
        "gauge": arguments.gauge,
        "starts": arguments.starts,
        "profiles": !arguments.no_profile,
        "step_s": arguments.step,
        "tolerance": integrator.tolerance(),
    });
    cases.base().provenance(
        Some(arguments.seed.into()),
        Value::Object(options.as_object().cloned().unwrap_or_default()),
    )
}

/// Why nothing was found, and what to do about it.
fn failed(arguments: &IdentifyArguments, error: IdentifyError) -> Failure {
    let file = &*arguments.input.file;
    let inspections = || arguments.inspections.first().map(|(_, file)| Path::new(file));
    let data = arguments.measured.as_deref().or_else(inspections).unwrap_or(file);
    match &error {
        IdentifyError::NothingFree | IdentifyError::Twice(_) => {
            Failure::usage(format!("--free: {error}"), RANGE)
        }
        IdentifyError::TooFew { .. } => {
            Failure::data(data, None, &error, "measure more, or free fewer parameters")
        }
        IdentifyError::Number { .. } => Failure::data(data, None, &error, "correct the number"),
        IdentifyError::Constant { .. } => {
            let help = "leave it out by --of, or give its noise by --noise or --gauge";
            Failure::data(data, None, &error, help)
        }
        IdentifyError::NoInfluence(name) => {
            let help = format!("leave --free {name} out, or measure something that it changes");
            Failure::no_influence(file, &error, help)
        }
        IdentifyError::NothingRuns { first, .. } => {
            let help = if first.help.is_empty() { "look at the bounds" } else { &first.help };
            Failure::empty_study(Some(file), &error, help)
        }
        IdentifyError::Interrupted(_) => Failure::stopped(file, &error, "a search begins anew"),
    }
}
