//! States of simulations as bytes.

use linkwear_runtime::SimulationState;
use linkwear_runtime::clearance_joint::ClearanceState;
use linkwear_runtime::contact::ImpactMemory;
use linkwear_runtime::wear::Profile;

use super::{Damage, Stored};
use crate::stored;

impl Stored for ImpactMemory<f64> {
    fn write(&self, to: &mut Vec<u8>) {
        self.touching.write(to);
        self.closing_speed.write(to);
    }

    fn read(from: &mut &[u8]) -> Result<Self, Damage> {
        Ok(Self { touching: Stored::read(from)?, closing_speed: Stored::read(from)? })
    }
}

impl Stored for Profile {
    fn write(&self, to: &mut Vec<u8>) {
        self.depths().to_vec().write(to);
    }

    fn read(from: &mut &[u8]) -> Result<Self, Damage> {
        Self::try_from(Vec::read(from)?).map_err(|error| Damage::value(error.to_string()))
    }
}

stored!(struct ClearanceState { memory, worn, profile, journal });
stored!(struct SimulationState { t, parameters, joints, angles, memory });
