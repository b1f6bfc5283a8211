//! Exponential, logarithm and the angle of a vector without branches, generic over the scalar, so that every back end gives the
//! same bits. In: any number. Out: numbers, at most 1 ulp from the exact value; infinite, subnormal and undefined arguments,
//! zeros with their signs, as IEEE 754 has them.
#![expect(clippy::excessive_precision, reason = "digits as published")]

mod arctangent;
mod exponential;
mod logarithm;

pub use arctangent::atan2;
pub use exponential::{exp, exp_of_moderate};
pub use logarithm::ln;

/// ln 2 as the sum of two: whole numbers below 2^20 times the first are exact.
const LN2_HIGH: f64 = 6.931_471_803_691_238_164_90e-1;
const LN2_LOW: f64 = 1.908_214_929_270_587_700_02e-10;
