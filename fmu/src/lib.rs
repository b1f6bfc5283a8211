//! Mechanisms as functional mock-up units of FMI 3.0: co-simulation and model exchange.
//!
//! A unit is a library, which is the same for every mechanism, and beside it the mechanism's program as bytes: [`Unit`].
//! The program of linkwear writes both into a file; a tool loads the library, which reads the program from the folder
//! `resources` and runs it as machine code, else by the interpreter. What the tool may ask for is in [`Variables`].
//!
//! # What `unsafe` stands on
//! `unsafe` is in the folder `edge`: slices and texts of a caller, exported symbols, instances that go from thread to thread. It relies on what the standard asks of a
//! caller, and on nothing else:
//! 1. A pointer to values is null or points to as many as the number beside it says; a text ends with a zero.
//! 2. No two calls work on the same instance at once, except those that the standard allows.
//! 3. The callback for messages may be called while a function of the unit is running.
//!
//! Instances and kept states are known by numbers that look like pointers and are never followed: a wrong one is told, not
//! read. No panic leaves the library.

#![deny(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::todo,
    clippy::unimplemented,
    clippy::unreachable
)]

mod edge;
mod fault;
mod instance;
mod loaded;
mod needs;
mod sensitivity;
mod unit;
mod variables;

pub use fault::Fault;
pub use instance::kept::Kept;
pub use instance::{Instance, Interface, Times};
pub use loaded::Loaded;
pub use needs::{belongs_to_contacts, belongs_to_start};
pub use unit::{Constant, PROGRAM_FILE, Unit};
pub use variables::{Variable, Variables};
