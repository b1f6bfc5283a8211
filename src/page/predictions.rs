//! Charts of a prediction: reliability with its band, hazard. In: a prediction. Out: charts. Never knows what it rests on.

use linkwear_gamma::Prediction;

use super::chart::{Chart, Series, Stroke};

/// Charts of a prediction.
pub fn charts(told: &Prediction) -> Vec<Chart> {
    let course = &told.course;
    let alive = course.iter().map(|(t, band, _)| [*t, band.value]).collect();
    let up = course.iter().map(|(t, band, _)| [*t, band.lower]);
    let down = course.iter().rev().map(|(t, band, _)| [*t, band.upper]);
    let hazard = course.iter().filter(|(.., hazard)| hazard.is_finite()).map(|(t, _, hazard)| [*t, *hazard]);
    let [b10, b50, _] = &told.quantiles;
    let marks = [(b10.value, "B10"), (b50.value, "B50")];
    let x = "time from now, in the unit of the exposure".to_owned();
    vec![
        Chart {
            title: "reliability".to_owned(),
            x: x.clone(),
            y: "part without failure".to_owned(),
            series: vec![
                Series::line("what the parameters leave open, 95 %", 0, up.chain(down).collect())
                    .drawn(Stroke::Band),
                Series::line("reliability", 0, alive),
            ],
            marks: marks.map(|(at, name)| (at, format!("{name} {at:.4}"))).to_vec(),
            from_zero: true,
            ..Chart::default()
        },
        Chart {
            title: "failures per unit of time of those without".to_owned(),
            x,
            y: "[1/time]".to_owned(),
            series: vec![Series::line("hazard", 1, hazard.collect())],
            from_zero: true,
            ..Chart::default()
        },
    ]
}
