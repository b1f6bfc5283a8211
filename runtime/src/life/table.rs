//! `table` coupling: what a revolution wears, measured once along the life and looked up afterwards.
//! In: a fine scale, settings. Out: a fine scale that costs nothing, and what is known of its error.
//! Never knows trajectories.
//!
//! Points are equally spaced in the logarithm of the clearance from c0 to c0 + gamma `W_crit`; between them depth
//! and wear integral are monotone cubics, log over log. Several joints would need a grid in all their clearances;
//! instead each has its table along the path that all of them take in the deterministic life. That assumes that a
//! joint wears nearly alike when the others are worn more or less than on that path; [`TableReport::others`] says
//! how nearly, by the extreme case.

use core::convert::Infallible;

use super::asked::measure;
use super::error::LifeError;
use super::flow::{JointFlow, WearFlow};
use super::interpolate::{Curve, find};
use super::joint::{Feedback, JointLife, WearOf};
use super::settings::{LifeSettings, WearStep};
use super::settings_error::SettingsError;
use super::source::{JointWear, WearSource};
use crate::contact::OutOfRange;
use crate::watch::Watch;
use crate::wear::{ContactMeasure, Measure, Observed, Profile};

/// Points of a table unless told otherwise.
pub const DEFAULT_POINTS: usize = 17;

/// What revolutions wear, by the wear of their joint.
#[derive(Clone, Debug, PartialEq)]
pub struct WearTable {
    joints: Vec<JointTable>,
    report: TableReport,
}

/// What a table was made from and how good it is. Errors are relative, of the depth per revolution.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TableReport {
    /// Points along the life.
    pub points: usize,
    /// Measurements spent.
    pub measurements: usize,
    /// Largest error of a table with every second point at the points left out: per joint, an upper estimate for the
    /// whole table unless its points miss a resonance altogether.
    pub left_out: Vec<f64>,
    /// Per joint, difference between the table and a joint that is unworn while all others are at the end of their
    /// life: the most that "each along the common path" can be wrong. Nothing with one joint.
    pub others: Option<Vec<f64>>,
}

#[derive(Clone, Debug, PartialEq)]
struct JointTable {
    /// Wear that doubles the clearance [m]: places are ln(1 + W/scale).
    scale: f64,
    places: Vec<f64>,
    depth: Curve,
    wear_integral: Curve,
    mean_force: Curve,
    peak_force: Curve,
    losses: Curve,
    touching: Curve,
    loss: Curve,
    bins: Vec<Curve>,
    journal: Vec<Curve>,
    observed: Vec<Option<Observed>>,
}

/// Wear of all joints and what a revolution does there.
struct Point {
    wear: Vec<f64>,
    measured: Vec<ContactMeasure>,
}

impl WearTable {
    /// Measures `points` points along the deterministic life (more with several joints, which need a predictor each).
    /// `watch` hears the finished part.
    ///
    /// # Errors
    /// If the settings make no sense or feed a profile back, or as [`LifeError`] says.
    pub fn measure<F: WearSource>(
        settings: &LifeSettings,
        fine: &mut F,
        points: usize,
        watch: Watch<'_>,
    ) -> Result<Self, LifeError<F::Error>> {
        settings.check()?;
        if points < 3 {
            let (name, need) = ("the number of points of a table", "3 or more");
            return Err(SettingsError::Run(OutOfRange { name, value: points as f64, need }).into());
        }
        no_profile(settings)?;
        let mut survey = Survey { settings, fine, state: F::State::default(), measurements: 0 };
        let path = survey.path(points, watch)?;
        let joints: Vec<JointTable> =
            (0..settings.joints.len()).map(|joint| JointTable::of(settings, &path, joint)).collect();
        let others = if joints.len() > 1 { Some(survey.others(&path, &joints)?) } else { None };
        let left_out = (0..joints.len()).map(|joint| left_out(settings, &path, joint)).collect();
        let report = TableReport { points: path.len(), measurements: survey.measurements, left_out, others };
        Ok(Self { joints, report })
    }

    /// From what was measured already: wears of the joints [m], rising, and what a revolution does there. Nothing is known of its
    /// error.
    ///
    /// # Errors
    /// If the settings make no sense or feed a profile back, or there is no point, or one is of other joints.
    pub fn of_points(
        settings: &LifeSettings,
        points: Vec<(Vec<f64>, Vec<ContactMeasure>)>,
    ) -> Result<Self, SettingsError> {
        settings.check()?;
        no_profile(settings)?;
        let expected = settings.joints.len();
        let other = points.iter().find(|(wear, measured)| [wear.len(), measured.len()] != [expected; 2]);
        if let Some((wear, _)) = other {
            return Err(SettingsError::State {
                what: "the number of measured joints",
                expected,
                found: wear.len(),
            });
        }
        if points.is_empty() {
            let (name, need) = ("the number of points of a table", "1 or more");
            return Err(OutOfRange { name, value: 0.0, need }.into());
        }
        let path: Vec<Point> = points.into_iter().map(|(wear, measured)| Point { wear, measured }).collect();
        let joints = (0..expected).map(|joint| JointTable::of(settings, &path, joint)).collect();
        let report = TableReport { points: path.len(), measurements: 0, left_out: Vec::new(), others: None };
        Ok(Self { joints, report })
    }

    /// What a revolution wears at a joint (index among the wearing joints) worn by W [m].
    pub fn at(&self, joint: usize, wear: f64) -> ContactMeasure {
        self.joints[joint].at(wear)
    }

    /// What it was made from and how good it is.
    pub fn report(&self) -> &TableReport {
        &self.report
    }
}

impl WearSource for WearTable {
    type State = ();
    type Error = Infallible;

    fn measure(&mut self, joints: &[JointWear], (): &mut ()) -> Result<Vec<ContactMeasure>, Infallible> {
        Ok(self.joints.iter().zip(joints).map(|(table, joint)| table.at(joint.wear)).collect())
    }

    fn flow(&self, settings: &LifeSettings) -> Option<WearFlow> {
        let is_whole = settings.check().is_ok() && settings.joints.len() == self.joints.len();
        if !is_whole || settings.step == WearStep::Cycle {
            return None;
        }
        let each = self.joints.iter().zip(&settings.joints);
        WearFlow::new(each.map(|(table, joint)| table.flow(joint, settings)).collect::<Option<_>>()?)
    }
}

/// A table knows wear as one number.
fn no_profile(settings: &LifeSettings) -> Result<(), SettingsError> {
    let profile = settings.joints.iter().find(|joint| joint.feedback == Feedback::Profile);
    profile.map_or(Ok(()), |joint| Err(SettingsError::TableOfProfile { joint: joint.joint.clone() }))
}

/// Wear that doubles the clearance [m]; without feedback only the others' wear counts, and any scale does.
fn scale(joint: &JointLife) -> f64 {
    let gamma = joint.gamma();
    if gamma > 0.0 { joint.clearance / gamma } else { joint.threshold }
}

impl JointTable {
    fn of(settings: &LifeSettings, path: &[Point], joint: usize) -> Self {
        let scale = scale(&settings.joints[joint]);
        let mut places: Vec<f64> = Vec::with_capacity(path.len());
        let mut points: Vec<&ContactMeasure> = Vec::with_capacity(path.len());
        for point in path {
            let place = libm::log1p(point.wear[joint] / scale);
            // A joint that does not wear stays at one place.
            if places.last().is_none_or(|last| place > last + 1e-12) {
                places.push(place);
                points.push(&point.measured[joint]);
            }
        }
        let column =
            |of: fn(&ContactMeasure) -> f64| points.iter().map(|point| of(point)).collect::<Vec<_>>();
        let profile = |bins: Option<usize>, of: fn(&ContactMeasure) -> Option<&Profile>| {
            let bin = |bin: usize| {
                let depth = |point: &&ContactMeasure| of(point).map_or(0.0, |p| p.depths()[bin]);
                Curve::plain(&places, points.iter().map(depth).collect())
            };
            (0..bins.unwrap_or(0)).map(bin).collect()
        };
        let bins = profile(settings.joints[joint].bins, |point| point.deposit.as_ref());
        let journal = profile(settings.joints[joint].journal_bins, |point| point.journal.as_ref());
        Self {
            scale,
            depth: Curve::logarithmic(&places, column(|wear| wear.depth)),
            wear_integral: Curve::logarithmic(&places, column(|wear| wear.wear_integral)),
            mean_force: Curve::plain(&places, column(|wear| wear.mean_force)),
            peak_force: Curve::plain(&places, column(|wear| wear.peak_force)),
            losses: Curve::plain(&places, column(|wear| wear.losses)),
            touching: Curve::plain(&places, column(|wear| wear.touching)),
            loss: Curve::plain(&places, column(|wear| wear.loss)),
            bins,
            journal,
            observed: points.iter().map(|point| point.observed).collect(),
            places,
        }
    }

    /// The mean path, where nothing but W decides it and nothing stops it before the threshold.
    fn flow(&self, joint: &JointLife, settings: &LifeSettings) -> Option<JointFlow> {
        // The deepest place is not always the same one: it takes the whole profile.
        let is_linear = matches!(joint.wear, WearOf::Depth | WearOf::Profile(Measure::Mean));
        let knots: Vec<f64> = self.places.iter().map(|place| self.scale * libm::expm1(*place)).collect();
        // Between points all curves are monotone.
        let holds = |wear: &f64| {
            let measured = self.at(*wear);
            measured.flaw().is_none() && measured.touching >= settings.least_touching
        };
        if !is_linear || self.scale != scale(joint) || !knots.iter().chain([&joint.threshold]).all(holds) {
            return None;
        }
        let rate = |wear: f64| {
            let cell = find(&self.places, libm::log1p(wear / self.scale));
            let value = |curve: &Curve| curve.at(cell).max(0.0);
            let depth = match joint.wear {
                WearOf::Depth => value(&self.depth),
                WearOf::Profile(_) => self.bins.iter().map(value).sum::<f64>() / self.bins.len() as f64,
            };
            let depth = if self.journal.is_empty() {
                depth
            } else {
                depth + self.journal.iter().map(value).sum::<f64>() / self.journal.len() as f64
            };
            joint.revolutions_per_cycle * depth
        };
        // A first cycle that reaches the threshold is a fault of the settings, which is told elsewhere.
        let flow = JointFlow::new(joint, self.scale, &knots, &rate)?;
        (flow.first() < joint.threshold).then_some(flow)
    }

    fn at(&self, wear: f64) -> ContactMeasure {
        let cell = find(&self.places, libm::log1p(wear / self.scale));
        // Only beyond the last point can a line fall below zero.
        let value = |curve: &Curve| curve.at(cell).max(0.0);
        let profile = |bins: &[Curve]| {
            let depths: Vec<f64> = bins.iter().map(value).collect();
            if depths.is_empty() { None } else { Profile::try_from(depths).ok() }
        };
        ContactMeasure {
            wear_integral: value(&self.wear_integral),
            depth: value(&self.depth),
            mean_force: value(&self.mean_force),
            peak_force: value(&self.peak_force),
            losses: value(&self.losses),
            touching: value(&self.touching).min(1.0),
            loss: value(&self.loss),
            deposit: profile(&self.bins),
            journal: profile(&self.journal),
            observed: self.observed[cell.nearest()],
        }
    }
}

/// Largest relative error at the points left out of a table with every second point.
fn left_out(settings: &LifeSettings, path: &[Point], joint: usize) -> f64 {
    let last = path.len() - 1;
    let kept = |index: &usize| index.is_multiple_of(2) || *index == last;
    let point =
        |index: usize| Point { wear: path[index].wear.clone(), measured: path[index].measured.clone() };
    let half: Vec<Point> = (0..path.len()).filter(kept).map(point).collect();
    let table = JointTable::of(settings, &half, joint);
    let lives = &settings.joints[joint];
    let error =
        |index: usize| difference(lives, &path[index].measured[joint], &table.at(path[index].wear[joint]));
    (0..path.len()).filter(|index| !kept(index)).map(error).fold(0.0, f64::max)
}

/// Relative difference of what two revolutions add to W.
fn difference(joint: &JointLife, truth: &ContactMeasure, table: &ContactMeasure) -> f64 {
    let (truth, table) = (gain(joint, truth), gain(joint, table));
    if truth == table { 0.0 } else { (table - truth).abs() / truth.abs().max(f64::MIN_POSITIVE) }
}

/// W that one cycle adds to an unworn joint [m].
fn gain(joint: &JointLife, wear: &ContactMeasure) -> f64 {
    joint.revolutions_per_cycle * joint.wear.of(wear)
}

/// Measures along the deterministic life.
struct Survey<'a, F: WearSource> {
    settings: &'a LifeSettings,
    fine: &'a mut F,
    state: F::State,
    measurements: usize,
}

impl<F: WearSource> Survey<'_, F> {
    fn measure(&mut self, wear: &[f64]) -> Result<Vec<ContactMeasure>, LifeError<F::Error>> {
        let worn = |(joint, wear): (&JointLife, &f64)| JointWear {
            clearance: joint.clearance + joint.gamma() * wear,
            wear: *wear,
            profile: None,
            journal: None,
        };
        let joints: Vec<JointWear> = self.settings.joints.iter().zip(wear).map(worn).collect();
        self.measurements += 1;
        measure(self.settings, self.fine, &joints, &mut self.state, 1)
    }

    /// Points at which the joint that leads has its places; the others are where they are then (Heun's method).
    fn path(&mut self, points: usize, watch: Watch<'_>) -> Result<Vec<Point>, LifeError<F::Error>> {
        let joints = &self.settings.joints;
        let mut wear = vec![0.0; joints.len()];
        let mut measured = self.measure(&wear)?;
        let gains = |measured: &[ContactMeasure]| -> Vec<f64> {
            joints.iter().zip(measured).map(|(joint, wear)| gain(joint, wear)).collect()
        };
        let pace = |gains: &[f64], joint: usize| gains[joint] / joints[joint].threshold;
        let first = gains(&measured);
        let lead = (0..joints.len())
            .fold(0, |lead, joint| if pace(&first, joint) > pace(&first, lead) { joint } else { lead });
        if first[lead] == 0.0 {
            return Err(LifeError::NoWear { cycle: 1 });
        }
        let mut path = vec![Point { wear: wear.clone(), measured: measured.clone() }];
        if joints.iter().all(|joint| joint.gamma() == 0.0) {
            return Ok(path);
        }
        let scale = scale(&joints[lead]);
        let end = libm::log1p(joints[lead].threshold / scale);
        for index in 1..points {
            let next = scale * libm::expm1(end * index as f64 / (points - 1) as f64);
            let before = gains(&measured);
            let step = next - wear[lead];
            let moved = |share: &dyn Fn(usize) -> f64| -> Vec<f64> {
                let place = |(joint, wear): (usize, &f64)| {
                    if joint == lead { next } else { wear + step * share(joint) }
                };
                wear.iter().enumerate().map(place).collect()
            };
            let mut there = moved(&|joint| before[joint] / before[lead]);
            if joints.len() > 1 {
                let after = gains(&self.measure(&there)?);
                if after[lead] == 0.0 {
                    return Err(LifeError::NoWear { cycle: 1 });
                }
                there = moved(&|joint| 0.5 * (before[joint] / before[lead] + after[joint] / after[lead]));
            }
            measured = self.measure(&there)?;
            if gains(&measured)[lead] == 0.0 {
                return Err(LifeError::NoWear { cycle: 1 });
            }
            wear = there;
            path.push(Point { wear: wear.clone(), measured: measured.clone() });
            if watch.report(index as f64 / (points - 1) as f64).is_break() {
                return Err(LifeError::Interrupted);
            }
        }
        Ok(path)
    }

    /// Each joint unworn while the others are at the end of the path, against its table.
    fn others(&mut self, path: &[Point], tables: &[JointTable]) -> Result<Vec<f64>, LifeError<F::Error>> {
        let Some(end) = path.last() else { return Ok(Vec::new()) };
        let mut errors = Vec::with_capacity(tables.len());
        for (joint, table) in tables.iter().enumerate() {
            let mut wear = end.wear.clone();
            wear[joint] = 0.0;
            let measured = self.measure(&wear)?;
            errors.push(difference(&self.settings.joints[joint], &measured[joint], &table.at(0.0)));
        }
        Ok(errors)
    }
}
