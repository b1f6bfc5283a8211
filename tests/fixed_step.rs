//! Steps without std and without allocation have the bits of `simulate --integrator rk4`: state and all columns, smooth mechanisms
//! and those with clearance. What is written for arrays of a length that is known when compiling is asked with such arrays.

use linkwear::mechanisms::{
    four_bar, four_bar_wear, pendulum, rssr, rssr_ball_wear, rssr_flexible, rssr_rigid, slider_crank,
    slider_crank_clearance,
};
use linkwear_codegen::{Options, SourceFile, compile};
use linkwear_runtime::{
    AllTables, FixedStep, Halt, Integrator, Settings, Sizes, Span, Start, System, Tables, Watch, simulate,
};

/// The start as `Builder::with_start` writes it.
fn start(name: &str) -> Start {
    let text = std::fs::read_to_string(format!("mechanisms/{name}.toml")).expect("a file");
    let source = SourceFile { name: name.to_owned(), text };
    let start = compile(&source, &Options::default()).expect("compiles").start().expect("a start");
    Start { state: start.state.leak(), sizes: start.sizes.leak() }
}

/// Flat state and columns after so many steps.
fn stepped<const JOINTS: usize>(
    (system, tables, start): (&impl System<f64>, &AllTables, &Start),
    parameters: &[f64],
    (step, count): (f64, usize),
) -> Result<(Vec<f64>, Vec<f64>), Halt> {
    let sizes = system.sizes();
    let (mut numbers, mut y) = (vec![0.0; sizes.step_numbers()], vec![0.0; sizes.flat_state()]);
    let mut columns = vec![0.0; sizes.channels];
    let mut laws = [const { None }; JOINTS];
    let mut stepper = FixedStep::new(system, tables, start, &mut laws, &mut numbers)?;
    stepper.begin(parameters, &mut y)?;
    // Times as a run counts them.
    let time = |i: usize| step * count as f64 * (i as f64 / count as f64);
    for i in 0..count {
        stepper.step(parameters, time(i), time(i + 1) - time(i), &mut y)?;
    }
    stepper.observe(parameters, time(count), &y, &mut columns)?;
    Ok((y, columns))
}

macro_rules! same_as_a_run {
    ($name:ident, $step:expr) => {{
        const SIZES: Sizes = $name::SIZES;
        let (mechanism, step, count) = ($name::Mechanism::default(), $step, 300);
        let parameters = mechanism.parameters();
        let start = start(stringify!($name));
        let (y, columns) = stepped::<{ SIZES.contacts }>(
            (&mechanism, &$name::ALL_TABLES, &start),
            &parameters,
            (step, count),
        )
        .expect(stringify!($name));
        let settings = Settings {
            span: Span::Time(step * count as f64),
            samples: 2,
            integrator: Integrator::Rk4 { step },
            ..Settings::default()
        };
        let run = simulate(&mechanism, $name::description(), &parameters, &settings, Watch::NONE);
        let run = run.expect("a run");
        assert!(run.stopped.is_none(), "{:?}", run.stopped);
        let mut compared = 0;
        for ((name, _, wraps), value) in $name::TABLES.channels.iter().zip(&columns) {
            let column = run.column(name).expect("a column");
            let (found, wanted) = (*value, column[column.len() - 1]);
            // A run counts turns on, an entry point does not.
            if !wraps {
                assert_eq!(
                    found.to_bits(),
                    wanted.to_bits(),
                    "{} {name}: {found} {wanted}",
                    stringify!($name)
                );
                compared += 1;
            }
        }
        assert!(compared > 2, "{}", stringify!($name));
        assert!(y[..SIZES.coordinates + SIZES.speeds] != *start.state, "it moves");
    }};
}

#[test]
fn steps_have_the_bits_of_a_run() {
    same_as_a_run!(pendulum, 1e-4);
    same_as_a_run!(four_bar, 1e-4);
    same_as_a_run!(slider_crank, 1e-4);
    same_as_a_run!(rssr_rigid, 1e-4);
    same_as_a_run!(rssr_flexible, 1e-4);
}

#[test]
fn steps_with_clearance_and_contact_have_the_bits_of_a_run() {
    same_as_a_run!(slider_crank_clearance, 1e-5);
    same_as_a_run!(rssr, 1e-5);
    same_as_a_run!(four_bar_wear, 1e-5);
    same_as_a_run!(rssr_ball_wear, 1e-5);
}

#[test]
fn what_cannot_be_stepped_is_refused() {
    let (mechanism, start) = (rssr_rigid::Mechanism::default(), start("rssr_rigid"));
    let parameters = mechanism.parameters();
    let mut numbers = [0.0; rssr_rigid::SIZES.step_numbers()];
    let short = numbers.len() - 1;
    let tables = &rssr_rigid::ALL_TABLES;
    let refused = FixedStep::new(&mechanism, tables, &start, &mut [], &mut numbers[..short]).err();
    assert_eq!(refused, Some(Halt::Length));
    assert_eq!(
        FixedStep::new(&mechanism, tables, &start, &mut [None], &mut numbers).err(),
        Some(Halt::Length)
    );

    // Columns that tell of a controller with a sample time.
    let sampled = Tables { channels: &[("t.sample1", "s", false)], ..rssr_rigid::TABLES };
    let sampled = AllTables { tables: Box::leak(Box::new(sampled)), ..*tables };
    let refused = FixedStep::new(&mechanism, &sampled, &start, &mut [], &mut numbers).err();
    assert_eq!(refused, Some(Halt::Samples));

    let mut stepper = FixedStep::new(&mechanism, tables, &start, &mut [], &mut numbers).expect("fits");
    let mut y = [0.0; rssr_rigid::SIZES.flat_state()];
    assert_eq!(stepper.begin(&parameters[1..], &mut y), Err(Halt::Length));
    assert_eq!(stepper.begin(&parameters, &mut y), Ok(()));
    let before = y;
    // A quarter of a turn in one step: loops stay open, or close elsewhere.
    let far = stepper.step(&parameters, 0.0, 0.125, &mut y);
    assert!(matches!(far, Err(Halt::OpenLoop | Halt::Jumped | Halt::NearlySingular)), "{far:?}");
    let none = parameters.map(|_| f64::NAN);
    assert_eq!(stepper.step(&none, 0.0, 1e-4, &mut y), Err(Halt::NotFinite));
    assert_eq!(y, before, "the state is as it was");
}
