//! The picture: the linkage in space on the left, what its drive feels on the right.
//! In: columns of one turn. Out: SVG text. Never knows how they were computed.

use std::fmt::Write as _;

/// One turn, first row equal to the last.
pub struct Curves {
    /// Crank tip A in the ground frame [m].
    pub crank_tip: Vec<[f64; 3]>,
    /// Rocker tip B [m].
    pub rocker_tip: Vec<[f64; 3]>,
    /// Drive torque [N m].
    pub torque: Vec<f64>,
    /// Force at the crank's bearing R1 [N].
    pub force: Vec<f64>,
}

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 400.0;
/// Bearing of the rocker in the ground frame [m], as in mechanisms/rssr_rigid.toml.
const ROCKER_BEARING: [f64; 3] = [0.35, 0.05, -0.30];
/// Ghost positions over the turn.
const GHOSTS: usize = 24;
/// The position drawn in full, as a part of the turn.
const SHOWN: f64 = 0.13;

const CRANK: &str = "#d9480f";
const COUPLER: &str = "#1864ab";
const ROCKER: &str = "#2b8a3e";
const INK: &str = "#343a40";

/// The whole picture.
pub fn svg(curves: &Curves) -> String {
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" \
         height=\"{HEIGHT}\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"13\" fill=\"{INK}\">\n\
         <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" rx=\"8\" fill=\"#ffffff\"/>\n"
    );
    linkage(&mut out, curves);
    let frame = Frame { left: 595.0, top: 46.0, width: 275.0, height: 120.0 };
    chart(&mut out, &frame, &curves.torque, "drive torque [N m]", CRANK);
    let frame = Frame { left: 595.0, top: 226.0, width: 275.0, height: 120.0 };
    chart(&mut out, &frame, &curves.force, "force at R1 [N]", COUPLER);
    text(&mut out, 732.0, 384.0, "middle", INK, "crank angle [deg], second turn at 2 Hz");
    out.push_str("</svg>\n");
    out
}

/// Looks from the front right and above: x to the right, y into the page, z up.
fn project(point: [f64; 3]) -> (f64, f64) {
    let [x, y, z] = point;
    (125.0 + 740.0 * (0.94 * x + 0.42 * y), 140.0 - 740.0 * (0.94 * z + 0.38 * y - 0.16 * x))
}

fn linkage(out: &mut String, curves: &Curves) {
    let rows = curves.crank_tip.len() - 1;
    for ghost in 0..GHOSTS {
        let row = ghost * rows / GHOSTS;
        let (a, b) = (curves.crank_tip[row], curves.rocker_tip[row]);
        line(out, a, b, COUPLER, "1", "0.22");
        line(out, ROCKER_BEARING, b, ROCKER, "1", "0.22");
    }
    path(out, &curves.crank_tip, CRANK);
    path(out, &curves.rocker_tip, ROCKER);
    axes(out);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a row of the table")]
    let shown = (SHOWN * rows as f64) as usize;
    let (a, b) = (curves.crank_tip[shown], curves.rocker_tip[shown]);
    line(out, [0.0; 3], a, CRANK, "6", "1");
    line(out, ROCKER_BEARING, b, ROCKER, "6", "1");
    line(out, a, b, COUPLER, "6", "1");
    for (point, radius) in [([0.0; 3], 7.0), (ROCKER_BEARING, 7.0), (a, 5.0), (b, 5.0)] {
        let (x, y) = project(point);
        let _ = writeln!(
            out,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"#ffffff\" stroke=\"{INK}\" stroke-width=\"2\"/>"
        );
    }
    let between = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|i| 0.5 * (p[i] + q[i]));
    label(out, [0.0; 3], (-26.0, 20.0), INK, "R1");
    label(out, a, (4.0, -12.0), INK, "S2");
    label(out, b, (12.0, -8.0), INK, "S3");
    label(out, ROCKER_BEARING, (14.0, 16.0), INK, "R4");
    label(out, between([0.0; 3], a), (-14.0, 26.0), CRANK, "crank");
    label(out, between(a, b), (-10.0, -14.0), COUPLER, "coupler");
    label(out, between(ROCKER_BEARING, b), (14.0, 8.0), ROCKER, "rocker");
    text(out, 24.0, 34.0, "start", INK, "RSSR linkage: two revolute, two spherical joints");
}

/// Ground frame at the crank's bearing and the axis of the rocker.
fn axes(out: &mut String) {
    for (end, name) in [([0.10, 0.0, 0.0], "x"), ([0.0, 0.12, 0.0], "y"), ([0.0, 0.0, 0.12], "z")] {
        line(out, [0.0; 3], end, "#868e96", "1.2", "1");
        label(out, end, (4.0, 2.0), "#868e96", name);
    }
    let [x, y, z] = ROCKER_BEARING;
    line(out, [x, y - 0.06, z], [x, y + 0.06, z], "#868e96", "1.2", "1");
}

struct Frame {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

fn chart(out: &mut String, frame: &Frame, values: &[f64], title: &str, color: &str) {
    let Frame { left, top, width, height } = *frame;
    let step = tick_step(values);
    let low = values.iter().fold(0.0_f64, |a, b| a.min(*b));
    let high = values.iter().fold(0.0_f64, |a, b| a.max(*b));
    let (low, high) = ((low / step).floor() * step, (high / step).ceil() * step);
    let y_of = |value: f64| top + height * (high - value) / (high - low);
    let mut tick = low;
    while tick <= high + 0.5 * step {
        let y = y_of(tick);
        let _ = writeln!(
            out,
            "<path d=\"M{left} {y:.1} h{width}\" stroke=\"{}\" stroke-width=\"1\"/>",
            if tick.abs() < 1e-9 { "#868e96" } else { "#dee2e6" }
        );
        text(out, left - 8.0, y + 4.0, "end", INK, &format!("{}", tick + 0.0));
        tick += step;
    }
    for quarter in 0..=4 {
        let x = left + width * f64::from(quarter) / 4.0;
        let _ = writeln!(out, "<path d=\"M{x:.1} {} v5\" stroke=\"#868e96\"/>", top + height);
        text(out, x, top + height + 18.0, "middle", INK, &(90 * quarter).to_string());
    }
    let last = (values.len() - 1) as f64;
    let points: Vec<String> = values
        .iter()
        .enumerate()
        .map(|(row, value)| format!("{:.1},{:.1}", left + width * row as f64 / last, y_of(*value)))
        .collect();
    let _ = writeln!(
        out,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\"/>",
        points.join(" ")
    );
    text(out, left, top - 12.0, "start", color, title);
}

/// 1, 2 or 5 times a power of ten: at most six steps over the range.
fn tick_step(values: &[f64]) -> f64 {
    let (low, high) = values.iter().fold((0.0_f64, 0.0_f64), |(a, b), v| (a.min(*v), b.max(*v)));
    let rough = ((high - low) / 5.0).max(1e-12);
    let power = 10.0_f64.powf(rough.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|step| *step >= rough)
        .unwrap_or(rough)
}

fn line(out: &mut String, a: [f64; 3], b: [f64; 3], color: &str, width: &str, opacity: &str) {
    let ((ax, ay), (bx, by)) = (project(a), project(b));
    let _ = writeln!(
        out,
        "<path d=\"M{ax:.1} {ay:.1} L{bx:.1} {by:.1}\" stroke=\"{color}\" stroke-width=\"{width}\" \
         stroke-opacity=\"{opacity}\" stroke-linecap=\"round\"/>"
    );
}

fn path(out: &mut String, points: &[[f64; 3]], color: &str) {
    let shown: Vec<String> =
        points.iter().map(|point| project(*point)).map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    let _ = writeln!(
        out,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"1.6\" stroke-dasharray=\"5 3\"/>",
        shown.join(" ")
    );
}

fn label(out: &mut String, at: [f64; 3], offset: (f64, f64), color: &str, words: &str) {
    let (x, y) = project(at);
    text(out, x + offset.0, y + offset.1, "start", color, words);
}

fn text(out: &mut String, x: f64, y: f64, anchor: &str, color: &str, words: &str) {
    let _ = writeln!(
        out,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{color}\">{words}</text>"
    );
}
