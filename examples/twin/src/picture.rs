//! The plan as a picture: readings, the threshold, and how wear will go on.

use std::fmt::Write as _;
use std::io;
use std::path::Path;

use crate::plan::{Plan, Twin};

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 360.0;
const LEFT: f64 = 60.0;
const BOTTOM: f64 = 50.0;
const MARGIN: f64 = 20.0;

/// Writes the picture, whole or not at all.
pub fn draw(file: &Path, twin: &Twin, plan: &Plan) -> io::Result<()> {
    let part = file.with_extension("part");
    std::fs::write(&part, svg(twin, plan))?;
    std::fs::rename(part, file)
}

fn svg(twin: &Twin, plan: &Plan) -> String {
    let (now, threshold) = (plan.now, twin.exposure.threshold);
    let last = (now.cycle + plan.left[2]) * 1.05;
    let x = |cycle: f64| LEFT + (WIDTH - LEFT - MARGIN) * cycle / last;
    let y = |wear: f64| HEIGHT - BOTTOM - (HEIGHT - BOTTOM - 2.0 * MARGIN) * wear / (1.1 * threshold);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" font-family=\"sans-serif\" \
         font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    // From the last reading on the model's path, stretched in time: wear still curves as the clearance opens.
    let model = twin.exposure.cycles(now.wear, threshold);
    let course = |left: f64| -> String {
        let at = |k: u32| {
            let wear = now.wear + (threshold - now.wear) * f64::from(k) / 20.0;
            let cycle = now.cycle + left * twin.exposure.cycles(now.wear, wear) / model;
            format!("{:.1},{:.1}", x(cycle), y(wear))
        };
        (0..=20).map(at).collect::<Vec<_>>().join(" ")
    };
    let [early, median, late] = plan.left.map(course);
    let back: Vec<&str> = late.split(' ').rev().collect();
    let _ = writeln!(out, "<polygon points=\"{early} {}\" fill=\"#cfe3f5\"/>", back.join(" "));
    let _ =
        writeln!(out, "<polyline points=\"{median}\" fill=\"none\" stroke=\"#1f6fb2\" stroke-width=\"2\"/>");
    let line = |from: (f64, f64), to: (f64, f64), style: &str| {
        format!(
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" {style}/>\n",
            from.0, from.1, to.0, to.1
        )
    };
    let text = |at: (f64, f64), anchor: &str, what: &str| {
        format!("<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{what}</text>\n", at.0, at.1)
    };
    out +=
        &line((x(0.0), y(threshold)), (x(last), y(threshold)), "stroke=\"#b22222\" stroke-dasharray=\"6 4\"");
    out += &text((x(0.0) + 6.0, y(threshold) - 6.0), "start", "failed");
    let replace = plan.replace_by();
    out += &line((x(replace), y(0.0)), (x(replace), y(threshold)), "stroke=\"#b22222\"");
    out += &text((x(replace) - 4.0, y(0.0) - 6.0), "end", &format!("replace by {replace:.1}"));
    for axis in [((x(0.0), y(0.0)), (x(last), y(0.0))), ((x(0.0), y(0.0)), (x(0.0), y(1.1 * threshold)))] {
        out += &line(axis.0, axis.1, "stroke=\"black\"");
    }
    let step = if last > 60.0 { 20.0 } else { 5.0 };
    for k in 0..=(last / step) as u32 {
        let cycle = step * f64::from(k);
        out += &text((x(cycle), y(0.0) + 18.0), "middle", &cycle.to_string());
    }
    for k in 0..=4 {
        let wear = 0.25 * threshold * f64::from(k);
        out += &text((x(0.0) - 6.0, y(wear) + 4.0), "end", &format!("{:.0}", 1e6 * wear));
    }
    out += &text((0.5 * (x(0.0) + x(last)), HEIGHT - 12.0), "middle", "cycles");
    out += &text((0.5 * MARGIN, MARGIN), "start", "wear of R1 [um]; band: B10 to B90");
    for inspection in &twin.inspections {
        let _ = writeln!(
            out,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"4\" fill=\"#1f6fb2\"/>",
            x(inspection.cycle),
            y(inspection.wear)
        );
    }
    out + "</svg>\n"
}
