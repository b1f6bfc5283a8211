//! What beams must do, against closed forms and independent quadrature.

mod constants;
mod files;
mod frequencies;
mod held;

use super::*;

/// Link 2 of the case study: a solid steel rod.
pub const LENGTH: f64 = 0.42;
pub const RADIUS: f64 = 0.006;
pub const STEEL: Material = Material { youngs_modulus: 210e9, poisson_ratio: 0.3, density: 7850.0 };

pub fn segment(length: f64, section: Section) -> Segment {
    Segment { length, section, material: STEEL }
}

pub fn rod(theory: Theory, hold: Hold, bending: usize) -> BeamInput {
    BeamInput {
        segments: vec![segment(LENGTH, Section::Round { radius: RADIUS })],
        masses: vec![],
        theory,
        hold,
        modes: Counts { bending, ..Counts::default() },
        damping_ratio: 0.01,
        second_order: false,
    }
}

pub fn data(input: &BeamInput) -> ModalData {
    Beam::new(input).expect("a sound beam").modal_data(&[]).expect("no nodes")
}

/// Frequencies of the modes whose names begin with a letter [Hz].
pub fn frequencies(input: &BeamInput, letter: char) -> Vec<f64> {
    let modes = data(input).modes;
    modes.iter().filter(|mode| mode.name.starts_with(letter)).map(|mode| mode.frequency).collect()
}

/// Compares relative to the expected values.
pub fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= tolerance * expected.abs(), "{found} is not {expected}");
    }
}

/// A root of `f` between two places where its sign differs.
pub fn root(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let rising = f(high) > 0.0;
    assert_ne!(f(low) > 0.0, rising, "no change of sign");
    for _ in 0..200 {
        let middle = f64::midpoint(low, high);
        if (f(middle) > 0.0) == rising { high = middle } else { low = middle }
    }
    f64::midpoint(low, high)
}
