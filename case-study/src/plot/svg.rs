//! A chart as SVG. In: [`Chart`]. Out: the text of the file. Never knows pixels.

use std::fmt::Write as _;

use super::{Axis, Chart, Look, Panel, Shape};
use crate::markup::escaped;

/// Size of text.
const TEXT: f64 = 15.0;
/// Width of a letter, roughly: readers' fonts differ, and only where the legend breaks depends on it.
const LETTER: f64 = 0.56 * TEXT;
/// Height of a line of the legend.
const LEGEND_LINE: f64 = 24.0;
/// Length of the sample beside a text of the legend.
const SAMPLE: f64 = 44.0;
/// Between the texts of the legend.
const GAP: f64 = 20.0;
/// Height of a panel's title.
const TITLE: f64 = 30.0;
const GRID: Look = Look::line((222, 222, 222), 2);
const FRAME: Look = Look::line(super::BLACK, 2);

/// A place in the picture, right and down from its corner.
type Place = (f64, f64);

/// The chart as an SVG file.
pub fn svg(chart: &Chart) -> String {
    let (width, height) = chart.size;
    let mut picture = Picture(format!(
        "<svg width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         xmlns=\"http://www.w3.org/2000/svg\" font-family=\"sans-serif\" font-size=\"{TEXT}\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#FFFFFF\"/>\n"
    ));
    let (width, height) = (f64::from(width), f64::from(height));
    let top = picture.legend(&chart.legend, width);
    let columns = chart.columns.max(1);
    let rows = chart.panels.len().div_ceil(columns).max(1);
    let (width, height) = (width / columns as f64, (height - top) / rows as f64);
    for (index, panel) in chart.panels.iter().enumerate() {
        let (x, y) = ((index % columns) as f64 * width, top + (index / columns) as f64 * height);
        picture.panel(panel, [x, y, x + width, y + height]);
    }
    picture.0 + "</svg>\n"
}

/// The text so far.
struct Picture(String);

impl Picture {
    fn add(&mut self, element: std::fmt::Arguments<'_>) {
        // A string takes everything.
        let _ = self.0.write_fmt(format_args!("{element}\n"));
    }

    /// Breaks into lines that fit; returns the height.
    fn legend(&mut self, legend: &[(&str, Look)], width: f64) -> f64 {
        let (mut x, mut y) = (f64::INFINITY, 4.0 - LEGEND_LINE / 2.0);
        for (text, look) in legend {
            let length = SAMPLE + GAP / 2.0 + LETTER * text.chars().count() as f64;
            if x + length > width {
                (x, y) = (GAP, y + LEGEND_LINE);
            }
            self.line(&[(x, y), (x + SAMPLE, y)], look);
            self.marks(&[(x + SAMPLE / 2.0, y)], look);
            self.text((x + SAMPLE + 8.0, y), "start", text, "");
            x += length + GAP;
        }
        y + LEGEND_LINE / 2.0 + 2.0
    }

    /// In a frame: left, top, right, bottom.
    fn panel(&mut self, panel: &Panel, [mut left, mut top, mut right, mut bottom]: [f64; 4]) {
        if panel.title.is_empty() {
            top += 8.0;
        } else {
            self.text((0.5 * (left + right), top + TITLE / 2.0), "middle", &panel.title, "");
            top += TITLE;
        }
        let (x, y) = (&panel.x, &panel.y);
        if panel.is_sketch {
            // As large as fits.
            let size = |axis: &Axis| axis.range.1 - axis.range.0;
            let scale = ((right - left) / size(x)).min((bottom - top) / size(y));
            let (wide, high) = (right - left - scale * size(x), bottom - top - scale * size(y));
            (left, right, top, bottom) =
                (left + wide / 2.0, right - wide / 2.0, top + high / 2.0, bottom - high / 2.0);
        } else {
            (left, top, right, bottom) = (left + 68.0, top, right - 20.0, bottom - 54.0);
        }
        let across = |value: f64| left + x.part(value) * (right - left);
        let up = |value: f64| bottom - y.part(value) * (bottom - top);
        if !panel.is_sketch {
            for (value, text) in x.marks() {
                let at = across(value);
                self.line(&[(at, top), (at, bottom)], &GRID);
                self.line(&[(at, bottom), (at, bottom + 5.0)], &FRAME);
                self.text((at, bottom + 15.0), "middle", &text, SMALL);
            }
            for (value, text) in y.marks() {
                let at = up(value);
                self.line(&[(left, at), (right, at)], &GRID);
                self.line(&[(left - 5.0, at), (left, at)], &FRAME);
                self.text((left - 8.0, at), "end", &text, SMALL);
            }
            self.line(&[(left, top), (left, bottom), (right, bottom)], &FRAME);
            self.text((0.5 * (left + right), bottom + 38.0), "middle", &x.label, "");
            let (x, middle) = (left - 54.0, 0.5 * (top + bottom));
            let turned = format!(" transform=\"rotate(-90 {x:.2} {middle:.2})\"");
            self.text((x, middle), "middle", &y.label, &turned);
        }
        for curve in &panel.curves {
            let finite = curve.points.iter().filter(|(x, y)| x.is_finite() && y.is_finite());
            let places: Vec<Place> = finite.map(|(x, y)| (across(*x), up(*y))).collect();
            self.line(&places, &curve.look);
            self.marks(&places, &curve.look);
        }
        for note in &panel.notes {
            let (x, y) = (across(note.at.0), up(note.at.1));
            let at = (x + note.shift.0, y + note.shift.1);
            self.text(at, "middle", &note.text, HALO);
        }
    }

    /// A line through places, unless the look has none.
    fn line(&mut self, places: &[Place], look: &Look) {
        if look.width == 0 || places.len() < 2 {
            return;
        }
        let points: Vec<String> = places.iter().map(|(x, y)| format!("{x:.2},{y:.2}")).collect();
        let dashes: Vec<String> = look.dashes.iter().map(u32::to_string).collect();
        self.add(format_args!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-dasharray=\"{}\" \
             stroke-linejoin=\"round\"/>",
            points.join(" "),
            colour(look),
            f64::from(look.width) / 2.0,
            if dashes.is_empty() { "none".to_owned() } else { dashes.join(" ") },
        ));
    }

    /// The markers of a look at every so many of the places; the legend has one place, and it is marked.
    fn marks(&mut self, places: &[Place], look: &Look) {
        let Some(marker) = look.marker else { return };
        let first = marker.first.min(places.len().saturating_sub(1));
        let colour = colour(look);
        for (x, y) in places.iter().skip(first).step_by(marker.every.max(1)) {
            let (left, top) = (x - 3.5, y - 3.5);
            match marker.shape {
                Shape::Dot => self
                    .add(format_args!("<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"3.5\" fill=\"{colour}\"/>")),
                Shape::Ring => self.add(format_args!(
                    "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"3.5\" fill=\"none\" stroke=\"{colour}\" \
                     stroke-width=\"1.25\"/>"
                )),
                Shape::Square => self.add(format_args!(
                    "<rect x=\"{left:.2}\" y=\"{top:.2}\" width=\"7\" height=\"7\" fill=\"{colour}\"/>"
                )),
            }
        }
    }

    /// A text with its middle height at a place.
    fn text(&mut self, (x, y): Place, anchor: &str, text: &str, more: &str) {
        let text = escaped(text);
        self.add(format_args!(
            "<text x=\"{x:.2}\" y=\"{y:.2}\" dy=\"0.35em\" text-anchor=\"{anchor}\"{more}>{text}</text>"
        ));
    }
}

/// Of the numbers beside an axis.
const SMALL: &str = " font-size=\"13.5\"";
/// White behind a note, so that lines do not run through its letters.
const HALO: &str = " stroke=\"#FFFFFF\" stroke-width=\"5\" stroke-linejoin=\"round\" paint-order=\"stroke\"";

fn colour(look: &Look) -> String {
    let (r, g, b) = look.colour;
    format!("#{r:02X}{g:02X}{b:02X}")
}

impl Axis {
    /// Where a value lies between the ends, 0 to 1.
    fn part(&self, value: f64) -> f64 {
        (value - self.range.0) / (self.range.1 - self.range.0)
    }

    /// Places of its marks with their texts: words, or numbers with the digits that their step needs.
    fn marks(&self) -> Vec<(f64, String)> {
        if !self.words.is_empty() {
            return self.words.clone();
        }
        let step = self.step;
        let needs = |digits: usize| {
            let scaled = step * 10_f64.powi(digits as i32);
            (scaled - scaled.round()).abs() < 1e-6 * scaled.abs()
        };
        let digits = (0..6).find(|digits| needs(*digits)).unwrap_or(6);
        // A hair of slack for rounding at both ends.
        let (first, last) = ((self.range.0 / step - 1e-9).ceil(), (self.range.1 / step + 1e-9).floor());
        let count = (last - first).clamp(0.0, 100.0) as i32;
        // Adding zero turns -0 into 0.
        let places = (0..=count).map(|index| (first + f64::from(index)) * step + 0.0);
        places.map(|value| (value, format!("{value:.digits$}"))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::Curve;

    #[test]
    fn marks_have_the_digits_of_their_step() {
        let texts = |range, step| -> Vec<String> {
            let axis = Axis { range, step, ..Axis::default() };
            axis.marks().into_iter().map(|mark| mark.1).collect()
        };
        assert_eq!(texts((-0.5, 0.5), 0.25), ["-0.50", "-0.25", "0.00", "0.25", "0.50"]);
        assert_eq!(texts((-1e-17, 20.0), 20.0), ["0", "20"]);
    }

    #[test]
    fn the_same_chart_gives_the_same_text_with_its_labels() {
        let look = Look::line((9, 8, 7), 2).dashed(&[4, 2]);
        let chart = Chart {
            size: (300, 200),
            columns: 1,
            panels: vec![Panel {
                x: Axis { label: "time [s]".into(), range: (0.0, 1.0), step: 0.5, ..Axis::default() },
                y: Axis { label: "force [N] <&>".into(), range: (0.0, 2.0), step: 1.0, ..Axis::default() },
                curves: vec![Curve { points: vec![(0.0, 0.0), (f64::NAN, 1.0), (1.0, 2.0)], look }],
                ..Panel::default()
            }],
            legend: vec![("a curve", look)],
        };
        let text = svg(&chart);
        assert_eq!(text, svg(&chart));
        for part in [
            "time [s]",
            "force [N] &lt;&amp;&gt;",
            "a curve",
            "#090807",
            "width=\"300\" height=\"200\"",
            "\"4 2\"",
        ] {
            assert!(text.contains(part), "{part}");
        }
        assert!(!text.contains("NaN"));
    }
}
