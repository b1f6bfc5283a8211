//! Lives from a table against lives that run their own dynamics, for every model of the contact area. The case study's
//! compiled equations; only what its description says of the area changes.

use std::num::NonZero;

use linkwear::mechanisms::rssr;
use linkwear_gamma::monte_carlo::{Ended, GammaDraw, MonteCarlo};
use linkwear_runtime::life::{
    DEFAULT_POINTS, LifeOutcome, LifeSettings, LifeState, MeanIncrement, WearSource, WearStep, WearTable,
    calibrate, run_life,
};
use linkwear_runtime::wear::Area;
use linkwear_runtime::{Description, DynamicsSource, RevolutionSettings, System, Watch};

/// Cycles of the deterministic life.
const CYCLES: f64 = 25.1;

struct Case {
    description: Description,
    system: rssr::Mechanism,
}

impl Case {
    fn new(area: Area) -> Self {
        let mut description = rssr::description().clone();
        let wear = description.contacts.to_mut()[0].wear.as_mut().expect("R1 wears");
        wear.area = area;
        Self { description, system: rssr::Mechanism::default() }
    }

    fn revolutions<'a>(&'a self, system: &'a dyn System<f64>) -> DynamicsSource<'a> {
        let parameters: Vec<f64> =
            self.description.parameters.iter().map(|parameter| parameter.default).collect();
        DynamicsSource::new(system, &self.description, &parameters, RevolutionSettings::default())
            .expect("a start")
    }

    /// Settings with cycles of the right length, and the table they come from.
    fn calibrated(&self) -> (LifeSettings, WearTable) {
        let mut fine = self.revolutions(&self.system);
        let mut settings = LifeSettings::new(fine.joints().expect("numbers in range"));
        let mut table =
            WearTable::measure(&settings, &mut fine, DEFAULT_POINTS, Watch::NONE).expect("a table");
        settings.step = WearStep::TABLE;
        let found = calibrate(&settings, &mut table, CYCLES, 1e-6).expect("a length of cycles");
        (settings.with_longer_cycles(found.factor), table)
    }
}

fn mean_life<F: WearSource>(settings: &LifeSettings, fine: &mut F) -> f64
where
    F::Error: std::fmt::Debug,
{
    let mut state = LifeState::new(settings, 0).expect("settings");
    match run_life(settings, fine, &MeanIncrement, &mut state, Watch::NONE) {
        Ok(LifeOutcome::Failed(failure)) => failure.cycles,
        other => panic!("{other:?}"),
    }
}

fn deterministic(area: Area, bound: f64) {
    let case = Case::new(area);
    let (mut settings, mut table) = case.calibrated();
    let by_table = mean_life(&settings, &mut table);
    settings.step = WearStep::FULL;
    let full = mean_life(&settings, &mut case.revolutions(&case.system));
    println!(
        "{area:?}: {:.4e} revolutions per cycle, table {by_table:.4}, full {full:.4}",
        settings.joints[0].revolutions_per_cycle
    );
    assert!((full - by_table).abs() < bound, "{area:?}: {by_table} {full}");
}

#[test]
fn the_mean_path_over_the_projected_area_is_the_same_by_table() {
    deterministic(Area::Projected, 0.02);
}

#[test]
#[ignore = "minutes; cargo test --test table_against_full -- --ignored --nocapture"]
fn the_mean_path_over_an_arc_is_the_same_by_table() {
    deterministic(Area::Conformal, 0.02);
}

#[test]
#[ignore = "minutes; cargo test --test table_against_full -- --ignored --nocapture"]
fn the_mean_path_over_the_width_of_hertz_is_nearly_the_same_by_table() {
    // Resonances that 17 points cannot follow.
    deterministic(Area::Hertz, 0.05);
}

/// 16 random lives, the same random numbers.
fn random(area: Area, bound: f64) {
    let case = Case::new(area);
    let (settings, table) = case.calibrated();
    let scatter = case.description.contacts[0].wear.and_then(|wear| wear.scatter).expect("a Gamma process");
    let draw = GammaDraw::new(1, &[scatter]);
    let full_settings = LifeSettings { step: WearStep::FULL, ..settings.clone() };
    let threads = NonZero::new(2).expect("two");
    let run = |settings| MonteCarlo { settings, draw: &draw, trajectories: 0..16, threads };
    let by_table = run(&settings).run(
        &|lend| {
            lend(&mut table.clone());
            Ok(())
        },
        Watch::NONE,
    );
    let full = run(&full_settings).run(
        &|lend| {
            let system = rssr::Mechanism::default();
            lend(&mut case.revolutions(&system));
            Ok(())
        },
        Watch::NONE,
    );
    assert_eq!((&by_table.ended, &full.ended), (&Ended::Complete, &Ended::Complete));
    let pairs = by_table.failures.iter().zip(&full.failures);
    let differences: Vec<f64> = pairs.map(|((_, a), (_, b))| (a.cycles - b.cycles).abs()).collect();
    let mean = differences.iter().sum::<f64>() / differences.len() as f64;
    println!("{area:?}: mean absolute difference of 16 lives {mean:.5} cycles, {differences:.4?}");
    assert!(mean < bound, "{area:?}: {mean}");
}

#[test]
#[ignore = "ten minutes; cargo test --test table_against_full -- --ignored --nocapture"]
fn random_lives_over_the_projected_area_are_the_same_by_table() {
    random(Area::Projected, 0.02);
}

#[test]
#[ignore = "ten minutes; cargo test --test table_against_full -- --ignored --nocapture"]
fn random_lives_over_an_arc_are_the_same_by_table() {
    random(Area::Conformal, 0.02);
}

#[test]
#[ignore = "ten minutes; cargo test --test table_against_full -- --ignored --nocapture"]
fn random_lives_over_the_width_of_hertz_are_nearly_the_same_by_table() {
    random(Area::Hertz, 0.05);
}
