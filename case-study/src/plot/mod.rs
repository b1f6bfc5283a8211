//! Line charts for print: what to draw as data, drawn as SVG and PNG. In: [`Chart`]. Out: text and bytes, the same for
//! the same chart, whatever fonts a machine has. Never knows what the numbers mean.

mod raster;
mod svg;

use thiserror::Error;

pub use raster::png;
pub use svg::svg;

/// A picture could not be turned into pixels.
#[derive(Debug, Error)]
#[error("a picture could not be turned into pixels: {0}")]
pub struct PlotError(#[source] Box<dyn std::error::Error + Send + Sync>);

/// A picture: panels in rows, one legend above them.
#[derive(Clone, Debug, Default)]
pub struct Chart {
    /// Width and height in units of 1/96 inch at which text has 11 points.
    pub size: (u32, u32),
    /// Panels side by side.
    pub columns: usize,
    pub panels: Vec<Panel>,
    pub legend: Vec<(&'static str, Look)>,
}

/// One coordinate system, with its title above.
#[derive(Clone, Debug, Default)]
pub struct Panel {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    /// No axes; one unit is as long in both directions.
    pub is_sketch: bool,
    /// The later over the earlier.
    pub curves: Vec<Curve>,
    pub notes: Vec<Note>,
}

#[derive(Clone, Debug, Default)]
pub struct Axis {
    /// What it shows, with its unit.
    pub label: String,
    pub range: (f64, f64),
    /// Distance of the marks.
    pub step: f64,
    /// Marks with words, at their places, instead of numbers.
    pub words: Vec<(f64, String)>,
}

#[derive(Clone, Debug)]
pub struct Curve {
    pub points: Vec<(f64, f64)>,
    pub look: Look,
}

impl Curve {
    pub fn through(x: &[f64], y: &[f64], look: Look) -> Self {
        Self { points: x.iter().copied().zip(y.iter().copied()).collect(), look }
    }
}

/// A text at a place.
#[derive(Clone, Debug)]
pub struct Note {
    /// Where, in the coordinates of the panel.
    pub at: (f64, f64),
    /// Shift of its middle to the right and down from there, in units of the chart's size.
    pub shift: (f64, f64),
    pub text: String,
}

/// Curves of one chart differ in two of its fields at least, so that they can be told apart in greyscale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Red, green, blue.
    pub colour: (u8, u8, u8),
    /// In halves of a unit; zero for markers alone.
    pub width: u32,
    /// Lengths of dashes and gaps, in turn; empty for a whole line.
    pub dashes: &'static [u32],
    pub marker: Option<Marker>,
}

/// Markers at every so many points, from the first that has one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Marker {
    pub shape: Shape,
    pub every: usize,
    pub first: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Dot,
    /// An empty circle.
    Ring,
    Square,
}

impl Look {
    /// A whole line.
    pub const fn line(colour: (u8, u8, u8), width: u32) -> Self {
        Self { colour, width, dashes: &[], marker: None }
    }

    /// The same, dashed.
    pub const fn dashed(self, dashes: &'static [u32]) -> Self {
        Self { dashes, ..self }
    }

    /// The same with markers.
    pub const fn marked(self, shape: Shape, every: usize, first: usize) -> Self {
        Self { marker: Some(Marker { shape, every, first }), ..self }
    }

    /// Whether greyscale keeps two looks apart: by a tenth of the brightness at least, or by dashes or markers.
    #[cfg(test)]
    pub fn differs_in_grey(&self, other: &Self) -> bool {
        let bright = |look: &Self| {
            let (r, g, b) = look.colour;
            (0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b)) / 255.0
        };
        (bright(self) - bright(other)).abs() > 0.1
            || self.dashes != other.dashes
            || self.marker.map(|marker| marker.shape) != other.marker.map(|marker| marker.shape)
    }
}

pub const BLACK: (u8, u8, u8) = (0, 0, 0);
/// The dark blue of the palette for colour-blind readers by Okabe and Ito.
pub const BLUE: (u8, u8, u8) = (0, 114, 178);
/// Its vermillion, darkened to differ from the blue in greyscale.
pub const RED: (u8, u8, u8) = (213, 94, 0);
/// Its bluish green, dark.
pub const GREEN: (u8, u8, u8) = (0, 90, 65);
/// Orange of the same palette, light.
pub const ORANGE: (u8, u8, u8) = (230, 159, 0);
/// Its sky blue, light.
pub const SKY: (u8, u8, u8) = (150, 205, 240);
pub const GREY: (u8, u8, u8) = (150, 150, 150);

/// An axis from 0 (or below) that holds all values, with about `marks` round marks.
pub fn axis(label: &str, values: impl Iterator<Item = f64>, marks: usize) -> Axis {
    axis_around(label, values.chain([0.0]), marks)
}

/// An axis that holds all values, with about `marks` round marks.
pub fn axis_around(label: &str, values: impl Iterator<Item = f64>, marks: usize) -> Axis {
    let ends = values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
    let (low, high) = if ends.0 <= ends.1 { ends } else { (0.0, 0.0) };
    let span = if high > low { high - low } else { 1.0 };
    let rough = span / marks.max(1) as f64;
    let power = 10_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0].map(|round| round * power).into_iter().find(|step| *step >= rough);
    let step = step.unwrap_or(10.0 * power);
    let first = (low / step).floor();
    let last = (high / step - 1e-9).ceil().max(first + 1.0);
    Axis { label: label.to_owned(), range: (first * step, last * step), step, words: Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_hold_their_values_with_round_marks() {
        let found = axis("force [N]", [3.0, 52.9, f64::NAN].into_iter(), 6);
        assert_eq!((found.range, found.step), ((0.0, 60.0), 10.0));
        let found = axis("z [mm]", [-300.0, 20.0].into_iter(), 5);
        assert_eq!((found.range, found.step), ((-300.0, 100.0), 100.0));
        assert_eq!(axis("", std::iter::empty(), 4).range.0, 0.0);
        assert_eq!(axis_around("life", [20.3, 29.9].into_iter(), 5).range, (20.0, 30.0));
    }
}
