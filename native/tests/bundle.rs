//! Turns side by side have the bits that each has alone: measures, states, memories.

use std::path::Path;

use linkwear_codegen::{Compiled, Options, SourceFile, compile};
use linkwear_native::{Native, NativeBundle, Refusal};
use linkwear_runtime::{
    Integrator, RunError, SINGULAR_PIVOT, StepPlan, TurnBundle, TurnMeasures, TurnOutcome, TurnRunner,
    TurnState, Watch, WholeSteps,
};

const INTEGRATOR: Integrator = Integrator::Rk43 { tolerance: 1e-5, max_step: None };

fn shipped(name: &str) -> Compiled {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../mechanisms").join(name);
    let text = std::fs::read_to_string(&file).expect("a shipped file");
    compile(&SourceFile { name: name.to_owned(), text }, &Options::default()).expect("it compiles")
}

fn runner<'a>(system: &'a Native, mechanism: &'a Compiled) -> TurnRunner<'a> {
    let (description, parameters) = (mechanism.description(), mechanism.parameters());
    TurnRunner::new(system, description, &parameters, INTEGRATOR, SINGULAR_PIVOT).expect("a start")
}

/// Two turns, alone: measures and states.
fn alone(runner: &mut TurnRunner<'_>, start: &TurnState) -> Vec<(TurnMeasures, TurnState)> {
    runner.restore(start).expect("its own state");
    (0..2).map(|_| (runner.measure(Watch::NONE).expect("a turn"), runner.state())).collect()
}

#[test]
fn eight_lanes_have_the_bits_of_lone_turns() {
    lanes_have_the_bits_of_lone_turns::<8>();
}

#[test]
fn four_lanes_have_the_bits_of_lone_turns() {
    lanes_have_the_bits_of_lone_turns::<4>();
}

fn lanes_have_the_bits_of_lone_turns<const N: usize>() {
    for name in ["rssr.toml", "four_bar_wear.toml"] {
        let mechanism = shipped(name);
        let system = Native::new(mechanism.tapes(), mechanism.sizes()).expect("machine code");
        let plan = StepPlan::new(mechanism.description(), mechanism.sizes()).expect("laws");
        let bundle = match NativeBundle::<N>::new(mechanism.tapes(), &plan) {
            // Eight lanes are for processors with AVX-512; lives run four at a time on others.
            Err(Refusal::Processor { .. }) if N == 8 => return,
            written => written.expect("lanes"),
        };
        let mut one = runner(&system, &mechanism);
        let start = one.state();
        let starts: Vec<TurnState> = (0..11)
            .map(|life| {
                one.restore(&start).expect("its own state");
                one.set_worn(0, 7e-6 * f64::from(life), None).expect("a clearance");
                one.state()
            })
            .collect();
        let began = std::time::Instant::now();
        let expected: Vec<_> = starts.iter().map(|start| alone(&mut one, start)).collect();
        println!("{name}: alone {:?} a turn", began.elapsed() / 22);
        let mut lanes = TurnBundle::new(&bundle, || Ok(runner(&system, &mechanism))).expect("a start");
        // Lives begin in any lane as it gets free, with whatever neighbours.
        let mut found: Vec<Vec<(TurnMeasures, TurnState)>> = vec![Vec::new(); starts.len()];
        let mut waiting: Vec<usize> = (0..starts.len()).rev().collect();
        let mut life_of = [0; N];
        let began = std::time::Instant::now();
        loop {
            while let Some(lane) = lanes.free_lane() {
                let Some(life) = waiting.pop() else { break };
                let from = found[life].last().map_or(&starts[life], |(_, state)| state);
                assert!(lanes.begin(lane, from, None).expect("a turn"));
                life_of[lane] = life;
            }
            if lanes.is_idle() {
                break;
            }
            lanes.step(&mut |lane, outcome| {
                let TurnOutcome::Done(done) = outcome else { panic!("lane {lane} is to be run alone") };
                let life = life_of[lane];
                found[life].push(*done);
                if found[life].len() < 2 {
                    waiting.push(life);
                }
            });
        }
        println!("{name}: side by side {:?} a turn", began.elapsed() / 22);
        for (life, (expected, found)) in expected.iter().zip(&found).enumerate() {
            for (turn, (expected, found)) in expected.iter().zip(found).enumerate() {
                assert_eq!(expected.0.joints, found.0.joints, "{name}, life {life}, turn {turn}");
                assert_eq!(expected.0.statistics, found.0.statistics, "{name}, life {life}, turn {turn}");
                assert_eq!(expected, found, "{name}, life {life}, turn {turn}");
            }
        }
    }
}

#[test]
fn turns_in_whole_steps_have_the_bits_of_others() {
    for name in ["rssr.toml", "four_bar_wear.toml"] {
        let mechanism = shipped(name);
        let system = Native::new(mechanism.tapes(), mechanism.sizes()).expect("machine code");
        let plan = StepPlan::new(mechanism.description(), mechanism.sizes()).expect("laws");
        let bundle = NativeBundle::<1>::new(mechanism.tapes(), &plan).expect("one lane");
        let (mut one, mut other) = (runner(&system, &mechanism), runner(&system, &mechanism));
        let mut whole = WholeSteps::new(&bundle, &other);
        for (turn, worn) in [0.0, 0.0, 2e-6, 3e-5].into_iter().enumerate() {
            one.set_worn(0, worn, None).expect("a clearance");
            other.set_worn(0, worn, None).expect("a clearance");
            let (expected, found) = (one.measure(Watch::NONE), whole.measure(&mut other, Watch::NONE));
            assert_eq!(found.expect("a turn"), expected.expect("a turn"), "{name}, turn {turn}");
            assert_eq!(other.state(), one.state(), "{name}, turn {turn}");
        }
        // Whoever stops a turn is where it began.
        let before = other.state();
        let stop = |_: f64| std::ops::ControlFlow::Break(());
        let stopped = whole.measure(&mut other, Watch::new(&stop));
        assert!(matches!(stopped, Err(RunError::Interrupted { t }) if t == before.t), "{stopped:?}");
        assert_eq!(other.state(), before, "{name}");
        assert_eq!(
            whole.measure(&mut other, Watch::NONE).expect("a turn"),
            one.measure(Watch::NONE).expect("a turn")
        );
    }
}
