//! All of an instance at one moment: kept, put back, as bytes.

use linkwear_runtime::SimulationState;
use linkwear_tape::stored::{Damage, sealed, unsealed};

use super::motion::Motion;
use super::{Instance, Mode, Times};
use crate::fault::{Fault, fault};

/// All of an instance at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    mode: Mode,
    times: Times,
    parameters: Vec<f64>,
    motion: Option<SimulationState>,
}

linkwear_tape::stored!(struct Kept { mode, times, parameters, motion });

impl Kept {
    /// As bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        sealed(self)
    }

    /// From its bytes.
    ///
    /// # Errors
    /// If they are damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Damage> {
        unsealed(bytes)
    }
}

impl Instance {
    /// Everything to go on from here.
    pub fn keep(&mut self) -> Kept {
        let motion = self.motion.as_mut().map(Motion::kept);
        Kept { mode: self.mode, times: self.times, parameters: self.parameters.clone(), motion }
    }

    /// Goes on from what was kept, of this unit by the same interface.
    ///
    /// # Errors
    /// If it is of another.
    pub fn put_back(&mut self, kept: &Kept) -> Result<(), Fault> {
        if kept.parameters.len() != self.parameters.len() {
            return fault("the state is of another unit");
        }
        let restored = match &kept.motion {
            None => None,
            Some(state) => {
                // Of what a start decides nothing is in a state: one that began otherwise begins again.
                let begun = self.motion.take().filter(|_| self.times == kept.times);
                let mut other = Self::new(self.loaded, self.interface);
                (other.times, other.mode) = (kept.times, Mode::Initialization);
                other.parameters.clone_from(&state.parameters);
                let mut motion = match begun {
                    Some(motion) => motion,
                    None => other.start()?,
                };
                motion.restore(state)?;
                Some(motion)
            }
        };
        (self.motion, self.refused) = (restored, None);
        (self.mode, self.times) = (kept.mode, kept.times);
        self.parameters.clone_from(&kept.parameters);
        Ok(())
    }
}
