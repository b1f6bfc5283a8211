//! How the wear of turns varies over some per cent of parameters, where bodies come apart. In: mechanisms on both sides of each
//! parameter. Out: points with derivatives. Never knows tangents or lives.

use std::sync::{Mutex, PoisonError};

use linkwear_codegen::tape::side_by_side;
use linkwear_runtime::life::WearSource;
use linkwear_runtime::wear::ContactMeasure;
use linkwear_runtime::{DynamicsSource, Orbit, RevolutionSettings};

use super::error::SensitivityError;
use super::measured::{Point, Wear, worn_joints};
use super::varied::Sides;
use super::wide::{FARTHEST, Wide, across};
use crate::mechanism::Mechanism;

/// A mechanism whose turns are measured, from wear to wear.
struct Neighbour {
    mechanism: Mechanism,
    orbit: Option<Orbit>,
}

/// Mechanisms on both sides of every parameter, and how far apart their logarithms are.
pub(super) struct Neighbours(Vec<([Neighbour; 2], f64)>);

impl Neighbour {
    fn new(mechanism: Mechanism) -> Self {
        Self { mechanism, orbit: None }
    }

    /// What a settled turn wears at these wears of the wearing joints [m], clearances by the mechanism's own.
    fn measure(&mut self, worn: &[f64]) -> Result<Vec<ContactMeasure>, SensitivityError> {
        let Self { mechanism, orbit } = self;
        with_source(mechanism, |source| {
            let joints = worn_joints(&source.joints()?, worn);
            source.measure(&joints, orbit).map_err(|error| SensitivityError::Wear(error.to_string()))
        })
    }
}

impl Neighbours {
    /// As far from a file's parameters as its lives.
    pub(super) fn new(sides: &[Sides], wide: &Wide<'_>) -> Result<Self, SensitivityError> {
        let pair = |sides: &Sides, step: f64| {
            let mechanism = |factor: f64| {
                let none = || SensitivityError::NoLives { parameter: sides.of.name.clone() };
                wide.mechanism(sides.at(factor).ok_or_else(none)?)
            };
            let [below, above] = [1.0 - step, 1.0 + step].map(mechanism);
            Ok(([Neighbour::new(below?), Neighbour::new(above?)], across(step)))
        };
        let [long, short] = FARTHEST;
        let pair = |sides: &Sides| pair(sides, long).or_else(|_: SensitivityError| pair(sides, short));
        sides.iter().map(pair).collect::<Result<_, _>>().map(Self)
    }

    /// A point with its derivatives, by the logarithms of wear and parameter.
    pub(super) fn point(
        &mut self,
        sides: &[Sides],
        (worn, measured): (Vec<f64>, Vec<ContactMeasure>),
        threads: usize,
    ) -> Result<Point, SensitivityError> {
        let over: Vec<f64> = self.0.iter().map(|(_, over)| *over).collect();
        let all: Vec<_> = self.0.iter_mut().flat_map(|(pair, _)| pair).map(Mutex::new).collect();
        let found = side_by_side(&all, threads, |one| {
            one.lock().unwrap_or_else(PoisonError::into_inner).measure(&worn)
        });
        let found = found.into_iter().collect::<Result<Vec<_>, _>>()?;
        let values = |one: &ContactMeasure| [one.wear_integral, one.depth];
        let wear = |(joint, own): (usize, &ContactMeasure)| {
            let own = values(own);
            let slope = |((pair, over), sides): ((&[Vec<ContactMeasure>], &f64), &Sides)| {
                let [below, above] = [0, 1].map(|side| values(&pair[side][joint]));
                std::array::from_fn(|which| {
                    let rise = (above[which] / below[which]).ln() / over;
                    if own[which] == 0.0 { 0.0 } else { rise * own[which] / sides.of.value }
                })
            };
            Wear { values: own, slopes: found.chunks_exact(2).zip(&over).zip(sides).map(slope).collect() }
        };
        let wear = measured.iter().enumerate().map(wear).collect();
        Ok(Point { worn, measured, wear, coarse: None })
    }
}

/// Has a mechanism's turns measured, in whole steps where there is code for them.
pub(super) fn with_source<T>(
    mechanism: &Mechanism,
    body: impl FnOnce(&mut DynamicsSource<'_>) -> Result<T, SensitivityError>,
) -> Result<T, SensitivityError> {
    let (system, whole) = (mechanism.system(), mechanism.whole_steps());
    let (description, parameters) = (&mechanism.description, &mechanism.parameters);
    let source = DynamicsSource::new(&*system, description, parameters, RevolutionSettings::default())?;
    body(&mut match &whole {
        Some(whole) => source.in_whole_steps(whole),
        None => source,
    })
}
