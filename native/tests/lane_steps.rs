//! What a step in a lane costs. Times, so nothing is asserted of them: `cargo test --release -p linkwear-native --test lane_steps --
//! --ignored --nocapture`.

use std::path::Path;
use std::time::Instant;

use linkwear_codegen::{Compiled, Options, SourceFile, compile};
use linkwear_native::{Native, NativeBundle};
use linkwear_runtime::{
    Bundle, Integrator, SINGULAR_PIVOT, StepPlan, TurnRunner, Watch, WholeSteps, WideBundle, turn_queue,
};

const INTEGRATOR: Integrator = Integrator::Rk43 { tolerance: 1e-6, max_step: None };
/// Batches of code alone, of which the quickest counts, and steps in each: a batch is short beside what else a processor does.
const BATCHES: u32 = 500;
const ROUNDS: u32 = 50;
/// Turns in each lane.
const TURNS: u32 = 8;

fn mechanism(name: &str) -> Compiled {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../mechanisms").join(name);
    let text = std::fs::read_to_string(&file).expect("a shipped file");
    compile(&SourceFile { name: name.to_owned(), text }, &Options::default()).expect("it compiles")
}

#[test]
#[ignore = "a measurement"]
fn nanoseconds_of_a_step() {
    for name in ["rssr.toml", "four_bar_wear.toml"] {
        let mechanism = mechanism(name);
        let plan = StepPlan::new(mechanism.description(), mechanism.sizes()).expect("laws");
        if let Ok(bundle) = NativeBundle::<8>::new(mechanism.tapes(), &plan) {
            measure(name, &mechanism, (&plan, &bundle), WideBundle::Eight(&bundle));
        }
        if let Ok(bundle) = NativeBundle::<4>::new(mechanism.tapes(), &plan) {
            measure(name, &mechanism, (&plan, &bundle), WideBundle::Four(&bundle));
        }
    }
}

#[test]
#[ignore = "a measurement"]
fn milliseconds_of_a_turn_in_whole_steps() {
    let mechanism = mechanism("rssr.toml");
    let plan = StepPlan::new(mechanism.description(), mechanism.sizes()).expect("laws");
    let Ok(bundle) = NativeBundle::<1>::new(mechanism.tapes(), &plan) else { return };
    let system = Native::with_laws(mechanism.tapes(), mechanism.sizes(), mechanism.description());
    let system = system.expect("machine code");
    let parameters = mechanism.parameters();
    let integrator = Integrator::Rk43 { tolerance: 1e-5, max_step: None };
    for worn in [0.0, 20e-6, 80e-6] {
        let mut runner =
            TurnRunner::new(&system, mechanism.description(), &parameters, integrator, SINGULAR_PIVOT)
                .expect("a start");
        runner.set_worn(0, worn, None).expect("a clearance");
        let mut whole = WholeSteps::new(&bundle, &runner);
        whole.measure(&mut runner, Watch::NONE).expect("a turn");
        let kept = runner.state();
        let began = Instant::now();
        for _ in 0..TURNS {
            whole.measure(&mut runner, Watch::NONE).expect("a turn");
        }
        let [whole, alone] = [began.elapsed(), {
            runner.restore(&kept).expect("its own state");
            let began = Instant::now();
            for _ in 0..TURNS {
                runner.measure(Watch::NONE).expect("a turn");
            }
            began.elapsed()
        }];
        let milliseconds = |time: std::time::Duration| 1e3 * time.as_secs_f64() / f64::from(TURNS);
        let clearance = 1e6 * (10e-6 + worn);
        println!(
            "{clearance:.0} um, 1e-5: {:.2} ms a turn in whole steps, {:.2} ms in others",
            milliseconds(whole),
            milliseconds(alone)
        );
    }
}

fn measure<const N: usize>(
    name: &str,
    mechanism: &Compiled,
    (plan, bundle): (&StepPlan, &dyn Bundle<N>),
    wide: WideBundle<'_>,
) {
    let code = code_alone(plan, bundle);
    let system = Native::new(mechanism.tapes(), mechanism.sizes()).expect("machine code");
    let parameters = mechanism.parameters();
    let runner =
        || TurnRunner::new(&system, mechanism.description(), &parameters, INTEGRATOR, SINGULAR_PIVOT);
    let (queue, requests) = turn_queue();
    let began = Instant::now();
    let steps: u64 = std::thread::scope(|scope| {
        let lives: Vec<_> = (0..N)
            .map(|life| {
                let queue = queue.clone();
                scope.spawn(move || {
                    let mut runner = runner().expect("a start");
                    runner.set_worn(0, 5e-6 * life as f64, None).expect("a clearance");
                    let turn = |_| {
                        let statistics = queue.measure(&mut runner, Watch::NONE).expect("a turn").statistics;
                        statistics.steps + statistics.rejected
                    };
                    (0..TURNS).map(turn).sum::<u64>()
                })
            })
            .collect();
        drop(queue);
        wide.serve(&runner, requests).expect("lanes");
        lives.into_iter().map(|life| life.join().expect("a life")).sum()
    });
    let all = began.elapsed().as_secs_f64() / steps as f64;
    println!("{name}, {N} lanes: {:.0} ns a step, of which code {:.0} ns", 1e9 * all, 1e9 * code);
}

/// Seconds of the machine code of a step, per lane.
fn code_alone<const N: usize>(plan: &StepPlan, bundle: &dyn Bundle<N>) -> f64 {
    // What the numbers are does not matter: there are no branches.
    // Beginning where a line of the cache does, as in lives.
    let mut numbers = vec![0.5_f64; plan.arena() * N + 8];
    let first = numbers.as_ptr().align_offset(64);
    let arena: &mut [[f64; N]] = numbers[first..].as_chunks_mut().0;
    let mut workspace = vec![[0.0; N]; bundle.workspace()];
    let mut least = f64::INFINITY;
    for _ in 0..BATCHES {
        let began = Instant::now();
        for _ in 0..ROUNDS {
            let (question, rest) = arena.split_at_mut(plan.step_question());
            bundle.step(question, rest, &mut workspace);
        }
        least = least.min(began.elapsed().as_secs_f64());
    }
    least / f64::from(ROUNDS) / N as f64
}
