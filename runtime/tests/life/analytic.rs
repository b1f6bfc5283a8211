//! Fine scales that are formulas, and the lives that follow from them.

use std::convert::Infallible;

use linkwear_runtime::Watch;
use linkwear_runtime::life::{
    Feedback, JointLife, JointWear, LifeError, LifeOutcome, LifeSettings, LifeState, MeanIncrement, WearOf,
    WearSource, WearStep, run_life,
};
use linkwear_runtime::wear::{ContactMeasure, Limits, Observed, Profile, ScalarFeedback};

/// Clearance of the unworn joint [m].
pub const C0: f64 = 10e-6;
/// Wear at failure [m].
pub const THRESHOLD: f64 = 80e-6;
/// Depth per revolution of the unworn joint [m]: the size of the case study.
pub const DEPTH: f64 = 3.25e-13;

/// Depth per revolution goes with powers of the joint's own clearance and of the others' mean clearance.
#[derive(Clone, Debug)]
pub struct Powers {
    /// Depth at C0, own exponent, exponent of the others.
    pub joints: Vec<(f64, f64, f64)>,
    /// Measurements made.
    pub calls: usize,
    /// Largest wear asked for, of all joints [m].
    pub most_wear: f64,
}

impl Powers {
    /// One joint.
    pub fn one(exponent: f64) -> Self {
        Self::new(vec![(DEPTH, exponent, 0.0)])
    }

    /// Several joints.
    pub fn new(joints: Vec<(f64, f64, f64)>) -> Self {
        Self { joints, calls: 0, most_wear: 0.0 }
    }
}

/// A revolution of a depth [m] at a clearance [m], with loads like those of the case study.
pub fn revolution(depth: f64, clearance: f64) -> ContactMeasure {
    ContactMeasure {
        wear_integral: 2.0053636 * (1.0 + 1e-4 * (clearance / C0 - 1.0)),
        depth,
        mean_force: 32.0,
        peak_force: 55.0,
        losses: 0.0,
        touching: 1.0,
        loss: 0.0,
        deposit: None,
        journal: None,
        observed: Some(Observed {
            pressure: 2e6,
            pressure_speed: 2.5e5,
            hertz_half_width: 5e-4,
            half_angle: 0.05,
            penetration: 2e-7,
            depth_per_cycle: 0.0,
            clearance,
            journal_radius: 0.01,
        }),
    }
}

impl WearSource for Powers {
    type State = ();
    type Error = Infallible;

    fn measure(&mut self, joints: &[JointWear], (): &mut ()) -> Result<Vec<ContactMeasure>, Infallible> {
        self.calls += 1;
        self.most_wear = joints.iter().map(|joint| joint.wear).fold(self.most_wear, f64::max);
        let sum: f64 = joints.iter().map(|joint| joint.clearance).sum();
        let wear = |((depth, own, others), joint): (&(f64, f64, f64), &JointWear)| {
            let rest = (sum - joint.clearance) / (joints.len() - 1).max(1) as f64;
            let coupling = if *others == 0.0 { 1.0 } else { (rest / C0).powf(*others) };
            revolution(depth * (joint.clearance / C0).powf(*own) * coupling, joint.clearance)
        };
        Ok(self.joints.iter().zip(joints).map(wear).collect())
    }
}

/// A joint with these revolutions per cycle and this feedback.
pub fn joint(name: &str, revolutions_per_cycle: f64, gamma: f64) -> JointLife {
    JointLife {
        joint: name.to_owned(),
        journal_radius: 0.01,
        clearance: C0,
        threshold: THRESHOLD,
        revolutions_per_cycle,
        wear: WearOf::Depth,
        feedback: Feedback::Scalar(ScalarFeedback::new(gamma).unwrap()),
        bins: None,
        journal_bins: None,
        limits: Limits { hardness: 3.5e9, pressure_speed: None },
    }
}

/// A joint whose profile of 36 bins is kept.
pub fn with_profile(mut joint: JointLife, wear: WearOf, feedback: Feedback) -> JointLife {
    (joint.bins, joint.wear, joint.feedback) = (Some(36), wear, feedback);
    joint
}

/// A profile gained per revolution: `depth` [m] around angle zero over half the bearing.
pub fn arc(depth: f64) -> Profile {
    let mut profile = Profile::unworn(36).unwrap();
    profile.deposit(0.0, 1.5, depth);
    profile
}

/// Exact life in revolutions of one joint with depth DEPTH (c/C0)^p: dx/dn = g x^p with x = c/C0.
pub fn exact_revolutions(exponent: f64, gamma: f64) -> f64 {
    if gamma == 0.0 {
        return THRESHOLD / DEPTH;
    }
    let growth = gamma * DEPTH / C0;
    let end: f64 = 1.0 + gamma * THRESHOLD / C0;
    if exponent == 1.0 {
        end.ln() / growth
    } else {
        (end.powf(1.0 - exponent) - 1.0) / ((1.0 - exponent) * growth)
    }
}

/// Settings of one joint that lives `cycles` cycles exactly.
pub fn settings(exponent: f64, gamma: f64, cycles: f64, step: WearStep) -> LifeSettings {
    let joint = joint("R1", exact_revolutions(exponent, gamma) / cycles, gamma);
    LifeSettings { step, ..LifeSettings::new(vec![joint]) }
}

/// Life in cycles and the last state.
pub type Lived<F> = (f64, LifeState<<F as WearSource>::State>);

/// The deterministic life.
pub fn live<F: WearSource>(settings: &LifeSettings, fine: &mut F) -> Result<Lived<F>, LifeError<F::Error>> {
    let mut state = LifeState::new(settings, 0)?;
    match run_life(settings, fine, &MeanIncrement, &mut state, Watch::NONE)? {
        LifeOutcome::Failed(failure) => Ok((failure.cycles, state)),
        outcome => panic!("{outcome:?}"),
    }
}

/// Adaptive steps of a tolerance, as short as need be.
pub fn adaptive(tolerance: f64) -> WearStep {
    WearStep::Adaptive { tolerance, shortest: 1e-3, longest: 16, remembers: false }
}
