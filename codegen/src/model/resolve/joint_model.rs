//! What kind a joint is, and its axes.

use super::inertia;
use super::lookup::enumerated;
use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::{Code, Severity};
use crate::model::{Axis, AxisKeys, JOINT_KINDS, JointKind, JointModel, PlaceKey};
use crate::spec::{At, ByCoordinate, Dimension, JointSpec, Name, PerBody, Triple};

/// An axis in place of one that is wrong.
const DUMMY: [f64; 3] = [0.0, 0.0, 1.0];

impl Resolver<'_> {
    pub(super) fn joint_model(&mut self, name: &Name, joint: &At<JointSpec>) -> JointModel {
        let spec = &joint.value;
        let mut written = spec.kinds();
        let Some((key, _)) = written.next() else {
            let message = format!("nothing says what kind of joint `{}` is", name.value);
            self.missing(joint.span, name.span, Code::NoKind, message).help(format!(
                "write for example `revolute = [\"ground\", \"crank\"]`; kinds are {}",
                all_kinds()
            ));
            return JointModel::stand_in();
        };
        if let Some((other, _)) = written.next() {
            let message = format!("joint `{}` is both {key} and {other}", name.value);
            self.refuse(Code::ConflictingKeys, name.span, message).help("make two joints of it");
        }
        let mut model = JointModel::new(key, &[]);
        if model.is_ball() && matches!(spec.drive, Some(ByCoordinate::Each(_))) {
            self.check_stray_axes(name, &model, spec);
            return JointModel::driven_ball();
        }
        self.check_stray_axes(name, &model, spec);
        model.axes = match model.kind.axes {
            AxisKeys::None => Vec::new(),
            AxisKeys::Axis => vec![self.main_axis(name, model.kind, joint)],
            AxisKeys::AxisAndFirst => {
                let normal = self.main_axis(name, model.kind, joint);
                let first = self.first_direction(name, (joint, model.kind), normal);
                vec![normal, first]
            }
            AxisKeys::Axes => self.two_axes(name, joint),
        };
        if model.thread().is_some() {
            model.lead = self.lead(name, joint);
        }
        model
    }

    fn check_stray_axes(&mut self, name: &Name, model: &JointModel, spec: &JointSpec) {
        let (kind, keys) = (model.kind.name, model.kind.axes);
        let has_axis = matches!(keys, AxisKeys::Axis | AxisKeys::AxisAndFirst);
        for (key, span) in spec.written() {
            let fits = match key {
                "axis" => has_axis,
                "axes" => keys == AxisKeys::Axes,
                "first" => keys == AxisKeys::AxisAndFirst,
                "lead" => model.thread().is_some(),
                "origin" => model.holds_place(),
                "length" => model.kind.place == PlaceKey::Length,
                "equation" => model.kind.place == PlaceKey::Equation,
                _ => true,
            };
            if !fits {
                let message = format!("a {kind} joint has no `{key}`");
                let help = match (key, keys) {
                    ("axis", AxisKeys::Axes) => {
                        format!("a {kind} joint has two: `axes = [[1, 0, 0], [0, 1, 0]]`")
                    }
                    ("lead", _) => "a rotation with proportional translation is a `screw`".to_owned(),
                    _ => "take it away".to_owned(),
                };
                self.refuse(Code::ConflictingKeys, span, message)
                    .label(format!("in joint `{}`", name.value))
                    .help(help);
            }
        }
    }

    fn main_axis(&mut self, name: &Name, kind: &JointKind, joint: &At<JointSpec>) -> Axis {
        if let Some(axis) = &joint.value.axis {
            return self.axis(axis, &joint.value, &place("axis", "joint", name));
        }
        let help = if kind.axes == AxisKeys::AxisAndFirst {
            "add `axis = [0, 0, 1]`, the normal of the plane"
        } else {
            "add `axis = [0, 0, 1]`, its direction in the ground frame at the reference pose"
        };
        let message = format!("the {} joint `{}` has no `axis`", kind.name, name.value);
        self.missing(joint.span, name.span, Code::MissingKey, message).help(help);
        Axis::both(DUMMY)
    }

    /// A direction for both branches, or one for each.
    fn axis(&mut self, written: &PerBody, spec: &JointSpec, what: &str) -> Axis {
        match written {
            PerBody::Shared(triple) => {
                let direction = self.direction(triple, what).unwrap_or(DUMMY);
                Axis::both(direction)
            }
            PerBody::Each(table) => {
                let bodies = spec.kinds().next().map(|(_, pair)| pair.0.value.as_slice()).unwrap_or_default();
                let mut found = [None, None];
                for (body, triple) in &table.0 {
                    let direction = self.direction(&triple.value, what).unwrap_or(DUMMY);
                    match bodies.iter().position(|known| known.value == body.value) {
                        Some(side @ (0 | 1)) => found[side] = Some(direction),
                        _ => {
                            let message =
                                format!("{what} names `{}`, which the joint does not connect", body.value);
                            let known = bodies.iter().map(|name| name.value.as_str());
                            self.refuse(Code::UnknownName, body.span, message)
                                .did_you_mean(&body.value, known);
                        }
                    }
                }
                if let (Some((first, _)), true) = (table.0.first(), found.contains(&None)) {
                    let message = format!("{what} is given for one body only");
                    self.refuse(Code::MissingKey, first.span, message)
                        .help("give it for both bodies, or once for both as a list");
                }
                Axis { parent: found[0].unwrap_or(DUMMY), child: found[1].unwrap_or(DUMMY) }
            }
        }
    }

    /// A direction of any length. Components are pure numbers, or quantities of one dimension.
    pub(super) fn direction(&mut self, written: &Triple, what: &str) -> Option<[f64; 3]> {
        let items = &written.0.value;
        if items.len() != 3 {
            self.wrong_count(written.0.span, items.len(), "3", what);
            return None;
        }
        let mut dimension: Option<Dimension> = None;
        let mut components = [0.0; 3];
        for (component, item) in components.iter_mut().zip(items) {
            // A bare zero fits every dimension.
            let formula = self.formula(item, None, Allowed::CONSTANTS, what);
            *component = self.value(&formula);
            if component.is_nan() || *component == 0.0 && formula.dimension == Dimension::NONE {
                continue;
            }
            let first = *dimension.get_or_insert(formula.dimension);
            if first != formula.dimension {
                let message =
                    format!("{what} mixes {} and {}", first.description(), formula.dimension.description());
                self.refuse(Code::UnitMismatch, item.span, message)
                    .help("give all three in one unit, or without");
                return None;
            }
        }
        if components.iter().any(|x| x.is_nan()) {
            return None;
        }
        let direction = inertia::unit(components);
        if direction.is_none() {
            let message = format!("{what} is zero and has no direction");
            self.refuse(Code::ZeroAxis, written.0.span, message)
                .help("write for example `[0, 0, 1]`; the length does not matter");
        }
        direction
    }

    fn two_axes(&mut self, name: &Name, joint: &At<JointSpec>) -> Vec<Axis> {
        let dummies = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Axis::both).to_vec();
        let what = place("axes", "joint", name);
        let Some(axes) = &joint.value.axes else {
            let message = format!("the universal joint `{}` has no `axes`", name.value);
            self.missing(joint.span, name.span, Code::MissingKey, message).help(
                "add `axes = [[1, 0, 0], [0, 1, 0]]`: the first is fixed in the parent, the second in the \
                 child",
            );
            return dummies;
        };
        let [first, second] = axes.value.as_slice() else {
            self.wrong_count(axes.span, axes.value.len(), "2 directions", &what);
            return dummies;
        };
        let (first, second) = (self.axis(first, &joint.value, &what), self.axis(second, &joint.value, &what));
        let sides = [(first.parent, second.parent), (first.child, second.child)];
        // 1e-6: nearer than that to parallel, the joint's cross has no plane but rounding.
        if sides.iter().any(|(a, b)| inertia::distance([0.0; 3], inertia::cross(*a, *b)) < 1e-6) {
            let message = format!("the two axes of the universal joint `{}` are parallel", name.value);
            self.refuse(Code::ParallelAxes, axes.span, message).help(
                "they are the two bars of the cross, usually at right angles; for one axis use `revolute`",
            );
        }
        vec![first, second]
    }

    fn lead(&mut self, name: &Name, joint: &At<JointSpec>) -> f64 {
        let Some(lead) = &joint.value.lead else {
            let message = format!("the screw joint `{}` has no `lead`", name.value);
            self.missing(joint.span, name.span, Code::MissingKey, message)
                .help("add `lead = \"5 mm\"`, the advance per turn; negative for a left-hand thread");
            return f64::NAN;
        };
        let formula =
            self.formula(lead, Some(Dimension::LENGTH), Allowed::CONSTANTS, &place("lead", "joint", name));
        let value = self.value(&formula);
        if value == 0.0 {
            let message = format!("the screw joint `{}` does not advance", name.value);
            self.refuse(Code::ZeroLead, lead.span, message).help("without advance it is a `revolute` joint");
        }
        value
    }

    /// Direction of `q1` of a planar joint or of a slot, made to be in the plane.
    fn first_direction(
        &mut self,
        name: &Name,
        (joint, kind): (&At<JointSpec>, &JointKind),
        normal: Axis,
    ) -> Axis {
        let what = place("first", "joint", name);
        let Some(written) = &joint.value.first else {
            if kind.needs_first() {
                let message = format!("the {} joint `{}` has no `first`", kind.name, name.value);
                self.missing(joint.span, name.span, Code::MissingKey, message)
                    .help("add `first = [1, 0, 0]`, the direction of the slot at the reference pose");
            } else if normal.parent != normal.child {
                let message = format!(
                    "joint `{}` has a normal for each body, so it needs `first` for each too",
                    name.value
                );
                self.missing(joint.span, name.span, Code::MissingKey, message).help(
                    "add `first = { crank = [1, 0, 0], ... }`, a direction in the plane as each body sees it",
                );
            }
            let default = inertia::any_perpendicular(normal.parent);
            return Axis::both(default);
        };
        let errors = |resolver: &Self| {
            resolver.diagnostics.iter().filter(|found| found.severity == Severity::Error).count()
        };
        let known = errors(self);
        let first = self.axis(written, &joint.value, &what);
        // What is wrong already is told there.
        if errors(self) > known {
            return Axis::both(inertia::any_perpendicular(normal.parent));
        }
        let mut in_plane = |direction: [f64; 3], normal: [f64; 3]| {
            let across = inertia::perpendicular_part(direction, normal);
            // As for universal joints.
            if inertia::distance([0.0; 3], across) < 1e-6 {
                let message = format!("{what} points along the normal of the plane");
                self.refuse(Code::ParallelAxes, written.span(), message)
                    .help("it is the direction of `q1`, in the plane");
            }
            inertia::unit(across).unwrap_or(DUMMY)
        };
        let parent = in_plane(first.parent, normal.parent);
        let same = first.parent == first.child && normal.parent == normal.child;
        let child = if same { parent } else { in_plane(first.child, normal.child) };
        Axis { parent, child }
    }
}

/// The keys of all kinds, as a list in a sentence.
fn all_kinds() -> String {
    let names: Vec<&str> = JOINT_KINDS.iter().map(|kind| kind.name).collect();
    enumerated(&names, " and ")
}
