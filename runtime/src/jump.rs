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

/// Whether forces jump between two sides: those at the two states nearest to each other, if those at the other of [`NEIGHBOURS`] states of each
/// side differ less from them. `neighbours` are asked for only where the nearest ones differ at all.
/// `elsewhere` are forces so far from both that their size tells what is much.
pub fn forces_jump(
    nearest: [&[f64]; 2],
    elsewhere: &[Vec<f64>],
    neighbours: impl FnOnce() -> [Vec<Vec<f64>>; 2],
) -> bool {
    let across = farthest(nearest[0], nearest[1]);
    let far = elsewhere.iter().map(Vec::as_slice).chain(nearest);
    let size = far.map(largest).fold(0.0, f64::max);
    if across <= JUMP * size {
        return false;
    }
    let sides = neighbours();
    let size = sides.iter().flatten().map(|forces| largest(forces)).fold(size, f64::max);
    let among = |(side, own): (&Vec<Vec<f64>>, &[f64])| {
        side.iter().map(|forces| farthest(own, forces)).fold(0.0, f64::max)
    };
    let rounding = sides.iter().zip(nearest).map(among).fold(0.0, f64::max);
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

    fn jump(sides: [Vec<Vec<f64>>; 2], elsewhere: &[Vec<f64>]) -> bool {
        let [one, other] = [sides[0][0].clone(), sides[1][0].clone()];
        forces_jump([&one, &other], elsewhere, || sides)
    }

    #[test]
    fn a_step_is_a_jump_and_a_steep_force_is_none() {
        assert!(jump([side(|_| 0.0), side(|_| 1e-3)], &[]));
        assert!(!jump([side(|x| -1e3 * x), side(|x| 1e3 * x)], &[]));
        assert!(!jump([side(|x| 1.0 - 1e9 * x), side(|x| 1.1 + 1e9 * x)], &[]), "as steep as that");
    }

    #[test]
    fn what_is_little_beside_forces_elsewhere_is_none() {
        assert!(!jump([side(|_| 0.0), side(|_| 1e-3)], &[vec![0.0, 1e5]]));
    }

    #[test]
    fn where_nothing_differs_no_neighbours_are_computed() {
        let mut asked = false;
        let jumps = forces_jump([&[1.0], &[1.0]], &[], || {
            asked = true;
            [vec![], vec![]]
        });
        assert!(!jumps && !asked);
    }
}
