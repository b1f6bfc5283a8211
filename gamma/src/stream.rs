//! Random numbers picked by what they are for. In: seed, trajectory, joint, cycle. Out: uniform and normal deviates,
//! the same on every machine, for any order of work. Never knows what is drawn.
//!
//! `ChaCha` with 8 rounds is a counter run through a permutation: any place of any stream is reached at once. The key holds
//! seed and joint, the stream number is the trajectory, and every cycle has a block of its own. So a trajectory draws
//! the same increments whichever thread or shard it runs on, and after a pause.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Words of 32 bits kept for one cycle. A draw takes some 10; rejection makes more than a few hundred impossible in
/// practice, and then it only runs into the next cycle's block.
const WORDS_PER_CYCLE: u128 = 4096;
/// Sets these streams apart from other uses of the same seed.
const PURPOSE: &[u8; 16] = b"linkwear.gamma.1";

/// The random numbers of one joint in one trajectory.
#[derive(Clone, Debug)]
pub struct Stream(ChaCha8Rng);

impl Stream {
    /// At the begin of the first cycle.
    #[must_use]
    pub fn new(seed: u64, trajectory: u64, joint: u64) -> Self {
        let mut key = [0_u8; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..16].copy_from_slice(&joint.to_le_bytes());
        key[16..].copy_from_slice(PURPOSE);
        let mut generator = ChaCha8Rng::from_seed(key);
        generator.set_stream(trajectory);
        Self(generator)
    }

    /// At the begin of a cycle, counted from 0, below 2^55.
    #[must_use]
    pub fn at(mut self, cycle: u64) -> Self {
        self.0.set_word_pos(u128::from(cycle) * WORDS_PER_CYCLE);
        self
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Uniform in (0, 1), never an end: the middle of one of 2^52 cells.
    pub fn uniform(&mut self) -> f64 {
        ((self.bits() >> 12) as f64 + 0.5) * (1.0 / (1_u64 << 52) as f64)
    }

    /// Standard normal, by Marsaglia's polar method (one of its pair, so that a draw has no memory).
    pub fn normal(&mut self) -> f64 {
        loop {
            let (x, y) = (2.0 * self.uniform() - 1.0, 2.0 * self.uniform() - 1.0);
            let square = x * x + y * y;
            if square > 0.0 && square < 1.0 {
                return x * libm::sqrt(-2.0 * libm::log(square) / square);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_of_a_stream_has_known_bits_whatever_came_before() {
        // Pinned: other bits would change the results of every seed.
        let bits = |trajectory, joint, cycle| Stream::new(7, trajectory, joint).at(cycle).bits();
        assert_eq!([bits(0, 0, 0), bits(1, 0, 0), bits(0, 1, 0), bits(0, 0, 1)], KNOWN);
        let mut stream = Stream::new(7, 0, 0);
        for _ in 0..100 {
            stream.normal();
        }
        assert_eq!(stream.at(1).bits(), KNOWN[3]);
    }

    const KNOWN: [u64; 4] = [
        13_077_527_142_614_884_970,
        2_349_712_983_982_220_937,
        5_512_707_190_370_733_920,
        7_347_546_441_153_215_298,
    ];

    #[test]
    fn deviates_have_the_moments_of_their_laws() {
        let mut stream = Stream::new(3, 5, 1);
        let count = 100_000;
        let (mut uniform, mut square, mut fourth) = (0.0, 0.0, 0.0);
        for _ in 0..count {
            let u = stream.uniform();
            assert!(u > 0.0 && u < 1.0);
            uniform += u;
            let z = stream.normal();
            square += z * z;
            fourth += z * z * z * z;
        }
        let n = f64::from(count);
        // Four standard errors: of u sqrt(1/12/n), of z^2 sqrt(2/n), of z^4 sqrt(96/n).
        assert!((uniform / n - 0.5).abs() < 4.0 * (1.0 / 12.0 / n).sqrt());
        assert!((square / n - 1.0).abs() < 4.0 * (2.0 / n).sqrt());
        assert!((fourth / n - 3.0).abs() < 4.0 * (96.0 / n).sqrt());
    }
}
