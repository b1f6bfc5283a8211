//! The mechanism on its way: integrated by the unit, or by the tool. Never knows modes or references.

use linkwear_runtime::{Simulation, SimulationState, StateSpace};

use crate::fault::Fault;
use crate::loaded::Loaded;

/// The mechanism on its way, by either interface.
pub(super) enum Motion {
    Steps(Box<Simulation<'static>>),
    Space(Box<StateSpace<'static>>),
}

impl Motion {
    pub(super) fn t(&self) -> f64 {
        match self {
            Self::Steps(run) => run.t(),
            Self::Space(space) => space.t(),
        }
    }

    pub(super) fn parameters(&self) -> &[f64] {
        match self {
            Self::Steps(run) => run.parameters(),
            Self::Space(space) => space.parameters(),
        }
    }

    pub(super) fn set_parameters(&mut self, parameters: &[f64]) -> Result<(), Fault> {
        match self {
            Self::Steps(run) => Ok(run.set_parameters(parameters)?),
            Self::Space(space) => Ok(space.set_parameters(parameters)?),
        }
    }

    /// Other values of a mechanism with inputs that drives follow. Where the unit integrates, these are led from step to step, not
    /// set; where the tool does, all inputs are what it says at each of its times.
    pub(super) fn follow(&mut self, loaded: &Loaded, wanted: &[f64]) -> Result<(), Fault> {
        let mut all = wanted.to_vec();
        let keeps = |index: usize| match self {
            Self::Steps(_) => loaded.leads[index],
            Self::Space(_) => loaded.is_input(index),
        };
        for (index, present) in self.parameters().iter().enumerate().filter(|(index, _)| keeps(*index)) {
            all[index] = *present;
        }
        if all != self.parameters() {
            self.set_parameters(&all)?;
        }
        match self {
            Self::Space(space) if wanted != space.parameters() => Ok(space.set_inputs(wanted)?),
            _ => Ok(()),
        }
    }

    /// Values of the parameters, with the inputs that hold at the present time.
    pub(super) fn present_parameters(&mut self) -> Vec<f64> {
        match self {
            Self::Steps(run) => run.present_parameters(),
            Self::Space(space) => space.parameters().to_vec(),
        }
    }

    pub(super) fn values(&mut self) -> Result<&[f64], Fault> {
        match self {
            Self::Steps(run) => Ok(run.values()),
            Self::Space(space) => Ok(space.values()?),
        }
    }

    pub(super) fn state(&self, index: usize) -> f64 {
        match self {
            Self::Steps(run) => {
                let (q, v) = (run.coordinates(), run.speeds());
                if index < q.len() { q[index] } else { v[index - q.len()] }
            }
            Self::Space(space) => space.states()[index],
        }
    }

    pub(super) fn derivative(&mut self, index: usize) -> Result<f64, Fault> {
        match self {
            Self::Steps(run) => Ok(run.derivatives()?[index]),
            Self::Space(space) => Ok(space.derivatives()?[index]),
        }
    }

    pub(super) fn penetrations(&mut self) -> Vec<f64> {
        match self {
            Self::Steps(run) => run.contacts().iter().map(|touch| touch.penetration()).collect(),
            Self::Space(space) => space.penetrations().collect(),
        }
    }

    pub(super) fn kept(&mut self) -> SimulationState {
        match self {
            Self::Steps(run) => run.state(),
            Self::Space(space) => space.state(),
        }
    }

    pub(super) fn restore(&mut self, state: &SimulationState) -> Result<(), Fault> {
        match self {
            Self::Steps(run) => Ok(run.restore(state)?),
            Self::Space(space) => Ok(space.restore(state)?),
        }
    }
}
