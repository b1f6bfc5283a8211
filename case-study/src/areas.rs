//! Why models agree or differ: how the wear of a revolution grows with the clearance for every model of the contact
//! area, flexible and rigid. In: mechanisms. Out: [`AreaGrowth`]. Never knows lives.

use linkwear_runtime::wear::Area;
use serde::Serialize;

use super::error::StudyError;
use super::job_pool::run_all;
use super::model::Model;
use super::options::{AREA_POINTS, Effort};
use super::progress::Progress;
use super::tables::{Measured, flexible, job};

/// From the unworn clearance to that at the threshold, which opens by all the wear.
const FULL: (f64, f64) = (1.0, 1.0);

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

/// Measures every model of the area.
pub(super) fn areas(
    threads: usize,
    effort: &Effort,
    progress: &Progress<'_>,
) -> Result<Vec<AreaGrowth>, StudyError> {
    let areas = [("projected", Area::Projected), ("Hertz", Area::Hertz), ("conformal", Area::Conformal)];
    let rigid = |area| job(Model::rigid, (area, effort.bins), (effort.rigid, AREA_POINTS), FULL, progress);
    let flexible = |area| job(flexible, (area, effort.bins), (effort.flexible, AREA_POINTS), FULL, progress);
    let jobs = areas.iter().map(|area| rigid(area.1)).chain(areas.iter().map(|area| flexible(area.1)));
    let found: Result<Vec<Measured>, StudyError> = run_all(threads, jobs.collect()).into_iter().collect();
    let found = found?;
    let (rigid, flexible) = found.split_at(areas.len());
    let growth = areas.iter().zip(rigid).zip(flexible);
    Ok(growth.map(|((area, rigid), flexible)| compared(area.0, rigid, flexible)).collect())
}

fn compared(area: &'static str, rigid: &Measured, flexible: &Measured) -> AreaGrowth {
    let ends = |model: &Measured| {
        let at = |wear: f64| model.table.at(0, wear).depth;
        (at(0.0), at(model.threshold()))
    };
    let ((first, last), (rigid_first, rigid_last)) = (ends(flexible), ends(rigid));
    let opened = libm::log(1.0 + flexible.threshold() / flexible.clearance());
    AreaGrowth {
        area,
        flexible: libm::log(last / first) / opened,
        rigid: libm::log(rigid_last / rigid_first) / opened,
        ratio_first: rigid_first / first,
        ratio_last: rigid_last / last,
    }
}
