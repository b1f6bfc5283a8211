//! The case study, with a flexible coupler, a loose bearing and contact, stepped without std and without allocation: a static
//! library that C calls (`main.c`).
#![no_std]

use linkwear_runtime::{FixedStep, Halt};

mod rssr {
    linkwear_runtime::include_mechanism!("rssr");
}

/// A run: time [s], flat state, what the stepper works in. All of it is kept by the caller.
#[repr(C)]
pub struct Run {
    t: f64,
    y: [f64; rssr::SIZES.flat_state()],
    numbers: [f64; rssr::SIZES.step_numbers()],
}

/// Bytes of a run.
#[unsafe(no_mangle)]
pub static RSSR_RUN: usize = size_of::<Run>();

/// Puts a run at its start.
#[unsafe(no_mangle)]
pub extern "C" fn rssr_begin(run: &mut Run) -> i32 {
    *run = Run { t: 0.0, y: [0.0; rssr::SIZES.flat_state()], numbers: [0.0; rssr::SIZES.step_numbers()] };
    act(run, |stepper, parameters, _, y| stepper.begin(parameters, y))
}

/// A step from the run's time to another one [s]. Not 0: why it cannot be made; the run is as it was.
#[unsafe(no_mangle)]
pub extern "C" fn rssr_step(run: &mut Run, end: f64) -> i32 {
    act(run, |stepper, parameters, t, y| {
        stepper.step(parameters, *t, end - *t, y)?;
        *t = end;
        Ok(())
    })
}

/// Angle of the rocker [rad], normal force in the bearing [N], its wear integral since the start [J].
#[unsafe(no_mangle)]
pub extern "C" fn rssr_observe(run: &mut Run, answer: &mut [f64; 3]) -> i32 {
    act(run, |stepper, parameters, t, y| {
        let mut columns = [0.0; rssr::SIZES.channels];
        stepper.observe(parameters, *t, y, &mut columns)?;
        let rocker = rssr::TABLES.channels.iter().position(|(name, ..)| *name == "R4.q").ok_or(Halt::Length)?;
        let bearing = stepper.contact(0).ok_or(Halt::Length)?;
        // Behind coordinates and speeds: work supplied, work dissipated, then what the bearing has done.
        let totals = rssr::SIZES.coordinates + rssr::SIZES.speeds + 2;
        *answer = [columns[rocker], bearing.normal_force, y[totals]];
        Ok(())
    })
}

/// Does something with the run of a mechanism as its file has it.
fn act(
    run: &mut Run,
    action: impl FnOnce(&mut FixedStep<'_, rssr::Mechanism>, &[f64], &mut f64, &mut [f64]) -> Result<(), Halt>,
) -> i32 {
    let mechanism = rssr::Mechanism::default();
    let mut laws = [const { None }; rssr::SIZES.contacts];
    let done = FixedStep::new(&mechanism, &rssr::ALL_TABLES, &rssr::START, &mut laws, &mut run.numbers)
        .and_then(|mut stepper| action(&mut stepper, &mechanism.parameters(), &mut run.t, &mut run.y));
    match done {
        Ok(()) => 0,
        Err(Halt::Length | Halt::Samples | Halt::Law(_)) => 1,
        Err(Halt::NearlySingular) => 2,
        Err(Halt::OpenLoop | Halt::Jumped) => 3,
        Err(Halt::NotFinite) => 4,
    }
}

/// The core library was compiled to unwind and names this; with `panic = "abort"` nothing calls it.
#[unsafe(no_mangle)]
pub extern "C" fn rust_eh_personality() {}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
