//! The Gamma process of `life`. In: alpha and beta of the mechanism's file, fits that take their place, a shared factor.
//! Out: draws, mean increments, how uncertain a mean life is by the fits. Never knows how lives are lived.

use std::path::{Path, PathBuf};

use linkwear_gamma::life::{Estimate, LifeError};
use linkwear_gamma::monte_carlo::{GammaDraw, GammaMean, PER_METRE};
use linkwear_gamma::process::{Gamma, Process as _};
use linkwear_gamma::series::SharedFactor;
use linkwear_runtime::{Description, GammaRates};
use serde_json::{Value, json};

use super::super::arguments::LifeArguments;
use super::super::failure::Failure;
use super::super::fit_file;
use super::super::table::number;
use super::failed;

/// Step in ln alpha and ln beta for the derivatives of a mean life: curvature leaves an error of 1e-4 of them.
const STEP: f64 = 0.02;
/// Beyond this a fit's wear is not that of the mechanism, but in other units.
const CREDIBLE: f64 = 100.0;

/// Parameters of all wearing joints.
pub struct Process {
    joints: Vec<Own>,
    fits: Vec<FittedFile>,
    shared: Option<SharedFactor>,
    seed: u64,
    pub warnings: Vec<String>,
}

/// One joint.
struct Own {
    name: String,
    rates: GammaRates,
    /// Which of the fits gave them; none: the mechanism's file.
    fit: Option<usize>,
}

/// A fit; several joints may have the same, and then err together.
struct FittedFile {
    path: PathBuf,
    estimate: Estimate,
}

impl Process {
    /// Of the wearing joints; None where a joint has no parameters and nobody asks for random lives.
    pub fn of(arguments: &LifeArguments, description: &Description) -> Result<Option<Self>, Failure> {
        let contacts = || description.contacts.iter().filter(|contact| contact.wear.is_some());
        let names: Vec<&str> = contacts().map(|contact| &*contact.joint).collect();
        let files = assigned(arguments, &names)?;
        let mut own = Self {
            joints: Vec::new(),
            fits: Vec::new(),
            shared: shared(arguments)?,
            seed: arguments.seed,
            warnings: Vec::new(),
        };
        let asked = arguments.trajectories.is_some() || !arguments.fit.is_empty() || own.shared.is_some();
        for (contact, file) in contacts().zip(files) {
            let name = contact.joint.to_string();
            let fit = file.map(|path| own.fit(&path)).transpose()?;
            let of_file = contact.wear.and_then(|wear| wear.scatter);
            let Some(rates) = fit.map(|at| rates(&own.fits[at].estimate)).or(of_file) else {
                if !asked {
                    return Ok(None);
                }
                let message = format!("joint `{name}` has no Gamma process to draw from");
                let help = format!(
                    "add alpha = \"13.65 1/um\" to [wear.{name}], give --fit {name}=FIT.json, or leave \
                     --trajectories, --fit and --shared-factor out"
                );
                return Err(failed(arguments, &message, &help));
            };
            own.joints.push(Own { name, rates, fit });
        }
        Ok(Some(own))
    }

    /// Reads a fit once; its place among the fits.
    fn fit(&mut self, path: &Path) -> Result<usize, Failure> {
        if let Some(known) = self.fits.iter().position(|fit| fit.path == path) {
            return Ok(known);
        }
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
        self.fits.push(FittedFile { path: path.to_path_buf(), estimate });
        Ok(self.fits.len() - 1)
    }

    /// Random increments.
    pub fn draw(&self) -> GammaDraw {
        self.draw_of(&self.rates())
    }

    /// The mean increments, alpha dLambda / beta.
    pub fn mean(&self) -> GammaMean {
        GammaMean::new(&self.rates())
    }

    fn rates(&self) -> Vec<GammaRates> {
        self.joints.iter().map(|joint| joint.rates).collect()
    }

    fn draw_of(&self, rates: &[GammaRates]) -> GammaDraw {
        let draw = GammaDraw::new(self.seed, rates);
        match self.shared {
            Some(factor) => draw.sharing(factor).expect("a positive number by the command line"),
            None => draw,
        }
    }

    /// Standard error that the fits' covariances leave to a mean life, to first order in the logarithms of alpha and
    /// beta; None without a covariance. `mean_life` lives by a draw, always with the same random numbers, so that
    /// what they do cancels in the differences. Different fits err independently.
    pub fn uncertainty<E>(
        &self,
        mean_life: &mut dyn FnMut(&GammaDraw) -> Result<f64, E>,
    ) -> Result<Option<f64>, E> {
        let uncertain = self.fits.iter().enumerate().filter(|(_, fit)| fit.estimate.is_uncertain());
        let mut variance = None;
        for (at, fit) in uncertain {
            let mut gradient = [0.0; 2];
            for (which, slope) in gradient.iter_mut().enumerate() {
                let [up, down] = [STEP, -STEP].map(|step| mean_life(&self.shifted(at, which, step)));
                *slope = (up? - down?) / (2.0 * STEP);
            }
            *variance.get_or_insert(0.0) += fit.estimate.variance(&gradient);
        }
        Ok(variance.map(f64::sqrt))
    }

    /// The same of the mean path that ends when this joint fails: wear per cycle is alpha / beta times what the worn
    /// joint wears by physics, so the path's life goes as beta / alpha. What other joints' fits do to it is left out.
    pub fn uncertainty_of_mean_path(&self, joint: usize, cycles: f64) -> Option<f64> {
        let estimate = &self.fits[self.joints[joint].fit?].estimate;
        estimate.is_uncertain().then(|| cycles * estimate.variance(&[-1.0, 1.0]).sqrt())
    }

    /// Draws with ln alpha (0) or ln beta (1) of one fit moved by a step.
    fn shifted(&self, fit: usize, which: usize, step: f64) -> GammaDraw {
        let mut rates = self.rates();
        for (rates, _) in rates.iter_mut().zip(&self.joints).filter(|(_, joint)| joint.fit == Some(fit)) {
            let value = if which == 0 { &mut rates.alpha } else { &mut rates.beta };
            *value *= step.exp();
        }
        self.draw_of(&rates)
    }

    /// Whether any parameters come from a fit.
    pub fn is_fitted(&self) -> bool {
        !self.fits.is_empty()
    }

    fn source(&self, joint: &Own) -> String {
        joint.fit.map_or_else(|| "file".to_owned(), |at| self.fits[at].path.display().to_string())
    }

    /// For machines.
    pub fn machine(&self) -> Value {
        let joint = |joint: &Own| {
            json!({
                "joint": joint.name,
                "alpha_per_um": joint.rates.alpha / PER_METRE,
                "beta_per_um": joint.rates.beta / PER_METRE,
                "from": self.source(joint),
            })
        };
        self.joints.iter().map(joint).collect()
    }

    /// One line for each joint, where not all parameters are those of the mechanism's file.
    pub fn human(&self) -> String {
        let line = |joint: &Own| {
            let from = match joint.fit {
                Some(_) => format!("from `{}`", self.source(joint)),
                None => "from the mechanism's file, taken as known".to_owned(),
            };
            let (alpha, beta) = (joint.rates.alpha / PER_METRE, joint.rates.beta / PER_METRE);
            format!("{}: alpha {}/um, beta {}/um, {from}\n", joint.name, number(alpha), number(beta))
        };
        if self.is_fitted() { self.joints.iter().map(line).collect() } else { String::new() }
    }
}

fn rates(estimate: &Estimate) -> GammaRates {
    let [alpha, beta] = estimate.parameters();
    GammaRates { alpha: PER_METRE * alpha, beta: PER_METRE * beta }
}

/// The factor all joints share, if one is asked for.
fn shared(arguments: &LifeArguments) -> Result<Option<SharedFactor>, Failure> {
    let Some(cov) = arguments.shared_factor else { return Ok(None) };
    // Life goes nearly as one over the factor, whose square has a mean below this only.
    let below = 0.5_f64.sqrt();
    if cov >= below {
        let error = LifeError::HeavyFactor { cov, below };
        return Err(Failure::Usage {
            message: error.to_string(),
            help: "give a smaller --shared-factor".into(),
        });
    }
    Ok(Some(SharedFactor::Gamma { cov }))
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
