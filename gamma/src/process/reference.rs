//! Parameters told by the exposure that readings are about, where exposure counts by an unknown power. In: logarithms of parameters, an
//! exponent. Out: the same where exposure counts in another unit. Never knows data, priors.
//!
//! Of Lambda = e^c the parameters belong to exposure 1, far from all readings: a law that is flat or normal in them says something
//! else of c for each unit that exposure is written in. At a reference that readings know it is the same in every unit.

use super::definition::Process;

/// An exposure that takes the place of exposure 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reference {
    ln: f64,
    powers: [f64; 2],
}

impl Reference {
    /// This exposure > 0; exposure 1 where it is none.
    pub fn exposure(process: &dyn Process, exposure: f64) -> Self {
        Self::at(process, libm::log(exposure))
    }

    /// The exposure of this logarithm.
    pub fn at(process: &dyn Process, ln: f64) -> Self {
        let ln = if ln.is_finite() { ln } else { 0.0 };
        Self { ln, powers: process.exposure_powers() }
    }

    /// What ln of both parameters goes up by from exposure 1 to the reference, for each unit of the exponent.
    pub fn slopes(&self) -> [f64; 2] {
        self.powers.map(|power| power * self.ln)
    }

    /// Parameters over exposure 1, taken to the reference.
    pub fn taken(&self, logs: &mut [f64], exponent: f64) {
        self.moved(logs, exponent);
    }

    /// Parameters over the reference, taken back to exposure 1.
    pub fn back(&self, logs: &mut [f64], exponent: f64) {
        self.moved(logs, -exponent);
    }

    fn moved(&self, logs: &mut [f64], by: f64) {
        for (log, slope) in logs.iter_mut().zip(self.slopes()) {
            *log += slope * by;
        }
    }

    /// An exposure in units of the reference.
    pub fn counted(&self, exposure: f64) -> f64 {
        if self.ln == 0.0 { exposure } else { exposure * libm::exp(-self.ln) }
    }
}

/// A covariance where ln of both parameters goes up by `slopes` times the third variable.
pub fn sheared(covariance: &[Vec<f64>], slopes: [f64; 2]) -> Vec<Vec<f64>> {
    let mut sheared = covariance.to_vec();
    for (at, slope) in slopes.into_iter().enumerate() {
        let third = sheared[2].clone();
        sheared[at].iter_mut().zip(third).for_each(|(entry, by)| *entry += slope * by);
        sheared.iter_mut().for_each(|row| row[at] += slope * row[2]);
    }
    sheared
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::PROCESSES;

    #[test]
    fn parameters_at_a_reference_give_the_same_law() {
        for process in PROCESSES {
            let reference = Reference::exposure(process, 40.0);
            let (logs, exponent): ([f64; 2], f64) = ([0.3, -0.2], 0.7);
            let mut taken = logs;
            reference.taken(&mut taken, exponent);
            let [plain, other] = [(logs, 9.0), (taken, reference.counted(9.0))]
                .map(|(logs, to): ([f64; 2], f64)| process.cumulative(logs, to.powf(exponent), 5.0));
            // A few roundings.
            assert!((plain - other).abs() < 1e-13, "{process:?} {plain} {other}");
            reference.back(&mut taken, exponent);
            assert!(taken.iter().zip(logs).all(|(a, b)| (a - b).abs() < 1e-15), "{process:?}");
        }
    }

    #[test]
    fn a_sheared_covariance_is_that_of_the_sheared_variables() {
        let covariance = [vec![4.0, 1.0, 0.5], vec![1.0, 3.0, -0.2], vec![0.5, -0.2, 2.0]];
        // Of a + 2 c and b - c.
        let expected =
            [vec![14.0, 1.0 - 0.5 - 0.4 - 4.0, 4.5], vec![-3.9, 3.0 + 0.4 + 2.0, -2.2], vec![4.5, -2.2, 2.0]];
        for (row, expected) in sheared(&covariance, [2.0, -1.0]).iter().zip(expected) {
            assert!(row.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{row:?}");
        }
    }
}
