//! A chart as SVG. In: [`Chart`]. Out: the text of the file. Never knows pixels.
//!
//! The library counts in whole units, so everything is drawn on a canvas [`FINE`] times as large and shown smaller.

use std::error::Error;
use std::ops::Range;
use std::sync::OnceLock;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::prelude::*;
use plotters::style::register_font;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{Axis, Chart, Curve, Look, Panel, PlotError, Shape};

/// Units of the canvas per unit of the chart.
const FINE: u32 = 8;
/// The family that browsers have and that is registered here for the widths of texts.
const FAMILY: &str = "sans-serif";
/// Size of text; the library takes 1.24 times what the file says.
const TEXT: u32 = 15 * FINE * 124 / 100;
/// Height of a line of the legend.
const LEGEND_LINE: u32 = 24 * FINE;
/// Length of the sample beside a text of the legend.
const SAMPLE: i32 = 44 * FINE as i32;

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type Drawn = Result<(), Box<dyn Error + Send + Sync>>;

/// The chart as an SVG file.
///
/// # Errors
/// If the drawing library refuses.
pub fn svg(chart: &Chart) -> Result<String, PlotError> {
    let size = (chart.size.0 * FINE, chart.size.1 * FINE);
    let mut text = String::new();
    font();
    {
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        all(chart, &area).map_err(PlotError::Draw)?;
    }
    let drawn = format!("<svg width=\"{}\" height=\"{}\"", size.0, size.1);
    let shown = format!("<svg width=\"{}\" height=\"{}\"", chart.size.0, chart.size.1);
    Ok(text.replacen(&drawn, &shown, 1))
}

/// Tells the library the widths of letters, once.
fn font() {
    static ONCE: OnceLock<()> = OnceLock::new();
    ONCE.get_or_init(|| {
        // It refuses only what is no font.
        let _ = register_font(FAMILY, FontStyle::Normal, dejavu::sans::regular());
    });
}

fn text_style(size: u32) -> TextStyle<'static> {
    (FAMILY, size).into_text_style(&(1, 1)).color(&BLACK)
}

fn all(chart: &Chart, area: &Area<'_>) -> Drawn {
    area.fill(&WHITE)?;
    let lines = legend_lines(chart, area)?;
    let (legend_area, panels) = area.split_vertically(LEGEND_LINE * lines.len() as u32 + 6 * FINE);
    legend(&legend_area, &lines)?;
    let columns = chart.columns.max(1);
    let rows = chart.panels.len().div_ceil(columns).max(1);
    for (panel, place) in chart.panels.iter().zip(panels.split_evenly((rows, columns))) {
        if panel.is_sketch { sketch(panel, area, &place)? } else { plane(panel, area, &place)? }
    }
    area.present()?;
    Ok(())
}

type LegendLine<'c> = Vec<(i32, &'c str, &'c Look)>;

/// Breaks the legend into lines that fit: place, text, look.
fn legend_lines<'c>(
    chart: &'c Chart,
    area: &Area<'_>,
) -> Result<Vec<LegendLine<'c>>, Box<dyn Error + Send + Sync>> {
    let mut lines: Vec<LegendLine<'c>> = Vec::new();
    let (width, gap) = (area.dim_in_pixel().0 as i32, 20 * FINE as i32);
    let mut x = i32::MAX;
    for (text, look) in &chart.legend {
        let (text_width, _) = area.estimate_text_size(text, &text_style(TEXT))?;
        let length = SAMPLE + gap / 2 + text_width as i32;
        if x.saturating_add(length) > width {
            x = gap;
            lines.push(Vec::new());
        }
        if let Some(line) = lines.last_mut() {
            line.push((x, text, look));
        }
        x += length + gap;
    }
    Ok(lines)
}

fn legend(area: &Area<'_>, lines: &[LegendLine<'_>]) -> Drawn {
    for (index, line) in lines.iter().enumerate() {
        let y = (LEGEND_LINE * index as u32 + LEGEND_LINE / 2 + 4 * FINE) as i32;
        for (x, text, look) in line {
            stroke(area, &[(*x, y), (*x + SAMPLE, y)], look)?;
            if let Some(marker) = look.marker {
                mark(area, (*x + SAMPLE / 2, y), look, marker.shape)?;
            }
            let style = text_style(TEXT).pos(Pos::new(HPos::Left, VPos::Center));
            area.draw(&Text::new((*text).to_owned(), (*x + SAMPLE + 8 * FINE as i32, y), style))?;
        }
    }
    Ok(())
}

/// An axis as the library asks for it: marks where [`Axis`] has them.
struct Marked(Axis);

impl Ranged for Marked {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        let part = (value - self.0.range.0) / (self.0.range.1 - self.0.range.0);
        #[allow(clippy::cast_possible_truncation, reason = "within the canvas")]
        let shift = (part * f64::from(to - from)).round() as i32;
        from + shift
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        // Marks have whole lines; there are none between.
        if hint.weight().allow_light_points() {
            Vec::new()
        } else if self.0.words.is_empty() {
            marks(&self.0)
        } else {
            self.0.words.iter().map(|word| word.0).collect()
        }
    }

    fn range(&self) -> Range<f64> {
        self.0.range.0..self.0.range.1
    }
}

impl ValueFormatter<f64> for Marked {
    fn format_ext(&self, value: &f64) -> String {
        let word = self.0.words.iter().find(|word| word.0 == *value);
        word.map_or_else(|| mark_text(*value, self.0.step), |word| word.1.clone())
    }
}

/// A panel with axes.
fn plane(panel: &Panel, root: &Area<'_>, area: &Area<'_>) -> Drawn {
    let mut builder = ChartBuilder::on(area);
    builder
        .margin(8 * FINE)
        .margin_right(20 * FINE)
        .x_label_area_size(46 * FINE)
        .y_label_area_size(60 * FINE);
    if !panel.title.is_empty() {
        builder.caption(&panel.title, text_style(TEXT));
    }
    let mut chart = builder.build_cartesian_2d(Marked(panel.x.clone()), Marked(panel.y.clone()))?;
    chart
        .configure_mesh()
        .max_light_lines(1)
        .light_line_style(TRANSPARENT)
        .bold_line_style(ShapeStyle::from(&RGBColor(222, 222, 222)).stroke_width(FINE))
        .axis_style(ShapeStyle::from(&BLACK).stroke_width(FINE))
        .label_style(text_style(TEXT * 9 / 10))
        .axis_desc_style(text_style(TEXT))
        .x_desc(&panel.x.label)
        .y_desc(&panel.y.label)
        .set_all_tick_mark_size(5 * FINE)
        .draw()?;
    let plot = chart.plotting_area();
    contents(panel, root, &|point| plot.map_coordinate(&point))
}

/// A panel without axes, as large as fits.
fn sketch(panel: &Panel, root: &Area<'_>, area: &Area<'_>) -> Drawn {
    let (columns, rows) = area.get_pixel_range();
    let title = 30 * FINE as i32;
    if !panel.title.is_empty() {
        let style = text_style(TEXT).pos(Pos::new(HPos::Center, VPos::Center));
        root.draw(&Text::new(
            panel.title.clone(),
            ((columns.start + columns.end) / 2, rows.start + title / 2),
            style,
        ))?;
    }
    let (x, y) = (panel.x.range, panel.y.range);
    let (width, height) = (f64::from(columns.end - columns.start), f64::from(rows.end - rows.start - title));
    let scale = (width / (x.1 - x.0)).min(height / (y.1 - y.0));
    let middle = (
        0.5 * f64::from(columns.start + columns.end) - scale * 0.5 * (x.0 + x.1),
        0.5 * f64::from(rows.start + title + rows.end) + scale * 0.5 * (y.0 + y.1),
    );
    #[allow(clippy::cast_possible_truncation, reason = "within the canvas")]
    let place = |(x, y): (f64, f64)| ((middle.0 + scale * x) as i32, (middle.1 - scale * y) as i32);
    contents(panel, root, &place)
}

/// Curves and notes at places of the canvas.
fn contents(panel: &Panel, root: &Area<'_>, place: &dyn Fn((f64, f64)) -> (i32, i32)) -> Drawn {
    for Curve { points, look } in &panel.curves {
        let finite = points.iter().filter(|(x, y)| x.is_finite() && y.is_finite());
        let places: Vec<(i32, i32)> = finite.map(|point| place(*point)).collect();
        stroke(root, &places, look)?;
        if let Some(marker) = look.marker {
            for at in places.iter().skip(marker.first).step_by(marker.every.max(1)) {
                mark(root, *at, look, marker.shape)?;
            }
        }
    }
    for note in &panel.notes {
        let (x, y) = place(note.at);
        let shifted = (x + note.shift.0 * FINE as i32, y + note.shift.1 * FINE as i32);
        halo(root, &note.text, shifted)?;
        let style = text_style(TEXT).pos(Pos::new(HPos::Center, VPos::Center));
        root.draw(&Text::new(note.text.clone(), shifted, style))?;
    }
    Ok(())
}

/// White behind a note, so that lines do not run through its letters.
fn halo(root: &Area<'_>, text: &str, (x, y): (i32, i32)) -> Drawn {
    let (width, height) = root.estimate_text_size(text, &text_style(TEXT))?;
    let (right, down) = (width as i32 / 2 + FINE as i32, height as i32 / 2);
    let corners = [(x - right, y - down), (x + right, y + down)];
    root.draw(&Rectangle::new(corners, ShapeStyle::from(&WHITE).filled()))?;
    Ok(())
}

/// A line through places, in dashes if the look has them.
fn stroke(root: &Area<'_>, places: &[(i32, i32)], look: &Look) -> Drawn {
    if look.width == 0 || places.len() < 2 {
        return Ok(());
    }
    let (r, g, b) = look.colour;
    // Widths of the chart are halves of its units.
    let style = ShapeStyle::from(&RGBColor(r, g, b)).stroke_width(look.width * FINE / 2);
    if look.dashes.is_empty() {
        root.draw(&PathElement::new(places.to_vec(), style))?;
    } else {
        for dash in dashes(places, look.dashes) {
            root.draw(&PathElement::new(dash, style))?;
        }
    }
    Ok(())
}

/// Cuts a line into dashes; the pattern runs on around corners.
fn dashes(places: &[(i32, i32)], pattern: &[u32]) -> Vec<Vec<(i32, i32)>> {
    let length = |index: usize| f64::from(pattern[index % pattern.len()] * FINE).max(1.0);
    let (mut index, mut left) = (0, length(0));
    let mut pieces = Vec::new();
    let mut piece = vec![places[0]];
    for pair in places.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let (dx, dy) = (f64::from(to.0 - from.0), f64::from(to.1 - from.1));
        let whole = dx.hypot(dy);
        let mut done = 0.0;
        while whole - done > left {
            done += left;
            let part = done / whole;
            let at = (from.0 + (part * dx).round() as i32, from.1 + (part * dy).round() as i32);
            if index % 2 == 0 {
                piece.push(at);
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece = vec![at];
            }
            index += 1;
            left = length(index);
        }
        left -= whole - done;
        if index % 2 == 0 {
            piece.push(to);
        }
    }
    pieces.extend((piece.len() > 1).then_some(piece));
    pieces
}

fn mark(root: &Area<'_>, at: (i32, i32), look: &Look, shape: Shape) -> Drawn {
    let (r, g, b) = look.colour;
    let colour = RGBColor(r, g, b);
    let size = 7 * FINE as i32 / 2;
    match shape {
        Shape::Dot => root.draw(&Circle::new(at, size, colour.filled()))?,
        Shape::Ring => {
            root.draw(&Circle::new(at, size, ShapeStyle::from(&colour).stroke_width(FINE * 5 / 4)))?
        }
        Shape::Square => {
            let corners = [(at.0 - size, at.1 - size), (at.0 + size, at.1 + size)];
            root.draw(&Rectangle::new(corners, colour.filled()))?;
        }
    }
    Ok(())
}

/// Places of the marks of an axis.
fn marks(axis: &Axis) -> Vec<f64> {
    let (from, to) = axis.range;
    // A hair of slack for rounding at both ends.
    let (first, last) = ((from / axis.step - 1e-9).ceil(), (to / axis.step + 1e-9).floor());
    let count = (last - first).clamp(0.0, 100.0) as i32;
    (0..=count).map(|index| (first + f64::from(index)) * axis.step).collect()
}

/// A mark's number with the digits that its step needs.
fn mark_text(value: f64, step: f64) -> String {
    let needs = |digits: usize| {
        let scaled = step * 10_f64.powi(digits as i32);
        (scaled - scaled.round()).abs() < 1e-6 * scaled.abs()
    };
    let digits = (0..6).find(|digits| needs(*digits)).unwrap_or(6);
    // Adding zero turns -0 into 0.
    format!("{:.digits$}", (value / step).round() * step + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_have_the_digits_of_their_step() {
        let axis = Axis { label: String::new(), range: (-0.5, 0.5), step: 0.25, ..Axis::default() };
        let texts: Vec<String> = marks(&axis).iter().map(|x| mark_text(*x, axis.step)).collect();
        assert_eq!(texts, ["-0.50", "-0.25", "0.00", "0.25", "0.50"]);
        assert_eq!(mark_text(-1e-17, 20.0), "0");
    }

    #[test]
    fn dashes_run_on_around_corners() {
        let unit = FINE as i32;
        let pieces = dashes(&[(0, 0), (6 * unit, 0), (6 * unit, 10 * unit)], &[4, 4]);
        let expected: Vec<Vec<(i32, i32)>> =
            vec![vec![(0, 0), (4 * unit, 0)], vec![(6 * unit, 2 * unit), (6 * unit, 6 * unit)]];
        assert_eq!(pieces, expected);
    }

    #[test]
    fn the_same_chart_gives_the_same_text_with_its_labels() {
        let chart = Chart {
            size: (300, 200),
            columns: 1,
            panels: vec![Panel {
                x: Axis { label: "time [s]".into(), range: (0.0, 1.0), step: 0.5, ..Axis::default() },
                y: Axis { label: "force [N] <&>".into(), range: (0.0, 2.0), step: 1.0, ..Axis::default() },
                curves: vec![Curve { points: vec![(0.0, 0.0), (1.0, 2.0)], look: Look::line((9, 8, 7), 2) }],
                ..Panel::default()
            }],
            legend: vec![("a curve".into(), Look::line((9, 8, 7), 2))],
        };
        let text = svg(&chart).expect("a picture");
        assert_eq!(text, svg(&chart).expect("a picture"));
        for part in
            ["time [s]", "force [N] &lt;&amp;&gt;", "a curve", "#090807", "width=\"300\" height=\"200\""]
        {
            assert!(text.contains(part), "{part}");
        }
    }
}
