//! The mean of random lives and how it varies. In: lives along tables. Out: [`RandomSensitivity`]. Never knows turns.

use linkwear_gamma::monte_carlo::GammaDraw;
use linkwear_runtime::life::WearFlow;
use linkwear_runtime::{GammaRates, Watch};

use super::error::SensitivityError;
use super::paths::{Life, Paths};
use super::result::{Derived, RandomSensitivity};
use super::varied::Variant;

/// Shape of a cycle's increment below which the mean of derivatives is no derivative of the mean: lives that a parameter moves to another
/// cycle are rare and moved far. At 1.25 it was 2 % off over 20,000 lives, at 2 within its error.
const LEAST_SHAPE: f64 = 2.0;

/// So many lives by a seed.
pub(super) fn random(
    (trajectories, seed): (u64, u64),
    paths: &Paths,
    watch: Watch<'_>,
) -> Result<RandomSensitivity, SensitivityError> {
    for (joint, [alpha, _]) in paths.base.processes.iter().enumerate() {
        let shape = alpha.exp() * paths.base.flow.gain(joint, 0.0);
        if shape < LEAST_SHAPE {
            let joint = paths.base.settings.joints[joint].joint.clone();
            return Err(SensitivityError::SmallShape { joint, shape });
        }
    }
    watch.begin("lives");
    let rates =
        paths.base.processes.iter().map(|[alpha, beta]| GammaRates { alpha: alpha.exp(), beta: beta.exp() });
    let draw = GammaDraw::new(seed, &rates.collect::<Vec<_>>());
    let mut lives: Vec<Life> = Vec::new();
    for life in 0..trajectories {
        if life % 64 == 0 && watch.report(life as f64 / trajectories as f64).is_break() {
            return Err(SensitivityError::Interrupted);
        }
        let cycles = paths.base.settings.most_cycles;
        lives.push(paths.drawn(&draw, life).ok_or(SensitivityError::Endless { life, cycles })?);
    }
    let count = lives.len() as f64;
    let statistics = |of: &dyn Fn(&Life) -> f64| {
        let mean = lives.iter().map(of).sum::<f64>() / count;
        let square = lives.iter().map(|life| (of(life) - mean).powi(2)).sum::<f64>();
        (mean, (square / (count - 1.0).max(1.0) / count).sqrt())
    };
    let (mean, error) = statistics(&|life| life.cycles);
    let by: Vec<(f64, f64)> = (0..paths.beside.len()).map(|at| statistics(&|life| life.slopes[at])).collect();
    Ok(RandomSensitivity {
        trajectories,
        seed,
        mean: Derived { value: mean, by: by.iter().map(|(slope, _)| *slope).collect(), doubts: Vec::new() },
        error,
        errors: by.iter().map(|(_, error)| *error).collect(),
    })
}

/// ln alpha and ln beta of every wearing joint.
pub(super) fn processes(variant: &Variant, flow: &WearFlow) -> Result<Vec<[f64; 2]>, SensitivityError> {
    let contacts = variant.compiled.description().contacts.iter();
    let wearing = contacts.filter_map(|contact| Some((contact, contact.wear.as_ref()?)));
    wearing
        .enumerate()
        .map(|(at, (contact, wear))| {
            if let Some(rates) = wear.scatter {
                return Ok([rates.alpha.ln(), rates.beta.ln()]);
            }
            let missing = || SensitivityError::NoProcess { joint: contact.joint.to_string() };
            let variation = wear.cycle_variation.ok_or_else(missing)?;
            // An increment of mean m has the shape alpha m and so the coefficient of variation 1 / sqrt(alpha m).
            let alpha = -(variation * variation * flow.gain(at, 0.0)).ln();
            Ok([alpha, alpha])
        })
        .collect()
}
