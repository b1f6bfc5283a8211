//! `merge`: shards of a life, which are folders, or of a study, which are files.

use super::answer::Answer;
use super::arguments::MergeArguments;
use super::failure::Failure;
use super::{life, study};

pub fn run(arguments: &MergeArguments) -> Result<Answer, Failure> {
    let files = arguments.shards.iter().filter(|shard| shard.is_file()).count();
    if files == 0 {
        life::merged(arguments)
    } else if files == arguments.shards.len() {
        study::merged(arguments)
    } else {
        let help = "merge shards of one life, which are folders, or parts of one study, which are files";
        Err(Failure::usage("folders and files are given: they are of a life and of a study", help))
    }
}
