//! What steps of a turn wear. In: rates at their ends and in their middles. Out: wear integrals and depths. Never knows motions.

use super::roots;
use super::tangents::Varied;

/// How long a step is: as a part of a turn, and of the steps of the turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Part {
    pub of_turn: f64,
    pub of_step: f64,
}

/// What a step did, joint by joint.
pub(super) struct Step<const N: usize> {
    /// Rates of depths at its begin and in its middle [m/s].
    pub begin: Vec<Varied<N>>,
    pub middle: Vec<Varied<N>>,
    /// What it added to wear integrals [J].
    pub integrals: Vec<Varied<N>>,
    pub losses: u32,
    pub is_rough: bool,
}

/// What steps have worn, joint by joint.
pub(super) struct Wear<const N: usize> {
    integrals: Vec<Varied<N>>,
    /// Depths [m] over the length of a step of the turn, until the last time that lengths changed.
    depths: Vec<Varied<N>>,
    /// Rates of depths since then, at ends and middles of steps.
    since: Vec<Vec<Varied<N>>>,
    part: f64,
}

impl<const N: usize> Wear<N> {
    pub(super) fn new(joints: usize) -> Self {
        let zeros = vec![Varied::ZERO; joints];
        Self { integrals: zeros.clone(), depths: zeros, since: vec![Vec::new(); joints], part: 1.0 }
    }

    pub(super) fn add(&mut self, step: &Step<N>, part: Part) {
        if part.of_step != self.part {
            self.begin_anew(&step.begin);
            self.part = part.of_step;
        }
        for (joint, since) in self.since.iter_mut().enumerate() {
            since.extend([step.begin[joint], step.middle[joint]]);
            self.integrals[joint] = self.integrals[joint].plus(1.0, &step.integrals[joint]);
        }
    }

    /// Adds up what has been since the lengths changed; `rates` are those at hand.
    fn begin_anew(&mut self, rates: &[Varied<N>]) {
        let half = Varied { value: 0.5 * self.part, tangents: [0.0; N] };
        for ((depth, since), rate) in self.depths.iter_mut().zip(&mut self.since).zip(rates) {
            since.push(*rate);
            *depth = depth.plus(1.0, &roots::integral(since, &half));
            since.clear();
        }
    }

    /// Wear integrals and depths, by the length of a step.
    pub(super) fn finish(mut self, rates: &[Varied<N>], step: &Varied<N>) -> Vec<[Varied<N>; 2]> {
        self.begin_anew(rates);
        let pairs = self.integrals.iter().zip(&self.depths);
        pairs.map(|(integral, depth)| [*integral, depth.over(step)]).collect()
    }
}
