//! Plans that cannot be made. In: the error of a plan. Out: a failure of the command line.

use linkwear_gamma::life::LifeError;
use linkwear_gamma::plan::PlanError;

use super::super::arguments::PlanArguments;
use super::super::failure::Failure;

/// A plan that cannot be made: options that contradict each other are to blame whatever the file has, else the two together.
pub fn refused(arguments: &PlanArguments, error: &PlanError) -> Failure {
    let help = "see `linkwear plan --help` for what the options mean";
    match error {
        PlanError::NothingToSave { .. }
        | PlanError::ReplacedTooLate { .. }
        | PlanError::Life(LifeError::Failed { .. }) => Failure::usage(error, help),
        _ => Failure::data(&arguments.file, None, error, help),
    }
}
