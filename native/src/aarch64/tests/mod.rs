//! Tests of what is written: its words against those of an assembler, its instructions by their meaning, all of it under an
//! emulator.

mod assembly;
mod emulated;
mod emulator;
mod encodings;
mod simulated;
mod targets;
