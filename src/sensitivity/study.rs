//! What is asked. In: a file, parameters. Out: a [`SensitivityStudy`] to run.

use std::num::NonZero;
use std::thread::available_parallelism;

use linkwear_codegen::{Options, SourceFile};
use linkwear_native::Routine;
use linkwear_runtime::life::{LifeSettings, WearSource, WearTable};
use linkwear_runtime::wear::ContactMeasure;
use linkwear_runtime::{DynamicsSource, Watch};

use super::chosen::chosen;
use super::doubts::{coarser, doubts, doubts_of_points, every_second, joint_sensitivity, without_each};
use super::error::SensitivityError;
use super::measured::{Point, Points, Survey};
use super::neighbours::{Neighbours, with_source};
use super::paths::{Along, Paths};
use super::random::{processes, random};
use super::result::{Derived, LeftOut, LifeSensitivity, RandomSensitivity, SensitivityResult};
use super::varied::{Sides, Variant};
use super::wide::{Wide, WideLife};
use crate::backend::Backend;
use crate::mechanism::Mechanism;

/// How wear and life vary with parameters.
///
/// ```no_run
/// use linkwear::mechanism::read_source;
/// use linkwear::sensitivity::SensitivityStudy;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let source = read_source("my.toml".as_ref())?;
/// let result = SensitivityStudy::new(&source).run()?;
/// for (at, parameter) in result.parameters.iter().enumerate() {
///     println!("d(life)/d({}) = {:e} cycles per {}", parameter.name, result.life.cycles.by[at], parameter.unit);
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct SensitivityStudy<'s> {
    /// The file.
    pub source: &'s SourceFile,
    /// How it is compiled.
    pub options: Options,
    /// The parameters. None: all that are numbers. Those that cannot be varied are left out; an error if that is each that is asked for.
    pub parameters: Option<Vec<String>>,
    /// Length of a step [s]. None: short enough.
    pub step: Option<f64>,
    /// Clearances at which turns are run, from that of the unworn mechanism to that of the failed one, at least 3.
    pub points: usize,
    /// Random lives, 2 at least. 0: none.
    pub trajectories: u64,
    /// Seed of their random numbers.
    pub seed: u64,
    /// Threads. None: one per core.
    pub threads: Option<NonZero<usize>>,
}

impl<'s> SensitivityStudy<'s> {
    /// By all parameters, of the mean path alone, at 9 clearances.
    pub fn new(source: &'s SourceFile) -> Self {
        Self {
            source,
            options: Options::default(),
            parameters: None,
            step: None,
            points: 9,
            trajectories: 0,
            seed: 1,
            threads: None,
        }
    }

    /// Runs it.
    ///
    /// # Errors
    /// Why there are no derivatives: see [`SensitivityError`].
    pub fn run(&self) -> Result<SensitivityResult, SensitivityError> {
        self.run_watched(Watch::NONE)
    }

    /// The same; `watch` hears the finished part.
    ///
    /// # Errors
    /// As [`Self::run`], and [`SensitivityError::Interrupted`].
    pub fn run_watched(&self, watch: Watch<'_>) -> Result<SensitivityResult, SensitivityError> {
        if self.points < 3 {
            let (name, value) = ("the number of clearances", self.points as f64);
            return Err(SensitivityError::Setting { name, value, need: "3 or more" });
        }
        if self.trajectories == 1 {
            let (name, need) = ("the number of random lives", "2 or more, or 0: one tells no scatter");
            return Err(SensitivityError::Setting { name, value: 1.0, need });
        }
        let mut base = Variant::new(self.source, &self.options)?;
        let steps = self.steps(base.turn)?;
        watch.begin("parameters");
        let (sides, left_out) =
            chosen((self.source, &self.options), self.parameters.as_deref(), &mut base, watch)?;
        let mechanism = Mechanism::of(&base.compiled, &self.options, Backend::Auto)
            .map_err(|error| SensitivityError::Wear(error.to_string()))?;
        let settings = LifeSettings::new(base.joints.clone());
        watch.begin("path");
        let wears = with_source(&mechanism, |source| {
            let turns = source.turns_to_repeat()?;
            if turns > 1 {
                return Err(SensitivityError::SeveralTurns { turns });
            }
            self.wears(&base, &settings, source)
        })?;
        watch.begin("turns");
        let survey = Survey {
            variant: &base,
            sides: &sides,
            steps,
            is_path_asked: self.trajectories > 0,
            threads: self.threads(),
        };
        let empty = linkwear_codegen::tape::Recorder::default().finish("nothing", 0, &[]);
        let measured = with_source(&mechanism, |source| {
            if Routine::<8>::new(&empty).is_ok() || Routine::<4>::new(&empty).is_err() {
                survey.measure::<8>(source, &wears, watch)
            } else {
                survey.measure::<4>(source, &wears, watch)
            }
        })?;
        if measured.rough.is_empty() {
            self.smooth(&base, (sides, left_out), &measured, watch)
        } else {
            self.rough((&base, &mechanism), (sides, left_out), measured, watch)
        }
    }

    fn threads(&self) -> usize {
        self.threads.or_else(|| available_parallelism().ok()).map_or(1, NonZero::get)
    }

    /// Steps of a turn, if their length was chosen.
    fn steps(&self, turn: f64) -> Result<Option<u64>, SensitivityError> {
        let Some(step) = self.step else { return Ok(None) };
        let steps = (turn / step).ceil();
        if !(step > 0.0 && step <= turn && steps < 1e9) {
            let (name, need) = ("the step", "above zero and at most a turn");
            return Err(SensitivityError::Setting { name, value: step, need });
        }
        Ok(Some(steps as u64))
    }

    /// Wears of all joints [m] where turns are run: those of the joint that fails are as far apart as clearances grow by one factor.
    fn wears(
        &self,
        base: &Variant,
        settings: &LifeSettings,
        source: &mut DynamicsSource<'_>,
    ) -> Result<Vec<Vec<f64>>, SensitivityError> {
        let table = WearTable::measure(settings, source, self.points, Watch::NONE)
            .map_err(|error| SensitivityError::Wear(error.to_string()))?;
        let flow = table.flow(settings).ok_or(SensitivityError::NoPath)?;
        let (slower, settings) = (base.slower(), settings.clone());
        let along = Along { flow, settings, slower, processes: Vec::new() };
        let settings = &along.settings;
        let (lead, life) = along.end();
        let threshold = settings.joints[lead].threshold;
        let growth = settings.joints[lead].gamma() * threshold / settings.joints[lead].clearance;
        let place = |at: usize| {
            let part = at as f64 / (self.points - 1) as f64;
            if growth > 0.0 {
                threshold * (part * growth.ln_1p()).exp_m1() / growth
            } else {
                part * threshold
            }
        };
        let wear = |at: usize| {
            let own = place(at);
            let time = along.flow.time(lead, 0.0, own).min(life);
            let of = |joint: usize| if joint == lead { own } else { along.worn_after(joint, time) };
            (0..settings.joints.len()).map(of).collect()
        };
        Ok((0..self.points).map(wear).collect())
    }

    /// By turns at all clearances.
    fn smooth(
        &self,
        base: &Variant,
        (sides, left_out): (Vec<Sides>, Vec<LeftOut>),
        measured: &Points,
        watch: Watch<'_>,
    ) -> Result<SensitivityResult, SensitivityError> {
        let paths = |points: &[Point]| self.paths(base, &sides, points);
        let coarse = coarser(&measured.points).map(|points| paths(&points)).transpose()?;
        let by_half = paths(&every_second(&measured.points))?.mean();
        let without = without_each(&measured.points).map(|points| Ok(paths(&points)?.mean().slopes));
        let without = without.collect::<Result<Vec<_>, SensitivityError>>()?;
        let paths = paths(&measured.points)?;
        let (mean, coarse) = (paths.mean(), coarse.map(|coarse| coarse.mean()));
        let of_steps = doubts(&mean.slopes, coarse.as_ref().map(|coarse| &*coarse.slopes));
        let of_points = doubts_of_points(&mean.slopes, &by_half.slopes, &without);
        let doubts = of_steps.iter().zip(of_points).map(|(steps, points)| steps + points);
        let cycles = Derived { value: mean.cycles, doubts: doubts.collect(), by: mean.slopes };
        let life =
            LifeSensitivity { joint: base.joints[mean.joint].joint.clone(), cycles, is_by_lives: false };
        let drawn = if self.trajectories > 0 {
            Some(random((self.trajectories, self.seed), &paths, watch)?)
        } else {
            None
        };
        Ok(result(base, (sides, left_out), measured, (life, drawn)))
    }

    /// By lives of the dynamics, where turns at some clearances say too little, or a journal wears, whose depth has no derivatives. Parameters without such lives are left out.
    fn rough(
        &self,
        (base, mechanism): (&Variant, &Mechanism),
        (sides, mut left_out): (Vec<Sides>, Vec<LeftOut>),
        mut measured: Points,
        watch: Watch<'_>,
    ) -> Result<SensitivityResult, SensitivityError> {
        let wide = Wide { source: self.source, options: &self.options, threads: self.threads() };
        let WideLife { joint, cycles, losses, slopes } = wide.life(mechanism, &sides, watch)?;
        measured.losses = measured.losses.max(losses);
        measured.keep(|place| slopes[place].is_some());
        let (mut kept, mut by, mut doubts) = (Vec::new(), Vec::new(), Vec::new());
        let mut refused = None;
        for (sides, slope) in sides.into_iter().zip(slopes) {
            let Some([slope, doubt]) = slope else {
                let parameter = sides.of.name;
                let error = SensitivityError::NoLives { parameter: parameter.clone() };
                left_out.push(LeftOut { parameter, reason: error.to_string() });
                refused.get_or_insert(error);
                continue;
            };
            kept.push(sides);
            by.push(slope);
            doubts.push(doubt);
        }
        if let (Some(error), true) = (refused, kept.is_empty() && self.parameters.is_some()) {
            return Err(error);
        }
        let life =
            LifeSensitivity { joint, cycles: Derived { value: cycles, by, doubts }, is_by_lives: true };
        let mut drawn = None;
        let mut neighbours = None;
        if measured.points.is_empty() {
            // Derivatives of the unworn mechanism's turns did not settle: differences tell how it wears.
            let unworn = measured.rough.remove(0);
            let beside = neighbours.insert(Neighbours::new(&kept, &wide)?);
            measured.points.push(beside.point(&kept, unworn, self.threads())?);
        }
        if self.trajectories > 0 {
            watch.begin("turns beside it");
            let mut neighbours = match neighbours {
                Some(neighbours) => neighbours,
                None => Neighbours::new(&kept, &wide)?,
            };
            let (mut points, rough) = (measured.points.clone(), std::mem::take(&mut measured.rough));
            let count = rough.len() as f64;
            for (place, (worn, known)) in rough.into_iter().enumerate() {
                if watch.report(place as f64 / count).is_break() {
                    return Err(SensitivityError::Interrupted);
                }
                points.push(neighbours.point(&kept, (worn, known), self.threads())?);
            }
            let paths = self.paths(base, &kept, &points)?;
            let mut lives = random((self.trajectories, self.seed), &paths, watch)?;
            // Random lives cross the same ripples: their mean is off by as much as the mean path by these points.
            for ((mean, path), life) in lives.mean.by.iter_mut().zip(paths.mean().slopes).zip(&life.cycles.by)
            {
                *mean += life - path;
            }
            drawn = Some(lives);
        }
        Ok(result(base, (kept, left_out), &measured, (life, drawn)))
    }

    /// Lives of the mechanism and of those beside it.
    fn paths(&self, base: &Variant, sides: &[Sides], points: &[Point]) -> Result<Paths, SensitivityError> {
        let along = |variant, shift| self.along(variant, points, shift);
        let beside = sides.iter().enumerate().map(|(at, sides)| {
            let [below, above] = &sides.sides;
            let pair = [along(below, Some((at, -sides.step)))?, along(above, Some((at, sides.step)))?];
            Ok((pair, sides.step))
        });
        Ok(Paths { beside: beside.collect::<Result<_, SensitivityError>>()?, base: along(base, None)? })
    }

    /// Lives of a mechanism whose wear is that of the points, moved along their derivatives by a step of a parameter.
    fn along(
        &self,
        variant: &Variant,
        points: &[Point],
        shift: Option<(usize, f64)>,
    ) -> Result<Along, SensitivityError> {
        let settings = LifeSettings::new(variant.joints.clone());
        let moved = |point: &Point| {
            let each = point.measured.iter().zip(&point.wear);
            let measured = each.map(|(known, wear)| {
                let value = |which: usize| {
                    let slope = shift.map_or(0.0, |(at, step)| step * wear.slopes[at][which]);
                    wear.values[which] + slope
                };
                ContactMeasure { wear_integral: value(0), depth: value(1), ..known.clone() }
            });
            (point.worn.clone(), measured.collect())
        };
        let table = WearTable::of_points(&settings, points.iter().map(moved).collect())?;
        let flow = table.flow(&settings).ok_or(SensitivityError::NoPath)?;
        let processes = if self.trajectories > 0 { processes(variant, &flow)? } else { Vec::new() };
        Ok(Along { flow, settings, slower: variant.slower(), processes })
    }
}

fn result(
    base: &Variant,
    (sides, left_out): (Vec<Sides>, Vec<LeftOut>),
    measured: &Points,
    (life, random): (LifeSensitivity, Option<RandomSensitivity>),
) -> SensitivityResult {
    let joints = (0..base.joints.len()).map(|joint| joint_sensitivity(base, &measured.points[0], joint));
    SensitivityResult {
        joints: joints.collect(),
        life,
        random,
        parameters: sides.into_iter().map(|sides| sides.of).collect(),
        left_out,
        steps: measured.steps,
        step: base.turn / measured.steps as f64,
        step_error: measured.step_error,
        turns: measured.turns,
        losses: measured.losses,
        points: measured.points.len(),
    }
}
