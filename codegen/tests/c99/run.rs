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

/// Columns of a run by the runtime that are free coordinates or speeds, at both ends: rows between would be put onto the
/// constraints once more.
fn columns(compiled: &Compiled, step: f64, count: usize) -> Vec<(usize, Vec<f64>)> {
    let settings = Settings {
        span: Span::Time(step * count as f64),
        samples: 2,
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

/// Largest difference between the ends of steps of C and of a run, relative to values above 1, and how many columns were compared.
fn difference(name: &str, step: f64, count: usize) -> Option<(f64, usize)> {
    let compiled = shipped(name);
    let columns = columns(&compiled, step, count);
    let built = build(&format!("run_{name}"), &compiled, &driver(&compiled), &["-O2"]);
    let mut worst = None;
    for built in built {
        let states = steps(&built, &compiled, step, count);
        let last = &states[count - 1];
        let off =
            |(place, column): &(usize, Vec<f64>)| (last[*place] - column[1]).abs() / column[1].abs().max(1.0);
        worst = Some((columns.iter().map(off).fold(0.0, f64::max), columns.len()));
    }
    worst
}

#[test]
fn steps_are_those_of_a_run_in_every_bit() {
    let smooth = ["pendulum", "four_bar", "slider_crank", "rssr_rigid", "rssr_flexible", "andrews"];
    let clearance = ["slider_crank_clearance", "rssr", "four_bar_wear", "rssr_ball_wear"];
    let all = smooth.map(|name| (name, 1e-4)).into_iter().chain(clearance.map(|name| (name, 1e-5)));
    for (name, step) in all {
        let Some((worst, columns)) = difference(name, step, 500) else { return };
        assert!(columns > 0, "{name}");
        assert_eq!(worst, 0.0, "{name}");
    }
}
