//! The spatial four-bar as a static library without std and without allocation, called from C (`main.c`).
#![no_std]

use linkwear_runtime::{Entry, System};

mod rssr {
    linkwear_runtime::include_mechanism!("rssr_rigid");
}

const STATE: usize = rssr::SIZES.coordinates + rssr::SIZES.speeds;
const BEFORE: usize = rssr::SIZES.parameters + 1;
const WORKSPACE: usize = rssr::SIZES.workspace;
/// Numbers of [`rssr_forward_dynamics`]: accelerations, multipliers, torque of the crank, pivots.
const FORWARD: usize = rssr::SIZES.output(Entry::ForwardDynamics);

/// Coordinates and speeds that assembly starts from.
#[unsafe(no_mangle)]
pub extern "C" fn rssr_start(t: f64, state: &mut [f64; STATE]) {
    evaluate(Entry::Start, t, &[], state);
}

/// Accelerations, multipliers, torque of the crank [N m] and pivots at a time [s] and a state.
#[unsafe(no_mangle)]
pub extern "C" fn rssr_forward_dynamics(t: f64, state: &[f64; STATE], answer: &mut [f64; FORWARD]) {
    evaluate(Entry::ForwardDynamics, t, state, answer);
}

fn evaluate(entry: Entry, t: f64, state: &[f64], answer: &mut [f64]) {
    let mechanism = rssr::Mechanism::default();
    let mut input = [t; BEFORE + STATE];
    input[..BEFORE - 1].copy_from_slice(&mechanism.parameters());
    input[BEFORE..BEFORE + state.len()].copy_from_slice(state);
    mechanism.evaluate(entry, &input, answer, &mut [0.0; WORKSPACE]);
}

/// The core library was compiled to unwind and names this; with `panic = "abort"` nothing calls it.
#[unsafe(no_mangle)]
pub extern "C" fn rust_eh_personality() {}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
