//! Reactions that redundant constraints leave undetermined: self-stress of the loops.
//! In: the left null space of the constraint Jacobian. Out: names of wrench components.

use linkwear_runtime::{Description, Entry, System};

use super::samples::{ClosedPositions, evaluate, null_space};

/// Components below this share of the largest of a self-stress count as untouched by it.
const UNTOUCHED: f64 = 1e-7;

/// Wrench components (`R1.Fx`) that change under a self-stress.
pub fn non_unique(
    description: &Description,
    system: &dyn System<f64>,
    parameters: &[f64],
    positions: &ClosedPositions,
) -> Vec<String> {
    let sizes = system.sizes();
    let stresses = null_space(&positions.positions[0].jacobian.transpose());
    let observe = |multipliers: &[f64]| {
        let (v, drives) = (vec![0.0; 2 * sizes.speeds], vec![0.0; sizes.drivers]);
        let (v, v_dot) = v.split_at(sizes.speeds);
        let input = [parameters, &[0.0], &positions.start, v, v_dot, multipliers, &drives].concat();
        let mut output = vec![0.0; sizes.channels];
        evaluate(system, Entry::Observe, &input, &mut output);
        output
    };
    let unloaded = observe(&vec![0.0; sizes.rows]);
    let mut touched = vec![false; sizes.channels];
    for stress in stresses.column_iter() {
        let loaded = observe(stress.clone_owned().as_slice());
        let changes: Vec<f64> = loaded.iter().zip(&unloaded).map(|(a, b)| (a - b).abs()).collect();
        for (index, channel) in description.channels.iter().enumerate() {
            touched[index] |= is_wrench(&channel.name) && changes[index] > UNTOUCHED;
        }
    }
    let names = description.channels.iter().zip(touched);
    names.filter(|(_, touched)| *touched).map(|(channel, _)| channel.name.to_string()).collect()
}

fn is_wrench(name: &str) -> bool {
    ["Fx", "Fy", "Fz", "Mx", "My", "Mz"].iter().any(|suffix| name.ends_with(&format!(".{suffix}")))
}
