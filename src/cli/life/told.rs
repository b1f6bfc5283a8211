//! What `life` says, for machines. In: a life, its statistics. Out: [`LifeAnswer`]. Never knows text.

use linkwear_gamma::life::{Contribution, CountedLives, LifeStatistics};
use linkwear_runtime::life::{Feedback, JointLife};
use linkwear_runtime::wear::Profile;
use serde_json::Value;

use super::super::answer::common::Ends;
use super::super::answer::life::{
    AloneAnswer, CycleAnswer, Duration, EndedAnswer, HalfWidths, Intervals, JointSpreadAnswer, LifeAnswer,
    LongerAnswer, MeanPathAnswer, MissionAnswer, ProcessAnswer, ScatterAnswer, SegmentAnswer, Sources,
    SpreadAnswer, StandardErrors, TimeAnswer, WearSpreadAnswer, WornAnswer, known,
};
use super::super::failure::remarks;
use crate::life::{
    Coupling, JointProcess, LifeFacts, LifeNumbers, LifePaths, LifeResult, MissionResult, SegmentResult,
    Spread, WornPair,
};

/// Points of the reliability function.
const POINTS: usize = 40;
/// Groups of cycles of a histogram, at most.
const GROUPS: f64 = 60.0;

/// All of it.
pub fn told_of<'a>(
    facts: &'a LifeFacts,
    life: &'a LifeResult,
    statistics: Option<&LifeStatistics>,
) -> LifeAnswer<'a> {
    let names = life.names();
    let joint = life.failed_joint();
    let LifeNumbers { mean, std, cov, p10, p50, p90, mean_whole_cycles, revolutions, .. } =
        life.numbers(statistics);
    let quantiles = [p10, p50, p90];
    let budget = life.budget();
    LifeAnswer {
        name: &facts.name,
        backend: &facts.backend,
        coupling: match life.coupling {
            Coupling::Table => "table",
            Coupling::Full => "full",
        },
        mean,
        std,
        cov,
        quantiles: quantiles.into(),
        mean_whole_cycles,
        trajectories: life.random_lives().max(1),
        random: life.random_lives() > 0,
        seed: facts.seed,
        mean_path: MeanPathAnswer {
            cycles: life.end.cycles,
            whole_cycles: life.end.whole_cycles,
            step_error: life.step_error,
        },
        failed_joint: &joint.joint,
        revolutions_per_cycle: joint.revolutions_per_cycle,
        revolutions,
        parameters: life.process.as_ref().map(|joints| joints.iter().map(process_entry).collect()),
        shared_factor: facts.shared_factor,
        table_error: life.table_error(),
        thresholds_m: life.joints.iter().map(|joint| (joint.joint.clone(), joint.threshold.into())).collect(),
        measurements: life.measurements,
        cycles: life.cycles.iter().map(|cycle| CycleAnswer::new(&names, cycle)).collect(),
        wear_measures: &facts.wear_measures,
        worn: life.worn.iter().map(worn_of).collect(),
        warnings: remarks(facts.warnings.clone(), "life", &life.warnings),
        time: life.seconds_per_cycle().map(|seconds| {
            let time = |cycles: f64| Duration::of(cycles * seconds);
            TimeAnswer {
                seconds_per_cycle: seconds,
                mean: time(mean),
                std: time(std),
                quantiles: quantiles.map(time).into(),
            }
        }),
        mission: life.mission.as_ref().map(|mission| mission_of(life, mission, mean)),
        scatter: statistics.map(|lives| scatter_of(life, lives)),
        error_budget: HalfWidths {
            half_widths_95: Sources::of(&budget, Contribution::half_width),
            total: budget.known_total(),
        },
    }
}

/// Bush and journal by angle.
fn worn_of(worn: &WornPair) -> WornAnswer<'_> {
    let journal = &worn.journal;
    WornAnswer {
        joint: &worn.joint,
        angle_rad: (0..journal.depths().len()).map(|bin| journal.middle(bin)).collect(),
        bush_m: worn.bush.as_ref().map(Profile::depths),
        journal_m: journal.depths(),
    }
}

/// How the machine was used.
fn mission_of<'a>(life: &'a LifeResult, mission: &'a MissionResult, mean: f64) -> MissionAnswer<'a> {
    let segment = |segment: &'a SegmentResult| SegmentAnswer {
        name: &segment.name,
        time_share: segment.time,
        revolution_share: segment.revolutions,
        set: segment.set.iter().map(|(name, value)| (name.clone(), (*value).into())).collect(),
        duration: segment.duration,
        seconds_per_revolution: segment.seconds_per_revolution,
        wear_shares: life.names().into_iter().zip(segment.wear.iter().map(|share| (*share).into())).collect(),
        alone: segment.alone.map(|alone| {
            let joint = &life.joints[alone.joint];
            let revolutions = alone.cycles * joint.revolutions_per_cycle;
            let time = segment.seconds_per_revolution.map(|seconds| Duration::of(revolutions * seconds));
            AloneAnswer { failed_joint: &joint.joint, cycles: alone.cycles, revolutions, time }
        }),
    };
    MissionAnswer {
        name: &mission.name,
        seconds: mission.seconds,
        missions: life.missions_of(mean),
        seconds_per_revolution: life.seconds_per_revolution,
        binning_error: mission.binning,
        segments: mission.segments.iter().map(segment).collect(),
    }
}

/// What random lives tell.
fn scatter_of(life: &LifeResult, lives: &LifeStatistics) -> ScatterAnswer {
    const PARTS: [f64; 3] = [0.1, 0.5, 0.9];
    let ends = |[lower, upper]: [Option<f64>; 2]| Ends { lower, upper };
    let (mean, half) = (lives.mean().value, lives.mean_half_width());
    let (low, high) = lives.std_interval();
    let first = life.names().into_iter().zip(life.failed_first().into_iter().map(Value::from));
    ScatterAnswer {
        standard_errors: StandardErrors {
            mean: lives.mean().error,
            std: known(lives.std().error),
            cov: lives.cov().into(),
            quantiles: PARTS.map(|p| Some(lives.quantile(p).ok()?.error)).into(),
        },
        intervals95: Intervals {
            mean: ends([Some(mean - half), Some(mean + half)]),
            std: ends([Some(low), Some(high)]),
            quantiles: PARTS.map(|p| Some(ends(lives.quantile_interval(p).ok()?))).into(),
        },
        bin_error: life.counted.is_some().then_some(CountedLives::ERROR),
        reliability: reliability(lives),
        histogram: histogram(lives),
        wear_spread: life.paths.as_ref().map(|paths| spread(life, paths)),
        failed_first: first.collect(),
    }
}

/// The part of the lives that is longer, from before the first failure to after the last.
fn reliability(lives: &LifeStatistics) -> Vec<LongerAnswer> {
    let (first, last) = (lives.shortest().floor(), lives.longest().ceil());
    let points = (0..=POINTS).map(|at| {
        let cycles = first + (last - first) * at as f64 / POINTS as f64;
        let part = lives.reliability(cycles);
        LongerAnswer { cycles, reliability: part.value, standard_error: part.error }
    });
    points.collect()
}

/// The part of the lives that ends in each cycle, or in each group of cycles.
fn histogram(lives: &LifeStatistics) -> Vec<EndedAnswer> {
    let (first, last) = (lives.shortest().ceil() - 1.0, lives.longest().ceil());
    let wide = ((last - first) / GROUPS).ceil().max(1.0);
    let ends = |at: usize| {
        let from = first + wide * at as f64;
        let [longer, left] = [from, from + wide].map(|cycles| lives.reliability(cycles).value);
        EndedAnswer { from, to: from + wide, part: longer - left }
    };
    (0..).map(ends).take_while(|ended| ended.from < last).collect()
}

/// Wear of lives as they were lived.
fn spread(life: &LifeResult, paths: &LifePaths) -> WearSpreadAnswer {
    let joint = |(joint, wear_m): (&JointLife, [f64; 3])| JointSpreadAnswer {
        joint: joint.joint.clone(),
        wear_m: wear_m.into(),
        clearance_m: match joint.feedback {
            Feedback::Scalar(feedback) => {
                Some(wear_m.map(|wear| feedback.next_clearance(joint.clearance, wear)).into())
            }
            Feedback::Profile => None,
        },
    };
    let cycle = |Spread { cycle, ended, wear }| SpreadAnswer {
        cycle,
        ended,
        joints: life.joints.iter().zip(wear).map(joint).collect(),
    };
    WearSpreadAnswer {
        lives: paths.lives(),
        cycles: paths.spread(&life.joints).into_iter().map(cycle).collect(),
    }
}

fn process_entry(joint: &JointProcess) -> ProcessAnswer<'_> {
    let [alpha_per_um, beta_per_um] = joint.per_micrometre();
    ProcessAnswer {
        joint: &joint.joint,
        alpha_per_um,
        beta_per_um,
        from: joint.from.as_deref().unwrap_or("file"),
        cycle_variation: joint.cycle_variation,
    }
}
