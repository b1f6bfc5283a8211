//! Steps of C beside steps of the runtime.

use linkwear_codegen::Compiled;
use linkwear_runtime::{Integrator, Settings, Simulation, Span, Watch};

use super::compiler::{Built, build};
use super::{example, shipped};

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

/// Coordinates and speeds at the end of a run by the runtime.
fn end_of_run(compiled: &Compiled, step: f64, count: usize) -> Vec<f64> {
    let end = step * count as f64;
    let settings = Settings::new(Integrator::Rk4 { step }, Span::Time(end), 2);
    let (system, parameters) = (compiled.interpreter(), compiled.parameters());
    let mut run = Simulation::start(&system, compiled.description(), &parameters, &settings).unwrap();
    run.advance(end, Watch::NONE).unwrap();
    [run.coordinates(), run.speeds()].concat()
}

/// Asserts that coordinates and speeds have the bits of a run after so many steps, by every compiler there is.
fn assert_same(compiled: &Compiled, step: f64, count: usize) {
    let name = &compiled.mechanism.name;
    let wanted = end_of_run(compiled, step, count);
    assert_eq!(wanted.len(), compiled.sizes().coordinates + compiled.sizes().speeds, "{name}");
    for built in build(&format!("run_{name}"), compiled, &driver(compiled), &["-O2"]) {
        let states = steps(&built, compiled, step, count);
        // Behind them stand what contacts and losses add up to.
        let found = &states[count - 1][..wanted.len()];
        let same = found.iter().zip(&wanted).all(|(a, b)| a.to_bits() == b.to_bits());
        assert!(same, "{name}: {}\n{found:?}\n{wanted:?}", built.compiler);
        assert!(states[0][..wanted.len()] != *found, "{name} moves");
    }
}

#[test]
fn steps_are_those_of_a_run_in_every_bit() {
    let smooth = ["pendulum", "four_bar", "slider_crank", "rssr_rigid", "rssr_flexible", "andrews"];
    let clearance = ["slider_crank_clearance", "rssr", "four_bar_wear", "rssr_ball_wear"];
    let all = smooth.map(|name| (name, 1e-4)).into_iter().chain(clearance.map(|name| (name, 1e-5)));
    for (name, step) in all {
        assert_same(&shipped(name), step, 500);
    }
}

/// Ends of guides and of tilting journals, teeth, stops, cables and mounts, states.
#[test]
fn steps_of_the_elements_are_those_of_a_run_in_every_bit() {
    for (name, step, count) in [
        ("loose_guide", 1e-5, 500),
        ("tilting_bearing", 1e-5, 500),
        ("planetary_gear", 1e-4, 500),
        // The ram strikes after 0.23 s.
        ("drop_hammer", 1e-4, 3000),
        ("servo_crank", 1e-4, 500),
    ] {
        assert_same(&example(name), step, count);
    }
}
