//! Geometry of one joint: its constraint rows and its coordinates.
//! In: a [`Joint`] and two moving frames. Out: rows and numbers. Never knows trees, cuts or forces.

use std::f64::consts::TAU;

use linkwear_codegen::id::{JointId, PointId};
use linkwear_codegen::model::{Axis, Carrier, Joint, Term};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use crate::formula::{State, evaluate};
use crate::frame::{across, angle_about, rotation_about};
use crate::jet::Jet;
use crate::kind::Kind;
use crate::row::{Pair, Row};

/// Coordinates and speeds of one joint, child relative to parent.
///
/// Revolute `[angle]`, prismatic `[distance]`, cylindrical `[angle, distance]`, screw `[angle]`,
/// universal `[angle about the parent's axis, angle about the child's axis]`, planar
/// `[first, second, angle]`, slot `[first, angle]`: position and speed of equal length, rad and m. Spherical: quaternion of the
/// relative rotation (scalar first) and relative angular velocity in W; inline, inplane: after the distances. Free: the same, followed by the
/// child's point relative to the parent's in W [m], and by the velocity, in W, of the child's point
/// relative to the parent's material there [m/s].
/// Angles are in (-pi, pi], except a screw's, which its slide makes unique.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointMotion {
    /// Coordinates.
    pub position: Vec<f64>,
    /// Speeds.
    pub speed: Vec<f64>,
}

/// A joint with numbers instead of formulas.
#[derive(Clone, Debug)]
pub(crate) struct JointGeometry {
    pub parent: Carrier,
    pub child: Carrier,
    pub kind: Kind,
    /// Its directions, as described.
    pub axes: Vec<Axis>,
    /// Advance of a screw per turn [m].
    pub lead: f64,
    /// Joint point at the reference pose, on the parent's branch and on the child's [m].
    pub points: [Vector3<f64>; 2],
    /// Columns: the same right-handed triad as the parent's and as the child's branch describe it. The
    /// third is the joint's (first) axis.
    pub triads: [Matrix3<f64>; 2],
    /// Of a joint that holds a place: what is zero there, with the values of all parameters.
    pub surface: Option<(Term, Vec<f64>)>,
}

/// A place that moves, as a surface asks for it.
struct Place([Jet; 3]);

impl State for Place {
    fn joint_position(&self, _: JointId, _: usize) -> f64 {
        f64::NAN
    }
    fn joint_speed(&self, _: JointId, _: usize) -> f64 {
        f64::NAN
    }
    fn point_position(&self, _: PointId, _: usize) -> f64 {
        f64::NAN
    }
    fn point_speed(&self, _: PointId, _: usize) -> f64 {
        f64::NAN
    }
    fn place(&self, component: usize) -> Jet {
        self.0[component]
    }
}

impl JointGeometry {
    pub fn new(joint: &Joint, points: [Vector3<f64>; 2], parameters: &[f64]) -> Self {
        let model = &joint.model;
        let triads = match model.axes[..] {
            [] => [Matrix3::identity(); 2],
            [axis] => triads_about(&axis),
            [axis, first, ..] => [
                triad(&Vector3::from(first.parent), &Vector3::from(axis.parent)),
                triad(&Vector3::from(first.child), &Vector3::from(axis.child)),
            ],
        };
        Self {
            parent: joint.parent,
            child: joint.child,
            kind: Kind::of(model),
            axes: model.axes.clone(),
            lead: model.lead,
            points,
            triads,
            surface: joint.surface.as_ref().map(|it| (it.equation.term.clone(), parameters.to_vec())),
        }
    }

    pub fn parent_axis(&self, k: usize) -> Vector3<f64> {
        self.triads[0].column(k).into()
    }

    fn child_axis(&self, k: usize) -> Vector3<f64> {
        self.triads[1].column(k).into()
    }

    /// Number of scalar coordinates that may be driven, sprung and damped.
    pub fn scalars(&self) -> usize {
        self.kind.coordinates().len()
    }

    /// What the joint forbids.
    pub fn rows(&self, pair: &Pair) -> Vec<Row> {
        let slides =
            |axes: &[usize]| -> Vec<Row> { axes.iter().map(|k| pair.slide(&self.parent_axis(*k))).collect() };
        let upright = || pair.parallel(&self.parent_axis(2), &self.child_axis(2)).to_vec();
        let locked = || -> Vec<Row> {
            let cosine = |a, b| pair.cosine(&self.parent_axis(a), &self.child_axis(b), 0.0);
            vec![cosine(1, 2), cosine(2, 0), cosine(0, 1)]
        };
        let together = || pair.together().to_vec();
        match self.kind {
            Kind::Revolute => [together(), upright()].concat(),
            Kind::Prismatic => [slides(&[0, 1]), locked()].concat(),
            Kind::Cylindrical => [slides(&[0, 1]), upright()].concat(),
            Kind::Screw => {
                let mut rows = [slides(&[0, 1]), upright()].concat();
                let along = pair.slide(&self.parent_axis(2));
                let mut turn = self.turn_about_axis(pair);
                // The angle is known up to whole turns; the slide says which.
                let turns = (along.residual / self.lead - turn.residual / TAU).round();
                turn.residual += TAU * turns;
                rows.push(along.plus(-self.lead / TAU, &turn));
                rows
            }
            Kind::Universal => {
                let [first, second] = self.two_axes();
                let (a, b) = (Vector3::from(first.parent), Vector3::from(second.parent));
                let mut rows = together();
                rows.push(pair.cosine(&a, &Vector3::from(second.child), a.dot(&b)));
                rows
            }
            Kind::Spherical => together(),
            Kind::Inline => slides(&[0, 1]),
            Kind::Planar => [slides(&[2]), upright()].concat(),
            Kind::Slot => [slides(&[1, 2]), upright()].concat(),
            Kind::Inplane => slides(&[2]),
            Kind::Fixed => [together(), locked()].concat(),
            Kind::Free => Vec::new(),
            Kind::Distance | Kind::OnSurface => self.on_surface(pair).into_iter().collect(),
        }
    }

    /// The row of a surface: the three coordinates of the place in the parent are rows themselves, and the equation of them
    /// is differentiated by Taylor arithmetic.
    fn on_surface(&self, pair: &Pair) -> Option<Row> {
        let (term, parameters) = self.surface.as_ref()?;
        let along = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| pair.slide(&axis));
        let at = |place: [Jet; 3]| evaluate(term, parameters, 0.0, &Place(place));
        let moving = along.map(|row| Jet { value: row.residual, first: row.rate, second: row.bias });
        let mut sum = Row::default();
        for (k, row) in along.iter().enumerate() {
            let mut place = along.map(|row| Jet::constant(row.residual));
            place[k].first = 1.0;
            sum = sum.plus(at(place).first, row);
        }
        let value = at(moving);
        Some(Row { residual: value.value, rate: value.first, bias: value.second, ..sum })
    }

    fn turn_about_axis(&self, pair: &Pair) -> Row {
        let [axis, rate, _] = pair.parent.direction(&self.parent_axis(2));
        let from = pair.parent.direction(&self.parent_axis(0))[0];
        let to = pair.child.direction(&self.child_axis(0))[0];
        pair.turn(angle_about(&axis, &from, &to), &axis, &rate)
    }

    /// Scalar coordinate `k` as a row: its value, its rate and what moves it.
    pub fn coordinate(&self, k: usize, pair: &Pair) -> Row {
        match (self.kind, k) {
            (Kind::Revolute | Kind::Cylindrical, 0) | (Kind::Slot, 1) | (Kind::Planar, 2) => {
                self.turn_about_axis(pair)
            }
            (Kind::Prismatic | Kind::Inline, 0) | (Kind::Cylindrical, 1) => pair.slide(&self.parent_axis(2)),
            (Kind::Planar | Kind::Slot | Kind::Inplane, _) => pair.slide(&self.parent_axis(k)),
            (Kind::Screw, 0) => {
                let mut turn = self.turn_about_axis(pair);
                turn.residual = pair.slide(&self.parent_axis(2)).residual * TAU / self.lead;
                turn
            }
            (Kind::Universal, _) => universal(self.two_axes(), k, pair),
            _ => unreachable!("`scalars` says how many coordinates there are"),
        }
    }

    /// Coordinates and speeds of the joint.
    pub fn motion(&self, pair: &Pair) -> JointMotion {
        let rows: Vec<Row> = (0..self.scalars()).map(|k| self.coordinate(k, pair)).collect();
        let mut position: Vec<f64> = rows.iter().map(|row| row.residual).collect();
        let mut speed: Vec<f64> = rows.iter().map(|row| row.rate).collect();
        if self.kind.is_round() {
            let rotation = pair.parent.state.rotation.transpose() * pair.child.state.rotation;
            let q = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
            position.extend([q.w, q.i, q.j, q.k]);
            speed.extend(pair.relative_omega().iter());
        }
        if self.kind == Kind::Free {
            let (p, c) = (&pair.parent_point, &pair.child_point);
            position.extend((c.position - p.position).iter());
            speed.extend((c.velocity - pair.parent.velocity_at(&c.position)).iter());
        }
        JointMotion { position, speed }
    }

    /// The two axes of a universal joint.
    pub fn two_axes(&self) -> [Axis; 2] {
        [self.axes[0], self.axes[1]]
    }
}

/// Angle `k` of a universal joint. With `omega = a q1' + b q2'`, a and b at a constant angle, the rate of
/// one is found by a direction at right angles to the other axis.
fn universal([first, second]: [Axis; 2], k: usize, pair: &Pair) -> Row {
    let parent = |v: &[f64; 3]| pair.parent.direction(&Vector3::from(*v));
    let child = |v: &[f64; 3]| pair.child.direction(&Vector3::from(*v));
    let [a, a_rate, _] = parent(&first.parent);
    let [b, b_rate, _] = child(&second.child);
    let cosine = Vector3::from(first.parent).dot(&Vector3::from(second.parent));
    let scale = 1.0 / (1.0 - cosine * cosine);
    if k == 0 {
        let value = angle_about(&a, &parent(&second.parent)[0], &b);
        pair.turn(value, &(scale * (a - cosine * b)), &(scale * (a_rate - cosine * b_rate)))
    } else {
        let value = angle_about(&b, &a, &child(&first.child)[0]);
        pair.turn(value, &(scale * (b - cosine * a)), &(scale * (b_rate - cosine * a_rate)))
    }
}

/// Right-handed triad whose third axis is `third` and whose first lies nearest to `first`.
fn triad(first: &Vector3<f64>, third: &Vector3<f64>) -> Matrix3<f64> {
    let x = (first - third * third.dot(first)).normalize();
    Matrix3::from_columns(&[x, third.cross(&x), *third])
}

/// The same triad about `axis` on both branches; where they differ, the shortest turn takes the child's
/// axis to the parent's.
fn triads_about(axis: &Axis) -> [Matrix3<f64>; 2] {
    let (p, c) = (Vector3::from(axis.parent), Vector3::from(axis.child));
    let [first, _] = across(&p);
    let parent = triad(&first, &p);
    let (v, cosine) = (p.cross(&c), p.dot(&c));
    let shortest = if cosine < -1.0 + 1e-12 {
        rotation_about(&first, std::f64::consts::PI)
    } else {
        let k = v.cross_matrix();
        Matrix3::identity() + k + k * k / (1.0 + cosine)
    };
    [parent, shortest * parent]
}

#[cfg(test)]
mod tests {
    use linkwear_codegen::id::PointId;
    use linkwear_codegen::model::JointModel;
    use linkwear_codegen::source::Span;

    use super::*;
    use crate::frame::{BodyState, Frame, rotation_by};

    fn kinds() -> Vec<JointModel> {
        let axis = |v: [f64; 3]| {
            let unit: [f64; 3] = Vector3::from(v).normalize().into();
            Axis { parent: unit, child: unit }
        };
        let main = axis([0.3, -0.5, 0.8]);
        vec![
            JointModel::new("revolute", &[main]),
            JointModel::new("prismatic", &[main]),
            JointModel::new("cylindrical", &[main]),
            JointModel { lead: 0.3, ..JointModel::new("screw", &[main]) },
            JointModel::new("universal", &[main, axis([0.9, 0.4, -0.2])]),
            JointModel::new("spherical", &[]),
            JointModel::new("inline", &[main]),
            JointModel::new("planar", &[main, axis([0.8, 0.0, -0.3])]),
            JointModel::new("slot", &[main, axis([0.8, 0.0, -0.3])]),
            JointModel::new("inplane", &[main, axis([0.8, 0.0, -0.3])]),
            JointModel::new("fixed", &[]),
            JointModel::new("free", &[]),
        ]
    }

    fn geometry(model: JointModel) -> JointGeometry {
        let joint = Joint {
            name: String::new(),
            model,
            parent: Carrier::Ground,
            child: Carrier::Ground,
            at: PointId::new(0),
            cut: false,
            drives: Vec::new(),
            passive: Vec::new(),
            clearance: None,
            surface: None,
            span: Span::default(),
        };
        JointGeometry::new(&joint, [Vector3::new(0.2, 0.1, -0.3), Vector3::new(0.25, 0.0, -0.1)], &[])
    }

    /// A body that moves with constant angular velocity and velocity: its accelerations are zero.
    fn drifting(seed: f64, t: f64) -> Frame {
        let wave = |k: f64| (7.3 * seed + 2.1 * k).sin();
        let omega = Vector3::new(wave(1.0), wave(2.0), wave(3.0));
        let velocity = Vector3::new(wave(4.0), wave(5.0), wave(6.0));
        let start = rotation_by(&Vector3::new(0.2 * wave(7.0), 0.3 * wave(8.0), 0.2 * wave(9.0)));
        let state = BodyState {
            rotation: rotation_by(&(t * omega)) * start,
            centre: 0.1 * velocity + t * velocity,
            omega,
            velocity,
        };
        Frame { state, reference: Vector3::new(wave(10.0), wave(11.0), 0.4) }
    }

    #[test]
    fn rates_and_biases_are_derivatives_for_every_joint() {
        for kind in kinds() {
            let joint = geometry(kind);
            let rows = |t: f64| {
                let pair = Pair::new(drifting(0.1, t), drifting(0.4, t), &joint.points);
                (joint.rows(&pair), pair)
            };
            let h = 1e-5;
            let ((low, _), (now, pair), (high, _)) = (rows(-h), rows(0.0), rows(h));
            for (k, row) in now.iter().enumerate() {
                let dot = |load: &crate::frame::Load, frame: &Frame| {
                    load.force.dot(&frame.state.velocity) + load.torque.dot(&frame.state.omega)
                };
                let by_coefficients = dot(&row.parent, &pair.parent) + dot(&row.child, &pair.child);
                assert!((by_coefficients - row.rate).abs() < 1e-14, "{:?} {k}", joint.kind);
                // A screw's angle is one only where its axes are parallel; see the next test.
                if joint.kind == Kind::Screw && k == 4 {
                    continue;
                }
                // Central differences of numbers of order 1: h² and rounding / h, both about 1e-10.
                let rate = (high[k].residual - low[k].residual) / (2.0 * h);
                let bias = (high[k].rate - low[k].rate) / (2.0 * h);
                assert!((rate - row.rate).abs() < 1e-9, "{:?} {k}: {rate} {}", joint.kind, row.rate);
                assert!((bias - row.bias).abs() < 1e-9, "{:?} {k}: {bias} {}", joint.kind, row.bias);
            }
        }
    }

    #[test]
    fn accelerations_of_a_placed_body_fit_rows_and_coordinates() {
        let reference = Vector3::new(0.5, -0.2, 0.3);
        let (q, v, a) = ([0.4, -0.7, 0.9], [1.3, 0.6, -0.8], [-0.5, 2.0, 0.7]);
        for kind in kinds() {
            let joint = geometry(kind);
            if joint.kind.is_round() {
                continue;
            }
            let placed = |t: f64| {
                let motion = JointMotion {
                    position: (0..joint.scalars()).map(|k| q[k] + v[k] * t + 0.5 * a[k] * t * t).collect(),
                    speed: (0..joint.scalars()).map(|k| v[k] + a[k] * t).collect(),
                };
                joint.place(&drifting(0.7, t), true, &reference, &motion)
            };
            // Central differences of numbers of order 1: h² and rounding / h, both about 1e-10.
            let h = 1e-5;
            let (low, state, high) = (placed(-h), placed(0.0), placed(h));
            let alpha = (high.omega - low.omega) / (2.0 * h);
            let acceleration = (high.velocity - low.velocity) / (2.0 * h);
            let drift = (high.centre - low.centre) / (2.0 * h) - state.velocity;
            assert!(drift.norm() < 1e-9, "{:?}", joint.kind);
            let pair = Pair::new(drifting(0.7, 0.0), Frame { state, reference }, &joint.points);
            let second =
                |row: &Row| row.child.torque.dot(&alpha) + row.child.force.dot(&acceleration) + row.bias;
            for row in joint.rows(&pair) {
                assert!(second(&row).abs() < 1e-8, "{:?} {}", joint.kind, second(&row));
            }
            for (k, asked) in a.iter().enumerate().take(joint.scalars()) {
                let row = joint.coordinate(k, &pair);
                assert!((second(&row) - asked).abs() < 1e-8, "{:?} {k} {}", joint.kind, second(&row));
            }
        }
    }

    #[test]
    fn placing_a_body_gives_the_joint_the_motion_asked_for() {
        for kind in kinds() {
            let joint = geometry(kind);
            let known = drifting(0.7, 0.3);
            let reference = Vector3::new(0.5, -0.2, 0.3);
            let scalars = joint.scalars();
            let (mut position, mut speed) =
                ([0.4, -0.7, 0.9][..scalars].to_vec(), [1.3, 0.6, -0.8][..scalars].to_vec());
            if joint.kind.is_round() {
                let q = UnitQuaternion::new(Vector3::new(0.4, -0.7, 0.9));
                position.extend([q.w, q.i, q.j, q.k]);
                speed.extend([1.3, 0.6, -0.8]);
            }
            if joint.kind == Kind::Free {
                position.extend([0.3, 0.2, -0.5]);
                speed.extend([0.4, 1.2, -0.3]);
            }
            let asked = JointMotion { position, speed };
            for outward in [true, false] {
                let state = joint.place(&known, outward, &reference, &asked);
                let found = Frame { state, reference };
                let pair = if outward {
                    Pair::new(known, found, &joint.points)
                } else {
                    Pair::new(found, known, &joint.points)
                };
                let got = joint.motion(&pair);
                let pairs =
                    asked.position.iter().zip(&got.position).chain(asked.speed.iter().zip(&got.speed));
                for (a, b) in pairs {
                    // Rounding of a few matrix products.
                    assert!((a - b).abs() < 1e-13, "{:?} {outward}: {asked:?} {got:?}", joint.kind);
                }
                for row in joint.rows(&pair) {
                    assert!(row.residual.abs() < 1e-14 && row.rate.abs() < 1e-14, "{:?}", joint.kind);
                }
            }
        }
    }
}
