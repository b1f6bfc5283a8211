//! Steps of C beside steps of the runtime.

use linkwear_codegen::Compiled;
use linkwear_runtime::{Integrator, Layout, Motion, Settings, Span, Watch, simulate};

use super::compiler::{Built, build};
use super::shipped;

/// The driver that steps a mechanism.
pub fn driver(compiled: &Compiled) -> String {
    filled(include_str!("run.c"), compiled)
}

/// A driver with the names of a mechanism.
pub fn filled(template: &str, compiled: &Compiled) -> String {
    let prefix = compiled.c_prefix();
    let set = if compiled.sizes().parameters > 0 {
        "pfx_set_parameters(&pfx_default_parameters, parameters);"
    } else {
        ""
    };
    template
        .replace("SET_PARAMETERS", set)
        .replace("pfx_", &format!("{prefix}_"))
        .replace("PFX_", &format!("{}_", prefix.to_ascii_uppercase()))
}

/// Flat states after every step.
pub fn steps(built: &Built, compiled: &Compiled, step: f64, count: usize) -> Vec<Vec<f64>> {
    let found = built.run(&[step, count as f64]);
    let states: Vec<Vec<f64>> = found.chunks(compiled.sizes().flat_state()).map(<[f64]>::to_vec).collect();
    assert_eq!(states.len(), count);
    states
}

/// Columns of a run by the runtime that are free coordinates or speeds, at every step.
fn columns(compiled: &Compiled, step: f64, count: usize) -> Vec<(usize, Vec<f64>)> {
    let settings = Settings {
        span: Span::Time(step * count as f64),
        samples: count + 1,
        integrator: Integrator::Rk4 { step },
        ..Settings::default()
    };
    let (system, description) = (compiled.interpreter(), compiled.description());
    let run = simulate(&system, description, &compiled.parameters(), &settings, Watch::NONE).unwrap();
    assert!(run.stopped.is_none(), "{:?}", run.stopped);
    // Of a quaternion the columns have another: that of the joint, not of the body.
    let layout = Layout::new(&description.motions);
    let scalars = layout.free().filter(|group| matches!(group.motion, Motion::Scalar { .. }));
    let places = scalars.flat_map(|group| [group.coordinate, description.coordinates.len() + group.speed]);
    let names: Vec<_> = description.coordinates.iter().chain(description.speeds.iter()).collect();
    places.filter_map(|place| run.column(&names[place].name).ok().map(|column| (place, column))).collect()
}

/// Largest difference between steps of C and a run, relative to values above 1, and how many columns were compared.
fn difference(name: &str, step: f64, count: usize) -> Option<(f64, usize)> {
    let compiled = shipped(name);
    let columns = columns(&compiled, step, count);
    let built = build(&format!("run_{name}"), &compiled, &driver(&compiled), &["-O2"]);
    let mut worst = None;
    for built in built {
        let states = steps(&built, &compiled, step, count);
        for (place, column) in &columns {
            let first = states.iter().zip(&column[1..]).position(|(state, value)| state[*place] != *value);
            if let Some(first) = first {
                println!(
                    "{name} place {place} from step {first}: {} {}",
                    states[first][*place],
                    column[first + 1]
                );
            }
        }
        let most = columns.iter().flat_map(|(place, column)| {
            let pairs = states.iter().zip(&column[1..]);
            pairs.map(|(state, value)| (state[*place] - value).abs() / value.abs().max(1.0))
        });
        worst = Some((most.fold(0.0, f64::max), columns.len()));
    }
    worst
}

#[test]
fn steps_of_rigid_and_flexible_rssr_and_others_are_those_of_a_run_in_every_bit() {
    for name in ["pendulum", "four_bar", "slider_crank", "rssr_rigid", "rssr_flexible", "andrews"] {
        let Some((worst, columns)) = difference(name, 1e-4, 500) else { return };
        println!("{name}: {worst} in {columns} columns");
        assert!(columns >= 1, "{name}");
        assert_eq!(worst, 0.0, "{name}");
    }
}

#[test]
fn steps_with_clearance_are_those_of_a_run() {
    for name in ["slider_crank_clearance", "rssr", "four_bar_wear", "rssr_ball_wear"] {
        let Some((worst, columns)) = difference(name, 1e-5, 500) else { return };
        println!("{name}: {worst} in {columns} columns");
        // Loops are corrected along other directions: those of a run are judged by the clearance.
        assert!(columns >= 1 && worst <= 1e-12, "{name}: {worst}");
    }
}
