//! Why models agree or differ: how the wear of a revolution grows with the clearance for every model of the contact
//! area, flexible and rigid. In: mechanisms. Out: [`AreaGrowth`]. Never knows lives.

use linkwear_runtime::wear::Area;
use serde::Serialize;

use super::model::Model;
use super::options::Effort;
use super::tables::{Measured, Survey};

/// With the names that results give them.
const AREAS: [(&str, Area); 3] =
    [("projected", Area::Projected), ("Hertz", Area::Hertz), ("conformal", Area::Conformal)];
/// The fewest points that a table of two ends has.
const POINTS: usize = 3;

/// Wear of a revolution by one model of the contact area.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AreaGrowth {
    /// Model of the area.
    pub area: &'static str,
    /// Exponent n of depth ~ c^n between the unworn clearance and that of the worn joint, flexible coupler.
    pub flexible: f64,
    /// The same, rigid coupler.
    pub rigid: f64,
    /// Depth with the rigid coupler over that with the flexible one, unworn.
    pub ratio_first: f64,
    /// The same at the threshold.
    pub ratio_last: f64,
}

/// What has to be measured: from the unworn clearance to that at the threshold, which opens by all the wear; rigid, which
/// takes longer, then flexible.
pub(super) fn surveys(effort: &Effort) -> Vec<Survey> {
    let models = [(Model::Rigid, effort.rigid), (Model::Flexible, effort.flexible)];
    let of = |(model, settings)| {
        AREAS.map(|(_, area)| Survey {
            model,
            area,
            bins: effort.bins,
            settings,
            points: POINTS,
            gamma: 1.0,
            reach: 1.0,
        })
    };
    models.map(of).concat()
}

/// Compares what [`surveys`] measured, in that order.
pub(super) fn growths(measured: &[Measured]) -> Vec<AreaGrowth> {
    let (rigid, flexible) = measured.split_at(AREAS.len());
    let ends = |model: &Measured| {
        let at = |wear: f64| model.table.at(0, wear).depth;
        (at(0.0), at(model.threshold()))
    };
    let compared = |((area, rigid), flexible): (((&'static str, Area), &Measured), &Measured)| {
        let ((first, last), (rigid_first, rigid_last)) = (ends(flexible), ends(rigid));
        let opened = libm::log(flexible.opening());
        AreaGrowth {
            area: area.0,
            flexible: libm::log(last / first) / opened,
            rigid: libm::log(rigid_last / rigid_first) / opened,
            ratio_first: rigid_first / first,
            ratio_last: rigid_last / last,
        }
    };
    AREAS.into_iter().zip(rigid).zip(flexible).map(compared).collect()
}
