//! `life --fit`: which fit is for which joint, and whether its data can be a life's. In: arguments. Out: [`Fits`].

use std::path::{Path, PathBuf};

use linkwear::life::JointFit;
use linkwear_gamma::life::Estimate;
use linkwear_gamma::process::{Gamma, Process as _};
use linkwear_runtime::Description;

use super::super::arguments::LifeArguments;
use super::super::failure::Failure;
use super::super::fit_file;
use super::super::table::number;

/// Beyond this a fit's wear is not that of the mechanism, but in other units.
const CREDIBLE: f64 = 100.0;

/// Fits for joints, and what is doubtful about them.
pub struct Fits {
    pub fits: Vec<JointFit>,
    pub warnings: Vec<String>,
}

impl Fits {
    /// Reads each file once.
    pub fn read(arguments: &LifeArguments, description: &Description) -> Result<Self, Failure> {
        let contacts = description.contacts.iter().filter(|contact| contact.wear.is_some());
        let joints: Vec<&str> = contacts.map(|contact| &*contact.joint).collect();
        let mut found = Self { fits: Vec::new(), warnings: Vec::new() };
        for (joint, path) in joints.iter().zip(assigned(arguments, &joints)?) {
            let Some(path) = path else { continue };
            let from = path.display().to_string();
            let known = found.fits.iter().find(|fit| fit.from == from);
            let estimate = match known {
                Some(known) => known.estimate.clone(),
                None => found.estimate(&path)?,
            };
            found.fits.push(JointFit { joint: (*joint).to_owned(), from, estimate });
        }
        Ok(found)
    }

    /// alpha and beta of a file.
    fn estimate(&mut self, path: &Path) -> Result<Estimate, Failure> {
        let file = fit_file::read(path)?;
        let again = "fit wear in um over Lambda: `linkwear life FILE --mean --format json > life.json`, then `linkwear \
                     fit .. --exposure CYCLES --lambda life.json`";
        let refused = |key: &str, message: &str, help: &str| {
            Err(fit_file::refused(path, file.fault(key, message, help)))
        };
        if file.process.name() != Gamma.name() {
            let message =
                format!("the fit is of the {} process: `life` draws Gamma increments", file.process.title());
            return refused("process", &message, "fit it without --process");
        }
        if file.exponent.is_some() {
            let message = "the fit has an exponent of exposure: in `life` physics says how wear goes on";
            return refused("exponent", message, again);
        }
        if !file.covariates.is_empty() {
            let message = "the fit has covariates: in `life` physics says what load does";
            return refused("covariates", message, again);
        }
        if file.over_lambda == Some(false) {
            let message = "the fit is over an exposure as it is, so its alpha is not one per um of Lambda";
            return refused("over_lambda", message, again);
        }
        let estimate = file.estimate(&[]).map_err(|error| fit_file::refused(path, error))?;
        let [alpha, beta] = estimate.parameters();
        let ratio = alpha / beta;
        if !(1.0 / CREDIBLE..=CREDIBLE).contains(&ratio) {
            let message = format!("by this fit wear grows {} times as fast as Lambda", number(ratio));
            let help = "count both wear and Lambda in um; if they are, correct the wear coefficient of the mechanism's \
                        file and fit again";
            return refused("alpha", &message, help);
        }
        self.warnings.extend(file.warning().map(str::to_owned));
        Ok(estimate)
    }
}

/// The fit's file of each wearing joint.
fn assigned(arguments: &LifeArguments, joints: &[&str]) -> Result<Vec<Option<PathBuf>>, Failure> {
    let mut files = vec![None; joints.len()];
    for text in &arguments.fit {
        let named = text.split_once('=').and_then(|(name, path)| {
            let at = joints.iter().position(|joint| *joint == name.trim())?;
            Some((at, path.trim()))
        });
        let bare =
            (joints.len() == 1 && (!text.contains('=') || Path::new(text).exists())).then_some((0, &**text));
        let Some((at, path)) = named.or(bare) else {
            let message = format!("--fit {text} does not say for which wearing joint it is");
            let help = format!("write --fit JOINT=FIT.json; wearing joints: {}", joints.join(", "));
            return Err(Failure::Usage { message, help });
        };
        if files[at].replace(PathBuf::from(path)).is_some() {
            let message = format!("joint `{}` has two fits", joints[at]);
            return Err(Failure::Usage { message, help: "give one --fit for each joint".to_owned() });
        }
    }
    Ok(files)
}
