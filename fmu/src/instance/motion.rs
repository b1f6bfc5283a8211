//! The mechanism on its way: integrated by the unit, or by the tool. Never knows modes or references.

use linkwear_runtime::{Simulation, SimulationState, StateSpace};

use crate::fault::Fault;

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
