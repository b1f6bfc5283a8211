//! How sure estimates are. In: a problem at its minimum. Out: errors, intervals, what is not told. Never knows how the minimum was
//! found.

use linkwear_gamma::special::{gamma_q, normal_quantile, student_bound};
use nalgebra::DMatrix;

use super::differences::{Steps, jacobian};
use super::directions::{Directions, apart_from};
use super::errors::ModelFault;
use super::problem::Problem;
use super::profile::{End, end};
use super::residuals::{LEVEL, Whiteness};
use super::result::{Combination, Direction, Estimated, Misfit, State};
use super::search::{Found, is_held};

/// Probability that intervals are for.
const WITHIN: f64 = 0.95;
/// Half an interval, as a part of the bounds, from which on the readings say no more than these.
const HALF: f64 = 0.5;
/// Parts of a direction that are worth a word.
const SHOWN: f64 = 0.02;
/// Degrees of freedom from which Student's law is the normal one up to 2e-4 of an interval.
const NORMAL: usize = 10_000;

/// All that errors come to.
pub(super) struct Inference {
    pub parameters: Vec<Estimated>,
    pub correlations: Vec<Vec<Option<f64>>>,
    pub directions: Vec<Direction>,
    pub combinations: Vec<Combination>,
    pub misfit: Option<Misfit>,
}

/// The part of an interval beyond its middle, in standard errors.
fn bound(degrees: Option<usize>) -> f64 {
    match degrees {
        Some(degrees) if degrees < NORMAL => student_bound(degrees, WITHIN),
        _ => normal_quantile(0.5 * (1.0 + WITHIN)),
    }
}

/// Where all noise is given, whether it explains the residuals.
fn misfit(problem: &Problem<'_>, found: &Found) -> Option<Misfit> {
    let is_given = problem.readings.groups().iter().all(|group| group.noise.is_some());
    let degrees = problem.readings.len().saturating_sub(problem.free.len());
    let chi_squared = found.squares();
    (is_given && degrees > 0).then(|| Misfit {
        chi_squared,
        degrees,
        p: gamma_q(0.5 * degrees as f64, 0.5 * chi_squared),
    })
}

impl Misfit {
    /// Factor of the variances of parameters where noise does not explain the residuals.
    fn factor(self) -> f64 {
        if self.p < LEVEL { (self.chi_squared / self.degrees as f64).max(1.0) } else { 1.0 }
    }

    /// Whether there is more in the residuals than the noise that was given.
    pub fn is_doubtful(self) -> bool {
        self.p < LEVEL
    }

    /// By how much the noise that was given is larger than what residuals show, if that is no chance and more than people round by.
    pub fn too_large(self) -> Option<f64> {
        /// Who knows noise roughly knows it to a factor of two.
        const ROUNDED: f64 = 2.0;
        let times = libm::sqrt(self.degrees as f64 / self.chi_squared);
        (self.p > 1.0 - LEVEL && times > ROUNDED).then_some(times)
    }
}

/// Errors at the minimum; with `profiles` intervals are those of the likelihood where it is no parabola.
pub(super) fn infer(
    problem: &Problem<'_>,
    found: &Found,
    (steps, white, profiles): (&Steps, &[Whiteness], bool),
) -> Result<Inference, ModelFault> {
    let slopes = jacobian(problem, &found.places, &found.residuals, (&steps.length, None))?;
    let gradient = slopes.tr_mul(&found.residuals);
    let count = problem.free.len();
    let is_held = |at: &usize| is_held(found.places[*at], gradient[*at]);
    let active: Vec<usize> = (0..count).filter(|at| !is_held(at)).collect();
    let own = slopes.select_columns(&active);
    let doubt: Vec<f64> = active.iter().map(|at| steps.doubt[*at]).collect();
    let known = Directions::of(&own, &doubt);
    let inverse = known.inverse();
    let misfit = misfit(problem, found);
    let factor = misfit.map_or(1.0, Misfit::factor);
    let covariance = sandwich(problem, &own, &inverse, white) * factor;
    let bound = bound(problem.degrees());
    let half = |at: usize| bound * libm::sqrt(covariance[(at, at)]);

    let mut parameters = Vec::new();
    for (at, free) in problem.free.iter().enumerate() {
        let place = found.places[at];
        let bare = |state| Estimated {
            free: free.clone(),
            value: free.value(place),
            state,
            error: None,
            interval: [None; 2],
            by_profile: false,
            doubt: steps.doubt[at],
        };
        let Some(own) = active.iter().position(|one| *one == at) else {
            parameters.push(bare(if place <= 0.0 { State::AtLower } else { State::AtUpper }));
            continue;
        };
        if half(own).is_nan() || half(own) >= HALF {
            parameters.push(bare(State::NotIdentified));
            continue;
        }
        // Correlated residuals and misfit widen: the likelihood must fall by as much more.
        let rise = bound * bound * covariance[(own, own)] / inverse[(own, own)];
        let ends = [-half(own), half(own)].map(|half| place + half);
        let ends = if profiles {
            let by_profile = |to: f64| end(problem, found, &steps.length, (at, to, rise));
            [by_profile(ends[0])?, by_profile(ends[1])?]
        } else {
            ends.map(|to| End { place: (0.0..=1.0).contains(&to).then_some(to), is_parabolic: true })
        };
        parameters.push(Estimated {
            error: Some(libm::sqrt(covariance[(own, own)]) * free.slope(place)),
            interval: ends.map(|end| end.place.map(|place| free.value(place))),
            by_profile: ends.iter().any(|end| !end.is_parabolic),
            ..bare(State::Estimated)
        });
    }
    let name = |at: usize| problem.free[active[at]].name.clone();
    let direction = |at: usize| {
        let vector = known.vectors.column(at);
        let parts = vector.iter().enumerate().filter(|(_, part)| part.abs() > SHOWN);
        let spread = libm::sqrt((vector.transpose() * &covariance * vector)[(0, 0)]);
        Direction {
            singular_value: known.singular[at],
            is_identified: known.singular[at] > 0.0 && bound * spread < HALF,
            parts: parts.map(|(one, part)| (name(one), *part)).collect(),
        }
    };
    let directions = (0..known.singular.len()).map(direction).collect();
    let unknown: Vec<usize> =
        (0..active.len()).filter(|at| parameters[active[*at]].state == State::NotIdentified).collect();
    let combinations = combinations(problem, found, (&own, &active, &unknown), (&doubt, bound, &covariance));
    let correlation = |i: usize, j: usize| {
        let place = |at: usize| active.iter().position(|one| *one == at);
        let (i, j) = (place(i)?, place(j)?);
        let value = covariance[(i, j)] / libm::sqrt(covariance[(i, i)] * covariance[(j, j)]);
        value.is_finite().then(|| value.clamp(-1.0, 1.0))
    };
    let correlations = (0..count).map(|i| (0..count).map(|j| correlation(i, j)).collect()).collect();
    Ok(Inference { parameters, correlations, directions, combinations, misfit })
}

/// Covariance of the places: noise of groups whose residuals hang together counts for more.
fn sandwich(
    problem: &Problem<'_>,
    slopes: &DMatrix<f64>,
    inverse: &DMatrix<f64>,
    white: &[Whiteness],
) -> DMatrix<f64> {
    if white.iter().all(|white| white.per_independent == 1.0) {
        return inverse.clone();
    }
    let size = slopes.ncols();
    let mut middle = DMatrix::zeros(size, size);
    for (range, white) in problem.readings.ranges().into_iter().zip(white) {
        let rows = slopes.rows(range.start, range.len());
        middle += rows.tr_mul(&rows) * white.per_independent;
    }
    inverse * middle * inverse
}

/// What is known of the parameters that are not identified: the directions among them that the readings tell.
fn combinations(
    problem: &Problem<'_>,
    found: &Found,
    (slopes, active, unknown): (&DMatrix<f64>, &[usize], &[usize]),
    (doubt, bound, covariance): (&[f64], f64, &DMatrix<f64>),
) -> Vec<Combination> {
    let frees: Vec<_> = unknown.iter().map(|at| &problem.free[active[*at]]).collect();
    let is_product = frees.iter().all(|free| free.is_logarithmic());
    // A product of powers and a sum do not mix.
    if unknown.len() < 2 || (!is_product && frees.iter().any(|free| free.is_logarithmic())) {
        return Vec::new();
    }
    let others: Vec<usize> = (0..active.len()).filter(|at| !unknown.contains(at)).collect();
    let doubt: Vec<f64> = unknown.iter().map(|at| doubt[*at]).collect();
    let known = Directions::of(&apart_from(slopes, unknown, &others), &doubt);
    let mut all = Vec::new();
    for (at, singular) in known.singular.iter().enumerate() {
        let vector = known.vectors.column(at);
        let spread = unknown.iter().enumerate().flat_map(|(i, a)| {
            unknown.iter().enumerate().map(move |(j, b)| vector[i] * vector[j] * covariance[(*a, *b)])
        });
        // The covariance of what nothing tells drowns this sum; the singular value has it alone.
        let inflation = spread.sum::<f64>().max(0.0) * singular * singular;
        let inflation = if inflation.is_finite() && inflation < 1e3 { inflation.max(1.0) } else { 1.0 };
        let half = bound * libm::sqrt(inflation) / singular;
        if half.is_nan() || half >= HALF {
            continue;
        }
        // By logarithms or values of the parameters, the largest power 1.
        let powers: Vec<f64> = vector.iter().zip(&frees).map(|(part, free)| part / free.width()).collect();
        let largest = powers.iter().fold(0.0_f64, |a, b| if b.abs() > a.abs() { *b } else { a });
        let sum = |to: f64| {
            let terms = unknown.iter().zip(&powers).zip(&frees).zip(vector.iter());
            terms
                .map(|(((at, power), free), part)| {
                    let place = found.places[active[*at]] + to * part;
                    let value = free.origin() + place * free.width();
                    power / largest * value
                })
                .sum::<f64>()
        };
        let value = |to: f64| if is_product { libm::exp(sum(to)) } else { sum(to) };
        let (a, b) = (value(-half), value(half));
        let parts = frees.iter().zip(&powers).map(|(free, power)| (free.name.clone(), power / largest));
        all.push(Combination {
            parts: parts.filter(|(_, power)| power.abs() > SHOWN).collect(),
            is_product,
            value: value(0.0),
            interval: [a.min(b), a.max(b)],
        });
    }
    all
}
