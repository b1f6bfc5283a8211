//! Where a part is in the whole: its points, directions and inertias as the whole draws them. In: the part's [`File`] and its place. Out: the
//! same in the frame of the whole, and what cannot be turned. Never knows names.

use linkwear_runtime::Scalar;

use super::body::{BodySpec, Centre};
use super::drawn::Turn;
use super::file::File;
use super::force::ForceSpec;
use super::joint::JointSpec;
use super::point::PointSpec;
use super::written::{At, Literal, Name, PerBody, Quantity, Table, Triple};
use crate::source::Span;

/// Where a part is.
pub(super) struct Place {
    /// None: not turned.
    pub turn: Option<Turn>,
    /// Coordinates of its origin, as written in the whole; empty: that of the whole.
    pub origin: Vec<Quantity>,
}

/// What a turned part must not have, where, and what to do.
pub(super) type Fault = (Span, String, &'static str);

impl Place {
    /// Moves all that is drawn.
    pub(super) fn apply(&self, file: &mut File) -> Vec<Fault> {
        let mut faults = Vec::new();
        self.tables((&mut file.points, &mut file.bodies, &mut file.joints, &mut file.forces), &mut faults);
        for (_, group) in &mut file.repeat.0 {
            let group = &mut group.value;
            self.tables(
                (&mut group.points, &mut group.bodies, &mut group.joints, &mut group.forces),
                &mut faults,
            );
        }
        if self.turn.is_some() {
            let groups = file.repeat.0.iter().flat_map(|(_, group)| &group.value.joints.0);
            let turning: Vec<&Name> = file
                .joints
                .0
                .iter()
                .chain(groups)
                .filter(|(_, joint)| has_ground_axes(&joint.value))
                .map(|(name, _)| name)
                .collect();
            let groups =
                file.repeat.0.iter().flat_map(|(_, group)| [&group.value.assembly, &group.value.initial]);
            for (name, _) in
                [&file.assembly, &file.initial].into_iter().chain(groups).flat_map(|table| &table.0)
            {
                if turning.iter().any(|joint| joint.value == name.value) {
                    let what = format!("the start of `{}` is written along the axes of the part", name.value);
                    faults.push((name.span, what, "start such joints in the file that includes the part"));
                }
            }
        }
        faults
    }

    fn tables(
        &self,
        (points, bodies, joints, forces): (
            &mut Table<PointSpec>,
            &mut Table<BodySpec>,
            &mut Table<JointSpec>,
            &mut Table<ForceSpec>,
        ),
        faults: &mut Vec<Fault>,
    ) {
        for (_, point) in &mut points.0 {
            self.point_spec(&mut point.value);
        }
        for (_, body) in &mut bodies.0 {
            self.body(&mut body.value);
        }
        for (name, joint) in &mut joints.0 {
            self.joint(name, &mut joint.value, faults);
        }
        for (_, force) in &mut forces.0 {
            let force = &mut force.value;
            self.directions(force.components.as_mut());
            self.basis(&mut force.directions, force.bushing.as_ref().map(|pair| pair.0.span));
        }
    }

    fn point_spec(&self, point: &mut PointSpec) {
        self.each(point.at.as_mut(), Self::point);
        point.by_body.0.iter_mut().for_each(|(_, at)| self.point(&mut at.value));
    }

    fn body(&self, body: &mut BodySpec) {
        if let Some(Centre::At(at)) = &mut body.centre {
            self.point(at);
        }
        self.directions(body.width_axis.as_mut());
        self.basis(&mut body.axes, body.inertia.as_ref().map(|inertia| inertia.span));
        let Some(bent) = &mut body.flexible else { return };
        self.basis(&mut bent.value.axes, bent.value.data.as_ref().map(|data| data.span));
        if let Some(turn) = &self.turn {
            bent.value.drawn = bent.value.drawn.turned(turn);
        }
        if let Some(section) = &mut bent.value.section {
            self.directions(section.value.y_axis.as_mut());
        }
    }

    fn joint(&self, name: &Name, joint: &mut JointSpec, faults: &mut Vec<Fault>) {
        if self.turn.is_some() {
            if let Some(equation) = &joint.equation {
                let what = "an `equation` is written along the axes of the part".to_owned();
                faults.push((equation.span, what, "turn the part in its own file"));
            }
            let spring = joint.spring.as_ref();
            // Of one stiffness, the spring of a ball acts alike about all axes.
            let is_alike = spring.is_some_and(|spring| spring.stiffness.is_some());
            if spring.is_some() && joint.spherical.is_some() && !is_alike {
                let what =
                    format!("the spring of joint `{}` is written along the axes of the part", name.value);
                faults.push((
                    name.span,
                    what,
                    "give it one `stiffness`, or put a `bushing` into `[forces]` instead, which turns with the part",
                ));
            }
            let is_along = spring.is_some() && joint.spherical.is_none();
            let is_written = joint.force.is_some() || is_along || joint.drive.is_some();
            if has_ground_axes(joint) && is_written {
                let what =
                    format!("what acts in joint `{}` is written along the axes of the part", name.value);
                faults.push((name.span, what, "write it in the file that includes the part"));
            }
            if joint.first.is_none() && (joint.planar.is_some() || joint.inplane.is_some()) {
                let what = format!("joint `{}` does not say along what its coordinates are", name.value);
                faults.push((name.span, what, "write its `first`"));
            }
        }
        self.each(joint.axis.as_mut(), Self::direction);
        self.each(joint.first.as_mut(), Self::direction);
        for axis in joint.axes.iter_mut().flat_map(|axes| &mut axes.value) {
            self.each(Some(axis), Self::direction);
        }
    }

    fn each(&self, at: Option<&mut PerBody>, place: fn(&Self, &mut Triple)) {
        match at {
            Some(PerBody::Shared(triple)) => place(self, triple),
            Some(PerBody::Each(table)) => table.0.iter_mut().for_each(|(_, at)| place(self, &mut at.value)),
            None => {}
        }
    }

    fn directions<'a>(&self, list: impl IntoIterator<Item = &'a mut Triple>) {
        list.into_iter().for_each(|triple| self.direction(triple));
    }

    /// Axes that are those of the drawing unless others are written; `needed`: where what they are of is.
    fn basis(&self, axes: &mut Option<At<Vec<Triple>>>, needed: Option<Span>) {
        let (Some(turn), Some(span)) = (&self.turn, needed.or(axes.as_ref().map(|axes| axes.span))) else {
            return;
        };
        match axes {
            Some(axes) => self.directions(&mut axes.value),
            None => {
                let number = |value: f64| At { span, value: Literal::Number(value) };
                let column =
                    |j: usize| Triple(At { span, value: (0..3).map(|i| number(turn[i][j])).collect() });
                *axes = Some(At { span, value: vec![column(0), column(1)] });
            }
        }
    }

    fn direction(&self, triple: &mut Triple) {
        self.moved(triple, &[]);
    }

    fn point(&self, triple: &mut Triple) {
        self.moved(triple, &self.origin);
    }

    /// Components of the turned vector and then of what is added, as formulas. A wrong count stays: it is reported later.
    fn moved(&self, Triple(At { value: components, .. }): &mut Triple, origin: &[Quantity]) {
        if components.len() != 3 {
            return;
        }
        let unit = |i: usize| std::array::from_fn(|j| f64::from(u8::from(i == j)));
        let turn = self.turn.unwrap_or_else(|| std::array::from_fn(unit));
        let made = turn.iter().enumerate().map(|(at, row)| {
            let parts =
                row.iter().zip(&*components).filter(|(factor, part)| **factor != 0.0 && !is_zero(part));
            let mut terms: Vec<(f64, &Quantity)> = parts.map(|(factor, part)| (*factor, part)).collect();
            terms.extend(origin.get(at).filter(|part| !is_zero(part)).map(|part| (1.0, part)));
            let span = components[at].span;
            match terms[..] {
                [] => At { span, value: Literal::Number(0.0) },
                [(1.0, only)] => only.clone(),
                _ => {
                    let texts: Vec<String> = terms.iter().map(|(factor, part)| term(*factor, part)).collect();
                    At { span, value: Literal::Text(texts.join(" + ")) }
                }
            }
        });
        let made: Vec<Quantity> = made.collect();
        *components = made;
    }
}

/// Joints whose coordinates are along the axes of the drawing.
fn has_ground_axes(joint: &JointSpec) -> bool {
    [&joint.spherical, &joint.free, &joint.inline, &joint.inplane, &joint.distance, &joint.on_surface]
        .iter()
        .any(|kind| kind.is_some())
}

fn is_zero(quantity: &Quantity) -> bool {
    match &quantity.value {
        Literal::Number(value) => *value == 0.0,
        Literal::Text(_) => false,
    }
}

fn term(factor: f64, part: &Quantity) -> String {
    let text = match &part.value {
        Literal::Number(value) => format!("{value:?}"),
        Literal::Text(text) => text.clone(),
    };
    match factor {
        1.0 => format!("({text})"),
        -1.0 => format!("-({text})"),
        _ => format!("{factor:?}*({text})"),
    }
}

/// The rotation about an axis of any length by an angle [rad]; quarter turns about axes of the frame are exact.
pub(super) fn turn(axis: [f64; 3], angle: f64) -> Option<Turn> {
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    if !(length > 0.0 && length.is_finite() && angle.is_finite()) {
        return None;
    }
    let n = axis.map(|x| x / length);
    let (s, c) = Scalar::sin_cos(angle);
    let (s, c) = (clean(s), clean(c));
    let cross = [[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]];
    Some(std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let unit = if i == j { c } else { 0.0 };
            clean(unit + (1.0 - c) * n[i] * n[j] + s * cross[i][j])
        })
    }))
}

/// Rounding of right angles is none.
fn clean(entry: f64) -> f64 {
    let near = entry.round();
    if (entry - near).abs() < 1e-15 { near + 0.0 } else { entry }
}
