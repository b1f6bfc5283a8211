//! Questions that have no answer. In: the error of a life. Out: a failure of the command line.

use linkwear_gamma::life::LifeError;

use super::super::arguments::PredictArguments;
use super::super::failure::Failure;

/// A question that has no answer: the numbers on the command line are to blame, by themselves where wear now and at failure are the
/// wrong way round, else together with the fit.
pub fn asked(arguments: &PredictArguments, error: &LifeError) -> Failure {
    let help = "see `linkwear predict --help` for what the options mean";
    let is_worn_out = arguments.current.is_some_and(|wear| wear >= arguments.threshold);
    match error {
        LifeError::Failed { .. } if is_worn_out => Failure::usage(error, help),
        _ => Failure::data(&arguments.fit, None, error, help),
    }
}
