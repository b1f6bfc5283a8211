//! A generator whose bits depend on where they are used and on nothing else. In: seed, trajectory, joint, cycle. Out: a
//! generator of `rand`. Never knows what is drawn for, nor which thread draws.
//!
//! The generator is ChaCha8 (`rand_chacha`), a function of key, stream number and block counter. The key is, in
//! little-endian bytes, seed (8), trajectory (8), joint (8) and the letters `linkwear`; the stream number is the
//! cycle; the counter begins at 0 in every cycle. So a draw depends on (seed, trajectory, joint, cycle) and its place
//! within the cycle alone: any number of threads or shards gives the same bits.

use core::convert::Infallible;

use rand::{Rng, SeedableRng, TryRng};
use rand_chacha::ChaCha8Rng;

/// The random numbers of one joint in one trajectory.
#[derive(Clone, Debug)]
pub struct Stream {
    generator: ChaCha8Rng,
}

impl Stream {
    /// The stream of a joint in a trajectory, at the start of cycle 0.
    pub fn new(seed: u64, trajectory: u64, joint: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..16].copy_from_slice(&trajectory.to_le_bytes());
        key[16..24].copy_from_slice(&joint.to_le_bytes());
        key[24..].copy_from_slice(b"linkwear");
        Self { generator: ChaCha8Rng::from_seed(key) }
    }

    /// Goes to the start of a cycle, whatever was drawn before.
    pub fn at(&mut self, cycle: u64) -> &mut Self {
        self.generator.set_stream(cycle);
        self.generator.set_word_pos(0);
        self
    }
}

impl TryRng for Stream {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok(self.generator.next_u32())
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        Ok(self.generator.next_u64())
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        self.generator.fill_bytes(bytes);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;
    use rand::distr::Open01;

    use super::*;

    #[test]
    fn a_draw_depends_on_its_four_numbers_alone() {
        let first = Stream::new(7, 3, 1).at(12).next_u64();
        let mut used = Stream::new(7, 3, 1);
        for _ in 0..1000 {
            used.at(5).next_u64();
            used.next_u64();
        }
        assert_eq!(used.at(12).next_u64(), first);
        let others = [(8, 3, 1, 12), (7, 4, 1, 12), (7, 3, 2, 12), (7, 3, 1, 13)];
        for (seed, trajectory, joint, cycle) in others {
            assert_ne!(Stream::new(seed, trajectory, joint).at(cycle).next_u64(), first);
        }
    }

    #[test]
    fn uniform_numbers_fill_the_open_interval_evenly() {
        let mut stream = Stream::new(1, 0, 0);
        let draws: Vec<f64> = (0..100_000).map(|_| stream.sample(Open01)).collect();
        assert!(draws.iter().all(|u| *u > 0.0 && *u < 1.0));
        let mean = draws.iter().sum::<f64>() / draws.len() as f64;
        // Four standard errors of the mean, 1 / sqrt(12 n).
        assert!((mean - 0.5).abs() < 4.0 / (12e5_f64).sqrt(), "{mean}");
    }
}
