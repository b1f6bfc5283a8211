//! Fig. 6 and the errors behind Table 2 as charts. In: [`Lives`]. Out: charts. Never computes results.

use crate::plot::{Axis, BLACK, Chart, Curve, GREY, Look, ORANGE, Panel, SKY, Shape, axis, axis_around};
use crate::{Lives, MODELS, Protocol};

/// Protocols with a fit: without one, errors are ten times as large and hide all others.
const FITTED: [Protocol; 3] = [Protocol::All, Protocol::First20, Protocol::First10];
/// Room on either side of what is drawn of a protocol, which is 1 wide.
const SPREAD: f64 = 0.22;

/// The middle of three points is marked.
const MIDDLE: usize = 1;
const TRUTH: Look = Look::line(GREY, 12);
const TRUE_MEAN: Look = Look::line(GREY, 2).dashed(&[3, 4]);
/// In the order of [`MODELS`].
const LOOKS: [Look; 3] = [
    Look::line(BLACK, 3),
    Look::line(ORANGE, 3).dashed(&[12, 4]),
    Look::line(SKY, 3).marked(Shape::Ring, 8, 4),
];
const POINTS: [Look; 3] = [
    Look::line(BLACK, 2).marked(Shape::Dot, 3, MIDDLE),
    Look::line(ORANGE, 2).marked(Shape::Square, 3, MIDDLE),
    Look::line(SKY, 2).marked(Shape::Ring, 3, MIDDLE),
];

fn title(lives: &Lives) -> String {
    format!("W: {} (Hertz), γ = {}", lives.wear, lives.gamma)
}

/// Densities of life, one panel per definition of wear.
pub(super) fn densities(all: &[Lives]) -> Chart {
    let places = all.iter().flat_map(|lives| &lives.densities).flat_map(|density| density.lives.iter());
    let time = axis_around("life [cycles]", places.copied(), 8);
    let mut legend = vec![("truth (finest own model)", TRUTH)];
    legend.extend(MODELS.into_iter().zip(LOOKS));
    legend.push(("mean of the truth", TRUE_MEAN));
    Chart {
        size: (860, 620),
        columns: 2,
        panels: all.iter().map(|lives| density_panel(lives, &time)).collect(),
        legend,
    }
}

fn density_panel(lives: &Lives, time: &Axis) -> Panel {
    let values = lives.densities.iter().flat_map(|density| density.values.iter().copied());
    let y = axis("density [1/cycle]", values, 5);
    let drawn = lives.densities.iter().zip([TRUTH].into_iter().chain(LOOKS));
    let mut curves: Vec<Curve> =
        drawn.map(|(density, look)| Curve::through(&density.lives, &density.values, look)).collect();
    curves.push(Curve::through(&[lives.truth.mean; 2], &[0.0, y.range.1], TRUE_MEAN));
    Panel { title: title(lives), x: time.clone(), y, curves, ..Panel::default() }
}

/// Errors of the predicted mean life with their scatter over data sets, one panel per definition of wear.
pub(super) fn errors(all: &[Lives]) -> Chart {
    Chart {
        size: (980, 620),
        columns: 2,
        panels: all.iter().map(error_panel).collect(),
        legend: MODELS.into_iter().zip(POINTS).collect(),
    }
}

fn error_panel(lives: &Lives) -> Panel {
    let width = FITTED.len() as f64;
    let mut curves = vec![Curve::through(&[0.0, width], &[0.0; 2], Look::line(GREY, 2))];
    let mut words = Vec::new();
    for (protocol, middle) in FITTED.iter().zip((0..).map(|place| f64::from(place) + 0.5)) {
        for ((prediction, look), side) in
            lives.under(*protocol).iter().zip(POINTS).zip([-SPREAD, 0.0, SPREAD])
        {
            let (error, scatter) = (100.0 * prediction.error, 100.0 * prediction.error_scatter);
            curves.push(Curve::through(
                &[middle + side; 3],
                &[error - scatter, error, error + scatter],
                look,
            ));
        }
        words.push((middle, protocol.name().to_owned()));
    }
    let values = curves.iter().flat_map(|curve| curve.points.iter().map(|point| point.1));
    let y = axis("error of the mean life [%]", values, 6);
    let x = Axis { range: (0.0, width), words, ..Axis::default() };
    Panel { title: title(lives), x, y, curves, ..Panel::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_are_told_apart_in_grey() {
        for looks in [LOOKS, POINTS] {
            for (index, look) in looks.iter().enumerate() {
                assert!(looks[..index].iter().all(|other| look.differs_in_grey(other)));
            }
        }
        assert!(LOOKS.iter().all(|look| look.differs_in_grey(&TRUTH)));
    }
}
