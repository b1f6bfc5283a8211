//! Tests of what is written, against a decoder and against plain evaluation.

mod encodings;
mod extremes;
mod guarded;
mod hostile;
mod masks;
mod random;
mod refused;
mod sines;
