//! What random tapes and mechanisms are written for.

use crate::aarch64::instruction::{Lanes, REGISTERS, Target};

/// 5 and 6 registers are fewer than any processor has: nearly every value is spilled. States go by pairs.
pub(super) const TARGETS: [Target; 6] = [
    Target { lanes: Lanes::One, states: 1, registers: 5 },
    Target { lanes: Lanes::One, states: 1, registers: 24 },
    Target { lanes: Lanes::One, states: 1, registers: REGISTERS },
    Target { lanes: Lanes::Two, states: 2, registers: 6 },
    Target { lanes: Lanes::Two, states: 4, registers: REGISTERS },
    Target { lanes: Lanes::Two, states: 8, registers: REGISTERS },
];

/// Numbers of every kind.
pub(super) const NUMBERS: [f64; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    1.5,
    -2.75,
    3.0,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    f64::MIN_POSITIVE,
    -f64::MIN_POSITIVE / 8.0,
    5e-324,
    f64::MAX,
    f64::MIN,
    1e17,
];
