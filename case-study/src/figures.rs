//! The figures of the study as pictures. In: [`Study`]. Out: [`Picture`]s, SVG and PNG. Never computes results.

mod lives;

use super::Study;
use super::around::{Around, Snapshot, WornBearing};
use super::configuration::Configuration;
use super::error::StudyError;
use super::force::Forces;
use crate::plot::{
    Axis, BLACK, BLUE, Chart, Curve, GREEN, GREY, Look, Marker, Note, ORANGE, Panel, RED, SKY, Shape, axis,
    png, svg,
};

/// Pixels per unit of a picture: 192 to the inch.
const PIXELS: f32 = 2.0;

/// A drawn figure.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Name of its files without extension.
    pub name: &'static str,
    /// The picture as SVG.
    pub svg: String,
    /// The picture as PNG.
    pub png: Vec<u8>,
}

/// All figures of a study.
///
/// # Errors
/// If a picture cannot be drawn.
pub fn pictures(study: &Study) -> Result<Vec<Picture>, StudyError> {
    let charts = [
        ("fig3-mechanism", mechanism(&study.configuration)),
        ("fig4-force", force(&study.forces)),
        ("fig5-wear", wear(&study.around)),
        ("fig6-life", lives::densities(&study.lives)),
        ("table2-errors", lives::errors(&study.lives)),
    ];
    let draw = |(name, chart): (&'static str, Chart)| {
        let svg = svg(&chart)?;
        let png = png(&svg, PIXELS)?;
        Ok(Picture { name, svg, png })
    };
    charts.into_iter().map(draw).collect()
}

/// From where the mechanism is seen: unit vectors to the right and up of the picture, in the ground frame.
struct View {
    right: [f64; 3],
    up: [f64; 3],
}

impl View {
    /// From above and the side: azimuth and elevation of the eye [deg].
    fn from(azimuth: f64, elevation: f64) -> Self {
        let (sa, ca) = azimuth.to_radians().sin_cos();
        let (se, ce) = elevation.to_radians().sin_cos();
        Self { right: [-sa, ca, 0.0], up: [-se * ca, -se * sa, ce] }
    }

    /// Place in the picture [mm] of a point [m].
    fn place(&self, at: [f64; 3]) -> (f64, f64) {
        let along = |axis: &[f64; 3]| 1e3 * (0..3).map(|i| axis[i] * at[i]).sum::<f64>();
        (along(&self.right), along(&self.up))
    }
}

const LINK: Look = Look::line(BLACK, 6);
const BENDING: Look = Look::line(BLUE, 6).dashed(&[14, 5]);
const SHADOW: Look = Look::line(GREY, 2);
const TRACE: Look = Look::line(RED, 2).dashed(&[3, 4]);
const BALL: Look = Look::line(BLACK, 0).marked(Marker { shape: Shape::Dot, every: 1, first: 0 });
const BEARING: Look = Look::line(BLACK, 0).marked(Marker { shape: Shape::Square, every: 1, first: 0 });

fn mechanism(configuration: &Configuration) -> Chart {
    let panel = |title: &str, view: &View| {
        let mut panel = drawn_from(configuration, view);
        panel.title = title.to_owned();
        panel
    };
    let legend = [
        ("rigid link", LINK),
        ("flexible link", BENDING),
        ("joint on the ground", BEARING),
        ("spherical joint", BALL),
        ("path over a turn", TRACE),
        ("projection on the lowest plane", SHADOW),
    ];
    Chart {
        size: (800, 370),
        columns: 2,
        panels: vec![
            panel("seen from the side and above", &View::from(-62.0, 24.0)),
            panel("seen along the y axis", &View::from(-90.0, 0.0)),
        ],
        legend: legend.map(|(text, look)| (text.to_owned(), look)).to_vec(),
    }
}

fn drawn_from(configuration: &Configuration, view: &View) -> Panel {
    let lowest = configuration.joints.iter().map(|joint| joint.at[2]).fold(f64::INFINITY, f64::min);
    let place = |at: &[f64; 3]| view.place(*at);
    let shadow = |at: &[f64; 3]| view.place([at[0], at[1], lowest]);
    let mut curves = Vec::new();
    for link in &configuration.links {
        curves.push(Curve { points: link.through.iter().map(shadow).collect(), look: SHADOW });
    }
    for joint in configuration.joints.iter().filter(|joint| !joint.trace.is_empty()) {
        curves.push(Curve { points: joint.trace.iter().map(place).collect(), look: TRACE });
    }
    for link in &configuration.links {
        let look = if link.flexible { BENDING } else { LINK };
        curves.push(Curve { points: link.through.iter().map(place).collect(), look });
    }
    for joint in &configuration.joints {
        let look = if joint.on_ground { BEARING } else { BALL };
        curves.push(Curve { points: vec![place(&joint.at)], look });
    }
    let mut notes = names(configuration, view);
    axes(view, lowest, &mut curves, &mut notes);
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let range = |of: fn(&(f64, f64)) -> f64| {
        let (low, high) =
            points().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        // Room for the names.
        (low - 0.06 * (high - low), high + 0.1 * (high - low))
    };
    let (x, y) = (range(|point| point.0), range(|point| point.1));
    let side = |range| Axis { range, ..Axis::default() };
    Panel { x: side(x), y: side(y), is_sketch: true, curves, notes, ..Panel::default() }
}

/// Names of joints, away from the links that end there, and of links, beside their middle.
fn names(configuration: &Configuration, view: &View) -> Vec<Note> {
    let unit = |(x, y): (f64, f64)| {
        let length = x.hypot(y);
        // Links that are seen end-on have no direction.
        if length > 1e-6 { (x / length, y / length) } else { (0.0, 0.0) }
    };
    #[allow(clippy::cast_possible_truncation, reason = "a name stays beside what it names")]
    let shifted = |at, (x, y): (f64, f64), by: f64, text: &str| Note {
        at,
        shift: ((by * x) as i32, -(by * y) as i32),
        text: text.to_owned(),
    };
    let mut notes = Vec::new();
    for joint in &configuration.joints {
        let here = view.place(joint.at);
        let mut away = (0.0, 0.0);
        for link in configuration.links.iter().filter(|link| link.through.contains(&joint.at)) {
            for other in link.through.iter().filter(|at| **at != joint.at) {
                let there = view.place(*other);
                let (x, y) = unit((there.0 - here.0, there.1 - here.1));
                away = (away.0 - x, away.1 - y);
            }
        }
        notes.push(shifted(here, unit(away), 21.0, &joint.name));
    }
    for link in &configuration.links {
        let (Some(first), Some(last)) = (link.through.first(), link.through.last()) else { continue };
        let (from, to) = (view.place(*first), view.place(*last));
        let (x, y) = unit((to.0 - from.0, to.1 - from.1));
        // Below, with more room the steeper the link is.
        let side = if x >= 0.0 { (y, -x) } else { (-y, x) };
        let by = 17.0 + 24.0 * y.abs();
        notes.push(shifted((0.5 * (from.0 + to.0), 0.5 * (from.1 + to.1)), side, by, &link.name));
    }
    notes
}

/// The directions of the ground frame, 100 mm long, on the lowest plane.
fn axes(view: &View, lowest: f64, curves: &mut Vec<Curve>, notes: &mut Vec<Note>) {
    let origin = [-0.2, -0.1, lowest];
    for (index, name) in ["x", "y", "z"].into_iter().enumerate() {
        let mut tip = origin;
        tip[index] += 0.1;
        let (from, to) = (view.place(origin), view.place(tip));
        // An axis that points at the eye has no direction.
        if (to.0 - from.0).hypot(to.1 - from.1) > 5.0 {
            curves.push(Curve { points: vec![from, to], look: Look::line(BLACK, 2) });
            notes.push(Note { at: to, shift: (9, -9), text: name.to_owned() });
        }
    }
    notes.push(Note { at: view.place(origin), shift: (44, 34), text: "axes: 100 mm".to_owned() });
}

fn force(forces: &Forces) -> Chart {
    let points = |curve: &super::ForceCurve| {
        curve.times.iter().copied().zip(curve.forces.iter().copied()).collect::<Vec<_>>()
    };
    let ring = Marker { shape: Shape::Ring, every: 14, first: 3 };
    let looks = [
        ("clearance, rigid coupler (one chaotic turn)", &forces.rigid, Look::line(ORANGE, 1)),
        ("ideal joint (reaction)", &forces.ideal, Look::line(SKY, 14)),
        ("clearance, flexible coupler", &forces.flexible, Look::line(BLACK, 3)),
        ("Exudyn, clearance, flexible coupler", &forces.reference, Look::line(RED, 0).marked(ring)),
    ];
    let all = looks.iter().flat_map(|(_, curve, _)| curve.forces.iter().copied());
    let curve =
        |(_, curve, look): &(&str, &super::ForceCurve, Look)| Curve { points: points(curve), look: *look };
    let mut time = axis("time from the start of a turn [s]", [forces.period].into_iter(), 10);
    time.range.1 = forces.period;
    Chart {
        size: (800, 440),
        columns: 1,
        panels: vec![Panel {
            x: time,
            y: axis("contact force Fₙ at R1 [N]", all, 7),
            curves: looks.iter().map(curve).collect(),
            ..Panel::default()
        }],
        legend: looks.iter().map(|(text, _, look)| ((*text).to_owned(), *look)).collect(),
    }
}

fn wear(around: &Around) -> Chart {
    let ring = Marker { shape: Shape::Ring, every: 6, first: 2 };
    let models: [(&str, &WornBearing, Look); 3] = [
        ("deterministic: rigid, no feedback", &around.deterministic, Look::line(ORANGE, 4)),
        ("proposed: flexible, feedback", &around.proposed, Look::line(BLACK, 3).dashed(&[9, 4])),
        ("finest own model", &around.finest, Look::line(GREEN, 2).marked(ring)),
    ];
    let count = around.proposed.snapshots.len();
    let depth = |snapshot: &Snapshot| -> Vec<f64> { snapshot.depths.iter().map(|x| 1e6 * x).collect() };
    let panel = |index: usize| {
        let shown =
            || models.iter().filter_map(|(_, worn, look)| Some((worn, worn.snapshots.get(index)?, look)));
        let values = shown().flat_map(|(_, snapshot, _)| depth(snapshot));
        let curve = |(worn, snapshot, look): (&&WornBearing, &Snapshot, &Look)| Curve {
            points: worn.angles.iter().copied().zip(depth(snapshot)).collect(),
            look: *look,
        };
        let is_last = index + 1 == count;
        let label = if is_last { "bearing angle [deg], 0 along the ground's x axis" } else { "" };
        Panel {
            title: around
                .proposed
                .snapshots
                .get(index)
                .map_or_else(String::new, |s| format!("cycle {}", s.cycle)),
            x: Axis { label: label.to_owned(), range: (-180.0, 180.0), step: 30.0, ..Axis::default() },
            y: axis("wear depth [µm]", values, 4),
            curves: shown().map(curve).collect(),
            ..Panel::default()
        }
    };
    Chart {
        size: (800, 820),
        columns: 1,
        panels: (0..count).map(panel).collect(),
        legend: models.iter().map(|(text, _, look)| ((*text).to_owned(), *look)).collect(),
    }
}
