//! Machine code for tapes, written at run time: what no compiler has seen runs as fast as compiled code, in the
//! interpreter's bits.
//!
//! From a tape to code: operations as a graph, in which the runtime's series stand operation by operation, sines of several angles side by
//! side, an order, registers, bytes, memory that is executable and no longer writable. All but the last step and the call is
//! safe code.
//!
//! # What `unsafe` stands on
//! `unsafe` is in `memory/code.rs`, which calls the code, and in `memory/called.rs`, which the code calls. They rely on:
//! 1. Code comes from the encoder only, for a tape that was verified: it reads and writes the four slices that it is
//!    given, or the columns behind the pointers in the first two, and nothing else, at places below the lengths that are kept beside it, and it ends in a return.
//! 2. These lengths are compared with those of the slices before every call.
//! 3. Code uses only what the processor was found to have when it was written.
//! 4. Memory is made executable once it is written, is never writable and executable together, and lives as long as what
//!    calls into it. Where a processor would not see by itself that its instructions have changed, it is told before the
//!    first call.
//! 5. A called function gets addresses of whole values inside these slices, the result apart from the arguments, and
//!    does not unwind.

#![deny(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::todo,
    clippy::unimplemented,
    clippy::unreachable
)]

#[cfg(any(test, target_arch = "aarch64"))]
mod aarch64;
mod columns;
#[cfg(any(target_arch = "aarch64", target_arch = "x86_64"))]
mod functions;
mod lanes;
#[cfg(any(target_arch = "aarch64", target_arch = "x86_64"))]
mod memory;
mod refusal;
mod routine;
mod seldom;
#[cfg(any(test, target_arch = "aarch64", target_arch = "x86_64"))]
mod straight;
mod system;
mod timing;
#[cfg(not(any(target_arch = "aarch64", target_arch = "x86_64")))]
mod unsupported;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use columns::Columns;
pub use lanes::{Lanes, NativeBundle};
pub use refusal::Refusal;
pub use routine::Routine;
pub use system::Native;
pub use timing::{nanoseconds_alone, nanoseconds_of_eight, nanoseconds_of_four};
