//! A picture of a mechanism, as in a paper: one position in full, others behind it, paths of its points, joints by name. In: a
//! compiled mechanism and a run with columns of poses. Out: SVG. Never knows files.

use std::fmt::Write as _;

use linkwear_codegen::Compiled;
use linkwear_codegen::model::Look;
use linkwear_runtime::Run;

use super::chart::{STYLE, VERSION};
use super::escape::escaped;
use super::scene::{Scene, Shape};
use super::vector::{cross, dot, minus, norm, plus};

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 600.0;
const MARGIN: f64 = 70.0;
/// Positions behind the one in full.
const GHOSTS: usize = 16;
/// The position in full, as a part of the run.
const SHOWN: f64 = 0.13;

/// The picture; nothing if the run has no columns of poses.
pub fn svg(compiled: &Compiled, run: &Run) -> Option<String> {
    styled(compiled, run, STYLE)
}

/// The same without colours, for a page that has its own.
pub fn within_page(compiled: &Compiled, run: &Run) -> Option<String> {
    styled(compiled, run, "")
}

fn styled(compiled: &Compiled, run: &Run, style: &str) -> Option<String> {
    let scene = Scene::new(compiled);
    let poses = scene
        .bodies
        .iter()
        .map(|body| run.channels.iter().position(|channel| *channel.name == *format!("{}.pose0", body.name)));
    let poses: Vec<usize> = poses.collect::<Option<_>>()?;
    let camera = Camera::fitted(&scene, run, &poses);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"chart\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" height=\"{HEIGHT}\">\n<!-- linkwear {VERSION} -->\n{style}\n\
         <rect class=\"paper\" width=\"{WIDTH}\" height=\"{HEIGHT}\"/>\n"
    );
    let rows = run.rows.len();
    for ghost in 0..GHOSTS {
        let row = run.rows.get(ghost * rows / GHOSTS)?;
        bodies(&mut out, &scene, &camera, (row, &poses), (1.2, 0.22));
    }
    paths(&mut out, &scene, &camera, run);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a row of the run")]
    let row = run.rows.get((SHOWN * rows as f64) as usize)?;
    ground(&mut out, &scene, &camera);
    circles(&mut out, &scene, &camera, (row, &poses));
    links(&mut out, &scene, &camera, (row, &poses));
    bodies(&mut out, &scene, &camera, (row, &poses), (6.0, 1.0));
    joints(&mut out, &scene, &camera, (row, &poses));
    axes(&mut out, &camera);
    let _ = writeln!(out, "<text class=\"title\" x=\"20\" y=\"28\">{}</text>\n</svg>", escaped(&scene.name));
    Some(out)
}

/// Where a place of a body is in a row.
fn moved(row: &[f64], first: usize, place: [f64; 3]) -> [f64; 3] {
    let at = |index: usize| row.get(first + index).copied().unwrap_or_default();
    [0, 1, 2].map(|i| dot([at(3 * i), at(3 * i + 1), at(3 * i + 2)], place) + at(9 + i))
}

struct Camera {
    right: [f64; 3],
    up: [f64; 3],
    scale: f64,
    middle: [f64; 2],
}

impl Camera {
    /// Along the axis of a plane mechanism, else from the front, the right and above; with everything in sight.
    fn fitted(scene: &Scene, run: &Run, poses: &[usize]) -> Self {
        let up = scene.up;
        let helper = if dot(up, [0.0, 1.0, 0.0]).abs() < 0.9 { [0.0, 1.0, 0.0] } else { [0.0, 0.0, -1.0] };
        let (right, up) = match scene.common_axis() {
            Some(axis) if norm(cross(axis, up)) > 0.5 => {
                let across = cross(up, axis);
                let lean = if dot(across, [1.0, 1.0, 1.0]) < 0.0 { -1.0 } else { 1.0 };
                let right = across.map(|part| lean * part / norm(across));
                (right, up)
            }
            Some(axis) => {
                let right =
                    if norm(cross(axis, [1.0, 0.0, 0.0])) > 0.5 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
                (right, cross(axis, right))
            }
            None => {
                let front = minus(helper, up.map(|part| part * dot(helper, up)));
                let front = front.map(|part| part / norm(front));
                let side = cross(front, up);
                let right = plus(side.map(|part| 0.91 * part), front.map(|part| 0.41 * part));
                let towards = plus(front.map(|part| -0.91 * part), side.map(|part| 0.41 * part));
                let towards = plus(towards.map(|part| 0.92 * part), up.map(|part| 0.39 * part));
                (right, cross(towards, right))
            }
        };
        let mut camera = Self { right, up, scale: 1.0, middle: [0.0; 2] };
        let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let mut see = |place: [f64; 3]| {
            for (side, value) in range.iter_mut().zip([dot(camera.right, place), dot(camera.up, place)]) {
                *side = [side[0].min(value), side[1].max(value)];
            }
        };
        let stride = run.rows.len().div_ceil(100).max(1);
        for row in run.rows.iter().step_by(stride) {
            let all = scene.bodies.iter().zip(poses);
            all.for_each(|(body, first)| {
                body.places.iter().for_each(|place| see(moved(row, *first, *place)))
            });
        }
        let grounds = scene.joints.iter().flat_map(|joint| joint.sides).filter(|(body, _)| body.is_none());
        grounds.for_each(|(_, place)| see(place));
        let held = scene.links.iter().flat_map(|link| link.sides).filter(|(body, _)| body.is_none());
        held.for_each(|(_, place)| see(place));
        for row in run.rows.iter().step_by(stride) {
            for circle in &scene.circles {
                circle.places().for_each(|place| see(moved(row, poses[circle.body], place)));
            }
        }
        let [wide, high] = range.map(|[low, high]| (high - low).max(1e-9));
        camera.scale = ((WIDTH - 2.0 * MARGIN) / wide).min((HEIGHT - 2.0 * MARGIN) / high);
        camera.middle = range.map(|[low, high]| 0.5 * (low + high));
        camera
    }

    fn see(&self, place: [f64; 3]) -> [f64; 2] {
        let x = 0.5 * WIDTH + self.scale * (dot(self.right, place) - self.middle[0]);
        let y = 0.5 * HEIGHT - self.scale * (dot(self.up, place) - self.middle[1]);
        [x, y]
    }
}

type At<'a> = (&'a [f64], &'a [usize]);

fn bodies(
    out: &mut String,
    scene: &Scene,
    camera: &Camera,
    (row, poses): At<'_>,
    (width, opacity): (f64, f64),
) {
    for (index, (body, first)) in scene.bodies.iter().zip(poses).enumerate() {
        let see = |place: usize| {
            camera.see(moved(row, *first, body.places.get(place).copied().unwrap_or_default()))
        };
        for [from, to] in &body.rods {
            let ([ax, ay], [bx, by]) = (see(*from), see(*to));
            let _ = writeln!(
                out,
                "<path class=\"k{}\" d=\"M{ax:.1} {ay:.1}L{bx:.1} {by:.1}\" stroke-width=\"{width}\" stroke-opacity=\"{opacity}\" stroke-linecap=\"round\"/>",
                index % 8
            );
        }
        if opacity == 1.0 && scene.bodies.len() <= 12 {
            name_of(out, body, index, see);
        }
    }
}

/// Pitch circles, with the name of a wheel that has no rod to write it at.
fn circles(out: &mut String, scene: &Scene, camera: &Camera, (row, poses): At<'_>) {
    let mut named = Vec::new();
    for circle in &scene.circles {
        let places = circle.places().map(|place| camera.see(moved(row, poses[circle.body], place)));
        let path: Vec<String> = places.map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(
            out,
            "<polyline class=\"k{}\" fill=\"none\" stroke-width=\"2\" points=\"{}\"/>",
            circle.body % 8,
            path.join(" ")
        );
        let body = &scene.bodies[circle.body];
        if body.rods.is_empty() && scene.bodies.len() <= 12 && !named.contains(&circle.body) {
            named.push(circle.body);
            let top = circle.places().map(|place| camera.see(moved(row, poses[circle.body], place)));
            let Some([x, y]) = top.min_by(|a, b| a[1].total_cmp(&b[1])) else { continue };
            let (class, name) = (circle.body % 8, escaped(&body.name));
            let _ = writeln!(
                out,
                "<text class=\"f{class}\" x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{name}</text>",
                y - 8.0
            );
        }
    }
}

/// Belts, springs, cables.
fn links(out: &mut String, scene: &Scene, camera: &Camera, (row, poses): At<'_>) {
    let place = |(body, place): (Option<usize>, [f64; 3])| {
        body.and_then(|body| poses.get(body)).map_or(place, |first| moved(row, *first, place))
    };
    let mut line = |corners: &[[f64; 2]]| {
        let path: Vec<String> = corners.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        let _ =
            writeln!(out, "<polyline class=\"axis\" stroke-width=\"1.6\" points=\"{}\"/>", path.join(" "));
    };
    for belt in &scene.belts {
        let circles = belt.circles.map(|at| &scene.circles[at]);
        let [centre, tip] = [circles[0].centre, plus(circles[0].centre, circles[0].axis)]
            .map(|at| place((Some(circles[0].body), at)));
        let ends = circles.map(|circle| (place((Some(circle.body), circle.centre)), circle.radius));
        let straights = belt.straights(minus(tip, centre), ends).into_iter().flatten();
        straights.for_each(|straight| line(&straight.map(|place| camera.see(place))));
    }
    for link in &scene.links {
        line(&link.corners(link.sides.map(|side| camera.see(place(side))), 7.0));
    }
}

fn name_of(out: &mut String, body: &Shape, index: usize, see: impl Fn(usize) -> [f64; 2]) {
    let Some([from, to]) = body.rods.first() else { return };
    let ([ax, ay], [bx, by]) = (see(*from), see(*to));
    let length = (bx - ax).hypot(by - ay).max(1.0);
    let (x, y) = (0.5 * (ax + bx) + 22.0 * (by - ay) / length, 0.5 * (ay + by) - 22.0 * (bx - ax) / length);
    let _ = writeln!(
        out,
        "<text class=\"f{}\" x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
        index % 8,
        y + 4.0,
        escaped(&body.name)
    );
}

fn paths(out: &mut String, scene: &Scene, camera: &Camera, run: &Run) {
    for name in &scene.traces {
        let Ok(places) = run.vector(&format!("{name}.")) else { continue };
        let stride = places.len().div_ceil(400).max(1);
        let path: Vec<String> = places
            .iter()
            .step_by(stride)
            .map(|place| camera.see(*place))
            .map(|[x, y]| format!("{x:.1},{y:.1}"))
            .collect();
        let _ = writeln!(
            out,
            "<polyline class=\"axis\" stroke-dasharray=\"5 3\" points=\"{}\"/>",
            path.join(" ")
        );
    }
}

/// Hatched where joints hold on to the ground.
fn ground(out: &mut String, scene: &Scene, camera: &Camera) {
    let grounds = scene.joints.iter().flat_map(|joint| joint.sides).filter(|(body, _)| body.is_none());
    for [x, y] in grounds.map(|(_, place)| camera.see(place)) {
        let _ = write!(
            out,
            "<path class=\"axis\" d=\"M{x:.1} {y:.1}l-13 22h26zM{:.1} {:.1}h40",
            x - 20.0,
            y + 22.0
        );
        (0..5).for_each(|at| {
            let _ = write!(out, "M{:.1} {:.1}l-6 8", x - 16.0 + 8.0 * f64::from(at), y + 22.0);
        });
        out.push_str("\"/>\n");
    }
}

fn joints(out: &mut String, scene: &Scene, camera: &Camera, (row, poses): At<'_>) {
    for joint in &scene.joints {
        let [[px, py], [x, y]] = joint.sides.map(|(body, place)| {
            let place =
                body.and_then(|body| poses.get(body)).map_or(place, |first| moved(row, *first, place));
            camera.see(place)
        });
        let _ = match joint.look {
            Look::Strut => writeln!(
                out,
                "<path stroke=\"#343a40\" stroke-width=\"3\" d=\"M{px:.1} {py:.1}L{x:.1} {y:.1}\"/>\
                 <circle class=\"paper\" stroke=\"#343a40\" stroke-width=\"2\" cx=\"{px:.1}\" cy=\"{py:.1}\" r=\"4\"/>\
                 <circle class=\"paper\" stroke=\"#343a40\" stroke-width=\"2\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\"/>"
            ),
            Look::Slider => writeln!(
                out,
                "<rect class=\"paper\" stroke=\"#343a40\" stroke-width=\"2\" x=\"{:.1}\" y=\"{:.1}\" width=\"18\" height=\"12\"/>",
                x - 9.0,
                y - 6.0
            ),
            Look::Ball => writeln!(
                out,
                "<circle class=\"paper\" stroke=\"#343a40\" stroke-width=\"2\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"6\"/><circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.5\"/>"
            ),
            _ => writeln!(
                out,
                "<circle class=\"paper\" stroke=\"#343a40\" stroke-width=\"2\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"6\"/>"
            ),
        };
        if scene.joints.len() <= 24 {
            let _ = writeln!(
                out,
                "<text x=\"{:.1}\" y=\"{:.1}\">{}</text>",
                x + 10.0,
                y - 10.0,
                escaped(&joint.name)
            );
        }
    }
}

/// The ground frame, in the corner.
fn axes(out: &mut String, camera: &Camera) {
    for (axis, name) in [([1.0, 0.0, 0.0], "x"), ([0.0, 1.0, 0.0], "y"), ([0.0, 0.0, 1.0], "z")] {
        let (x, y) = (34.0 * dot(camera.right, axis), -34.0 * dot(camera.up, axis));
        if x.hypot(y) > 3.0 {
            let _ = writeln!(
                out,
                "<path class=\"axis\" d=\"M50 {:.1}l{x:.1} {y:.1}\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{name}</text>",
                HEIGHT - 50.0,
                50.0 + 1.25 * x,
                HEIGHT - 46.0 + 1.25 * y
            );
        }
    }
}
