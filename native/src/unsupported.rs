//! Processors for which no code is written. In: anything. Out: the refusal.

use std::convert::Infallible;

use linkwear_runtime::{Entry, StageSum, StepPlan};
use linkwear_tape::{Tape, Tapes};

use crate::refusal::Refusal;

pub(crate) struct Functions(Infallible);

impl Functions {
    pub(crate) fn new<const LANES: usize>(_: &[Tape]) -> Result<Self, Refusal> {
        Err(Refusal::Processor { needed: "an x86-64 or aarch64 processor" })
    }

    pub(crate) fn of_entries<const LANES: usize>(_: &dyn Tapes, _: &[Entry]) -> Result<Self, Refusal> {
        Self::new::<LANES>(&[])
    }

    pub(crate) fn of_steps<const LANES: usize>(_: &dyn Tapes, _: &StepPlan) -> Result<Self, Refusal> {
        Self::new::<LANES>(&[])
    }

    pub(crate) fn of_laws(_: &dyn Tapes, _: &StepPlan) -> Result<Self, Refusal> {
        Self::new::<1>(&[])
    }

    pub(crate) fn of_whole_step(_: &dyn Tapes, _: &StepPlan, _: StageSum) -> Result<Self, Refusal> {
        Self::new::<1>(&[])
    }

    pub(crate) fn of_columns<const LANES: usize>(_: &[Tape]) -> Result<Self, Refusal> {
        Self::new::<LANES>(&[])
    }

    pub(crate) fn run_columns<const LANES: usize>(
        &self,
        _: usize,
        _: &[&[f64]],
        _: &mut [&mut [f64]],
        _: &mut [f64],
    ) {
        match self.0 {}
    }

    pub(crate) fn workspace(&self) -> usize {
        match self.0 {}
    }

    pub(crate) fn run(&self, _: usize, _: &[f64], _: &mut [f64], _: &mut [f64]) {
        match self.0 {}
    }
}
