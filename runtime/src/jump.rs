//! Whether forces jump between two states next to each other. In: forces on both sides and elsewhere. Out: yes or no.
//! Never knows what jumps, nor why one looks there.

use crate::linear::largest;

/// States on each side. Where rounding is all that is left of the forces, those of one side differ among themselves as they do from the
/// other side's.
pub const NEIGHBOURS: u32 = 6;
/// Part of the largest force by which the two nearest states cannot differ, unless it changes a thousandfold over a step. Where one looks a
/// force may go through zero, and be all that there is.
const JUMP: f64 = 1e-7;
/// A jump is more than this times what those of one side differ by: of six that round, the farthest are a third of their range apart at least.
const ABOVE_ROUNDING: f64 = 16.0;

/// Whether forces jump between two sides. Of each side the forces at up to [`NEIGHBOURS`] states, the one nearest to the other side first;
/// `elsewhere` are forces so far from both that their size tells what is much. A side without forces jumps nowhere.
pub fn forces_jump(sides: [&[Vec<f64>]; 2], elsewhere: &[Vec<f64>]) -> bool {
    let [Some(one), Some(other)] = sides.map(<[_]>::first) else { return false };
    let among = |side: &[Vec<f64>]| side.iter().map(|forces| farthest(&side[0], forces)).fold(0.0, f64::max);
    let all = sides.into_iter().flatten().chain(elsewhere);
    let size = all.map(|forces| largest(forces)).fold(0.0, f64::max);
    let rounding = sides.map(among).into_iter().fold(0.0, f64::max);
    let across = farthest(one, other);
    across > JUMP * size && across > ABOVE_ROUNDING * rounding
}

/// The largest difference of forces.
fn farthest(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Forces at six states of a side, by their distance from where one looks.
    fn side(force: impl Fn(f64) -> f64) -> Vec<Vec<f64>> {
        (0..NEIGHBOURS).map(|step| vec![1.0, force(1e-10 * f64::from(step))]).collect()
    }

    #[test]
    fn a_step_is_a_jump_and_a_steep_force_is_none() {
        assert!(forces_jump([&side(|_| 0.0), &side(|_| 1e-3)], &[]));
        assert!(!forces_jump([&side(|x| -1e3 * x), &side(|x| 1e3 * x)], &[]));
        assert!(!forces_jump([&side(|x| 1.0 - 1e9 * x), &side(|x| 1.1 + 1e9 * x)], &[]), "as steep as that");
    }

    #[test]
    fn what_is_little_beside_forces_elsewhere_is_none() {
        let sides = [side(|_| 0.0), side(|_| 1e-3)];
        assert!(!forces_jump([&sides[0], &sides[1]], &[vec![0.0, 1e5]]));
        assert!(!forces_jump([&sides[0], &[]], &[]), "nothing to compare with");
    }
}
