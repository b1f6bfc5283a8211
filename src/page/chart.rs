//! Charts as SVG: lines, steps, bands, points, marks. In: numbers and what they are called. Out: text; colours by classes, so that
//! a page gives them its own. Never knows what is drawn.

use std::fmt::Write as _;

use super::escape::escaped;

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    Line,
    Dashed,
    Points,
    /// Between a lower and an upper end: points go there and back.
    Band,
    /// From the axis up.
    Bars,
}

/// Numbers of one colour.
#[derive(Clone, Debug)]
pub struct Series {
    pub name: String,
    pub points: Vec<[f64; 2]>,
    pub stroke: Stroke,
    pub colour: usize,
    /// Columns whose value at an instant, or whose length as a vector, is told beside the name.
    pub columns: Vec<usize>,
}

/// Axes, series, marks.
#[derive(Clone, Debug, Default)]
pub struct Chart {
    pub title: String,
    pub x: String,
    pub y: String,
    pub series: Vec<Series>,
    /// Upright lines with a word each.
    pub marks: Vec<(f64, String)>,
    /// Whether x is the time of the run.
    pub is_time: bool,
    /// Whether y begins at 0.
    pub from_zero: bool,
}

/// By which version it was drawn.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
const WIDTH: f64 = 480.0;
const HEIGHT: f64 = 270.0;
const LEFT: f64 = 58.0;
const RIGHT: f64 = 16.0;
const BOTTOM: f64 = 44.0;
/// Characters of a line of names.
const NAMES: usize = 58;
/// Points of a line: more are narrower than it.
const POINTS: usize = 1500;

/// Colours of standalone pictures; pages have the same classes.
pub const STYLE: &str = "<style>.chart{font:12px system-ui,Helvetica,Arial,sans-serif;fill:#343a40}.chart .grid{stroke:#dee2e6}\
.chart .axis{stroke:#868e96;fill:none}.chart .mark{stroke:#343a40;stroke-dasharray:4 3}.chart .title{font-weight:600;font-size:13px}\
.chart .s{fill:none;stroke-width:1.8;stroke-linejoin:round}.chart .dashed{stroke-dasharray:6 4}.chart .paper{fill:#fff}\
.chart .cursor{display:none}.k0{stroke:#1864ab}.k1{stroke:#d9480f}.k2{stroke:#2b8a3e}.k3{stroke:#862e9c}.k4{stroke:#0b7285}\
.k5{stroke:#c92a2a}.k6{stroke:#5f3dc4}.k7{stroke:#846358}.f0{fill:#1864ab}.f1{fill:#d9480f}.f2{fill:#2b8a3e}.f3{fill:#862e9c}\
.f4{fill:#0b7285}.f5{fill:#c92a2a}.f6{fill:#5f3dc4}.f7{fill:#846358}.band{fill-opacity:.22;stroke:none}</style>";

impl Series {
    /// A line.
    pub fn line(name: impl Into<String>, colour: usize, points: Vec<[f64; 2]>) -> Self {
        Self { name: name.into(), points, stroke: Stroke::Line, colour: colour % 8, columns: Vec::new() }
    }

    /// Drawn otherwise.
    pub fn drawn(self, stroke: Stroke) -> Self {
        Self { stroke, ..self }
    }
}

impl Chart {
    /// Whether there is anything to draw.
    pub fn is_empty(&self) -> bool {
        self.series.iter().all(|series| series.points.is_empty())
    }

    /// As a file of its own.
    pub fn file(charts: &[Self]) -> String {
        let mut body = String::new();
        for (index, chart) in charts.iter().enumerate() {
            let (_, height) = chart.size();
            let y: f64 = charts.iter().take(index).map(|chart| chart.size().1).sum();
            let _ = writeln!(
                body,
                "<g transform=\"translate(0 {y})\"><rect class=\"paper\" width=\"{WIDTH}\" height=\"{height}\"/>{}</g>",
                chart.inner()
            );
        }
        let height: f64 = charts.iter().map(|chart| chart.size().1).sum();
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"chart\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" height=\"{height}\">\n<!-- linkwear {VERSION} -->\n{STYLE}\n{body}</svg>\n"
        )
    }

    /// Within a page.
    pub fn figure(&self) -> String {
        let (width, height) = self.size();
        let [[low, high], _] = self.ranges();
        let time = if self.is_time { " data-time" } else { "" };
        format!(
            "<svg class=\"chart\" role=\"img\" aria-label=\"{}\" viewBox=\"0 0 {width} {height}\"{time} data-x=\"{low},{high},{LEFT},{}\">{}</svg>",
            escaped(&self.title),
            WIDTH - LEFT - RIGHT,
            self.inner()
        )
    }

    fn size(&self) -> (f64, f64) {
        (WIDTH, HEIGHT + 16.0 * self.name_lines().len().saturating_sub(1) as f64)
    }

    fn top(&self) -> f64 {
        30.0 + 16.0 * self.name_lines().len() as f64
    }

    /// Indices of series, by the lines that their names take.
    fn name_lines(&self) -> Vec<Vec<usize>> {
        let named = self.series.iter().enumerate().filter(|(_, series)| !series.name.is_empty());
        let mut lines: Vec<(usize, Vec<usize>)> = Vec::new();
        for (index, series) in named {
            let wide = series.name.chars().count() + if series.columns.is_empty() { 5 } else { 14 };
            match lines.last_mut() {
                Some((used, line)) if *used + wide <= NAMES => {
                    *used += wide;
                    line.push(index);
                }
                _ => lines.push((wide, vec![index])),
            }
        }
        lines.into_iter().map(|(_, line)| line).collect()
    }

    /// Of x and y.
    fn ranges(&self) -> [[f64; 2]; 2] {
        let range = |axis: usize| {
            let values = self.series.iter().flat_map(|series| &series.points).map(move |point| point[axis]);
            let marks = self.marks.iter().map(|(x, _)| *x).filter(|_| axis == 0);
            values
                .chain(marks)
                .filter(|value| value.is_finite())
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
                    [low.min(value), high.max(value)]
                })
        };
        let [x, [low, high]] = [range(0), range(1)];
        let low = if self.from_zero { low.min(0.0) } else { low };
        [x, [low, high]].map(|[low, high]| {
            if !(low.is_finite() && high.is_finite()) {
                [0.0, 1.0]
            } else if high - low > 1e-12 * high.abs().max(low.abs()) {
                [low, high]
            } else {
                let half = if high == 0.0 { 1.0 } else { 0.5 * high.abs() };
                [low - half, high + half]
            }
        })
    }

    fn inner(&self) -> String {
        let (_, height) = self.size();
        let (top, low_end) = (self.top(), height - BOTTOM);
        let [[x0, x1], [y0, y1]] = self.ranges();
        let step = tick_step(y0, y1, 5.0);
        let (y0, y1) = ((y0 / step + 1e-9).floor() * step, (y1 / step - 1e-9).ceil() * step);
        let to_x = |x: f64| LEFT + (WIDTH - LEFT - RIGHT) * (x - x0) / (x1 - x0);
        let to_y = |y: f64| low_end - (low_end - top) * (y - y0) / (y1 - y0);
        let mut out = String::new();
        let _ = write!(
            out,
            "<text class=\"title\" x=\"{LEFT}\" y=\"18\">{} {}</text>",
            escaped(&self.title),
            escaped(&self.y)
        );
        for tick in ticks(y0, y1, step) {
            let y = to_y(tick);
            let _ = write!(
                out,
                "<path class=\"grid\" d=\"M{LEFT} {y:.1}H{:.1}\"/><text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                WIDTH - RIGHT,
                LEFT - 6.0,
                y + 4.0,
                label(tick, step)
            );
        }
        let across = tick_step(x0, x1, 6.0);
        for tick in ticks(x0, x1, across) {
            let x = to_x(tick);
            let _ = write!(
                out,
                "<path class=\"axis\" d=\"M{x:.1} {low_end}v5\"/><text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
                low_end + 18.0,
                label(tick, across)
            );
        }
        let _ = write!(
            out,
            "<path class=\"axis\" d=\"M{LEFT} {low_end}H{:.1}\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            WIDTH - RIGHT,
            0.5 * (LEFT + WIDTH - RIGHT),
            height - 8.0,
            escaped(&self.x)
        );
        for series in &self.series {
            series.draw(&mut out, &to_x, &to_y, to_y(0.0_f64.max(y0)));
        }
        for (index, (x, word)) in self.marks.iter().enumerate() {
            let x = to_x(*x);
            let (anchor, by) = if x > 0.7 * WIDTH { ("end", -4.0) } else { ("start", 4.0) };
            let _ = write!(
                out,
                "<path class=\"mark\" d=\"M{x:.1} {top:.1}V{low_end}\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{}</text>",
                x + by,
                top + 12.0 + 14.0 * (index % 3) as f64,
                escaped(word)
            );
        }
        self.names(&mut out);
        let _ = write!(out, "<path class=\"cursor\" d=\"M0 {top:.1}V{low_end}\"/>");
        out
    }

    fn names(&self, out: &mut String) {
        for (line, names) in self.name_lines().iter().enumerate() {
            let y = 36.0 + 16.0 * line as f64;
            let mut x = LEFT;
            for series in names.iter().filter_map(|index| self.series.get(*index)) {
                let wide = series.name.chars().count() as f64 * 6.6;
                let columns: Vec<String> = series.columns.iter().map(ToString::to_string).collect();
                let now = if columns.is_empty() {
                    String::new()
                } else {
                    format!("<tspan class=\"now\" dx=\"5\" data-columns=\"{}\"></tspan>", columns.join(","))
                };
                series.key(out, x, y - 4.0);
                let _ = write!(
                    out,
                    "<text x=\"{:.1}\" y=\"{y:.1}\">{}{now}</text>",
                    x + 21.0,
                    escaped(&series.name)
                );
                x += wide + if series.columns.is_empty() { 38.0 } else { 96.0 };
            }
        }
    }
}

impl Series {
    /// What it looks like, before its name: 16 wide, about the height `y`.
    fn key(&self, out: &mut String, x: f64, y: f64) {
        let colour = self.colour;
        let _ = match self.stroke {
            Stroke::Line => write!(out, "<path class=\"s k{colour}\" d=\"M{x:.1} {y:.1}h16\"/>"),
            Stroke::Dashed => write!(out, "<path class=\"s dashed k{colour}\" d=\"M{x:.1} {y:.1}h16\"/>"),
            Stroke::Points => {
                write!(out, "<circle class=\"f{colour}\" cx=\"{:.1}\" cy=\"{y:.1}\" r=\"2.6\"/>", x + 8.0)
            }
            Stroke::Band | Stroke::Bars => {
                let top = y - 5.0;
                write!(
                    out,
                    "<rect class=\"band f{colour}\" x=\"{x:.1}\" y=\"{top:.1}\" width=\"16\" height=\"10\"/>"
                )
            }
        };
    }

    fn draw(&self, out: &mut String, to_x: &dyn Fn(f64) -> f64, to_y: &dyn Fn(f64) -> f64, floor: f64) {
        let stride = if self.stroke == Stroke::Line { self.points.len().div_ceil(POINTS).max(1) } else { 1 };
        let shown =
            self.points.iter().filter(|point| point.iter().all(|part| part.is_finite())).step_by(stride);
        let places: Vec<[f64; 2]> = shown.map(|[x, y]| [to_x(*x), to_y(*y)]).collect();
        let colour = self.colour;
        let path = || places.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect::<Vec<_>>().join(" ");
        let _ = match self.stroke {
            Stroke::Line => write!(out, "<polyline class=\"s k{colour}\" points=\"{}\"/>", path()),
            Stroke::Dashed => write!(out, "<polyline class=\"s dashed k{colour}\" points=\"{}\"/>", path()),
            Stroke::Band => write!(out, "<polygon class=\"band f{colour}\" points=\"{}\"/>", path()),
            Stroke::Points => places.iter().try_for_each(|[x, y]| {
                write!(out, "<circle class=\"f{colour}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.6\"/>")
            }),
            Stroke::Bars => {
                let wide = places.windows(2).map(|pair| pair[1][0] - pair[0][0]).fold(40.0, f64::min);
                places.iter().try_for_each(|[x, y]| write!(out, "<rect class=\"band f{colour}\" x=\"{:.1}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"{:.1}\"/>", x - 0.46 * wide, 0.92 * wide, (floor - y).max(0.0)))
            }
        };
    }
}

/// 1, 2 or 5 times a power of ten: about so many steps over the range.
fn tick_step(low: f64, high: f64, count: f64) -> f64 {
    let rough = (high - low) / count;
    let power = 10.0_f64.powf(rough.log10().floor());
    let found =
        [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * power).find(|step| *step >= rough * 0.999);
    found.filter(|step| step.is_normal()).unwrap_or(1.0)
}

fn ticks(low: f64, high: f64, step: f64) -> impl Iterator<Item = f64> {
    let first = (low / step - 1e-9).ceil();
    (0..20).map(move |at| (first + f64::from(at)) * step).take_while(move |tick| *tick <= high + 1e-9 * step)
}

fn label(tick: f64, step: f64) -> String {
    if tick.abs() < 1e-9 * step {
        return "0".to_owned();
    }
    let size = tick.abs().max(step);
    if !(1e-3..1e5).contains(&size) || step < 1e-4 {
        let text = format!("{tick:.2e}");
        return text.replace(".00e", "e").replace("0e", "e");
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 4")]
    let decimals = (-step.log10().floor()).clamp(0.0, 4.0) as usize;
    format!("{tick:.decimals$}")
}
