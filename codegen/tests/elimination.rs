//! Rows first and the saddle point are two ways to one solution: accelerations, multipliers and drives agree at closed
//! states of driven mechanisms.

use std::path::Path;

use linkwear_codegen::compile::{Compiled, Options, compile};
use linkwear_codegen::model::Closure;
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{Evaluator, State, assemble};

fn compiled(name: &str, closure: Closure, saddle: bool) -> Compiled {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../mechanisms").join(format!("{name}.toml"));
    let source = SourceFile { name: name.to_owned(), text: std::fs::read_to_string(path).expect("a file") };
    let options = Options { closure: Some(closure), saddle, ..Options::default() };
    compile(&source, &options).unwrap_or_else(|errors| panic!("{errors}"))
}

fn forward_operations(compiled: &Compiled) -> u64 {
    let counts = compiled.operations();
    let forward = counts.iter().find(|count| count.name == "forward_dynamics").expect("it is there");
    forward.operations.total
}

/// Accelerations, multipliers and drives.
fn solved(compiled: &Compiled, t: f64, state: &State) -> [Vec<f64>; 3] {
    let system = compiled.interpreter();
    let parameters = compiled.parameters();
    let mut evaluator = Evaluator::new(&system, compiled.description(), &parameters).expect("parameters");
    let forward = evaluator.forward(t, &state.q, &state.v);
    [forward.accelerations, forward.multipliers, forward.drives].map(<[f64]>::to_vec)
}

#[test]
fn both_ways_agree_and_rows_first_is_never_dearer() {
    let driven = [
        "four_bar",
        "six_bar",
        "slider_crank",
        "spatial_slider_crank",
        "bennett",
        "rssr_rigid",
        "rssr_flexible",
    ];
    for name in driven {
        for closure in [Closure::Joint, Closure::Log] {
            let [rows_first, saddle] = [false, true].map(|saddle| compiled(name, closure, saddle));
            assert!(forward_operations(&rows_first) <= forward_operations(&saddle), "{name} {closure:?}");
            let system = rows_first.interpreter();
            // From one start the loops are closed for the drivers' place at several times, as far as Newton comes.
            let times = (0..12).map(|i| 0.01 * f64::from(i));
            let states: Vec<(f64, State)> = times
                .filter_map(|t| {
                    assemble(&system, rows_first.description(), &rows_first.parameters(), t)
                        .ok()
                        .map(|state| (t, state))
                })
                .collect();
            assert!(states.len() >= 3, "{name} {closure:?}: {} states", states.len());
            for (t, state) in states {
                let [ours, theirs] = [&rows_first, &saddle].map(|compiled| solved(compiled, t, &state));
                for (a, b) in ours.iter().zip(&theirs) {
                    let size = b.iter().fold(1e-6, |size: f64, x| size.max(x.abs()));
                    let error = a.iter().zip(b).fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs()));
                    // The saddle point squares the condition of the loops, some 1e2, on roundings of 1e-16.
                    assert!(error <= 1e-10 * size, "{name} {closure:?} at {t} s: {error:e} of {size:e}");
                }
            }
        }
    }
}

#[test]
fn without_drivers_the_equations_do_not_change() {
    for name in ["andrews", "bricard", "n_four_bar_2", "pendulum"] {
        let [with, without] = [false, true].map(|saddle| compiled(name, Closure::Joint, saddle));
        assert_eq!(with.rust_source(), without.rust_source(), "{name}");
    }
}
