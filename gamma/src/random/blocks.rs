//! The first random numbers of several streams at once: ChaCha8 as [`Stream`](super::Stream) has it, one block in each lane.
//! In: seed, joint, trajectories, cycles. Out: the words that the streams would give first. Never knows what is drawn.

use super::width::LANES;

/// A word of the state in each lane.
type Words = [u32; LANES];

/// `expand 32-byte k`, as D. J. Bernstein has it, in little-endian words.
const CONSTANTS: [u32; 4] = [0x6170_7865, 0x3320_646e, 0x7962_2d32, 0x6b20_6574];
/// `linkwear` in little-endian words: the end of every key.
const NAME: [u32; 2] = [u32::from_le_bytes(*b"link"), u32::from_le_bytes(*b"wear")];

/// The first three numbers of 64 bits in each lane: of stream (seed, trajectory, joint) at the start of a cycle.
#[inline]
pub(super) fn first_numbers(
    (seed, joint): (u64, u64),
    trajectories: &[u64; LANES],
    cycles: &[u64; LANES],
) -> [[u64; LANES]; 3] {
    let low = |numbers: &[u64; LANES]| numbers.map(|number| number as u32);
    let high = |numbers: &[u64; LANES]| numbers.map(|number| (number >> 32) as u32);
    let all = |word: u32| [word; LANES];
    let begin: [Words; 16] = [
        all(CONSTANTS[0]),
        all(CONSTANTS[1]),
        all(CONSTANTS[2]),
        all(CONSTANTS[3]),
        all(seed as u32),
        all((seed >> 32) as u32),
        low(trajectories),
        high(trajectories),
        all(joint as u32),
        all((joint >> 32) as u32),
        all(NAME[0]),
        all(NAME[1]),
        // The block counter, then the number of the stream.
        all(0),
        all(0),
        low(cycles),
        high(cycles),
    ];
    // One loop without branches over all lanes: so written, compilers make it one of vectors.
    let mut words = [[0; LANES]; 6];
    for lane in 0..LANES {
        let begin = begin.map(|word| word[lane]);
        let end = double_round(double_round(double_round(double_round(begin))));
        for (at, word) in words.iter_mut().enumerate() {
            word[lane] = end[at].wrapping_add(begin[at]);
        }
    }
    let number = |at: usize, lane: usize| u64::from(words[at][lane]) | (u64::from(words[at + 1][lane]) << 32);
    [0, 2, 4].map(|at| std::array::from_fn(|lane| number(at, lane)))
}

/// Columns, then diagonals.
#[inline(always)]
fn double_round(state: [u32; 16]) -> [u32; 16] {
    let [a0, a1, a2, a3, b0, b1, b2, b3, c0, c1, c2, c3, d0, d1, d2, d3] = state;
    let [a0, b0, c0, d0] = quarter_round(a0, b0, c0, d0);
    let [a1, b1, c1, d1] = quarter_round(a1, b1, c1, d1);
    let [a2, b2, c2, d2] = quarter_round(a2, b2, c2, d2);
    let [a3, b3, c3, d3] = quarter_round(a3, b3, c3, d3);
    let [a0, b1, c2, d3] = quarter_round(a0, b1, c2, d3);
    let [a1, b2, c3, d0] = quarter_round(a1, b2, c3, d0);
    let [a2, b3, c0, d1] = quarter_round(a2, b3, c0, d1);
    let [a3, b0, c1, d2] = quarter_round(a3, b0, c1, d2);
    [a0, a1, a2, a3, b0, b1, b2, b3, c0, c1, c2, c3, d0, d1, d2, d3]
}

#[inline(always)]
fn quarter_round(a: u32, b: u32, c: u32, d: u32) -> [u32; 4] {
    let a = a.wrapping_add(b);
    let d = (d ^ a).rotate_left(16);
    let c = c.wrapping_add(d);
    let b = (b ^ c).rotate_left(12);
    let a = a.wrapping_add(b);
    let d = (d ^ a).rotate_left(8);
    let c = c.wrapping_add(d);
    [a, (b ^ c).rotate_left(7), c, d]
}

#[cfg(test)]
mod tests {
    use rand::Rng;

    use super::*;
    use crate::random::Stream;

    #[test]
    fn lanes_give_what_their_streams_give() {
        let (seed, joint) = (0x0123_4567_89ab_cdef, u64::MAX);
        let trajectories = std::array::from_fn(|lane| (lane as u64) << (8 * lane));
        let cycles = std::array::from_fn(|lane| (lane as u64 * 7) << (5 * lane));
        let found = first_numbers((seed, joint), &trajectories, &cycles);
        for lane in 0..LANES {
            let mut stream = Stream::new(seed, trajectories[lane], joint);
            stream.at(cycles[lane]);
            for numbers in &found {
                assert_eq!(numbers[lane], stream.next_u64(), "lane {lane}");
            }
        }
    }
}
