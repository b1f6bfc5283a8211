//! What this processor has. Out: the best [`Target`] for a number of lanes.

use std::arch::is_x86_feature_detected;

use super::instruction::{Lanes, Target};

/// What code for so many lanes may use here; none if this processor cannot run any.
pub(super) fn target(lanes: Lanes) -> Option<Target> {
    let registers = if has_avx512() {
        32
    } else if is_x86_feature_detected!("avx") {
        16
    } else {
        return None;
    };
    let target = Target { lanes, registers, columns: false };
    can_run(target).then_some(target)
}

/// Whether code for a target runs here.
pub(super) fn can_run(target: Target) -> bool {
    let wide = target.registers > 16 || target.lanes == Lanes::Eight;
    if wide { has_avx512() && target.registers > 16 } else { is_x86_feature_detected!("avx") }
}

/// 32 registers, masks, and all of it for shorter registers too.
fn has_avx512() -> bool {
    is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl")
}
