//! The functions of FMI 3.0 as symbols. In: pointers and numbers of a caller. Out: a status, values where the caller wants them.
//! Never knows mechanisms.
#![allow(non_snake_case, reason = "names of the standard")]

mod caller;
mod life;
mod motion;
mod registry;
mod states;
mod unsupported;
mod values;
