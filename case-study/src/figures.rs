//! The figures of the study as pictures. In: [`Study`]. Out: [`Picture`]s, SVG and PNG. Never computes results.

mod lives;

use super::Study;
use super::around::{Around, Snapshot};
use super::configuration::Configuration;
use super::error::StudyError;
use super::force::Forces;
use crate::plot::{
    Axis, BLACK, BLUE, Chart, Curve, GREEN, GREY, Look, Note, ORANGE, Panel, RED, SKY, Shape, axis, png, svg,
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
        let svg = svg(&chart);
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
const BALL: Look = Look::line(BLACK, 0).marked(Shape::Dot, 1, 0);
const BEARING: Look = Look::line(BLACK, 0).marked(Shape::Square, 1, 0);

fn mechanism(configuration: &Configuration) -> Chart {
    let panel = |title: &str, view| Panel { title: title.to_owned(), ..drawn_from(configuration, view) };
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
        legend: legend.to_vec(),
    }
}

fn drawn_from(configuration: &Configuration, view: &View) -> Panel {
    let lowest = configuration.joints.iter().map(|joint| joint.at[2]).fold(f64::INFINITY, f64::min);
    let shadow = |at: &[f64; 3]| [at[0], at[1], lowest];
    let drawn =
        |points: &[[f64; 3]], look| Curve { points: points.iter().map(|at| view.place(*at)).collect(), look };
    let Configuration { joints, links } = configuration;
    let shadows = links.iter().map(|link| link.through.iter().map(shadow).collect::<Vec<_>>());
    let mut curves: Vec<Curve> = shadows.map(|shadow| drawn(&shadow, SHADOW)).collect();
    curves.extend(joints.iter().map(|joint| drawn(&joint.trace, TRACE)));
    curves.extend(links.iter().map(|link| drawn(&link.through, if link.flexible { BENDING } else { LINK })));
    curves
        .extend(joints.iter().map(|joint| drawn(&[joint.at], if joint.on_ground { BEARING } else { BALL })));
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
    let shifted = |at, (x, y): (f64, f64), by: f64, text: &str| Note {
        at,
        shift: (by * x, -by * y),
        text: text.to_owned(),
    };
    let mut notes = Vec::new();
    for joint in &configuration.joints {
        let here = view.place(joint.at);
        let links = configuration.links.iter().filter(|link| link.through.contains(&joint.at));
        let others = links.flat_map(|link| &link.through).filter(|at| **at != joint.at);
        let away = others.map(|other| view.place(*other)).fold((0.0, 0.0), |away, there| {
            let (x, y) = unit((there.0 - here.0, there.1 - here.1));
            (away.0 - x, away.1 - y)
        });
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
            notes.push(Note { at: to, shift: (9.0, -9.0), text: name.to_owned() });
        }
    }
    notes.push(Note { at: view.place(origin), shift: (44.0, 34.0), text: "axes: 100 mm".to_owned() });
}

fn force(forces: &Forces) -> Chart {
    let shown = [
        ("clearance, rigid coupler (one chaotic turn)", &forces.rigid, Look::line(ORANGE, 1)),
        ("ideal joint (reaction)", &forces.ideal, Look::line(SKY, 14)),
        ("clearance, flexible coupler", &forces.flexible, Look::line(BLACK, 3)),
        (
            "Exudyn, clearance, flexible coupler",
            &forces.reference,
            Look::line(RED, 0).marked(Shape::Ring, 14, 3),
        ),
    ];
    let all = shown.iter().flat_map(|(_, curve, _)| curve.forces.iter().copied());
    let mut time = axis("time from the start of a turn [s]", [forces.period].into_iter(), 10);
    time.range.1 = forces.period;
    let curves = shown.map(|(_, curve, look)| Curve::through(&curve.times, &curve.forces, look));
    Chart {
        size: (800, 440),
        columns: 1,
        panels: vec![Panel {
            x: time,
            y: axis("contact force Fₙ at R1 [N]", all, 7),
            curves: curves.to_vec(),
            ..Panel::default()
        }],
        legend: shown.map(|(text, _, look)| (text, look)).to_vec(),
    }
}

fn wear(around: &Around) -> Chart {
    let models = [
        ("deterministic: rigid, no feedback", &around.deterministic, Look::line(ORANGE, 4)),
        ("proposed: flexible, feedback", &around.proposed, Look::line(BLACK, 3).dashed(&[9, 4])),
        ("finest own model", &around.finest, Look::line(GREEN, 2).marked(Shape::Ring, 6, 2)),
    ];
    let panel = |(at, proposed): (usize, &Snapshot)| {
        let curves = models.map(|(_, worn, look)| {
            let depths: Vec<f64> = worn.snapshots[at].depths.iter().map(|depth| 1e6 * depth).collect();
            Curve::through(&worn.angles, &depths, look)
        });
        let depths = curves.iter().flat_map(|curve| curve.points.iter().map(|point| point.1));
        let is_last = at + 1 == around.proposed.snapshots.len();
        let label = if is_last { "bearing angle [deg], 0 along the ground's x axis" } else { "" };
        Panel {
            title: format!("cycle {}", proposed.cycle),
            x: Axis { label: label.to_owned(), range: (-180.0, 180.0), step: 30.0, ..Axis::default() },
            y: axis("wear depth [µm]", depths, 4),
            curves: curves.to_vec(),
            ..Panel::default()
        }
    };
    Chart {
        size: (800, 820),
        columns: 1,
        panels: around.proposed.snapshots.iter().enumerate().map(panel).collect(),
        legend: models.map(|(text, _, look)| (text, look)).to_vec(),
    }
}
