//! Lives side by side on mean paths that are solved already. In: paths, a draw, numbers of trajectories. Out: their ends,
//! each by its number alone, whatever is beside it. Never knows threads.

use linkwear_runtime::life::{FailureEvent, IncrementModel, LANES, Lanes, LifeSettings, WearFlow};

/// Hears of whole cycles: trajectory, cycle from 1, wear W [m] of every joint at its end. A life that is lived twice is heard of twice,
/// from its first cycle on.
pub type Heard<'a> = &'a (dyn Fn(u64, u64, &[f64]) + Sync);

/// Lives at hand, one in each lane. Nothing is allocated for a life or a cycle.
pub(super) struct SideBySide<'a> {
    settings: &'a LifeSettings,
    flow: WearFlow,
    draw: &'a (dyn IncrementModel + Sync),
    heard: Option<Heard<'a>>,
    lanes: Lanes,
    is_busy: [bool; LANES],
    /// W [m] of each joint in each lane, and after the cycle at hand.
    wear: Vec<[f64; LANES]>,
    gains: Vec<[f64; LANES]>,
    next: Vec<[f64; LANES]>,
    /// W [m] of each joint of one life, for who hears of it.
    told: Vec<f64>,
}

impl<'a> SideBySide<'a> {
    pub(super) fn new(
        settings: &'a LifeSettings,
        flow: WearFlow,
        (draw, heard): (&'a (dyn IncrementModel + Sync), Option<Heard<'a>>),
    ) -> Self {
        let zeros = || vec![[0.0; LANES]; flow.joints()];
        let (wear, gains, next) = (zeros(), zeros(), zeros());
        let (lanes, is_busy, told) = (Lanes::default(), [false; LANES], vec![0.0; flow.joints()]);
        Self { settings, draw, heard, lanes, is_busy, wear, gains, next, told, flow }
    }

    /// Lives these trajectories; `ended` hears of each, in the order in which they end. Nothing as its end: the life is one that
    /// has to go cycle by cycle, because it does not fail or a draw is no number.
    // Not generic: what is, is compiled by the crate that calls it, which need not be optimised.
    pub(super) fn live(
        &mut self,
        trajectories: &mut dyn Iterator<Item = u64>,
        ended: &mut dyn FnMut(u64, Option<FailureEvent>),
    ) {
        (0..LANES).for_each(|lane| self.begin(lane, trajectories.next()));
        while self.is_busy.contains(&true) {
            self.cycle();
            for lane in 0..LANES {
                if !self.is_busy[lane] {
                    continue;
                }
                self.tell(lane);
                let end = match self.end(lane) {
                    Ok(None) => {
                        self.lanes.cycles[lane] += 1;
                        if self.lanes.cycles[lane] < self.settings.most_cycles {
                            self.wear.iter_mut().zip(&self.next).for_each(|(wear, to)| wear[lane] = to[lane]);
                            continue;
                        }
                        None
                    }
                    Ok(Some(end)) => Some(end),
                    Err(NoNumber) => None,
                };
                ended(self.lanes.trajectories[lane], end);
                self.begin(lane, trajectories.next());
            }
        }
    }

    fn begin(&mut self, lane: usize, trajectory: Option<u64>) {
        // An idle lane lives the life it had once more, unheard.
        self.is_busy[lane] = trajectory.is_some();
        if let Some(trajectory) = trajectory {
            self.lanes.trajectories[lane] = trajectory;
            self.lanes.own[lane] = self.draw.of_trajectory(trajectory);
        }
        self.lanes.cycles[lane] = 0;
        self.wear.iter_mut().for_each(|wear| wear[lane] = 0.0);
    }

    /// Draws a cycle in all lanes.
    fn cycle(&mut self) {
        for joint in 0..self.wear.len() {
            let wear = &self.wear[joint];
            let gains = wear.map(|wear| self.flow.gain(joint, wear));
            let drawn = self.draw.draw_lanes(joint, &self.lanes, &gains);
            self.gains[joint] = gains;
            self.next[joint] = std::array::from_fn(|lane| wear[lane] + drawn[lane]);
        }
    }

    /// Tells of the cycle at hand of a life.
    fn tell(&mut self, lane: usize) {
        if let Some(heard) = self.heard {
            self.told.iter_mut().zip(&self.next).for_each(|(told, next)| *told = next[lane]);
            heard(self.lanes.trajectories[lane], self.lanes.cycles[lane] + 1, &self.told);
        }
    }

    /// Whether a life ends in the cycle, and when the first of its joints does.
    fn end(&self, lane: usize) -> Result<Option<FailureEvent>, NoNumber> {
        let mut first: Option<FailureEvent> = None;
        let done = self.lanes.cycles[lane];
        for (joint, lives) in self.settings.joints.iter().enumerate() {
            let [from, to] = [self.wear[joint][lane], self.next[joint][lane]];
            if !(to >= from && to.is_finite()) {
                return Err(NoNumber);
            }
            if to >= lives.threshold {
                // Within the cycle all increments of the mean path are drawn by one factor.
                let part = (lives.threshold - from) / (to - from);
                let time = self.flow.time(joint, from, from + part * self.gains[joint][lane]);
                let end = FailureEvent {
                    joint,
                    cycles: done as f64 + time.clamp(0.0, 1.0),
                    whole_cycles: done + 1,
                };
                if first.is_none_or(|first| end.cycles < first.cycles) {
                    first = Some(end);
                }
            }
        }
        Ok(first)
    }
}

/// A draw that is none.
struct NoNumber;
