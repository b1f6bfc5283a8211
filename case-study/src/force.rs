//! Fig. 4: force at the crank bearing over one turn: ideal joint, rigid and flexible coupler with clearance, and the
//! curve of an independent multibody code. In: models. Out: [`Forces`]. Never knows how it is drawn.

use linkwear_runtime::wear::ContactMeasure;
use linkwear_runtime::{IdealJoint, Run};
use serde::Serialize;

use super::error::StudyError;
use super::model::{JOINT, Model};
use super::options::STEP;
use super::workers::Workers;

/// Of the coupler in the reference [Hz].
const REFERENCE_FREQUENCIES: [f64; 3] = [138.042, 550.64, 1233.27];
/// Samples of a turn of half a second: 40 µs apart, a twelfth of the fastest vibration of the contact.
const SAMPLES: usize = 12_501;
/// Every so many samples of a smooth curve are kept: 1 ms apart, as the reference's rows.
const THINNED: usize = 25;
/// The rigid coupler's chatter needs them denser.
const THINNED_CHATTER: usize = 5;

/// A force over one turn.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ForceCurve {
    /// Time since the start of the turn [s].
    pub times: Vec<f64>,
    /// Normal force, of an ideal joint the reaction across the axis [N].
    pub forces: Vec<f64>,
    /// Mean over the turn [N].
    pub mean: f64,
    /// Largest [N].
    pub peak: f64,
    /// When the largest acts [s].
    pub peak_time: f64,
    /// Wear integral S of the turn [J]; of an ideal joint with a journal as large.
    pub wear_integral: f64,
    /// How often contact was lost.
    pub contact_losses: u64,
}

/// What a curve looks like, for a comparison by words.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Shape {
    /// Force at the start of the turn [N].
    pub first: f64,
    /// Largest force in the first tenth of the turn [N].
    pub early_peak: f64,
    /// Mean force of the second to ninth tenth [N].
    pub middle: f64,
    /// Largest force in the last fifth [N].
    pub late_peak: f64,
    /// Force at the end [N].
    pub last: f64,
}

/// Fig. 4.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Forces {
    /// Time of a turn [s].
    pub period: f64,
    /// Ideal joints, flexible coupler.
    pub ideal: ForceCurve,
    /// Clearance, rigid coupler: one turn of a chaotic motion.
    pub rigid: ForceCurve,
    /// Clearance, flexible coupler.
    pub flexible: ForceCurve,
    /// Exudyn: clearance, flexible coupler.
    pub reference: ForceCurve,
    /// Flexible curve with the reference's frequencies against the reference: root mean square of the difference
    /// over that of the reference.
    pub error: f64,
    /// The same with the frequencies of the shipped file.
    pub error_as_shipped: f64,
    /// Shape of the flexible curve.
    pub shape: Shape,
}

/// Runs the turns of Fig. 4.
pub(super) fn forces(settle: u32, workers: &Workers<'_>) -> Result<Forces, StudyError> {
    let matched = Model::WithFrequencies(REFERENCE_FREQUENCIES);
    let models = [
        (matched, THINNED),
        (Model::Rigid, THINNED_CHATTER),
        (Model::Flexible, THINNED),
        (Model::Ideal, THINNED),
    ];
    let turns = workers.each(&models, |(model, thinned)| {
        let run = model.turn(settle, STEP, SAMPLES, workers)?;
        let (forces, measure) = match model {
            Model::Ideal => reaction(&run)?,
            _ => (run.column(&format!("{JOINT}.Fn"))?, run.turns[run.turns.len() - 1][0].clone()),
        };
        Ok::<_, StudyError>((curve(&run, &forces, *thinned, &measure), forces))
    })?;
    #[expect(clippy::unreachable, reason = "`each` gives a result for every item")]
    let Ok([(matched, matched_forces), (rigid, _), (flexible, flexible_forces), (ideal, _)]) =
        <[_; 4]>::try_from(turns)
    else {
        unreachable!("a turn of every model")
    };
    let period = matched.times[matched.times.len() - 1];
    let reference = reference(period)?;
    Ok(Forces {
        period,
        error: difference(&reference, &matched_forces, period),
        error_as_shipped: difference(&reference, &flexible_forces, period),
        shape: shape(&flexible_forces),
        ideal,
        rigid,
        flexible,
        reference,
    })
}

fn curve(run: &Run, forces: &[f64], thinned: usize, measure: &ContactMeasure) -> ForceCurve {
    let start = run.times[0];
    let time = |index: usize| run.times[index] - start;
    let at = (0..forces.len()).fold(0, |best, index| if forces[index] > forces[best] { index } else { best });
    let kept = || (0..forces.len()).step_by(thinned);
    ForceCurve {
        times: kept().map(time).collect(),
        forces: kept().map(|index| forces[index]).collect(),
        mean: measure.mean_force,
        peak: forces[at],
        peak_time: time(at),
        wear_integral: measure.wear_integral,
        contact_losses: measure.losses as u64,
    }
}

/// The reaction of the ideal joint, across its axis, and what it does to a journal as large as that of the worn joint.
fn reaction(run: &Run) -> Result<(Vec<f64>, ContactMeasure), StudyError> {
    let radius = Model::Flexible.mechanism()?.description.contacts[0].journal_radius;
    let joint = IdealJoint::revolute(run, JOINT, [0.0, 0.0, 1.0], radius)?;
    let forces = run.rows.iter().map(|row| joint.normal_force_and_speed(row).0).collect();
    Ok((forces, joint.measure(run, None)))
}

/// The turn of the independent code.
fn reference(period: f64) -> Result<ForceCurve, StudyError> {
    let text = include_str!("data/exudyn_flex_10um.csv");
    let lines = text.lines().enumerate().filter(|(_, line)| !line.starts_with('#')).skip(1);
    let mut rows = Vec::new();
    for (index, line) in lines {
        let cells: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
        match cells.as_deref() {
            Ok(&[t, force, speed]) => rows.push((t, force, speed)),
            _ => return Err(StudyError::Reference { line: index + 1 }),
        }
    }
    // Its rows are up to 5 µs off the even grid; the trapezoidal rule knows that.
    let integral = |of: fn(&(f64, f64, f64)) -> f64| -> f64 {
        rows.windows(2).map(|pair| 0.5 * (pair[1].0 - pair[0].0) * (of(&pair[0]) + of(&pair[1]))).sum()
    };
    let peak = rows.iter().fold((0.0, 0.0), |best, row| if row.1 > best.1 { (row.0, row.1) } else { best });
    Ok(ForceCurve {
        mean: integral(|row| row.1) / period,
        wear_integral: integral(|row| row.1 * row.2.abs()),
        peak: peak.1,
        peak_time: peak.0,
        contact_losses: 0,
        times: rows.iter().map(|row| row.0).collect(),
        forces: rows.iter().map(|row| row.1).collect(),
    })
}

/// Root mean square of the difference at the reference's times, over that of the reference.
fn difference(reference: &ForceCurve, forces: &[f64], period: f64) -> f64 {
    let spacing = period / (forces.len() - 1) as f64;
    let pairs = reference.times.iter().zip(&reference.forces);
    let (error, size) = pairs.fold((0.0, 0.0), |(error, size), (t, expected)| {
        let miss = interpolate(forces, t / spacing) - expected;
        (error + miss * miss, size + expected * expected)
    });
    (error / size).sqrt()
}

/// Value at a place counted in samples, by the cubic through the four nearest.
fn interpolate(values: &[f64], place: f64) -> f64 {
    let last = values.len() as isize - 4;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the samples")]
    let first = (place.floor() as isize - 1).clamp(0, last) as usize;
    let x = place - first as f64;
    let weight = |i: usize| -> f64 {
        (0..4).filter(|j| *j != i).map(|j| (x - j as f64) / (i as f64 - j as f64)).product()
    };
    (0..4).map(|i| values[first + i] * weight(i)).sum()
}

fn shape(forces: &[f64]) -> Shape {
    let at = |part: f64| (part * (forces.len() - 1) as f64) as usize;
    let largest = |values: &[f64]| values.iter().fold(0.0, |a: f64, b| a.max(*b));
    let middle = &forces[at(0.1)..at(0.8)];
    Shape {
        first: forces[0],
        early_peak: largest(&forces[..at(0.1)]),
        middle: middle.iter().sum::<f64>() / middle.len() as f64,
        late_peak: largest(&forces[at(0.8)..]),
        last: forces[forces.len() - 1],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_are_interpolated_exactly_and_compared_at_the_references_times() {
        let cubic = |x: f64| 1.0 + x * (2.0 + x * (0.5 - 0.1 * x));
        let values: Vec<f64> = (0..11).map(|i| cubic(f64::from(i))).collect();
        for place in [0.0, 0.3, 5.5, 9.9, 10.0] {
            // A dozen roundings of numbers up to 100.
            assert!((interpolate(&values, place) - cubic(place)).abs() < 1e-12);
        }
        let mut reference = reference(0.5).expect("the data file");
        reference.times = vec![0.05, 0.31];
        reference.forces = reference.times.iter().map(|t| 2.0 * cubic(20.0 * t)).collect();
        assert!((difference(&reference, &values, 0.5) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn the_reference_has_the_figures_of_its_source() {
        let reference = reference(0.5).expect("the data file");
        assert_eq!(reference.times.len(), 501);
        // Its source gives a peak of 52.810 N between the rows and 2.0054 J by its integrator; the largest row has
        // 52.80498267 N, and rows 1 ms apart sum up to 2.0017 J: half a digit of each.
        assert!((reference.peak - 52.804_982_67).abs() < 1e-8, "{}", reference.peak);
        assert!((reference.wear_integral - 2.0017).abs() < 5e-5, "{}", reference.wear_integral);
    }
}
