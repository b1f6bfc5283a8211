//! Reactions that redundant constraints leave undetermined: self-stress of the loops.
//! In: the left null space of the constraint Jacobian. Out: names of wrench components.

use super::case::Case;
use super::samples::{ClosedPositions, null_space};

/// Components below this share of the largest of a self-stress count as untouched by it.
const UNTOUCHED: f64 = 1e-7;

/// Positions looked at: a component that a self-stress leaves alone in one position it may touch in the next.
const POSITIONS: usize = 6;

/// Wrench components (`R1.Fx`) that change under a self-stress in some position.
pub fn non_unique(case: &Case<'_>, positions: &ClosedPositions) -> Vec<String> {
    let sizes = case.system.sizes();
    let channels = &case.description.channels;
    let mut touched = vec![false; sizes.channels];
    let stride = positions.positions.len().div_ceil(POSITIONS).max(1);
    for position in positions.positions.iter().step_by(stride) {
        let observe = |multipliers: &[f64]| case.observe(&position.q, &vec![0.0; sizes.speeds], multipliers);
        let unloaded = observe(&vec![0.0; sizes.rows]);
        let stresses = null_space(&position.jacobian.transpose());
        for stress in stresses.column_iter() {
            let loaded = observe(stress.clone_owned().as_slice());
            for (index, channel) in channels.iter().enumerate() {
                touched[index] |=
                    is_wrench(&channel.name) && (loaded[index] - unloaded[index]).abs() > UNTOUCHED;
            }
        }
    }
    let names = channels.iter().zip(touched);
    names.filter(|(_, touched)| *touched).map(|(channel, _)| channel.name.to_string()).collect()
}

fn is_wrench(name: &str) -> bool {
    ["Fx", "Fy", "Fz", "Mx", "My", "Mz"].iter().any(|suffix| name.ends_with(&format!(".{suffix}")))
}
