//! How long a life gets, by what its cycles wear, and how long a cycle should be. In: wearing joints, wear. Out: the joint that fails
//! first. Never lives anything.

use linkwear_runtime::life::JointLife;

/// Cycles of a life that is neither coarse nor long to live.
const GOOD: f64 = 50.0;

/// When a joint fails if every cycle wears alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Pace {
    /// The joint that fails first.
    pub joint: String,
    /// Cycles until then.
    pub cycles: f64,
    /// Revolutions of that joint that a cycle stands for.
    pub revolutions_per_cycle: f64,
    /// Whether others wear, too.
    pub has_others: bool,
}

impl Pace {
    /// By what every joint wears in a cycle [m]; nothing if none does.
    pub(super) fn of(joints: &[JointLife], wears: impl Iterator<Item = f64>) -> Option<Self> {
        let lives = joints.iter().zip(wears).map(|(joint, wear)| (joint, joint.threshold / wear));
        let (joint, cycles) = lives.min_by(|(_, one), (_, other)| one.total_cmp(other))?;
        cycles.is_finite().then(|| Self {
            joint: joint.joint.clone(),
            cycles,
            revolutions_per_cycle: joint.revolutions_per_cycle,
            has_others: joints.len() > 1,
        })
    }

    /// What makes a life of about 50 cycles of it.
    pub fn cure(&self) -> String {
        let Self { joint, cycles, revolutions_per_cycle, has_others } = self;
        let wanted = revolutions_per_cycle * cycles / GOOD;
        let digit = 10_f64.powf(wanted.log10().floor());
        let round = (wanted / digit).round() * digit;
        let left = revolutions_per_cycle * cycles / round;
        let others = if *has_others { ", and as many times more in the other tables [wear]" } else { "" };
        format!(
            "write `revolutions_per_cycle = {round:e}` in [wear.{joint}], in place of {revolutions_per_cycle}, for some {left:.0} cycles{others}"
        )
    }
}
