//! A derivative with the laws of contact inside has the bits of one with them outside: rows, turns, parameters that change.

use std::path::Path;

use linkwear_codegen::{Compiled, Options, SourceFile, compile};
use linkwear_native::{Native, NativeBundle, Refusal};
use linkwear_runtime::{
    Description, Entry, Integrator, Run, SINGULAR_PIVOT, Settings, Simulation, Span, StageSum, StepPlan,
    System, TOTALS, TurnRunner, Watch, simulate,
};

const METHODS: [Integrator; 2] =
    [Integrator::Rk43 { tolerance: 1e-5, max_step: None }, Integrator::Rk4 { step: 4e-5 }];

fn compiled(name: &str) -> Compiled {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name);
    let text = std::fs::read_to_string(&file).expect("a file of this repository");
    compile(&SourceFile { name: name.to_owned(), text }, &Options::default()).expect("it compiles")
}

/// Machine code with the laws outside, and inside.
fn both(mechanism: &Compiled) -> Option<[Native; 2]> {
    let native = match Native::new(mechanism.tapes(), mechanism.sizes()) {
        Err(Refusal::Processor { .. }) => return None,
        written => written.expect("machine code"),
    };
    let inside = Native::with_laws(mechanism.tapes(), mechanism.sizes(), mechanism.description());
    Some([native, inside.expect("machine code")])
}

fn bits(run: &Run) -> Vec<Vec<u64>> {
    run.rows.iter().map(|row| row.iter().map(|value| value.to_bits()).collect()).collect()
}

#[test]
fn runs_have_the_same_bits() {
    for name in ["mechanisms/rssr.toml", "mechanisms/rssr_ball_wear.toml", "examples/data/loose_guide.toml"] {
        let mechanism = compiled(name);
        let Some([outside, inside]) = both(&mechanism) else { return };
        assert!(outside.laws_inside().is_none() && inside.laws_inside().is_some(), "{name}");
        for method in METHODS {
            // Long enough for code of the stages within steps.
            let settings = Settings::new(method, Span::Time(0.12), 11);
            let run = |system: &Native| {
                let (description, parameters) = (mechanism.description(), mechanism.parameters());
                simulate(system, description, &parameters, &settings, Watch::NONE).expect("a run")
            };
            let (expected, found) = (run(&outside), run(&inside));
            assert!(expected.rows.len() == 11 && bits(&expected) == bits(&found), "{name} {method:?}");
            assert_eq!(expected.statistics, found.statistics, "{name} {method:?}");
            assert!(found.statistics.steps > 600, "{name} {method:?}: {}", found.statistics.steps);
        }
    }
}

/// Another clearance has another stiffness: laws inside are told of it by an evaluation outside.
#[test]
fn wear_and_parameters_change_under_way() {
    let mechanism = compiled("mechanisms/rssr.toml");
    let Some(systems) = both(&mechanism) else { return };
    let (description, parameters) = (mechanism.description(), mechanism.parameters());
    let [expected, found] = systems.each_ref().map(|system| {
        let settings = Settings::new(METHODS[0], Span::Time(0.2), 0);
        let mut simulation = Simulation::start(system, description, &parameters, &settings).expect("a start");
        simulation.advance(0.1, Watch::NONE).expect("a motion");
        let mut others = parameters.clone();
        others[0] *= 2.0;
        simulation.set_parameters(&others).expect("another clearance");
        simulation.advance(0.2, Watch::NONE).expect("a motion");
        let mut runner =
            TurnRunner::new(system, description, &parameters, METHODS[0], SINGULAR_PIVOT).expect("a start");
        runner.set_worn(0, 3e-5, None).expect("a clearance");
        (simulation.state().memory, runner.measure(Watch::NONE).expect("a turn").joints)
    });
    let bits = |memory: &[f64]| memory.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&expected.0), bits(&found.0));
    assert_eq!(expected.1, found.1);
}

/// Code of a whole step answers in the bits of the plan, and says where its answer does not count.
#[test]
fn steps_have_the_bits_of_their_plan() {
    for name in ["mechanisms/rssr.toml", "mechanisms/rssr_ball_wear.toml"] {
        let mechanism = compiled(name);
        let Some([_, inside]) = both(&mechanism) else { return };
        let laws = inside.laws_inside().expect("laws inside");
        let interpreter = mechanism.interpreter();
        let sizes = System::<f64>::sizes(&interpreter);
        let plan = StepPlan::new(mechanism.description(), sizes).expect("laws");
        let evaluate = |entry, input: &[f64]| {
            let (mut output, mut workspace) = (vec![0.0; sizes.output(entry)], vec![0.0; sizes.workspace]);
            System::evaluate(&interpreter, entry, input, &mut output, &mut workspace);
            output
        };
        let (contacts, clearance) = (sizes.contacts, 1e-5);
        let mut state = mechanism.start().expect("a start").state;
        state.resize(sizes.flat_state(), 0.0);
        // Unworn, as stiff as steel, apart; then as the plan lists it.
        let memory = [0.0, 1e10, 0.0, 0.0].repeat(contacts);
        let question = |known: f64, speed: f64| {
            let (length, slope) = (1e-5, vec![speed; state.len()]);
            let times = [0.5 * length, length, length];
            let (known, pivots) = (vec![known; contacts], vec![0.0; sizes.rows]);
            [
                mechanism.parameters(),
                times.to_vec(),
                state.clone(),
                slope,
                memory.clone(),
                known,
                pivots,
                vec![1.0],
            ]
            .concat()
        };
        let flags = sizes.output(Entry::Derivative)
            + contacts * (TOTALS + StepPlan::CONTACT_ANSWER + 1)
            + 2 * sizes.flat_state()
            + sizes.coordinates
            + sizes.output(Entry::Energy);
        let answer = |question: &[f64]| {
            assert_eq!(question.len(), plan.classical_step_question());
            let [_, found] = [StageSum::EndsFirst, StageSum::InTurn].map(|sum| {
                let code = laws.classical_step(sum).expect("code of steps");
                let expected = plan.classical_step(&evaluate, question, sum);
                let (mut found, mut workspace) = (vec![0.0; expected.len()], vec![0.0; code.workspace()]);
                code.evaluate(question, &mut found, &mut workspace);
                // What is no number has any sign.
                let bits = |x: &f64| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() };
                assert!(expected.iter().map(bits).eq(found.iter().map(bits)), "{name}");
                found
            });
            // Behind the energies: regularity at the last inner stage; the least of these, that at the end.
            [found[flags + 1], found[flags + 2]]
        };
        assert!(answer(&question(clearance, 0.1)).iter().all(|regular| *regular > 0.5), "{name}");
        assert_eq!(answer(&question(1.5 * clearance, 0.1)), [0.0; 2], "another clearance, {name}");
        let [within, _] = answer(&question(clearance, f64::INFINITY));
        assert!(within.is_nan(), "no numbers, {name}");
    }
}

/// Laws of another description, as segments of missions have them, are not those of the code.
#[test]
fn other_laws_are_evaluated_outside() {
    let mechanism = compiled("mechanisms/rssr.toml");
    let Some(systems) = both(&mechanism) else { return };
    let parameters = mechanism.parameters();
    let mut description = mechanism.description().clone();
    let turn = |system: &Native, description: &Description| {
        let runner = TurnRunner::new(system, description, &parameters, METHODS[0], SINGULAR_PIVOT);
        runner.expect("a start").measure(Watch::NONE).expect("a turn").joints[0].clone()
    };
    let before = turn(&systems[1], &description);
    description.contacts.to_mut()[0].wear.as_mut().expect("R1 wears").coefficient *= 1.5;
    let [expected, found] = systems.each_ref().map(|system| turn(system, &description));
    assert_eq!(expected, found);
    // The depth goes with the coefficient: a rounding or two in every step.
    assert!((found.depth / before.depth - 1.5).abs() < 1e-12, "{} {}", found.depth, before.depth);
}

/// Wear by bearing angle is kept outside.
#[test]
fn laws_with_profiles_stay_outside() {
    let mechanism = compiled("examples/data/worn_journal.toml");
    let plan = StepPlan::new(mechanism.description(), mechanism.sizes()).expect("laws");
    let kept = plan.joints().iter().any(linkwear_runtime::clearance_joint::Clearance::keeps_profiles);
    let Some([_, inside]) = both(&mechanism) else { return };
    assert_eq!(inside.laws_inside().is_none(), kept);
    assert_eq!(matches!(NativeBundle::<4>::new(mechanism.tapes(), &plan), Err(Refusal::Profile)), kept);
}
