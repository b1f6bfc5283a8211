//! Machine code that the turns of a life run in, where there is some. In: a study. Out: sources whose turns run in it, in the same bits.
//! Never knows what a turn is for.

use linkwear_native::NativeBundle;
use linkwear_runtime::{DynamicsSource, Integrator};

use super::study::{Coupling, LifeStudy};
use crate::backend::Lanes;

/// Machine code of a mechanism for its table and its mean path.
pub(super) struct MachineCode {
    /// For whole steps of a turn.
    whole: Option<NativeBundle<1>>,
    /// For measurements that are asked for together, where the mean path does.
    lanes: Option<Lanes>,
}

impl LifeStudy<'_> {
    /// None where its method or a mission has none.
    pub(super) fn machine_code(&self) -> MachineCode {
        let mechanism = self.takes_bundles().then_some(self.mechanism);
        let whole = mechanism.and_then(|mechanism| mechanism.whole_steps());
        let is_asked = self.coupling() == Coupling::Full;
        let lanes = mechanism.filter(|_| is_asked).and_then(|mechanism| mechanism.lanes());
        MachineCode { whole, lanes }
    }

    /// Whether its turns may be run in bundles: these are of one method, and run one description and one set of parameters.
    pub(super) fn takes_bundles(&self) -> bool {
        let has_mission = matches!(self.chosen_mission(), Ok(Some(_)));
        !has_mission && matches!(self.revolutions.integrator, Integrator::Rk43 { .. })
    }
}

impl MachineCode {
    /// Whether it has lanes for measurements that are asked for together.
    pub fn has_lanes(&self) -> bool {
        self.lanes.is_some()
    }

    /// These sources, with their turns run in it.
    pub fn run<'s>(&'s self, sources: Vec<DynamicsSource<'s>>) -> Vec<DynamicsSource<'s>> {
        let run = |mut source: DynamicsSource<'s>| {
            if let Some(whole) = &self.whole {
                source = source.in_whole_steps(whole);
            }
            if let Some(lanes) = &self.lanes {
                source = source.side_by_side(lanes.wide());
            }
            source
        };
        sources.into_iter().map(run).collect()
    }
}
