//! Start values: `[assembly]` (guesses) and `[initial]` (met exactly).

use super::modal_start::ModalStart;
use super::names::Thing;
use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::id::{BodyId, JointId};
use crate::model::{Carrier, Coordinate, Joint, JointModel, Start};
use crate::source::Span;
use crate::spec::{At, Dimension, File, Literal, Name, Quantity, StartSpec, StartTable};

/// A start value as written.
struct Written<'a> {
    index: usize,
    position: Option<&'a Quantity>,
    speed: Option<&'a Quantity>,
    span: Span,
}

impl Resolver<'_> {
    pub(super) fn resolve_starts(&mut self, file: &File, joints: &[Joint]) -> Vec<Start> {
        let mut starts: Vec<Start> = Vec::new();
        for (table, key, held) in [(&file.assembly, "assembly", false), (&file.initial, "initial", true)] {
            for (name, value) in &table.0 {
                let what = format!("[{key}]");
                let bends = file
                    .bodies
                    .0
                    .iter()
                    .any(|(body, spec)| body.value == name.value && spec.value.flexible.is_some());
                if let (Some((Thing::Body(body), _)), true) = (self.names.find(&name.value), bends) {
                    self.modal_start(body, name, &value.value, value.span, held);
                    continue;
                }
                let Some(id) = self.joint_named(name, &what) else { continue };
                let joint = &joints[id.index()];
                if joint.model.stands_in {
                    continue;
                }
                let sides = [joint.parent, joint.child];
                if joint.model.flies() && !sides.contains(&Carrier::Ground) {
                    let message = format!(
                        "the free joint `{}` is between two bodies, and has start values",
                        name.value
                    );
                    self.refuse(Code::BadStart, name.span, message).help(
                        "what flies starts in the ground: give each body a free joint to it, `free = [\"ground\", ..]`",
                    );
                    continue;
                }
                for written in self.written(name, &value.value, &joint.model, key) {
                    let start = self.start(id, joint, &written, held, &place(key, "joint", name));
                    self.check_start(joint, &start, &starts);
                    starts.push(start);
                }
            }
        }
        starts
    }

    /// `coupler = { eta = [...], eta_v = [...] }`.
    fn modal_start(&mut self, body: BodyId, name: &Name, spec: &StartSpec, span: Span, held: bool) {
        let StartSpec::Table(table) = spec else {
            let message = format!("`{}` is a body: its modes start from `eta` and `eta_v`", name.value);
            self.refuse(Code::BadStart, span, message)
                .help(format!("write `{} = {{ eta = [0, 0], eta_v = [0, 0] }}`", name.value));
            return;
        };
        if !held {
            let message = format!("the modes of `{}` take no guesses", name.value);
            self.refuse(Code::BadStart, span, message).help("write it under [initial]");
        }
        let mut list = |values: &Option<At<Vec<Quantity>>>, key: &str| -> Vec<f64> {
            let values = values.as_ref().map_or(&[][..], |list| &list.value);
            values.iter().map(|x| self.fixed(name, key, Some(x), Dimension::NONE, 0.0)).collect()
        };
        let (position, speed) = (list(&table.value.eta, "eta"), list(&table.value.eta_v, "eta_v"));
        self.modal_starts.push(ModalStart { body, position, speed, span });
    }

    /// The values by index, of the forms `"-48 deg"`, `["10 deg", "5 mm"]` and `{ q = ..., v = ... }`.
    fn written<'a>(
        &mut self,
        name: &Name,
        spec: &'a StartSpec,
        model: &JointModel,
        key: &str,
    ) -> Vec<Written<'a>> {
        let needed = model.start_values().len();
        let one = |index, quantity: &'a Quantity| Written {
            index,
            position: Some(quantity),
            speed: None,
            span: quantity.span,
        };
        let (list, span): (Vec<Written<'a>>, Span) = match spec {
            StartSpec::One(quantity) => (vec![one(0, quantity)], quantity.span),
            StartSpec::List(list) => {
                (list.value.iter().enumerate().map(|(at, q)| one(at, q)).collect(), list.span)
            }
            StartSpec::Table(table) => return self.by_name(name, table, model, key),
        };
        if list.len() == needed && needed > 0 {
            return list;
        }
        let what = format!("a {} joint", model.kind.name);
        let message = match needed {
            0 => format!("{what} like `{}` has no coordinates, so it takes no start value", name.value),
            1 => format!("{what} like `{}` has one coordinate, not {}", name.value, list.len()),
            _ => format!("{what} like `{}` starts from {needed} values, not {}", name.value, list.len()),
        };
        let coordinates = model.coordinates().len();
        self.refuse(Code::BadStart, span, message).help(match needed - coordinates {
            0 if needed == 0 => "take it away".to_owned(),
            0 => {
                let first = if needed == 1 { "" } else { "1" };
                format!("give {needed} values, or name them: `{{ q{first} = ... }}`")
            }
            3 if coordinates == 0 => {
                r#"give the three components of the rotation vector: `["0 deg", "0 deg", "30 deg"]`"#
                    .to_owned()
            }
            3 => format!("give {coordinates} coordinates and a rotation vector: three angles"),
            _ => "give a rotation vector and a displacement: three angles, three lengths".to_owned(),
        });
        Vec::new()
    }

    fn by_name<'a>(
        &mut self,
        name: &Name,
        table: &'a At<StartTable>,
        model: &JointModel,
        key: &str,
    ) -> Vec<Written<'a>> {
        let t = &table.value;
        let needed = model.start_values().len();
        let numbered =
            [(&t.q1, &t.v1), (&t.q2, &t.v2), (&t.q3, &t.v3), (&t.q4, &t.v4), (&t.q5, &t.v5), (&t.q6, &t.v6)];
        let mut list: Vec<Written<'a>> = Vec::new();
        let alone = std::iter::once((0, 0, (&t.q, &t.v)));
        let all = alone.chain(numbered.into_iter().enumerate().map(|(index, pair)| (index, index + 1, pair)));
        for (index, number, (position, speed)) in all {
            let Some(span) = position.as_ref().or(speed.as_ref()).map(|quantity| quantity.span) else {
                continue;
            };
            let exists = if number == 0 { needed == 1 } else { number <= needed };
            if !exists || list.iter().any(|written| written.index == index) {
                let message = format!(
                    "[{key}]: a {} joint like `{}` has no such coordinate",
                    model.kind.name, name.value
                );
                let help = match needed {
                    0 => "it takes no start value".to_owned(),
                    1 => "its coordinate is `q`, its speed `v`".to_owned(),
                    n => format!("its coordinates are `q1` to `q{n}`, its speeds `v1` to `v{n}`"),
                };
                self.refuse(Code::BadStart, span, message).help(help);
                continue;
            }
            list.push(Written { index, position: position.as_ref(), speed: speed.as_ref(), span });
        }
        list
    }

    fn start(&mut self, id: JointId, joint: &Joint, written: &Written<'_>, held: bool, what: &str) -> Start {
        let is = joint.model.start_values()[written.index];
        if let Some(position) = written.position {
            self.warn_degrees(position, is, what);
        }
        let position =
            written.position.map(|q| self.formula(q, Some(is.dimension()), Allowed::PARAMETERS, what));
        let speed = written.speed.map(|q| self.formula(q, Some(is.speed()), Allowed::PARAMETERS, what));
        if let Some((written, formula)) = written.speed.zip(speed.as_ref())
            && !formula.is_wrong()
        {
            self.warn_frequency(written, is, what);
        }
        Start { joint: id, coordinate: written.index, position, speed, held, span: written.span }
    }

    fn check_start(&mut self, joint: &Joint, start: &Start, earlier: &[Start]) {
        if let Some(drive) = joint.drives.iter().find(|drive| drive.coordinate == start.coordinate) {
            let message =
                format!("the motion of joint `{}` is prescribed, so it takes no start value", joint.name);
            self.refuse(Code::BadStart, start.span, message)
                .also(drive.law.span, "prescribed here")
                .help("take it away, or put the start into the motion: `drive = \"10 deg + 2*pi*speed*t\"`");
        }
        let same = |other: &&Start| other.joint == start.joint && other.coordinate == start.coordinate;
        if let Some(other) = earlier.iter().find(same) {
            let message = format!("joint `{}` has two start values", joint.name);
            self.refuse(Code::BadStart, start.span, message)
                .label("met exactly")
                .also(other.span, "a guess")
                .help("keep the one in [initial]");
        }
    }

    /// `600 rpm` is 10 1/s here, as `10 Hz` is; whoever writes so for an angular speed means 2 pi times that.
    fn warn_frequency(&mut self, quantity: &Quantity, is: Coordinate, what: &str) {
        let Literal::Text(text) = &quantity.value else { return };
        let text = text.trim();
        if is == Coordinate::Angle && self.turns_of(quantity).of.turns > 0 {
            let message =
                format!("{what}: \"{text}\" is a frequency, and is read as that many radians per second");
            self.refuse(Code::FrequencyAsSpeed, quantity.span, message)
                .help(format!("write \"2*pi*{text}\" if turns are meant, rad/s if not"));
        }
    }

    /// `-48` for an angle is read as radians; whoever writes so means degrees.
    pub(super) fn warn_degrees(&mut self, quantity: &Quantity, is: Coordinate, what: &str) {
        let number = match &quantity.value {
            Literal::Number(number) => *number,
            Literal::Text(text) => text.trim().parse().unwrap_or(0.0),
        };
        if is == Coordinate::Angle && number.abs() > 2.0 * std::f64::consts::PI {
            let message = format!("{what}: the bare number {number} is read as {number} rad");
            self.refuse(Code::LooksLikeDegrees, quantity.span, message)
                .help(format!("write \"{number} deg\" if degrees are meant, \"{number} rad\" if not"));
        }
    }
}
