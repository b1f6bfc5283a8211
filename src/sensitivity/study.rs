//! What is asked. In: a file, parameters. Out: a [`SensitivityStudy`] to run.

use std::num::NonZero;
use std::thread::available_parallelism;

use linkwear_codegen::model::Parameter;
use linkwear_codegen::{Options, SourceFile};
use linkwear_gamma::monte_carlo::GammaDraw;
use linkwear_native::Routine;
use linkwear_runtime::life::{LifeSettings, WearFlow, WearSource, WearTable};
use linkwear_runtime::wear::ContactMeasure;
use linkwear_runtime::{DynamicsSource, GammaRates, RevolutionSettings, Watch};

use super::doubts::{coarser, doubts, doubts_of_points, every_second, joint_sensitivity, without_each};
use super::error::SensitivityError;
use super::measured::{Point, Points, Survey};
use super::paths::{Along, Life, Paths};
use super::result::{Derived, LeftOut, LifeSensitivity, RandomSensitivity, SensitivityResult};
use super::varied::{Sides, Variant};
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
    /// The parameters. None: all that are numbers.
    pub parameters: Option<Vec<String>>,
    /// Length of a step [s]. None: short enough.
    pub step: Option<f64>,
    /// Clearances at which turns are run, from that of the unworn mechanism to that of the failed one, at least 3.
    pub points: usize,
    /// Random lives. 0: none.
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
        let base = Variant::new(self.source, &self.options)?;
        let steps = self.steps(base.turn)?;
        watch.begin("parameters");
        let (sides, left_out) = self.sides(&base, watch)?;
        let mechanism = Mechanism::of(&base.compiled, &self.options, Backend::Auto)
            .map_err(|error| SensitivityError::Wear(error.to_string()))?;
        let (system, whole) = (mechanism.system(), mechanism.whole_steps());
        let source = || {
            let settings = RevolutionSettings::default();
            let (description, parameters) = (&mechanism.description, &mechanism.parameters);
            let source = DynamicsSource::new(&*system, description, parameters, settings)?;
            Ok::<_, SensitivityError>(match &whole {
                Some(whole) => source.in_whole_steps(whole),
                None => source,
            })
        };
        let settings = LifeSettings::new(base.joints.clone());
        watch.begin("path");
        let wears = self.wears(&settings, &mut source()?)?;
        watch.begin("turns");
        let threads = self.threads.or_else(|| available_parallelism().ok()).map_or(1, NonZero::get);
        let survey = Survey { variant: &base, sides: &sides, steps, threads };
        let empty = linkwear_codegen::tape::Recorder::default().finish("nothing", 0, &[]);
        let measured = if Routine::<8>::new(&empty).is_ok() || Routine::<4>::new(&empty).is_err() {
            survey.measure::<8>(&mut source()?, &wears, watch)
        } else {
            survey.measure::<4>(&mut source()?, &wears, watch)
        }?;
        self.result((&base, sides, left_out), &measured, watch)
    }

    /// Steps of a turn, if their length was chosen.
    fn steps(&self, turn: f64) -> Result<Option<u64>, SensitivityError> {
        let Some(step) = self.step else { return Ok(None) };
        let steps = (turn / step).ceil();
        if !(step > 0.0 && (1.0..1e9).contains(&steps)) {
            let (name, need) = ("the step", "above zero and at most a turn");
            return Err(SensitivityError::Setting { name, value: step, need });
        }
        Ok(Some(steps as u64))
    }

    /// The mechanism on both sides of every parameter; parameters that were not asked for may be left out.
    fn sides(
        &self,
        base: &Variant,
        watch: Watch<'_>,
    ) -> Result<(Vec<Sides>, Vec<LeftOut>), SensitivityError> {
        let all = &base.compiled.mechanism.parameters;
        let named = |name: &String| {
            let known = || all.iter().map(|parameter| parameter.name.clone()).collect();
            let unknown = || SensitivityError::UnknownParameter { parameter: name.clone(), known: known() };
            all.iter().find(|one| one.name == *name).ok_or_else(unknown)
        };
        let chosen: Vec<&Parameter> = match &self.parameters {
            Some(asked) => asked.iter().map(named).collect::<Result<_, _>>()?,
            None => all.iter().collect(),
        };
        let (mut sides, mut left_out) = (Vec::new(), Vec::new());
        for (place, parameter) in chosen.iter().enumerate() {
            if watch.report(place as f64 / chosen.len() as f64).is_break() {
                return Err(SensitivityError::Interrupted);
            }
            match base.sides(self.source, &self.options, parameter) {
                Ok(found) => sides.push(found),
                Err(error) if self.parameters.is_some() => return Err(error),
                Err(error) => {
                    left_out.push(LeftOut { parameter: parameter.name.clone(), reason: error.to_string() });
                }
            }
        }
        Ok((sides, left_out))
    }

    /// Wears of all joints [m] where turns are run: those of the joint that fails are as far apart as clearances grow by one factor.
    fn wears(
        &self,
        settings: &LifeSettings,
        source: &mut DynamicsSource<'_>,
    ) -> Result<Vec<Vec<f64>>, SensitivityError> {
        let table = WearTable::measure(settings, source, self.points, Watch::NONE)
            .map_err(|error| SensitivityError::Wear(error.to_string()))?;
        let flow = table.flow(settings).ok_or(SensitivityError::NoPath)?;
        let along = Along { flow, settings: settings.clone(), processes: Vec::new() };
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

    fn result(
        &self,
        (base, sides, left_out): (&Variant, Vec<Sides>, Vec<LeftOut>),
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
        let joints = (0..base.joints.len()).map(|joint| joint_sensitivity(base, &measured.points[0], joint));
        let of_steps = doubts(&mean.slopes, coarse.as_ref().map(|coarse| &*coarse.slopes));
        let of_points = doubts_of_points(&mean.slopes, &by_half.slopes, &without);
        let doubts = of_steps.iter().zip(of_points).map(|(steps, points)| steps + points);
        let cycles = Derived { value: mean.cycles, doubts: doubts.collect(), by: mean.slopes };
        let life = LifeSensitivity { joint: base.joints[mean.joint].joint.clone(), cycles };
        let random = if self.trajectories > 0 { Some(self.random(&paths, watch)?) } else { None };
        Ok(SensitivityResult {
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
        })
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
        Ok(Along { flow, settings, processes })
    }

    fn random(&self, paths: &Paths, watch: Watch<'_>) -> Result<RandomSensitivity, SensitivityError> {
        watch.begin("lives");
        let rates = paths
            .base
            .processes
            .iter()
            .map(|[alpha, beta]| GammaRates { alpha: alpha.exp(), beta: beta.exp() });
        let draw = GammaDraw::new(self.seed, &rates.collect::<Vec<_>>());
        let mut lives: Vec<Life> = Vec::new();
        for life in 0..self.trajectories {
            if life % 64 == 0 && watch.report(life as f64 / self.trajectories as f64).is_break() {
                return Err(SensitivityError::Interrupted);
            }
            let cycles = paths.base.settings.most_cycles;
            lives.push(paths.drawn(&draw, life).ok_or(SensitivityError::Endless { life, cycles })?);
        }
        let count = lives.len() as f64;
        let statistics = |of: &dyn Fn(&Life) -> f64| {
            let mean = lives.iter().map(of).sum::<f64>() / count;
            let square = lives.iter().map(|life| (of(life) - mean).powi(2)).sum::<f64>();
            (mean, (square / (count - 1.0).max(1.0) / count).sqrt())
        };
        let (mean, error) = statistics(&|life| life.cycles);
        let by: Vec<(f64, f64)> =
            (0..paths.beside.len()).map(|at| statistics(&|life| life.slopes[at])).collect();
        Ok(RandomSensitivity {
            trajectories: self.trajectories,
            seed: self.seed,
            mean: Derived {
                value: mean,
                by: by.iter().map(|(slope, _)| *slope).collect(),
                doubts: Vec::new(),
            },
            error,
            errors: by.iter().map(|(_, error)| *error).collect(),
        })
    }
}

/// ln alpha and ln beta of every wearing joint.
fn processes(variant: &Variant, flow: &WearFlow) -> Result<Vec<[f64; 2]>, SensitivityError> {
    let contacts = variant.compiled.description().contacts.iter();
    let wearing = contacts.filter_map(|contact| Some((contact, contact.wear.as_ref()?)));
    wearing
        .enumerate()
        .map(|(at, (contact, wear))| {
            if let Some(rates) = wear.scatter {
                return Ok([rates.alpha.ln(), rates.beta.ln()]);
            }
            let missing = || SensitivityError::NoProcess { joint: contact.joint.to_string() };
            let variation = wear.cycle_variation.ok_or_else(missing)?;
            // An increment of mean m has the shape alpha m and so the coefficient of variation 1 / sqrt(alpha m).
            let alpha = -(variation * variation * flow.gain(at, 0.0)).ln();
            Ok([alpha, alpha])
        })
        .collect()
}
