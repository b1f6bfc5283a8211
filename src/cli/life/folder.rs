//! The folder of `life --out`: `life.json`, `cycles.csv`, `lives.csv`, each whole or absent.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use linkwear_runtime::life::{CycleJoint, CycleRecord, FailureEvent};

use super::super::failure::Failure;
use super::super::file::{claim_folder, write_whole};
use super::output::Answer;

/// A folder that was empty.
pub struct Folder(PathBuf);

impl Folder {
    /// Makes it; one with something in it is refused, so that no result is mixed with another.
    pub fn claim(path: &Path) -> Result<Self, Failure> {
        claim_folder(path)?;
        Ok(Self(path.to_path_buf()))
    }

    /// Everything.
    pub fn write(&self, answer: &Answer<'_>) -> Result<(), Failure> {
        let (names, life) = (answer.life.names(), answer.life);
        self.write_cycles(&names, &life.cycles)?;
        if !life.lives.is_empty() {
            write_whole(&self.0.join("lives.csv"), |file| write_lives(file, &names, &life.lives))?;
        }
        let answer = answer.to_json();
        write_whole(&self.0.join("life.json"), |file| writeln!(file, "{answer:#}"))
    }

    /// The cycles of the mean path.
    pub fn write_cycles(&self, joints: &[String], cycles: &[CycleRecord]) -> Result<PathBuf, Failure> {
        let path = self.0.join("cycles.csv");
        write_whole(&path, |file| {
            write!(file, "cycle,used [1]")?;
            for joint in joints {
                for column in CycleJoint::columns() {
                    write!(file, ",{joint}.{}", column.head())?;
                }
            }
            writeln!(file)?;
            for cycle in cycles {
                write!(file, "{},{}", cycle.cycle, cycle.used)?;
                for joint in &cycle.joints {
                    for value in joint.values() {
                        write!(file, ",{value}")?;
                    }
                }
                writeln!(file)?;
            }
            Ok(())
        })?;
        Ok(path)
    }
}

fn write_lives(file: &mut impl Write, joints: &[String], lives: &[FailureEvent]) -> io::Result<()> {
    writeln!(file, "trajectory,life [cycles],whole cycles,failed joint")?;
    for (trajectory, end) in lives.iter().enumerate() {
        writeln!(file, "{trajectory},{},{},{}", end.cycles, end.whole_cycles, joints[end.joint])?;
    }
    Ok(())
}
