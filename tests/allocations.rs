//! Runs allocate for what they give back and nothing on the way. Two runs with as many rows, one over twice the time of the
//! other: twice the steps and evaluations, and as many allocations.

use allocation_counter::measure;
use linkwear::backend::Backend;
use linkwear::mechanism::{Mechanism, read_source};
use linkwear_codegen::Options;
use linkwear_native::Refusal;
use linkwear_runtime::{Entry, Integrator, Settings, Span, Watch, simulate};

/// Ideal joints; angles of cut joints that are followed; a flexible coupler; a journal with clearance; a ball; two journals.
const MECHANISMS: [&str; 6] =
    ["rssr_rigid", "four_bar", "rssr_flexible", "rssr", "rssr_ball_wear", "four_bar_wear"];
const METHODS: [Integrator; 4] = [
    Integrator::Rk4 { step: 2e-5 },
    Integrator::Dopri5 { tolerance: 1e-9, max_step: None },
    Integrator::Rk43 { tolerance: 1e-10, max_step: None },
    Integrator::GeneralizedAlpha { step: 1e-5, rho: 0.8 },
];
/// Rows of every run. Steps of the fixed-step methods stay of one length.
const SAMPLES: usize = 11;
/// Lengths of the runs [s], within the first turn of every mechanism: a measured turn is a result, and allocates.
const SHORT: f64 = 0.02;
const LONG: f64 = 0.06;

/// The mechanism on a back end; none where the processor lacks it.
fn on(name: &str, backend: Backend) -> Option<Mechanism> {
    let source = read_source(format!("mechanisms/{name}.toml").as_ref()).expect("a shipped file");
    let refused = |error: &dyn std::error::Error| {
        let refusal = error.source().and_then(|source| source.downcast_ref::<Refusal>());
        assert!(refusal.is_some() || backend == Backend::Native, "{name}: {error}");
    };
    Mechanism::compile(&source, &Options::default(), backend).map_err(|error| refused(&error)).ok()
}

/// Steps and allocations of a run.
fn counted(mechanism: &Mechanism, method: Integrator, seconds: f64) -> (u64, u64) {
    let system = mechanism.system();
    let settings = Settings::new(method, Span::Time(seconds), SAMPLES);
    let mut steps = 0;
    let allocations = measure(|| {
        let run = simulate(&*system, &mechanism.description, &mechanism.parameters, &settings, Watch::NONE);
        let run = run.expect("it starts");
        assert_eq!(run.stopped, None);
        steps = run.statistics.steps;
    });
    (steps, allocations.count_total)
}

fn assert_steps_allocate_nothing(backend: Backend) {
    for name in MECHANISMS {
        let Some(mechanism) = on(name, backend) else { return };
        for method in METHODS {
            // Code of the stages within steps is written once, in the first run that is long enough.
            counted(&mechanism, method, LONG);
            let (few, short) = counted(&mechanism, method, SHORT);
            let (many, long) = counted(&mechanism, method, LONG);
            assert!(
                short > 0 && many >= few + few / 2,
                "{name}, {method:?}: {short} allocations, {few} and {many} steps"
            );
            assert_eq!(long, short, "{name}, {method:?}: allocations over {many} steps and over {few}");
        }
    }
}

#[test]
fn steps_of_compiled_code_allocate_nothing() {
    assert_steps_allocate_nothing(Backend::Compiled);
}

#[test]
fn steps_of_machine_code_allocate_nothing() {
    assert_steps_allocate_nothing(Backend::Native);
}

#[test]
fn no_evaluation_allocates() {
    for backend in [Backend::Compiled, Backend::Native, Backend::Interpreter] {
        let Some(mechanism) = on("rssr", backend) else { continue };
        let system = mechanism.system();
        let sizes = system.sizes();
        for entry in Entry::ALL {
            let input = vec![0.3; sizes.input(entry)];
            let (mut output, mut workspace) = (vec![0.0; sizes.output(entry)], vec![0.0; sizes.workspace]);
            // Entries that few runs ask for are written when they are asked for first.
            system.evaluate(entry, &input, &mut output, &mut workspace);
            let allocations = measure(|| system.evaluate(entry, &input, &mut output, &mut workspace));
            assert_eq!(allocations.count_total, 0, "{backend:?}, {entry:?}");
        }
    }
}
