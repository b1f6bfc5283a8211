//! What the fine scale is asked, and what is taken for an answer. In: joints as worn, in a cycle. Out: what their revolutions wear, or
//! why that means nothing. Never knows where the joints came from.

use super::error::LifeError;
use super::settings::LifeSettings;
use super::source::{JointWear, WearSource};
use crate::wear::{ContactMeasure, Profile};

/// Asks the fine scale in a cycle (from 1), and refuses joints and answers that mean nothing.
pub(super) fn measure<F: WearSource>(
    settings: &LifeSettings,
    fine: &mut F,
    joints: &[JointWear],
    state: &mut F::State,
    cycle: u64,
) -> Result<Vec<ContactMeasure>, LifeError<F::Error>> {
    refuse_joints(settings, joints, cycle)?;
    let measured = fine.measure(joints, state).map_err(|error| LifeError::Fine { cycle, error })?;
    refuse_measured(settings, &measured, cycle)?;
    Ok(measured)
}

/// The same of several states of wear.
pub(super) fn measure_each<F: WearSource>(
    settings: &LifeSettings,
    fine: &mut F,
    joints: &[Vec<JointWear>],
    states: &mut [F::State],
    cycle: u64,
) -> Result<Vec<Vec<ContactMeasure>>, LifeError<F::Error>> {
    joints.iter().try_for_each(|joints| refuse_joints(settings, joints, cycle))?;
    let each = fine.measure_each(joints, states).map_err(|error| LifeError::Fine { cycle, error })?;
    each.iter().try_for_each(|measured| refuse_measured(settings, measured, cycle))?;
    Ok(each)
}

/// Refuses joints that mean nothing.
fn refuse_joints<E>(settings: &LifeSettings, joints: &[JointWear], cycle: u64) -> Result<(), LifeError<E>> {
    for (joint, worn) in settings.joints.iter().zip(joints) {
        let profiles = worn.profile.iter().chain(&worn.journal);
        let clearance = worn.clearance + profiles.map(Profile::maximum).sum::<f64>();
        let (name, journal_radius) = (joint.joint.clone(), joint.journal_radius);
        if clearance >= journal_radius {
            return Err(LifeError::ClearanceAboveJournal { joint: name, cycle, clearance, journal_radius });
        }
    }
    Ok(())
}

/// Refuses answers that mean nothing.
fn refuse_measured<E>(
    settings: &LifeSettings,
    measured: &[ContactMeasure],
    cycle: u64,
) -> Result<(), LifeError<E>> {
    let shape = |what, expected, found| {
        if expected == found { Ok(()) } else { Err(LifeError::Shape { what, expected, found }) }
    };
    shape("joints", settings.joints.len(), measured.len())?;
    for (joint, wear) in settings.joints.iter().zip(measured) {
        if let Some(bins) = joint.bins {
            let found = wear.deposit.as_ref().map_or(0, |profile| profile.depths().len());
            shape("bins of a profile", bins, found)?;
        }
        if let Some(bins) = joint.journal_bins {
            let found = wear.journal.as_ref().map_or(0, |profile| profile.depths().len());
            shape("bins of a journal", bins, found)?;
        }
        if let Some((name, value)) = wear.flaw() {
            return Err(LifeError::Measured { joint: joint.joint.clone(), cycle, name, value });
        }
        if wear.touching < settings.least_touching {
            return Err(LifeError::ContactLost {
                joint: joint.joint.clone(),
                cycle,
                touching: wear.touching,
            });
        }
    }
    Ok(())
}
