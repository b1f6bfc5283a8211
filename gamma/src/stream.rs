//! Random numbers that depend on where they are used and on nothing else. In: seed, trajectory, joint, cycle. Out:
//! uniform and normal numbers. Never knows what they are drawn for, nor which thread draws them.
//!
//! The generator is ChaCha8 (`rand_chacha`), a function of key, stream number and block counter. The key is, in
//! little-endian bytes, seed (8), trajectory (8), joint (8) and the letters `linkwear`; the stream number is the
//! cycle; the counter begins at 0 in every cycle. So a draw depends on (seed, trajectory, joint, cycle) and its place
//! within the cycle alone: any number of threads or shards gives the same bits.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

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

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.generator.next_u64()
    }

    /// Uniform in the open interval (0, 1): the middles of 2^52 equal parts, so neither end can come.
    pub fn uniform(&mut self) -> f64 {
        const PART: f64 = 1.0 / (1_u64 << 52) as f64;
        ((self.bits() >> 12) as f64 + 0.5) * PART
    }

    /// Standard normal, by Box and Muller, from two uniform numbers.
    pub fn normal(&mut self) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(self.uniform()));
        radius * libm::cos(2.0 * core::f64::consts::PI * self.uniform())
    }

    /// A whole number in 0..count, for resampling. `count` > 0; the bias, count / 2^64, is beyond measure.
    pub fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.bits()) * count as u128) >> 64) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_draw_depends_on_its_four_numbers_alone() {
        let first = Stream::new(7, 3, 1).at(12).bits();
        let mut used = Stream::new(7, 3, 1);
        for _ in 0..1000 {
            used.at(5).bits();
            used.bits();
        }
        assert_eq!(used.at(12).bits(), first);
        let others = [(8, 3, 1, 12), (7, 4, 1, 12), (7, 3, 2, 12), (7, 3, 1, 13)];
        for (seed, trajectory, joint, cycle) in others {
            assert_ne!(Stream::new(seed, trajectory, joint).at(cycle).bits(), first);
        }
    }

    #[test]
    fn uniform_numbers_fill_the_open_interval_evenly() {
        let mut stream = Stream::new(1, 0, 0);
        let draws: Vec<f64> = (0..100_000).map(|_| stream.uniform()).collect();
        assert!(draws.iter().all(|u| *u > 0.0 && *u < 1.0));
        let mean = draws.iter().sum::<f64>() / draws.len() as f64;
        // Four standard errors of the mean, 1 / sqrt(12 n).
        assert!((mean - 0.5).abs() < 4.0 / (12e5_f64).sqrt(), "{mean}");
    }

    #[test]
    fn normal_numbers_have_mean_variance_and_kurtosis_of_the_normal_law() {
        let mut stream = Stream::new(2, 0, 0);
        let n = 100_000;
        let draws: Vec<f64> = (0..n).map(|_| stream.normal()).collect();
        let moment = |k: i32| draws.iter().map(|z| z.powi(k)).sum::<f64>() / f64::from(n);
        // Four standard errors: variances of z, z^2, z^4 are 1, 2, 96.
        let error = |variance: f64| 4.0 * (variance / f64::from(n)).sqrt();
        assert!(moment(1).abs() < error(1.0));
        assert!((moment(2) - 1.0).abs() < error(2.0));
        assert!((moment(4) - 3.0).abs() < error(96.0));
    }
}
