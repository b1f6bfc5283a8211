//! Charts of a fit: probability paper, quantiles, residuals. In: a fit, its data. Out: charts. Never knows where readings are
//! from.

use linkwear_gamma::data::{Increment, Observations};
use linkwear_gamma::fit::{Fit, Goodness};
use linkwear_gamma::special::normal_quantile;

use super::chart::{Chart, Series, Stroke};

/// Charts of a fit; residuals are left out of rounded readings, whose laws hang together.
pub fn charts(fit: &Fit, goodness: &Goodness, data: &Observations) -> Vec<Chart> {
    let count = goodness.transforms.len() as f64;
    let score = |u: f64| normal_quantile(u.clamp(1e-12, 1.0 - 1e-12));
    let position = |at: usize| score((at as f64 + 0.5) / count);
    let paper = goodness.transforms.iter().enumerate().map(|(at, u)| [position(at), score(*u)]).collect();
    let quantiles = goodness.quantiles.iter().map(|(expected, seen)| [*expected, *seen]).collect();
    let residual = |(one, u): (&Increment, &f64)| [0.5 * (one.from + one.to), score(*u)];
    let residuals: Vec<[f64; 2]> = if fit.model.resolution.is_none() {
        data.increments.iter().filter(|one| one.is_plain()).zip(&goodness.in_order).map(residual).collect()
    } else {
        Vec::new()
    };
    let zero = ends(&residuals).map(|end| [end, 0.0]).collect();
    let all = [
        Chart {
            x: "normal score of the rank".to_owned(),
            ..against("probability paper: normal scores of the increments", paper)
        },
        Chart {
            x: "expected by the fitted law".to_owned(),
            ..against("quantiles of the increments of wear", quantiles)
        },
        Chart {
            title: "residuals: normal scores over exposure".to_owned(),
            x: "exposure, in the unit of the data".to_owned(),
            series: vec![
                Series::line("the fitted law's median", 1, zero).drawn(Stroke::Dashed),
                Series::line("increments", 0, residuals).drawn(Stroke::Points),
            ],
            ..Chart::default()
        },
    ];
    all.into_iter().filter(|chart| !chart.is_empty()).collect()
}

/// Points beside the line on which they lie if the law is right.
fn against(title: &str, points: Vec<[f64; 2]>) -> Chart {
    let line = ends(&points).map(|end| [end, end]).collect();
    Chart {
        title: title.to_owned(),
        series: vec![
            Series::line("as the law has it", 1, line).drawn(Stroke::Dashed),
            Series::line("increments", 0, points).drawn(Stroke::Points),
        ],
        ..Chart::default()
    }
}

/// Smallest and largest x.
fn ends(points: &[[f64; 2]]) -> impl Iterator<Item = f64> {
    let ends = points
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [x, _]| [low.min(*x), high.max(*x)]);
    ends.into_iter().filter(|end| end.is_finite())
}
