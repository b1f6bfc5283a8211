//! Questions that have no answer. In: the error of a life. Out: a failure of the command line.

use linkwear_gamma::life::LifeError;

use super::super::arguments::PredictArguments;
use super::super::failure::Failure;

/// A question that has no answer: the numbers on the command line are to blame.
pub fn asked(arguments: &PredictArguments, error: &LifeError) -> Failure {
    Failure::data(&arguments.fit, None, error, "see `linkwear predict --help` for what the options mean")
}
