//! How many revolutions a cycle must stand for, so that the deterministic life has a given number of cycles.
//! In: settings, a fine scale (a table: it is asked many thousand times), the life wanted. Out: the factor.
//! Never knows draws.
//!
//! With continuous feedback the life in revolutions does not depend on how they are grouped, and one division would
//! do. With feedback once per cycle it does: the life is found by a secant between two that bracket it.

use thiserror::Error;

use super::cycle::{LifeOutcome, run_life};
use super::error::LifeError;
use super::increment::MeanIncrement;
use super::joint::JointLife;
use super::path::{Walker, rates};
use super::settings::{LifeSettings, WearStep};
use super::source::WearSource;
use super::state::LifeState;
use super::worn::WearState;
use crate::watch::Watch;

/// Lives tried at most: bisection alone halves any bracket to rounding in fewer.
const MOST_LIVES: usize = 100;

/// Cycles of the right length.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Calibration {
    /// What the revolutions per cycle of every joint were multiplied by.
    pub factor: f64,
    /// Revolutions per cycle, per joint.
    pub revolutions_per_cycle: Vec<f64>,
    /// Deterministic life with them [cycles].
    pub cycles: f64,
}

/// Why no length of cycle was found.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CalibrationError<E> {
    /// A life with fewer than two cycles has no meaning.
    #[error("a life of {cycles} cycles cannot be calibrated; it must be 2 or more and finite")]
    Cycles {
        /// The life asked for.
        cycles: f64,
    },
    /// The life jumps over the one asked for.
    #[error("the life jumps over {cycles} cycles and comes no nearer than {reached}; smooth the fine scale")]
    Jump {
        /// The life asked for.
        cycles: f64,
        /// The nearest found.
        reached: f64,
    },
    /// A life could not be computed.
    #[error(transparent)]
    Life(#[from] LifeError<E>),
}

/// Finds the revolutions per cycle with which the deterministic life has `cycles` cycles to `tolerance` cycles. The
/// ratio of joints that have different ones is kept. Adaptive wear steps are taken finer than the settings say, so
/// that the result is that of the fine scale and not of its steps.
///
/// # Errors
/// If the life wanted makes no sense, jumps, or cannot be computed.
pub fn calibrate<F: WearSource>(
    settings: &LifeSettings,
    fine: &mut F,
    cycles: f64,
    tolerance: f64,
) -> Result<Calibration, CalibrationError<F::Error>> {
    if !(cycles >= 2.0 && cycles.is_finite()) {
        return Err(CalibrationError::Cycles { cycles });
    }
    let mut settings = LifeSettings { keep_cycles: false, ..settings.clone() };
    if let WearStep::Adaptive { .. } = settings.step {
        settings.step = WearStep::FINE;
    }
    let mut factor = first_guess(&settings, fine, cycles)?;
    // Factors with too long and too short a life, and the logarithms of life over life wanted.
    let (mut long, mut short) = (None::<(f64, f64)>, None::<(f64, f64)>);
    let mut nearest = f64::NAN;
    for _ in 0..MOST_LIVES {
        let life = life(&settings, fine, factor, cycles)?;
        if life.is_none_or(|life| (life - cycles).abs() < (nearest - cycles).abs() || nearest.is_nan()) {
            nearest = life.unwrap_or(nearest);
        }
        if let Some(life) = life.filter(|life| (life - cycles).abs() <= tolerance) {
            let scaled = settings.with_longer_cycles(factor);
            let revolutions = scaled.joints.iter().map(|joint| joint.revolutions_per_cycle).collect();
            return Ok(Calibration { factor, revolutions_per_cycle: revolutions, cycles: life });
        }
        // A life that ends in its first cycle is short by an unknown amount.
        let miss = life.map_or(-libm::log(cycles), |life| libm::log(life / cycles));
        if miss > 0.0 {
            long = Some((factor, miss))
        } else {
            short = Some((factor, miss))
        }
        factor = match (long, short) {
            (Some((a, miss_a)), Some((b, miss_b))) => {
                let (a, b) = (libm::log(a), libm::log(b));
                let part = miss_a / (miss_a - miss_b);
                // Keeps away from the ends, so that a bracket that is curved shrinks too.
                libm::exp(a + (b - a) * part.clamp(0.02, 0.98))
            }
            // Life times length of a cycle is nearly constant.
            _ => factor * libm::exp(miss),
        };
    }
    Err(CalibrationError::Jump { cycles, reached: nearest })
}

/// As if nothing changed along the life.
fn first_guess<F: WearSource>(
    settings: &LifeSettings,
    fine: &mut F,
    cycles: f64,
) -> Result<f64, CalibrationError<F::Error>> {
    let state = LifeState::<F::State>::new(settings, 0).map_err(LifeError::from)?;
    let mut walker = Walker {
        settings,
        fine,
        base: &state.joints,
        state: F::State::default(),
        cycle: 0,
        measurements: 0,
        earlier: Vec::new(),
    };
    let measured = walker.measure(&vec![0.0; settings.width()], &mut F::State::default())?;
    let rates = rates(settings, &measured);
    let pace = |((joint, rate), base): ((&JointLife, &[f64]), &WearState)| {
        joint.after(base, rate, 1.0).wear / joint.threshold
    };
    let fastest = settings.parts(&rates).zip(&state.joints).map(pace).fold(0.0, f64::max);
    if fastest > 0.0 { Ok(1.0 / (fastest * cycles)) } else { Err(LifeError::NoWear { cycle: 1 }.into()) }
}

/// Life with cycles longer by a factor; nothing if it ends within its first cycle.
fn life<F: WearSource>(
    settings: &LifeSettings,
    fine: &mut F,
    factor: f64,
    cycles: f64,
) -> Result<Option<f64>, CalibrationError<F::Error>> {
    let mut settings = settings.clone().with_longer_cycles(factor);
    // Longer lives than this are only known to be too long; the search goes on from there.
    settings.most_cycles = (10.0 * cycles).ceil() as u64;
    let mut state = LifeState::new(&settings, 0).map_err(LifeError::from)?;
    match run_life(&settings, fine, &MeanIncrement, &mut state, Watch::NONE) {
        Ok(LifeOutcome::Failed(failure)) => Ok(Some(failure.cycles)),
        Ok(LifeOutcome::Cancelled | LifeOutcome::CycleLimit) => Ok(Some(settings.most_cycles as f64)),
        Err(LifeError::ThresholdBelowFirstIncrement { .. }) => Ok(None),
        Err(stop) => Err(stop.into()),
    }
}
