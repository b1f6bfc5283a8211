//! The flexible slider-crank of the Test Set for IVP Solvers (problem "crank", B. Simeon 1996), through a modal data file.
//! Reference at t = 0.1 s: MEBDFI at tolerance 1e-14, as in the R package deTestSet 1.1.7.4; other times: an
//! independent integration made before linkwear was begun (agrees with the former to 3e-8).

mod support;
mod truth;

use linkwear_codegen::source::SourceFile;
use linkwear_runtime::Span;
use support::{Recorded, compile_source, run};
use truth::reached;

fn simulate() -> Recorded {
    let name = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/flexible_slider_crank.toml");
    let text = std::fs::read_to_string(name).expect("the mechanism");
    let compiled = compile_source(&SourceFile { name: name.into(), text }, &[], None);
    run(&compiled, Span::Time(0.1), Span::Time(0.0), 6, 1e-11)
}

/// The row of the largest error on the page of truth.
fn worst(figure: &str, values: &[(f64, f64)], bound: f64) {
    let error = values.iter().map(|(value, expected)| (value / expected - 1.0).abs()).fold(0.0, f64::max);
    reached("flexible slider-crank, test set", figure, error, bound);
}

fn close(what: &str, value: f64, expected: f64, tolerance: f64) {
    assert!((value / expected - 1.0).abs() < tolerance, "{what}: {value} not {expected}");
}

#[test]
fn slider_crank_reaches_the_published_state_and_forces() {
    let run = simulate();
    let angle = run.last("R1.q") + run.last("R2.q");
    let position = [
        ("rod angle", angle, -0.331_173_498_825_626),
        ("slider", run.last("P.x"), 0.169_737_332_842_786),
        ("q1", run.last("rod.eta1"), 1.893_192_899_613_509e-4),
        ("q2", run.last("rod.eta2"), 2.375_751_249_879_174e-5),
        ("q3", run.last("rod.eta3"), -5.323_896_770_569_702e-6),
        ("q4", run.last("rod.eta4"), -8.363_313_279_112_129e-6),
    ];
    worst("position at 0.1 s, relative", &position.map(|(_, value, expected)| (value, expected)), 1e-6);
    let speeds =
        [(150.0 + run.last("R2.v"), 60.253_467_551_383_69), (run.last("P.vx"), -8.753_116_326_670_527)];
    worst("speeds at 0.1 s, relative", &speeds, 1e-5);
    // The reference's multipliers enter as -G^T lambda.
    let forces = [
        (run.last("G.Fy"), 62.329_358_332_879_16),
        (run.last("R3.Fx"), 163.792_099_369_330_6),
        (run.last("R1.drive"), -25.298_579_476_466_89),
    ];
    worst("forces at 0.1 s, relative", &forces, 1e-5);
}

#[test]
fn slider_crank_passes_the_times_between() {
    let run = simulate();
    let expected = [
        [-0.070_620_331_418, 0.150_746_384_63, 4.110_157_7e-5, 4.395_553_5e-6],
        [0.140_158_745_51, 0.441_099_524_77, -8.613_938_2e-4, -8.888_423_9e-6],
        [-0.207_551_301_31, 0.156_884_678_21, 1.158_721_4e-4, 1.358_115_7e-5],
        [0.271_601_678_64, 0.415_593_448_55, -1.463_240_6e-3, -1.853_837_8e-5],
    ];
    for (at, [angle, slider, q1, q2]) in expected.into_iter().enumerate() {
        let column = |name: &str| run.column(name)[at + 1];
        close("rod angle", column("R1.q") + column("R2.q"), angle, 1e-6);
        close("slider", column("P.x"), slider, 1e-6);
        close("q1", column("rod.eta1"), q1, 1e-6);
        close("q2", column("rod.eta2"), q2, 1e-6);
    }
}
