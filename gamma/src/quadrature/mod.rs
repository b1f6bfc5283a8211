//! Integrals in one dimension: adaptive over an interval, and over a line for functions with one hump. In: functions.
//! Out: integrals, or points and weights. Never knows what is integrated.

mod adaptive;
mod hump;

pub(crate) use adaptive::integrate;
pub(crate) use hump::Hump;
