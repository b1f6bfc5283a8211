//! `life --fit`: which file is for which joint. In: arguments. Out: fits, and what is doubtful about them.

use std::path::Path;

use crate::life::JointFit;
use linkwear_runtime::Description;

use super::super::failure::Failure;
use super::super::input::read_fit;

/// Reads the fits, in the order of the wearing joints.
pub fn fits(given: &[String], description: &Description) -> Result<(Vec<JointFit>, Vec<String>), Failure> {
    let contacts = description.contacts.iter().filter(|contact| contact.wear.is_some());
    let joints: Vec<&str> = contacts.map(|contact| &*contact.joint).collect();
    let mut assigned = given.iter().map(|text| assign(text, &joints)).collect::<Result<Vec<_>, _>>()?;
    assigned.sort_by_key(|(joint, _)| *joint);
    let (mut fits, mut warnings) = (Vec::new(), Vec::new());
    for (at, (joint, path)) in assigned.iter().enumerate() {
        let file = read_fit(path)?;
        let fit = JointFit::new(joints[*joint], path.display().to_string(), &file);
        fits.push(fit.map_err(|error| Failure::fit(path)(error.located(&file)))?);
        if !assigned[..at].iter().any(|(_, before)| before == path) {
            warnings.extend(file.warning().map(str::to_owned));
        }
    }
    Ok((fits, warnings))
}

/// The joint, by its place among those that wear, and the file of one `--fit`.
fn assign<'a>(text: &'a str, joints: &[&str]) -> Result<(usize, &'a Path), Failure> {
    let named = text.split_once('=').and_then(|(name, path)| {
        let at = joints.iter().position(|joint| *joint == name.trim())?;
        Some((at, Path::new(path.trim())))
    });
    let is_bare = joints.len() == 1 && (!text.contains('=') || Path::new(text).exists());
    named.or(is_bare.then_some((0, Path::new(text)))).ok_or_else(|| {
        if joints.is_empty() {
            let help = "leave --fit out, or add [clearance.R1] and [wear.R1], R1 being the joint that wears";
            return Failure::usage(format!("--fit {text}: no joint of this mechanism wears"), help);
        }
        let help = format!("write --fit JOINT=FIT.json; wearing joints: {}", joints.join(", "));
        Failure::usage(format!("--fit {text} does not say for which wearing joint it is"), help)
    })
}
