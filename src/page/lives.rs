//! Charts of a life: density and reliability of the random lives, wear and clearance by cycles. In: what `life --format json` says of
//! it. Out: charts. Never knows how lives are lived.

use serde_json::Value;

use super::chart::{Chart, Series, Stroke};

/// A normal deviate beyond which 2.5 % lie.
const BAND: f64 = 1.959_963_985;
const MICROMETRES: f64 = 1e6;

/// Charts of a life.
pub fn charts(json: &Value) -> Vec<Chart> {
    [density(json), by_cycle(json), reliability(json), wear(json), clearance(json), worn(json)]
        .into_iter()
        .filter(|chart| !chart.is_empty())
        .collect()
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], |list| list)
}

/// Numbers under these keys; nothing if one is missing.
fn numbers<const N: usize>(value: &Value, keys: [&str; N]) -> Option<[f64; N]> {
    let found = keys.map(|key| value[key].as_f64());
    found.iter().all(Option::is_some).then(|| found.map(Option::unwrap_or_default))
}

/// Mean and B10 as marks.
fn marks(json: &Value) -> Vec<(f64, String)> {
    let mark = |value: &Value, word: &str| value.as_f64().map(|value| (value, format!("{word} {value:.2}")));
    [mark(&json["quantiles"]["p10"], "B10"), mark(&json["mean"], "mean")].into_iter().flatten().collect()
}

/// By the differences of the reliability.
fn density(json: &Value) -> Chart {
    let longer: Vec<[f64; 2]> =
        list(&json["reliability"]).iter().filter_map(|at| numbers(at, ["cycles", "reliability"])).collect();
    let count = json["trajectories"].as_f64().unwrap_or_default();
    let parts = longer.len().saturating_sub(1);
    let mut series = Vec::new();
    if parts > 0 {
        // Rice's rule, as far as the points of the reliability make bins.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most so many")]
        let bins = ((2.0 * count.cbrt()).ceil().max(5.0) as usize).min(parts);
        let edges: Vec<[f64; 2]> = (0..=bins).map(|bin| longer[bin * parts / bins]).collect();
        let bars = edges.windows(2).map(|pair| {
            let [[from, before], [to, after]] = [pair[0], pair[1]];
            [0.5 * (from + to), (before - after) / (to - from)]
        });
        let name = format!("{count} random lives");
        series.push(Series::line(name, 0, bars.collect()).drawn(Stroke::Bars));
        series.push(Series::line("smoothed", 1, smoothed(&longer, count, &json["std"])));
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

/// Gauss kernels of Silverman's width, no narrower than the points of the reliability are apart.
fn smoothed(longer: &[[f64; 2]], count: f64, std: &Value) -> Vec<[f64; 2]> {
    let std = std.as_f64().unwrap_or_default();
    let (Some([low, _]), Some([high, _])) = (longer.first(), longer.last()) else { return Vec::new() };
    let apart = (high - low) / (longer.len() - 1) as f64;
    let width = (1.06 * std * count.powf(-0.2)).max(apart);
    let at = |index: i32| low - width + (high - low + 2.0 * width) * f64::from(index) / 120.0;
    let kernel = |x: f64, life: f64| (-0.5 * ((x - life) / width).powi(2)).exp();
    let norm = width * std::f64::consts::TAU.sqrt();
    let density = |x: f64| {
        let part = |pair: &[[f64; 2]]| (pair[0][1] - pair[1][1]) * kernel(x, 0.5 * (pair[0][0] + pair[1][0]));
        longer.windows(2).map(part).sum::<f64>() / norm
    };
    (0..=120).map(at).map(|x| [x, density(x)]).collect()
}

/// The probability that a life ends in a cycle.
fn by_cycle(json: &Value) -> Chart {
    let ended: Vec<[f64; 3]> =
        list(&json["histogram"]).iter().filter_map(|at| numbers(at, ["from", "to", "part"])).collect();
    let wide = ended.first().map_or(1.0, |[from, to, _]| to - from);
    let steps = ended.iter().flat_map(|[from, to, part]| [[*from, *part], [*to, *part]]);
    let (first, last) =
        (ended.first().map(|[from, ..]| [*from, 0.0]), ended.last().map(|[_, to, _]| [*to, 0.0]));
    let steps: Vec<[f64; 2]> = first.into_iter().chain(steps).chain(last).collect();
    let area = Series::line("", 0, steps.clone()).drawn(Stroke::Band);
    let of = if wide == 1.0 { "each cycle".to_owned() } else { format!("groups of {wide} cycles") };
    Chart {
        title: "probability that the life ends".to_owned(),
        x: "cycles".to_owned(),
        series: vec![area, Series::line(format!("in {of}"), 0, steps)],
        from_zero: true,
        ..Chart::default()
    }
}

fn reliability(json: &Value) -> Chart {
    let keys = ["cycles", "reliability", "standard_error"];
    let read: Vec<[f64; 3]> =
        list(&json["reliability"]).iter().filter_map(|point| numbers(point, keys)).collect();
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

/// Names of the joints that wear.
fn joints(json: &Value) -> Vec<&str> {
    let first = list(&json["cycles"]).first().map_or(&[][..], |cycle| list(&cycle["joints"]));
    first.iter().filter_map(|joint| joint["joint"].as_str()).collect()
}

/// A quantity of a joint along the mean path, at the end of each cycle.
fn mean_path(json: &Value, at: usize, key: &str) -> Vec<[f64; 2]> {
    let value = |cycle: &Value| Some([cycle["cycle"].as_f64()?, cycle["joints"][at][key].as_f64()?]);
    list(&json["cycles"]).iter().filter_map(value).collect()
}

/// Between 10 and 90 % of the lives, and half of them.
fn spread(json: &Value, (at, name): (usize, &str), (key, new): (&str, f64)) -> Vec<Series> {
    let quantiles = |cycle: &Value| {
        let [p10, p50, p90] = numbers(&cycle["joints"][at][key], ["p10", "p50", "p90"])?;
        Some([cycle["cycle"].as_f64()?, p10, p50, p90])
    };
    let start = [0.0, new, new, new];
    let read: Vec<[f64; 4]> = list(&json["wear_spread"]["cycles"]).iter().filter_map(quantiles).collect();
    if read.is_empty() {
        return Vec::new();
    }
    let read: Vec<[f64; 4]> = std::iter::once(start).chain(read).collect();
    let of = |which: usize| move |row: &[f64; 4]| [row[0], MICROMETRES * row[which]];
    let band = read.iter().map(of(3)).chain(read.iter().rev().map(of(1)));
    let lives = json["wear_spread"]["lives"].as_f64().unwrap_or_default();
    vec![
        Series::line(format!("{name}, 80 % of {lives} lives"), at, band.collect()).drawn(Stroke::Band),
        Series::line("their median", at, read.iter().map(of(2)).collect()).drawn(Stroke::Dashed),
    ]
}

/// Wear by the lives as they were lived, and by the mean path, up to the thresholds.
fn wear(json: &Value) -> Chart {
    let mut series = Vec::new();
    for (at, name) in joints(json).into_iter().enumerate() {
        series.extend(spread(json, (at, name), ("wear_m", 0.0)));
        let line = std::iter::once([0.0, 0.0]).chain(mean_path(json, at, "wear_m"));
        let line = line.map(|[cycle, wear]| [cycle, MICROMETRES * wear]);
        series.push(Series::line(format!("{name}, mean path"), at, line.collect()));
    }
    let end = series.iter().flat_map(|line| &line.points).map(|point| point[0]).fold(0.0, f64::max);
    for (at, name) in joints(json).into_iter().enumerate() {
        if let Some(threshold) = json["thresholds_m"][name].as_f64() {
            let line = [0.0, end].map(|cycle| [cycle, MICROMETRES * threshold]);
            series
                .push(Series::line(format!("{name} has failed"), at + 4, line.into()).drawn(Stroke::Dashed));
        }
    }
    Chart {
        title: "wear over cycles".to_owned(),
        x: "cycles".to_owned(),
        y: "[um]".to_owned(),
        series,
        ..Chart::default()
    }
}

/// Bushes and journals by angle, where journals wear.
fn worn(json: &Value) -> Chart {
    let mut series = Vec::new();
    for (at, joint) in list(&json["worn"]).iter().enumerate() {
        let name = joint["joint"].as_str().unwrap_or_default();
        for (side, (key, what)) in [("bush_m", "bush"), ("journal_m", "journal")].into_iter().enumerate() {
            let depths = list(&joint["angle_rad"]).iter().zip(list(&joint[key]));
            let place = |(angle, depth): (&Value, &Value)| {
                Some([angle.as_f64()?.to_degrees(), MICROMETRES * depth.as_f64()?])
            };
            let line: Vec<[f64; 2]> = depths.filter_map(place).collect();
            if !line.is_empty() {
                series.push(Series::line(format!("{what} of {name}"), 2 * at + side, line));
            }
        }
    }
    Chart {
        title: "worn depth by angle, each in its own frame".to_owned(),
        x: "angle [deg]".to_owned(),
        y: "[um]".to_owned(),
        series,
        from_zero: true,
        ..Chart::default()
    }
}

/// The clearance that wear has opened; nothing where it opens none as a whole.
fn clearance(json: &Value) -> Chart {
    let mut series = Vec::new();
    for (at, name) in joints(json).into_iter().enumerate() {
        // A cycle tells the clearance at its begin, and the wear at its end.
        let begins = mean_path(json, at, "clearance_m");
        let (Some([_, new]), Some([_, last])) = (begins.first(), begins.last()) else { continue };
        if last <= new {
            continue;
        }
        series.extend(spread(json, (at, name), ("clearance_m", *new)));
        let line = begins.iter().map(|[cycle, clearance]| [cycle - 1.0, MICROMETRES * clearance]);
        series.push(Series::line(format!("{name}, mean path"), at, line.collect()));
    }
    Chart {
        title: "clearance over cycles".to_owned(),
        x: "cycles".to_owned(),
        y: "[um]".to_owned(),
        series,
        ..Chart::default()
    }
}
