//! Charts of a life: density and reliability of the random lives, clearance by cycles. In: a life, its JSON. Out: charts. Never
//! knows how lives are lived.

use linkwear_gamma::special::gamma_quantile;
use serde_json::Value;

use super::chart::{Chart, Series, Stroke};
use crate::life::LifeResult;

/// A normal deviate beyond which 2.5 % lie.
const BAND: f64 = 1.959_963_985;
/// Ends of the band of the clearance.
const ENDS: [f64; 2] = [0.05, 0.95];
const MICROMETRES: f64 = 1e6;

/// Charts of a life; `json` is what `life --format json` says of it.
pub fn charts(life: &LifeResult, json: &Value) -> Vec<Chart> {
    [density(life, json), reliability(json), clearance(life)]
        .into_iter()
        .filter(|chart| !chart.is_empty())
        .collect()
}

/// Mean and B10 as marks.
fn marks(json: &Value) -> Vec<(f64, String)> {
    let mark = |value: &Value, word: &str| value.as_f64().map(|value| (value, format!("{word} {value:.2}")));
    [mark(&json["quantiles"]["p10"], "B10"), mark(&json["mean"], "mean")].into_iter().flatten().collect()
}

fn density(life: &LifeResult, json: &Value) -> Chart {
    let mut cycles: Vec<f64> = life.lives.iter().map(|end| end.cycles).collect();
    cycles.sort_by(f64::total_cmp);
    let mut series = Vec::new();
    if let (Some(first), Some(last)) = (cycles.first(), cycles.last())
        && last > first
    {
        let count = cycles.len() as f64;
        // Rice's rule.
        let bins = (2.0 * count.cbrt()).ceil().clamp(5.0, 60.0);
        let wide = (last - first) / bins;
        let mut heights = vec![0.0; bins as usize];
        let last_bin = heights.len() - 1;
        for life in &cycles {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a bin")]
            let bin = ((life - first) / wide) as usize;
            heights[bin.min(last_bin)] += 1.0 / (count * wide);
        }
        let bars =
            heights.iter().enumerate().map(|(bin, height)| [first + (bin as f64 + 0.5) * wide, *height]);
        let name = format!("{} random lives", cycles.len());
        series.push(Series::line(name, 0, bars.collect()).drawn(Stroke::Bars));
        series.push(Series::line("smoothed", 1, smoothed(&cycles)));
    }
    Chart {
        title: "density of the life".to_owned(),
        x: "life [cycles]".to_owned(),
        y: "[1/cycle]".to_owned(),
        marks: marks(json),
        series,
        from_zero: true,
        ..Chart::default()
    }
}

/// Gauss kernels of Silverman's width.
fn smoothed(sorted: &[f64]) -> Vec<[f64; 2]> {
    let count = sorted.len() as f64;
    let mean = sorted.iter().sum::<f64>() / count;
    let std = (sorted.iter().map(|life| (life - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0)).sqrt();
    let width = 1.06 * std * count.powf(-0.2);
    let (low, high) = (mean - 4.0 * std, mean + 4.0 * std);
    let stride = sorted.len().div_ceil(5000);
    let kept: Vec<f64> = sorted.iter().copied().step_by(stride).collect();
    let at = |index: i32| low + (high - low) * f64::from(index) / 120.0;
    let kernel = |x: f64, life: f64| (-0.5 * ((x - life) / width).powi(2)).exp();
    let norm = kept.len() as f64 * width * std::f64::consts::TAU.sqrt();
    (0..=120).map(at).map(|x| [x, kept.iter().map(|life| kernel(x, *life)).sum::<f64>() / norm]).collect()
}

fn reliability(json: &Value) -> Chart {
    let points = json["reliability"].as_array().map_or(&[][..], |points| points);
    let read = |point: &Value| {
        let [x, y, error] = ["cycles", "reliability", "standard_error"].map(|key| point[key].as_f64());
        Some([x?, y?, error?])
    };
    let read: Vec<[f64; 3]> = points.iter().filter_map(read).collect();
    let end = |side: f64| move |[x, y, error]: &[f64; 3]| [*x, (y + side * BAND * error).clamp(0.0, 1.0)];
    let band = read.iter().map(end(1.0)).chain(read.iter().rev().map(end(-1.0)));
    let line = read.iter().map(|[x, y, _]| [*x, *y]).collect();
    Chart {
        title: "reliability: part of the lives that is longer".to_owned(),
        x: "life [cycles]".to_owned(),
        marks: marks(json),
        series: vec![
            Series::line("95 % band", 0, band.collect()).drawn(Stroke::Band),
            Series::line("reliability", 0, line),
        ],
        from_zero: true,
        ..Chart::default()
    }
}

/// By the mean path; its spread by the process of wear at the exposure of the mean path.
fn clearance(life: &LifeResult) -> Chart {
    let mut series = Vec::new();
    for (at, joint) in life.joints.iter().enumerate() {
        let cycles: Vec<_> = life
            .cycles
            .iter()
            .filter_map(|cycle| Some((cycle.cycle as f64, cycle.joints.get(at)?)))
            .collect();
        let (Some((_, first)), second) = (cycles.first(), cycles.get(1)) else { continue };
        // How much of the wear opens the clearance.
        let opened = second.map_or(1.0, |(_, second)| (second.clearance - first.clearance) / first.wear);
        let to = |wear: f64| MICROMETRES * (first.clearance + opened * wear);
        let line = std::iter::once([0.0, MICROMETRES * first.clearance]);
        let line = line.chain(cycles.iter().map(|(cycle, joint)| [*cycle, to(joint.wear)])).collect();
        if let Some(process) = life.process.as_ref().and_then(|processes| processes.get(at)) {
            let [alpha, beta] = process.per_micrometre();
            let mut exposure = 0.0;
            let quantiles = cycles.iter().map(|(cycle, joint)| {
                exposure += MICROMETRES * joint.mean_increment;
                let wear = |p| to(gamma_quantile(alpha * exposure, p) / beta / MICROMETRES);
                (*cycle, ENDS.map(wear))
            });
            let quantiles: Vec<(f64, [f64; 2])> =
                std::iter::once((0.0, [to(0.0); 2])).chain(quantiles).collect();
            let upper = quantiles.iter().map(|(cycle, [_, high])| [*cycle, *high]);
            let lower = quantiles.iter().rev().map(|(cycle, [low, _])| [*cycle, *low]);
            let name = format!("{}, 9 of 10 lives at the mean exposure", joint.joint);
            series.push(Series::line(name, at, upper.chain(lower).collect()).drawn(Stroke::Band));
        }
        series.push(Series::line(format!("{}, mean path", joint.joint), at, line));
    }
    Chart {
        title: "clearance over cycles".to_owned(),
        x: "cycles".to_owned(),
        y: "[um]".to_owned(),
        series,
        ..Chart::default()
    }
}
