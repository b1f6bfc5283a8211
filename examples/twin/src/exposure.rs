//! What the equations of motion expect of the wear: how fast the joint wears at each depth. In: generated code. Out: cycles
//! between two depths, and the depth after some cycles.

use std::error::Error;

use linkwear_runtime::life::{LifeSettings, WearFlow, WearSource, WearTable};
use linkwear_runtime::{Description, DynamicsSource, GammaRates, RevolutionSettings, System, Watch};

/// Points of the table: the wear per revolution is smooth over the clearance.
const POINTS: usize = 9;

/// Wear of the one wearing joint by the model.
pub struct Exposure {
    flow: WearFlow,
    /// Wear at which the joint has failed [m].
    pub threshold: f64,
    /// Scatter as the mechanism's file has it.
    pub scatter: GammaRates,
}

impl Exposure {
    /// Runs settled revolutions at several clearances.
    pub fn measure(
        system: &dyn System<f64>,
        description: &Description,
        parameters: &[f64],
    ) -> Result<Self, Box<dyn Error>> {
        let mut source = DynamicsSource::new(system, description, parameters, RevolutionSettings::default())?;
        let settings = LifeSettings::new(source.joints()?);
        let table = WearTable::measure(&settings, &mut source, POINTS, Watch::NONE)?;
        let flow = table.flow(&settings).ok_or("the mean path cannot be solved by a table")?;
        let scatter = description.contacts.iter().filter_map(|contact| contact.wear?.scatter).next();
        Ok(Self {
            flow,
            threshold: settings.joints[0].threshold,
            scatter: scatter.ok_or("give alpha in [wear], the scatter of wear")?,
        })
    }

    /// Cycles that the model takes from one depth to another [m].
    pub fn cycles(&self, from: f64, to: f64) -> f64 {
        self.flow.time(0, from, to)
    }

    /// What the model wears in some cycles from a depth on [m]: the exposure of the Gamma process.
    pub fn of(&self, from: f64, cycles: f64) -> f64 {
        let rest = self.cycles(from, self.threshold);
        if cycles >= rest {
            // The joint has outlived the model: it goes on as at the threshold.
            return self.threshold - from + (cycles - rest) * self.flow.gain(0, self.threshold);
        }
        let (mut low, mut high) = (from, self.threshold);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.cycles(from, middle) < cycles { low = middle } else { high = middle }
        }
        low - from
    }
}
