//! Laws of contact as one function of C: the runtime's own, written down operation by operation. In: joints with clearance. Out: text,
//! and what it calls.

use std::collections::BTreeSet;
use std::fmt::Write;

use linkwear_runtime::CONTACT_MOTION;
use linkwear_runtime::clearance_joint::Clearance;
use linkwear_runtime::contact::{ImpactMemory, Support};

use super::recorder::{Function, Number, Recorder};

/// Numbers per joint that laws want besides its motion: wear on top of its clearance, whether it touches, closing speed.
pub const MEMORY: usize = 3;
/// Numbers per joint that they answer.
pub const ANSWER: usize = 14;

/// The statements of the function: `motions` and `contacts` to `answers`.
pub fn laws(joints: &[Clearance]) -> (String, BTreeSet<Function>) {
    let recorder = Recorder::default();
    let motions = CONTACT_MOTION * joints.len();
    let answers: Vec<Number<'_>> = joints
        .iter()
        .enumerate()
        .flat_map(|(index, joint)| {
            let motion: [Number<'_>; CONTACT_MOTION] =
                std::array::from_fn(|i| recorder.input(CONTACT_MOTION * index + i));
            let [worn, touching, closing_speed] =
                std::array::from_fn(|i| recorder.input(motions + MEMORY * index + i));
            answer(joint, &motion, worn, &ImpactMemory { touching, closing_speed })
        })
        .collect();
    let outputs: Vec<usize> = answers.into_iter().map(|answer| recorder.id(answer)).collect();
    let recording = recorder.finish();
    let input = |index: usize| match index.checked_sub(motions) {
        None => format!("motions[{index}]"),
        Some(index) => format!("contacts[{index}]"),
    };
    let (mut text, results) = recording.statements(&outputs, input);
    for (index, result) in results.iter().enumerate() {
        let _ = writeln!(text, "    answers[{index}] = {result};");
    }
    (text, recording.calls(&outputs))
}

fn answer<'r>(
    joint: &Clearance,
    motion: &[Number<'r>; CONTACT_MOTION],
    worn: Number<'r>,
    memory: &ImpactMemory<Number<'r>>,
) -> [Number<'r>; ANSWER] {
    let clearance = motion[CONTACT_MOTION - 1] + worn;
    let round = |offset| Support::round(offset, clearance);
    let response = joint.respond(motion, round, (clearance, joint.stiffness(clearance)), memory);
    let [fx, fy, fz, mx, my, mz] = response.wrench;
    [
        fx,
        fy,
        fz,
        mx,
        my,
        mz,
        response.wear_power,
        response.depth_rate,
        response.normal_force,
        response.loss,
        response.penetration,
        response.penetration_rate,
        response.sliding_speed,
        response.elastic_energy,
    ]
}
