//! Several joints of one machine, each with its fit. In: files and numbers of the command line. Out: the life of the machine.

use std::path::Path;

use linkwear_gamma::life::OperatingState;
use linkwear_gamma::{Covariate, FitFile, Machine, Member, Questions};
use serde_json::{Value, json};

use super::super::arguments::PredictArguments;
use super::super::failure::Failure;
use super::super::input::read_fit;
use super::super::value::OtherJoint;
use super::refused::asked;
use crate::checksum::sha256_of;

/// A machine with the names that its joints are told by: those of their files.
pub struct Joints {
    pub names: Vec<String>,
    pub life: Machine,
    /// Of each further joint, its file's checksum and how far it is worn.
    others: Vec<Value>,
}

impl Joints {
    /// What provenance tells of them.
    pub fn options(&self) -> Value {
        json!(self.others)
    }
}

/// The fits of the other joints.
pub fn others(arguments: &PredictArguments) -> Result<Vec<FitFile>, Failure> {
    arguments.also.iter().map(|joint| read_fit(&joint.fit)).collect()
}

/// The values of covariates that a fit knows; one that no fit knows is left for the first to refuse.
pub fn known(arguments: &PredictArguments, fit: &FitFile, others: &[FitFile]) -> Vec<(String, f64)> {
    let knows = |fit: &FitFile, name: &str| fit.covariates.iter().any(|known| known.name == name);
    let is_for = |name: &str| knows(fit, name) || !others.iter().any(|other| knows(other, name));
    arguments.covariate.iter().filter(|(name, _)| is_for(name)).cloned().collect()
}

/// The machine, if there are other joints.
pub fn machine(
    arguments: &PredictArguments,
    (first, fit): (Member, &FitFile),
    others: &[FitFile],
    questions: &Questions,
) -> Result<Option<Joints>, Failure> {
    if others.is_empty() {
        return Ok(None);
    }
    let mut members = vec![first];
    let mut told = Vec::new();
    for (fit, joint) in others.iter().zip(&arguments.also) {
        members.push(member(arguments, fit, joint)?);
        told.push(json!({
            "fit_sha256": sha256_of(fit.text().as_bytes()), "threshold": joint.threshold,
            "current": joint.current, "at": joint.at,
        }));
    }
    let files = std::iter::once(&arguments.fit).chain(arguments.also.iter().map(|joint| &joint.fit));
    let mut life = Machine::new(&members, questions).map_err(|error| asked(arguments, &error))?;
    let texts: Vec<&str> = std::iter::once(fit).chain(others).map(FitFile::text).collect();
    if (1..texts.len()).any(|at| texts[..at].contains(&texts[at])) {
        life.warnings.push(
            "joints of the machine go by the same fit: what it leaves open is taken as independent, so bands and interval of the machine are too narrow"
                .to_owned(),
        );
    }
    for (at, (other, joint)) in others.iter().zip(&arguments.also).enumerate() {
        let mut before =
            std::iter::once(&arguments.fit).chain(arguments.also[..at].iter().map(|also| &also.fit));
        if before.all(|before| *before != joint.fit) {
            life.warnings.extend(far(&joint.fit, other, &values_of(arguments, other)));
        }
        // Units are words of the data: two for one unit are no fault.
        if !fit.exposure_unit.is_empty() && fit.exposure_unit != other.exposure_unit {
            life.warnings.push(format!(
                "exposure is `{}` in {} and `{}` in {}: both have to be the same, by one rate",
                fit.exposure_unit,
                arguments.fit.display(),
                other.exposure_unit,
                joint.fit.display()
            ));
        }
    }
    Ok(Some(Joints { names: names(files.map(AsRef::as_ref)), life, others: told }))
}

/// Warnings of covariates far outside the data of one fit of several, with its file.
pub fn far(file: &Path, fit: &FitFile, values: &[(String, f64)]) -> Vec<String> {
    let told = fit.far_covariates(values).into_iter();
    told.map(|warning| format!("{}: {warning}", file.display())).collect()
}

/// The values of the covariates of one fit.
fn values_of(arguments: &PredictArguments, fit: &FitFile) -> Vec<(String, f64)> {
    let given = |known: &Covariate| arguments.covariate.iter().find(|(name, _)| *name == known.name);
    fit.covariates.iter().filter_map(given).cloned().collect()
}

fn member(arguments: &PredictArguments, fit: &FitFile, joint: &OtherJoint) -> Result<Member, Failure> {
    let estimate = fit.informed(&values_of(arguments, fit)).map_err(Failure::fit(&joint.fit))?;
    let worn = (joint.current, joint.at);
    let state = OperatingState::of(&estimate, joint.threshold, arguments.rate, worn)
        .map_err(|error| Failure::data(&joint.fit, None, error, "see --also in `linkwear predict --help`"))?;
    Ok(Member { estimate, state })
}

/// The files' names without their ends, with a number where two are the same.
fn names<'a>(files: impl Iterator<Item = &'a Path>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for file in files {
        let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let again = names.iter().filter(|name| name.split(' ').next() == Some(stem.as_str())).count();
        names.push(if again == 0 { stem } else { format!("{stem} {}", again + 1) });
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_are_told_apart_by_their_files() {
        let files = ["a/left.json", "right.json", "b/left.json"].map(Path::new);
        assert_eq!(names(files.into_iter()), ["left", "right", "left 2"]);
    }
}
