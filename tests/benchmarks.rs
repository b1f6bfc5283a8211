//! Benchmarks that nobody here made: Andrews' squeezer, the N four-bar, Bricard's mechanism, the stiff flyball
//! governor. Numbers and sources: tests/reference/README.md.

mod support;

use linkwear_runtime::Span;
use support::{Recorded, Table, compiled, run};

const START: Span = Span::Time(0.0);

#[test]
fn andrews_squeezer_reaches_the_reference_at_0_03_s() {
    let table = Table::reference("andrews.csv");
    let run = run(&compiled("andrews", &[], None), Span::Time(0.03), START, 31, 1e-12);
    for name in ["beta", "Theta", "gamma", "Phi", "delta", "Omega", "epsilon"] {
        for (quantity, suffix, bound) in [("q", "", 1e-8), ("v", "_dot", 1e-6)] {
            let expected = table.column(&format!("{name}{suffix}"))[1];
            let value = run.last(&format!("{name}.{quantity}"));
            let error = ((value - expected) / expected).abs();
            assert!(error < bound, "{name}.{quantity}: {value} against {expected}: {error:e}");
        }
    }
    assert!(run.description.channels.iter().any(|channel| channel.name.ends_with(".lambda1")));
    assert_energy(&run);
}

fn assert_energy(run: &Recorded) {
    let statistics = &run.run.statistics;
    // The bound for conservative mechanisms; here for all of them, losses accounted for.
    assert!(
        statistics.energy_error_J < 1e-8 * statistics.energy_throughput_J,
        "energy drifts by {:e} J of {:e} J",
        statistics.energy_error_J,
        statistics.energy_throughput_J
    );
    assert!(statistics.max_loop_error_m < 1e-10, "loops open by {:e} m", statistics.max_loop_error_m);
}

/// Largest distance of B0 from the regular branch at the reference times.
fn n_four_bar(name: &str, cells: f64, end: f64, tolerance: f64) -> f64 {
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
    eprintln!("{worst:e} {:?}", run.run.statistics);
    worst
}

#[test]
fn n_four_bar_with_2_cells_stays_on_its_branch_for_10_s() {
    let error = n_four_bar("n_four_bar_2", 2.0, 10.0, 1e-10);
    assert!(error < 1e-5, "{error:e}");
}

#[test]
fn n_four_bar_with_40_cells_stays_on_its_branch_for_20_s() {
    let error = n_four_bar("n_four_bar_40", 40.0, 20.0, 1e-9);
    // 1e-3 is what the benchmark calls high precision.
    assert!(error < 1e-3, "{error:e}");
}

#[test]
fn bricard_has_one_freedom_and_reaches_the_reference_after_1_s() {
    let compiled = compiled("bricard", &[], None);
    assert_eq!((compiled.analysis.mobility, compiled.analysis.redundant.len()), (1, 1));
    let run = run(&compiled, Span::Time(1.0), START, 11, 1e-11);
    let table = Table::reference("bricard.csv");
    for axis in ["x", "y", "z"] {
        let (value, expected) = (run.last(&format!("P3.{axis}")), table.column(axis)[0]);
        assert!((value - expected).abs() < 1e-6, "{axis}: {value} against {expected}");
    }
    assert_energy(&run);
}

#[test]
fn bricard_keeps_its_energy_for_10_s() {
    assert_energy(&run(&compiled("bricard", &[], None), Span::Time(10.0), START, 101, 1e-10));
}

#[test]
fn flyball_governor_climbs_as_the_reference_does() {
    let run = run(&compiled("flyball", &[], None), Span::Time(10.0), START, 11, 1e-9);
    let table = Table::reference("flyball.csv");
    let heights = run.column("S.z");
    for row in 0..table.len() {
        let (value, expected) = (heights[table.column("t")[row] as usize], table.column("s")[row]);
        assert!(
            (value - expected).abs() < 1e-5,
            "t = {}: {value} against {expected}",
            table.column("t")[row]
        );
    }
}
