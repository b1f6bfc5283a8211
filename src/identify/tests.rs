//! The estimator on models in closed form, where the right answer is known.

use linkwear_runtime::Watch;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

use super::{
    Free, Group, Identified, IdentifyError, IdentifySettings, Model, ModelFault, Readings, State, identify,
};
use crate::study::PointError;
use linkwear_gamma::special::normal_quantile;

/// Normal noise of standard deviation 1.
pub(super) fn noise(count: usize, seed: u64) -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut uniform = || ((random.next_u64() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64;
    (0..count).map(|_| normal_quantile(uniform())).collect()
}

/// A formula of the parameters and of x.
struct Formula<F>(Vec<f64>, F);

impl<F: Fn(&[f64], f64) -> f64> Model for Formula<F> {
    fn predict(&self, values: &[f64], _: Watch<'_>) -> Result<Vec<f64>, ModelFault> {
        Ok(self.0.iter().map(|x| (self.1)(values, *x)).collect())
    }
}

fn free(name: &str, lower: f64, upper: f64) -> Free {
    Free { name: name.to_owned(), lower, upper, unit: String::new() }
}

fn xs(count: usize) -> Vec<f64> {
    (0..count).map(|at| at as f64 / (count - 1) as f64).collect()
}

fn sought(
    formula: impl Fn(&[f64], f64) -> f64,
    frees: &[Free],
    values: Vec<f64>,
    level: Option<f64>,
) -> Result<Identified, IdentifyError> {
    let at = xs(values.len());
    let group = Group {
        name: "y".to_owned(),
        unit: "1".to_owned(),
        noise: level,
        clock: "x".to_owned(),
        at: at.clone(),
        values,
    };
    let model = Formula(at, formula);
    identify(frees, &Readings::new(vec![group])?, &model, &IdentifySettings::default(), Watch::NONE)
}

fn decay(p: &[f64], x: f64) -> f64 {
    p[0] * (-p[1] * x).exp()
}

fn measured(truth: &[f64], count: usize, seed: u64, level: f64) -> Vec<f64> {
    xs(count).iter().zip(noise(count, seed)).map(|(x, e)| decay(truth, *x) + level * e).collect()
}

#[test]
fn a_straight_line_has_the_errors_of_linear_regression() {
    let y: Vec<f64> = xs(21).iter().zip(noise(21, 1)).map(|(x, e)| 1.0 + 2.0 * x + 0.1 * e).collect();
    let frees = [free("a", -5.0, 5.0), free("b", -5.0, 5.0)];
    let found = sought(|p, x| p[0] + p[1] * x, &frees, y.clone(), None).expect("a fit");
    // In closed form.
    let (x, n) = (xs(21), 21.0);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / n;
    let (mx, my) = (mean(&x), mean(&y));
    let sxx: f64 = x.iter().map(|x| (x - mx).powi(2)).sum();
    let b = x.iter().zip(&y).map(|(x, y)| (x - mx) * (y - my)).sum::<f64>() / sxx;
    let rss: f64 = x.iter().zip(&y).map(|(x, y)| (y - my - b * (x - mx)).powi(2)).sum();
    let error = (rss / (n - 2.0) / sxx).sqrt();
    let slope = &found.parameters[1];
    // The search rests a thousandth of an error from the minimum; noise is iterated to a thousandth.
    assert!((slope.value - b).abs() < 3e-3 * error, "{} {b}", slope.value);
    assert!((slope.error.expect("an error") / error - 1.0).abs() < 3e-3);
    // Student's t of 19 degrees of freedom at 97.5 %: 2.093024.
    let [lower, upper] = slope.interval.map(|end| end.expect("an end"));
    assert!(((upper - lower) / (2.0 * 2.093_024 * error) - 1.0).abs() < 3e-3);
    assert!(!slope.by_profile && found.degrees == Some(19));
}

#[test]
fn intervals_hold_the_truth_in_nineteen_of_twenty_samples() {
    let truth = [3.0, 1.5];
    let frees = [free("a", 0.1, 30.0), free("b", 0.1, 10.0)];
    let mut held = [0; 2];
    for seed in 0..60 {
        let found = sought(decay, &frees, measured(&truth, 40, seed, 0.2), None).expect("a fit");
        for (at, one) in found.parameters.iter().enumerate() {
            let [lower, upper] = one.interval.map(|end| end.expect("an end"));
            held[at] += usize::from(lower <= truth[at] && truth[at] <= upper);
        }
    }
    // 57 +- 1.7 of 60: four standard deviations below.
    assert!(held.iter().all(|held| *held >= 50), "{held:?}");
}

#[test]
fn only_a_product_is_told_where_only_a_product_enters() {
    let y = measured(&[3.0, 1.5], 40, 7, 0.02);
    let frees = [free("k", 0.01, 10.0), free("h", 0.1, 100.0), free("b", 0.1, 10.0)];
    let found = sought(|p, x| decay(&[p[0] * p[1], p[2]], x), &frees, y, None).expect("a fit");
    let states: Vec<State> = found.parameters.iter().map(|one| one.state).collect();
    assert_eq!(states, [State::NotIdentified, State::NotIdentified, State::Estimated]);
    assert!(found.set_words().len() == 1 && found.set_words()[0].starts_with("b="));
    let [product] = found.combinations.as_slice() else { panic!("{:?}", found.combinations) };
    // Powers of both by differences of runs, which are right to 1e-6.
    assert!(product.is_product && product.parts.iter().all(|(_, power)| (power - 1.0).abs() < 1e-4));
    assert!(product.interval[0] < 3.0 && 3.0 < product.interval[1], "{product:?}");
    assert!(product.interval[1] / product.interval[0] < 1.05);
    assert_eq!(found.minima.len(), 1, "a valley is one minimum: {:?}", found.minima);
}

#[test]
fn a_bound_is_no_estimate() {
    let y = measured(&[3.0, 1.5], 40, 7, 0.02);
    let found = sought(decay, &[free("a", 0.1, 30.0), free("b", 2.0, 10.0)], y, None).expect("a fit");
    let one = &found.parameters[1];
    assert_eq!((one.state, one.error, one.interval), (State::AtLower, None, [None, None]));
    assert!(found.warnings.iter().any(|warning| warning.contains("b lies at its lower bound")));
    // The misfit that the bound makes is seen.
    assert!(found.groups[0].whiteness.is_doubtful());
}

#[test]
fn where_all_lie_at_bounds_nothing_is_estimated() {
    let y = measured(&[3.0, 1.5], 40, 7, 0.02);
    for bounds in [free("b", 2.0, 10.0), free("b", 0.1, 1.2)] {
        let found = sought(|p, x| decay(&[3.0, p[0]], x), &[bounds], y.clone(), None).expect("a fit");
        let one = &found.parameters[0];
        assert!(matches!(one.state, State::AtLower | State::AtUpper) && one.error.is_none(), "{one:?}");
        assert!(
            found.warnings.iter().any(|warning| warning.contains("widen the bounds")),
            "{:?}",
            found.warnings
        );
    }
}

#[test]
fn noise_that_is_given_is_held_against_the_residuals() {
    let y = measured(&[3.0, 1.5], 40, 9, 0.2);
    let frees = [free("a", 0.1, 30.0), free("b", 0.1, 10.0)];
    let right = sought(decay, &frees, y.clone(), Some(0.2)).expect("a fit");
    let misfit = right.misfit.expect("noise is given");
    assert!(misfit.degrees == 38 && !misfit.is_doubtful() && right.degrees.is_none(), "{misfit:?}");
    let is_told = |found: &Identified| {
        found.warnings.iter().any(|warning| warning.contains("as large as residuals show"))
    };
    assert!(!is_told(&right), "{:?}", right.warnings);
    let large = sought(decay, &frees, y.clone(), Some(20.0)).expect("a fit");
    let times = large.misfit.expect("noise is given").too_large().expect("far too large");
    // Of 38 degrees of freedom the noise is known to 11 %: three times that.
    assert!((times / 100.0 - 1.0).abs() < 0.35 && is_told(&large), "{times} {:?}", large.warnings);
    let wrong = sought(decay, &frees, y, Some(0.05)).expect("a fit");
    assert!(wrong.misfit.expect("noise is given").is_doubtful());
    // Enlarged by the root of chi-squared over degrees: the errors of the noise that there is.
    let error = |found: &Identified| found.parameters[1].error.expect("an error");
    let shown = (misfit.chi_squared / 38.0).sqrt();
    assert!((error(&wrong) / error(&right) / shown - 1.0).abs() < 1e-2);
}

#[test]
fn two_minima_are_told() {
    // The square hides the sign.
    let y: Vec<f64> = xs(30).iter().zip(noise(30, 2)).map(|(x, e)| 0.25 * x + 0.01 * e).collect();
    let found = sought(|p, x| p[0] * p[0] * x, &[free("p", -1.0, 1.0)], y, None).expect("a fit");
    assert_eq!(found.minima.len(), 2, "{:?}", found.minima);
    assert!(found.warnings.iter().any(|warning| warning.contains("another minimum")), "{:?}", found.warnings);
}

#[test]
fn an_interval_that_is_no_parabola_goes_by_the_profile() {
    // a^4 is flat near 0: the likelihood of a linear parameter is far from a parabola.
    let y: Vec<f64> = xs(30).iter().zip(noise(30, 4)).map(|(x, e)| 0.0081 * x + 0.05 * e).collect();
    let found = sought(|p, x| p[0].powi(4) * x, &[free("p", 0.001, 2.0)], y, None).expect("a fit");
    let one = &found.parameters[0];
    assert!(one.by_profile || one.state == State::NotIdentified, "{one:?}");
    assert!(one.interval[0].is_none_or(|lower| lower <= 0.3));
    assert!(one.interval[1].is_none_or(|upper| upper >= 0.3), "{one:?}");
}

#[test]
fn wrong_questions_are_answered() {
    let y = measured(&[3.0, 1.5], 40, 7, 0.02);
    let one = [free("a", 0.1, 30.0)];
    let error = |frees: &[Free], y: Vec<f64>| sought(decay, frees, y, None).expect_err("wrong");
    assert_eq!(error(&[], y.clone()), IdentifyError::NothingFree);
    let twice = [free("a", 0.1, 30.0), free("a", 0.1, 3.0)];
    assert_eq!(error(&twice, y.clone()), IdentifyError::Twice("a".into()));
    let constant = error(&one, vec![1.0; 5]);
    assert!(matches!(constant, IdentifyError::Constant { count: 5, .. }), "{constant}");
    assert!(matches!(error(&one, vec![1.0, f64::NAN]), IdentifyError::Number { .. }));
    let few = [free("a", 0.1, 30.0), free("b", 0.1, 3.0)];
    assert!(matches!(error(&few, vec![1.0, 2.0]), IdentifyError::TooFew { readings: 2, parameters: 2 }));
    let idle = [free("a", 0.1, 30.0), free("b", 0.1, 3.0), free("idle", 0.1, 3.0)];
    assert_eq!(error(&idle, y.clone()), IdentifyError::NoInfluence("idle".into()));
    let nowhere = |_: &[f64], _: f64| f64::NAN;
    let error = sought(nowhere, &one, y, None).expect_err("nothing runs");
    assert!(matches!(error, IdentifyError::NothingRuns { first: PointError { .. }, .. }), "{error}");
}

#[test]
fn a_perfect_model_is_found_to_the_last_digits() {
    let found =
        sought(decay, &[free("a", 0.1, 30.0), free("b", 0.1, 10.0)], measured(&[3.0, 1.5], 40, 7, 0.0), None);
    let found = found.expect("a fit");
    // Steps end where they promise less than 1e-10 of the spread of the readings.
    assert!((found.parameters[0].value - 3.0).abs() < 1e-8, "{}", found.parameters[0].value);
    assert!((found.parameters[1].value - 1.5).abs() < 1e-8, "{}", found.parameters[1].value);
}
