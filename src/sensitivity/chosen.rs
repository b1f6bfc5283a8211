//! By which parameters something is differentiated. In: a file, the names that were asked for. Out: the mechanism on both sides of each
//! of them, in one form of its equations, and why some are left out.

use linkwear_codegen::model::Parameter;
use linkwear_codegen::{Options, SourceFile};
use linkwear_runtime::Watch;

use super::error::SensitivityError;
use super::result::LeftOut;
use super::varied::{Sides, Variant};

/// Both sides of every parameter; the first error, if there is none of those that were asked for.
///
/// Numbers of a file may meet by accident: a mass of 50 beside an inertia of 0.02 makes a factor of one, which the equations leave out.
/// Beside such a value they have one form, on both sides the same. All is compiled with that parameter a hair off then, and the base
/// takes the form that this gives.
pub(super) fn chosen(
    (source, options): (&SourceFile, &Options),
    asked: Option<&[String]>,
    base: &mut Variant,
    watch: Watch<'_>,
) -> Result<(Vec<Sides>, Vec<LeftOut>), SensitivityError> {
    let parameters = named(&base.compiled.mechanism.parameters, asked)?;
    let (mut options, mut met) = (options.clone(), Vec::new());
    loop {
        let (sides, refused) = sides((source, &options), &parameters, base, watch)?;
        let special = refused.iter().find_map(|(parameter, error)| {
            let is_new =
                matches!(error, SensitivityError::OtherForm { .. }) && !met.contains(&parameter.name);
            Some((*parameter, is_new.then(|| Variant::beside(parameter, met.len()))??))
        });
        let Some((parameter, set)) = special else {
            return told(sides, refused, asked.is_some());
        };
        met.push(parameter.name.clone());
        let mut beside = options.clone();
        beside.overrides.push(set);
        // Where it differs from one side to the other, no form serves both.
        if let Ok(general) = Variant::new(source, &beside)
            && general.sides(source, &beside, parameter).is_ok()
        {
            base.take_form(general);
            options = beside;
        }
    }
}

fn named(all: &[Parameter], asked: Option<&[String]>) -> Result<Vec<Parameter>, SensitivityError> {
    let Some(asked) = asked else {
        return if all.is_empty() { Err(SensitivityError::NoParameters) } else { Ok(all.to_vec()) };
    };
    let one = |name: &String| {
        let known = || all.iter().map(|parameter| parameter.name.clone()).collect();
        let unknown = || SensitivityError::UnknownParameter { parameter: name.clone(), known: known() };
        all.iter().find(|one| one.name == *name).cloned().ok_or_else(unknown)
    };
    asked.iter().map(one).collect()
}

/// A parameter that is left out, and why.
type Refused<'p> = (&'p Parameter, SensitivityError);

fn sides<'p>(
    (source, options): (&SourceFile, &Options),
    parameters: &'p [Parameter],
    base: &Variant,
    watch: Watch<'_>,
) -> Result<(Vec<Sides>, Vec<Refused<'p>>), SensitivityError> {
    let (mut sides, mut refused) = (Vec::new(), Vec::new());
    for (place, parameter) in parameters.iter().enumerate() {
        if watch.report(place as f64 / parameters.len() as f64).is_break() {
            return Err(SensitivityError::Interrupted);
        }
        match base.sides(source, options, parameter) {
            Ok(found) => sides.push(found),
            Err(error) => refused.push((parameter, error)),
        }
    }
    Ok((sides, refused))
}

fn told(
    sides: Vec<Sides>,
    refused: Vec<Refused<'_>>,
    is_asked: bool,
) -> Result<(Vec<Sides>, Vec<LeftOut>), SensitivityError> {
    let reason = |(parameter, error): &Refused<'_>| LeftOut {
        parameter: parameter.name.clone(),
        reason: error.to_string(),
    };
    let left_out = refused.iter().map(reason).collect();
    match refused.into_iter().next() {
        Some((_, error)) if is_asked && sides.is_empty() => Err(error),
        _ => Ok((sides, left_out)),
    }
}
