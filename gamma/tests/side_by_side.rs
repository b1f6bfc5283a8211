//! Lives by a table, solved beforehand and lived side by side: the lives that going cycle by cycle gives, the same bits for any
//! threads and any split into ranges.

#![allow(clippy::disallowed_methods)]

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::num::NonZero;
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicUsize, Ordering};

use allocation_counter::measure;
use linkwear_gamma::life::LifeStatistics;
use linkwear_gamma::monte_carlo::{Ended, GammaDraw, Lives, MonteCarlo};
use linkwear_gamma::series::SharedFactor;
use linkwear_runtime::life::{
    DEFAULT_POINTS, FailureEvent, Feedback, JointLife, JointWear, LifeSettings, WearOf, WearSource, WearStep,
    WearTable,
};
use linkwear_runtime::wear::{ContactMeasure, Limits, Measure, Observed, Profile, ScalarFeedback};
use linkwear_runtime::{GammaRates, Watch};

const RATES: GammaRates = GammaRates { alpha: 13.65e6, beta: 13.65e6 };
const THRESHOLD: f64 = 80e-6;
const C0: f64 = 10e-6;

/// Joints of which each wears with a power of its own clearance, and a table of them would have kinks.
#[derive(Clone)]
struct Powers(Vec<f64>);

impl WearSource for Powers {
    type State = ();
    type Error = Infallible;

    fn measure(&mut self, joints: &[JointWear], (): &mut ()) -> Result<Vec<ContactMeasure>, Infallible> {
        let wear = |(joint, power): (&JointWear, &f64)| {
            let worn = joint.clearance / C0;
            let depth = 3.2e-6 * libm::pow(worn, *power) * (1.0 + 0.02 * libm::sin(2.0 * worn));
            ContactMeasure {
                wear_integral: 2.0,
                depth,
                mean_force: 30.0,
                peak_force: 50.0,
                losses: 0.0,
                touching: 1.0,
                loss: 0.0,
                deposit: Profile::try_from(vec![0.5 * depth, depth, 1.5 * depth, depth]).ok(),
                journal: None,
                observed: Some(Observed::nothing(joint.clearance, 0.01)),
            }
        };
        Ok(joints.iter().zip(&self.0).map(wear).collect())
    }
}

/// The same table for those who go cycle by cycle.
#[derive(Clone)]
struct CycleByCycle(WearTable);

impl WearSource for CycleByCycle {
    type State = ();
    type Error = Infallible;

    fn measure(&mut self, joints: &[JointWear], state: &mut ()) -> Result<Vec<ContactMeasure>, Infallible> {
        self.0.measure(joints, state)
    }
}

fn settings(joints: usize, wear: WearOf) -> LifeSettings {
    let joint = |at: usize| JointLife {
        joint: format!("R{at}"),
        journal_radius: 0.01,
        clearance: C0,
        threshold: THRESHOLD,
        revolutions_per_cycle: 1.0 + 0.02 * at as f64,
        wear,
        feedback: Feedback::Scalar(ScalarFeedback::new(1.0).expect("a factor")),
        bins: (wear != WearOf::Depth).then_some(4),
        journal_bins: None,
        limits: Limits { hardness: 3.5e9, pressure_speed: None },
    };
    let settings = LifeSettings::new((0..joints).map(joint).collect());
    LifeSettings { step: WearStep::TABLE, keep_cycles: false, ..settings }
}

fn table(settings: &LifeSettings, powers: &[f64]) -> WearTable {
    WearTable::measure(settings, &mut Powers(powers.to_vec()), DEFAULT_POINTS, Watch::NONE).expect("a table")
}

fn live<F: WearSource<State = (), Error = Infallible> + Clone + Sync>(
    settings: &LifeSettings,
    draw: &GammaDraw,
    fine: &F,
    (trajectories, threads): (Range<u64>, usize),
) -> Lives<Infallible> {
    let threads = NonZero::new(threads).expect("a thread");
    MonteCarlo { settings, draw, trajectories, threads }.run(
        &|lend| {
            lend(&mut fine.clone());
            Ok(())
        },
        Watch::NONE,
    )
}

fn bits(lives: &Lives<Infallible>) -> Vec<(u64, u64, u64, usize)> {
    assert_eq!(lives.ended, Ended::Complete);
    let bits =
        |(number, end): &(u64, FailureEvent)| (*number, end.cycles.to_bits(), end.whole_cycles, end.joint);
    lives.failures.iter().map(bits).collect()
}

#[test]
fn lives_are_those_of_going_cycle_by_cycle() {
    let shared = SharedFactor::Gamma { cov: 0.2 };
    for (powers, wear) in [
        (&[0.5][..], WearOf::Depth),
        (&[0.5, 0.3, 0.1], WearOf::Depth),
        (&[0.5], WearOf::Profile(Measure::Mean)),
        (&[0.5], WearOf::Profile(Measure::Maximum)),
    ] {
        let settings = settings(powers.len(), wear);
        let table = table(&settings, powers);
        // The deepest place takes the whole profile.
        let is_deepest = wear == WearOf::Profile(Measure::Maximum);
        assert_eq!(table.flow(&settings).is_none(), is_deepest, "{powers:?} {wear:?}");
        let plain = GammaDraw::new(3, &vec![RATES; powers.len()]);
        for draw in [plain.clone(), plain.sharing(shared).expect("a factor")] {
            let beside = live(&settings, &draw, &table, (0..60, 1));
            let alone = live(&settings, &draw, &CycleByCycle(table.clone()), (0..60, 1));
            assert_eq!((&beside.ended, beside.failures.len()), (&Ended::Complete, 60));
            for ((number, beside), (other, alone)) in beside.failures.iter().zip(&alone.failures) {
                assert_eq!((number, beside.joint), (other, alone.joint));
                // Steps of the mean path are good to 1e-6 of what is gained in them, and nearly all err alike.
                let error = (beside.cycles / alone.cycles - 1.0).abs();
                assert!(error < 3e-6, "{powers:?} {number}: {} {}", beside.cycles, alone.cycles);
                assert!(beside.whole_cycles == alone.whole_cycles || error > 0.0);
            }
        }
    }
}

#[test]
fn threads_and_ranges_change_no_bit() {
    let settings = settings(2, WearOf::Depth);
    let table = table(&settings, &[0.5, 0.4]);
    let draw = GammaDraw::new(9, &[RATES; 2]);
    let of = |range: Range<u64>, threads| bits(&live(&settings, &draw, &table, (range, threads)));
    let whole = of(0..3000, 1);
    assert_eq!(whole.len(), 3000);
    for threads in [2, 7] {
        assert_eq!(whole, of(0..3000, threads), "{threads} threads");
    }
    // Every life stands in any lane, beside any others.
    for cuts in [&[0, 1, 2, 3, 11, 600, 3000][..], &[0, 511, 512, 513, 1031, 3000]] {
        let split: Vec<_> = cuts.windows(2).flat_map(|cut| of(cut[0]..cut[1], 2)).collect();
        assert_eq!(whole, split, "{cuts:?}");
    }
    // Pinned: debug and release, now and later, give these bits.
    assert_eq!(whole[0].1, 4_623_225_058_290_142_144, "first life");
}

#[test]
fn known_lives_are_not_lived_again_and_all_others_are_heard_of() {
    let settings = settings(1, WearOf::Depth);
    let table = table(&settings, &[0.5]);
    let draw = GammaDraw::new(9, &[RATES]);
    let known: BTreeMap<u64, FailureEvent> = (0..2000)
        .step_by(3)
        .map(|at| (at, FailureEvent { joint: 0, cycles: 1.5, whole_cycles: 2 }))
        .collect();
    let heard = AtomicUsize::new(0);
    let threads = NonZero::new(2).expect("threads");
    let lives = MonteCarlo { settings: &settings, draw: &draw, trajectories: 0..2000, threads }.go_on(
        &known,
        &|ends| {
            assert!(ends.iter().all(|(number, _)| !known.contains_key(number)));
            heard.fetch_add(ends.len(), Ordering::Relaxed);
        },
        &|lend| {
            lend(&mut table.clone());
            Ok(())
        },
        Watch::NONE,
    );
    assert_eq!((heard.into_inner(), lives.failures.len()), (2000 - known.len(), 2000));
    let all = live(&settings, &draw, &table, (0..2000, 1)).failures;
    for ((number, end), (_, lived)) in lives.failures.iter().zip(&all) {
        assert_eq!(end, known.get(number).unwrap_or(lived));
    }
}

#[test]
fn lives_that_do_not_end_are_told_and_a_watch_stops_between_blocks() {
    let settings = settings(1, WearOf::Depth);
    let table = table(&settings, &[0.5]);
    let draw = GammaDraw::new(9, &[RATES]);
    let all = live(&settings, &draw, &table, (0..100, 1)).failures;
    let longest = all.iter().map(|(_, end)| end.whole_cycles).max().expect("lives");
    let first = all.iter().find(|(_, end)| end.whole_cycles == longest).expect("the longest life").0;
    let short = LifeSettings { most_cycles: longest - 1, ..settings.clone() };
    let lives = live(&short, &draw, &table, (0..100, 1));
    assert_eq!(lives.ended, Ended::Survived { trajectory: first });
    let threads = NonZero::new(1).expect("a thread");
    let stopped = MonteCarlo { settings: &settings, draw: &draw, trajectories: 0..10_000, threads }.run(
        &|lend| {
            lend(&mut table.clone());
            Ok(())
        },
        Watch::new(&|part| if part < 0.1 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }),
    );
    assert_eq!(stopped.ended, Ended::Cancelled);
    assert!((1000..2000).contains(&stopped.failures.len()));
    // What was lived is a part of the whole.
    assert_eq!(stopped.failures[..100], all);
}

#[test]
fn neither_lives_nor_cycles_allocate() {
    let settings = settings(1, WearOf::Depth);
    let table = table(&settings, &[0.5]);
    let draw = GammaDraw::new(9, &[RATES]);
    let allocations = |count| {
        let mut lives = 0;
        let seen = measure(|| lives = live(&settings, &draw, &table, (0..count, 1)).failures.len());
        assert_eq!(lives as u64, count);
        seen.count_total
    };
    let few = allocations(1000);
    assert!(few > 0);
    assert_eq!(few, allocations(4000));
}

#[test]
fn statistics_are_those_of_going_cycle_by_cycle() {
    let settings = settings(1, WearOf::Depth);
    let table = table(&settings, &[0.5]);
    let draw = GammaDraw::new(5, &[RATES]);
    let of = |lives: Lives<Infallible>| {
        let cycles: Vec<f64> = lives.failures.iter().map(|(_, end)| end.cycles).collect();
        LifeStatistics::of(&cycles).expect("lives")
    };
    let beside = of(live(&settings, &draw, &table, (0..300, 2)));
    let alone = of(live(&settings, &draw, &CycleByCycle(table), (0..300, 2)));
    // The same random numbers: far within the standard errors.
    assert!((beside.mean().value - alone.mean().value).abs() < 1e-3 * alone.mean().error);
    assert!((beside.std().value - alone.std().value).abs() < 1e-3 * alone.std().error);
}
