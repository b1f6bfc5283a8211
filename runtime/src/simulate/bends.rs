//! How far flexible bodies bend, beside what linear shapes are good for. In: free coordinates at steps. Out: a [`RunError`] where a body
//! deflects by more than its length, a [`RunWarning`] at the end. Never knows equations.

use super::extremes::At;
use super::warning::RunWarning;
use crate::description::{BendInfo, Description};
use crate::error::RunError;

/// Part of a body's length from which a deflection draws a warning. A cantilever that a load at its tip bends by a tenth of its length by
/// linear theory bends by 0.6 % less, and by 3 % less where it is 0.25 (Bisshopp and Drucker, 1945): beyond, shapes go wrong about as the
/// square. A link that turns fast against its vibrations, or is softer than anything real, shows here as well.
const DOUBTFUL: f64 = 0.1;
/// Part of it from which nothing of a run is to be believed: no place of a link of this length gets there.
const WRONG: f64 = 1.0;

/// Watches all bodies of one run.
#[derive(Clone, Debug)]
pub(super) struct Bends<'a> {
    bodies: Vec<Bend<'a>>,
}

#[derive(Clone, Debug)]
struct Bend<'a> {
    info: &'a BendInfo,
    /// Of every mode, the largest displacement of a place per unit [m].
    sizes: Vec<f64>,
    /// Largest deflection so far that is doubtful [m].
    most: At,
}

impl<'a> Bends<'a> {
    pub(super) fn new(description: &'a Description) -> Self {
        let bend = |info: &'a BendInfo| {
            let places = info.shapes.as_chunks::<3>().0.iter().enumerate();
            let mut sizes = vec![0.0_f64; info.modes];
            for (at, shape) in places {
                let size = &mut sizes[at % info.modes];
                *size = size.max(length(*shape));
            }
            let most = At { value: DOUBTFUL * info.length, t: f64::NAN };
            Bend { info, sizes, most }
        };
        let bends = description.bends.iter().filter(|info| info.length > 0.0 && info.modes > 0);
        Self { bodies: bends.map(bend).collect() }
    }

    /// Looks at the end of a step.
    ///
    /// # Errors
    /// [`RunError::BentTooFar`].
    pub(super) fn note(&mut self, t: f64, q: &[f64]) -> Result<(), RunError> {
        for Bend { info, sizes, most } in &mut self.bodies {
            let modes = &q[info.first..][..info.modes];
            // No place moves by more than this: mostly nothing is left to do.
            let bound: f64 = modes.iter().zip(&*sizes).map(|(mode, size)| mode.abs() * size).sum();
            if bound <= most.value {
                continue;
            }
            let deflection = deflection(info, modes);
            if deflection > WRONG * info.length {
                let (body, length) = (info.body.to_string(), info.length);
                return Err(RunError::BentTooFar { t, body, deflection, length });
            }
            if deflection > most.value {
                *most = At { value: deflection, t };
            }
        }
        Ok(())
    }

    /// Bodies that bent doubtfully far.
    pub(super) fn warnings(&self) -> impl Iterator<Item = RunWarning> {
        self.bodies.iter().filter(|bend| !bend.most.t.is_nan()).map(|Bend { info, most, .. }| {
            let (body, length) = (info.body.to_string(), info.length);
            RunWarning::BentFar { body, t: most.t, deflection: most.value, length }
        })
    }
}

/// Largest displacement of a place [m].
fn deflection(info: &BendInfo, modes: &[f64]) -> f64 {
    let shapes = info.shapes.as_chunks::<3>().0;
    let places = shapes.chunks_exact(info.modes).map(|place| {
        let sum = |axis: usize| place.iter().zip(modes).map(|(shape, mode)| shape[axis] * mode).sum();
        length(std::array::from_fn(sum))
    });
    places.fold(0.0, f64::max)
}

fn length([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_that_moves_most_tells_how_far_a_body_bends() {
        // Two places, two modes: along y both, along z the second alone.
        let shapes = vec![0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0];
        let info = BendInfo { body: "b".into(), length: 2.0, first: 1, modes: 2, shapes: shapes.into() };
        let mut bends = Bends { bodies: Vec::new() };
        let sizes = vec![2.0, 3.0];
        bends.bodies.push(Bend { info: &info, sizes, most: At { value: 0.2, t: f64::NAN } });
        assert_eq!(bends.note(0.1, &[9.0, 0.1, 0.0]), Ok(()));
        assert_eq!(bends.warnings().count(), 0);
        assert_eq!(bends.note(0.2, &[9.0, 0.2, 0.1]), Ok(()));
        assert_eq!(bends.note(0.3, &[9.0, -0.15, 0.0]), Ok(()));
        let told = bends.warnings().next();
        assert_eq!(
            told,
            Some(RunWarning::BentFar { body: "b".into(), t: 0.2, deflection: 0.5, length: 2.0 })
        );
        let wrong = bends.note(0.4, &[9.0, -1.1, 0.0]);
        assert!(matches!(wrong, Err(RunError::BentTooFar { t: 0.4, .. })), "{wrong:?}");
    }
}
