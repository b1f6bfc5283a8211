//! Benchmarks that nobody here made: Andrews' squeezer, the N four-bar, Bricard's mechanism, the stiff flyball
//! governor. Numbers and sources: tests/reference/README.md.

mod support;
mod truth;

use linkwear_codegen::source::SourceFile;
use linkwear_runtime::Span;
use support::{Recorded, Table, compile_source, compiled, run, shipped};
use truth::reached;

const START: Span = Span::Time(0.0);

#[test]
fn andrews_squeezer_reaches_the_reference_at_0_03_s() {
    let table = Table::reference("andrews.csv");
    let run = run(&compiled("andrews", &[], None), Span::Time(0.03), START, 31, 1e-12);
    for (quantity, suffix, bound, what) in [("q", "", 1e-8, "angles"), ("v", "_dot", 1e-6, "speeds")] {
        let errors = ["beta", "Theta", "gamma", "Phi", "delta", "Omega", "epsilon"].map(|name| {
            let expected = table.column(&format!("{name}{suffix}"))[1];
            (run.last(&format!("{name}.{quantity}")) / expected - 1.0).abs()
        });
        let what = format!("{what} at 0.03 s, relative");
        reached("Andrews' squeezer", &what, errors.into_iter().fold(0.0, f64::max), bound);
    }
    assert!(run.description.channels.iter().any(|channel| channel.name.ends_with(".lambda1")));
    assert_energy("Andrews' squeezer", &run);
}

fn assert_energy(case: &str, run: &Recorded) {
    let statistics = &run.run.statistics;
    // The bound for conservative mechanisms; here for all of them, losses accounted for.
    let drift = statistics.energy_error_J / statistics.energy_throughput_J;
    reached(case, "energy, of what went through", drift, 1e-8);
    reached(case, "loop error [m]", statistics.max_loop_error_m, 1e-10);
}

/// Largest distance of B0 from the regular branch at the reference times, and the steps it took.
fn n_four_bar(name: &str, cells: f64, end: f64, tolerance: f64) -> (f64, u64) {
    let table = Table::reference("n_four_bar.csv");
    let samples = 401;
    let run = run(&compiled(name, &[], None), Span::Time(end), START, samples, tolerance);
    let (x, y) = (run.column("B0.x"), run.column("B0.y"));
    let mut worst: f64 = 0.0;
    for row in 0..table.len() {
        if table.column("cells")[row] == cells {
            let at = (table.column("t")[row] / end * (samples - 1) as f64).round() as usize;
            worst = worst.max((x[at] - table.column("x")[row]).hypot(y[at] - table.column("y")[row]));
        }
    }
    eprintln!("{tolerance:e}: {worst:e} {:?}", run.run.statistics);
    (worst, run.run.statistics.steps)
}

/// Errors fall with the tolerance down to what rounding at singular positions leaves, `floor` [m] but for a factor of two; steps
/// grow as an order of five has it.
fn assert_tighter_is_better(runs: &[(f64, u64)], floor: f64) {
    for pair in runs.windows(2) {
        let [(before, fewer), (error, steps)] = [pair[0], pair[1]];
        assert!(error < before.max(2.0 * floor), "{runs:?}");
        // 10^(1/5) is 1.6; steps shortened to fight rounding would be many more.
        assert!((steps as f64) < 2.0 * fewer as f64, "{runs:?}");
    }
}

#[test]
fn n_four_bar_with_2_cells_stays_on_its_branch_for_10_s() {
    let tolerances = [1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13];
    let runs = tolerances.map(|tolerance| n_four_bar("n_four_bar_2", 2.0, 10.0, tolerance));
    reached("N four-bar, 2 cells", "position of B0 to 10 s [m]", runs[2].0, 5e-9);
    assert_tighter_is_better(&runs, 5e-9);
}

#[test]
fn n_four_bar_with_2_cells_stays_on_its_branch_wherever_its_steps_end() {
    // Some steps would end in singular positions but for 1e-4 rad. Where projections moved what the loops hardly hold there, three
    // of these tolerances gave 2e-7 to 3e-6 m; where steps ended there, one in ten of any gave 5e-9 to 4e-8 m.
    for k in 0..24 {
        let tolerance = 10_f64.powf(-10.0 - 0.125 * f64::from(k));
        let (error, _) = n_four_bar("n_four_bar_2", 2.0, 10.0, tolerance);
        assert!(error < 5e-9, "{tolerance:e}: {error:e}");
    }
}

/// Loops keep their digits wherever the origin is: rounding of a loop shows a million times in the speeds of a singular position.
#[test]
fn n_four_bar_drawn_a_kilometre_off_moves_the_same() {
    let near = shipped("n_four_bar_2");
    let text = near.text.replace("[\"0 m\"", "[\"1 km\"").replace("[\"{i}*L", "[\"1 km + {i}*L");
    assert_ne!(near.text, text);
    let far = SourceFile { text, ..near.clone() };
    let [near, far] = [(near, 0.0), (far, 1e3)].map(|(source, off)| {
        let run = run(&compile_source(&source, &[], None), Span::Time(10.0), START, 101, 1e-11);
        run.column("B0.x").iter().map(|x| x - off).collect::<Vec<f64>>()
    });
    let apart = near.iter().zip(&far).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    // A last place of a kilometre is 1.1e-13 m. When places were subtracted as they are, this run ended at 8.5 s.
    assert!(apart < 1e-12, "{apart:e}");
}

#[test]
fn n_four_bar_with_40_cells_stays_on_its_branch_for_20_s() {
    let (error, _) = n_four_bar("n_four_bar_40", 40.0, 20.0, 1e-9);
    // 1e-3 is what the benchmark calls high precision.
    reached("N four-bar, 40 cells", "position of B0 to 20 s [m]", error, 1e-3);
}

#[test]
#[ignore = "ten seconds of a release build, minutes of another; run with --ignored"]
fn n_four_bar_with_40_cells_gets_better_with_the_tolerance() {
    let tolerances = [1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13];
    let runs = tolerances.map(|tolerance| n_four_bar("n_four_bar_40", 40.0, 20.0, tolerance));
    // Forty loops in a row, twice as long: rounding of each shows in the next ones.
    assert_tighter_is_better(&runs, 2e-8);
    // Steps end elsewhere beside the singular positions with every tolerance, and there rounding shows most.
    let between = [-9.75, -10.25, -10.5, -10.75, -11.25, -11.5, -11.75, -12.25, -12.5, -12.75];
    for tolerance in between.map(|exponent| 10_f64.powf(exponent)) {
        let (error, _) = n_four_bar("n_four_bar_40", 40.0, 20.0, tolerance);
        assert!(error < 2e-8, "{tolerance:e}: {error:e}");
    }
}

#[test]
fn bricard_has_one_freedom_and_reaches_the_reference_after_1_s() {
    let compiled = compiled("bricard", &[], None);
    assert_eq!((compiled.analysis.mobility, compiled.analysis.redundant.len()), (1, 1));
    let run = run(&compiled, Span::Time(1.0), START, 11, 1e-11);
    let table = Table::reference("bricard.csv");
    let errors = ["x", "y", "z"].map(|axis| (run.last(&format!("P3.{axis}")) - table.column(axis)[0]).abs());
    reached("Bricard", "position of P3 at 1 s [m]", errors.into_iter().fold(0.0, f64::max), 1e-6);
    assert_energy("Bricard, 1 s", &run);
}

#[test]
fn bricard_keeps_its_energy_for_10_s() {
    assert_energy(
        "Bricard, 10 s",
        &run(&compiled("bricard", &[], None), Span::Time(10.0), START, 101, 1e-10),
    );
}

#[test]
fn flyball_governor_climbs_as_the_reference_does() {
    let run = run(&compiled("flyball", &[], None), Span::Time(10.0), START, 11, 1e-9);
    let table = Table::reference("flyball.csv");
    let heights = run.column("S.z");
    let error = |row: usize| (heights[table.column("t")[row] as usize] - table.column("s")[row]).abs();
    reached("flyball governor", "height to 10 s [m]", (0..table.len()).map(error).fold(0.0, f64::max), 1e-5);
}
