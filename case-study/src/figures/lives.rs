//! Fig. 6 and the errors behind Table 2 as charts. In: [`Lives`]. Out: charts. Never computes results.

use crate::plot::{
    Axis, BLACK, Chart, Curve, GREY, Look, Marker, ORANGE, Panel, SKY, Shape, axis, axis_around,
};
use crate::{Density, LifeNumbers, Lives, MODELS, Prediction, Protocol, UnderProtocol};

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
    Look::line(SKY, 3).marked(Marker { shape: Shape::Ring, every: 8, first: 4 }),
];
const POINTS: [Look; 3] = [
    Look::line(BLACK, 2).marked(Marker { shape: Shape::Dot, every: 3, first: MIDDLE }),
    Look::line(ORANGE, 2).marked(Marker { shape: Shape::Square, every: 3, first: MIDDLE }),
    Look::line(SKY, 2).marked(Marker { shape: Shape::Ring, every: 3, first: MIDDLE }),
];

fn title(lives: &Lives) -> String {
    format!("W: {} (Hertz), γ = {}", lives.wear, lives.gamma)
}

/// Densities of life, one panel per definition of wear.
pub(super) fn densities(all: &[Lives]) -> Chart {
    let places = all.iter().flat_map(|lives| &lives.densities).flat_map(|density| density.lives.iter());
    let time = axis_around("life [cycles]", places.copied(), 8);
    let legend = ["truth (finest own model)", MODELS[0], MODELS[1], MODELS[2], "mean of the truth"];
    let looks = [TRUTH, LOOKS[0], LOOKS[1], LOOKS[2], TRUE_MEAN];
    Chart {
        size: (860, 620),
        columns: 2,
        panels: all.iter().map(|lives| density_panel(lives, &time)).collect(),
        legend: legend.iter().map(|&text| text.to_owned()).zip(looks).collect(),
    }
}

fn density_panel(lives: &Lives, time: &Axis) -> Panel {
    let points =
        |density: &Density| density.lives.iter().copied().zip(density.values.iter().copied()).collect();
    let values = lives.densities.iter().flat_map(|density| density.values.iter().copied());
    let y = axis("density [1/cycle]", values, 5);
    let looks = std::iter::once(&TRUTH).chain(&LOOKS);
    let curve = |(density, look): (&Density, &Look)| Curve { points: points(density), look: *look };
    let mut curves: Vec<Curve> = lives.densities.iter().zip(looks).map(curve).collect();
    let mean = |truth: &LifeNumbers| vec![(truth.mean, 0.0), (truth.mean, y.range.1)];
    curves.push(Curve { points: mean(&lives.truth), look: TRUE_MEAN });
    Panel { title: title(lives), x: time.clone(), y, curves, ..Panel::default() }
}

/// Errors of the predicted mean life with their scatter over data sets, one panel per definition of wear.
pub(super) fn errors(all: &[Lives]) -> Chart {
    let with_scatter = |prediction: &Prediction| {
        let (error, scatter) = (100.0 * prediction.error, 100.0 * prediction.error_scatter);
        [error - scatter, error, error + scatter]
    };
    let panel = |lives: &Lives| {
        let mut curves = vec![zero()];
        let fitted: Vec<&UnderProtocol> =
            FITTED.iter().filter_map(|protocol| lives.under(*protocol)).collect();
        for (place, under) in fitted.iter().enumerate() {
            curves.extend(bars(place, under, &with_scatter));
        }
        let values = fitted.iter().flat_map(|under| &under.predictions).flat_map(with_scatter);
        let y = axis("error of the mean life [%]", values, 6);
        let words = FITTED.iter().zip(0..).map(|(protocol, place)| (f64::from(place) + 0.5, protocol.name()));
        let x = Axis {
            range: (0.0, FITTED.len() as f64),
            words: words.map(|(place, name)| (place, name.to_owned())).collect(),
            ..Axis::default()
        };
        Panel { title: title(lives), x, y, curves, ..Panel::default() }
    };
    Chart {
        size: (980, 620),
        columns: 2,
        panels: all.iter().map(panel).collect(),
        legend: MODELS.iter().map(|&name| name.to_owned()).zip(POINTS).collect(),
    }
}

fn zero() -> Curve {
    Curve { points: vec![(0.0, 0.0), (FITTED.len() as f64, 0.0)], look: Look::line(GREY, 2) }
}

fn bars<'a>(
    place: usize,
    under: &'a UnderProtocol,
    with_scatter: &'a dyn Fn(&Prediction) -> [f64; 3],
) -> impl Iterator<Item = Curve> + 'a {
    under.predictions.iter().zip(POINTS).enumerate().map(move |(model, (prediction, look))| {
        let x = place as f64 + 0.5 + SPREAD * (model as f64 - 1.0);
        Curve { points: with_scatter(prediction).iter().map(|error| (x, *error)).collect(), look }
    })
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
