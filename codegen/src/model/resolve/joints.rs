//! Joints: which bodies and point, motion laws, damping, springs and actuators.

use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::id::PointId;
use crate::model::{Carrier, Coordinate, Drive, Formula, Joint, JointModel, Passive, Term};
use crate::source::Span;
use crate::spec::{At, ByCoordinate, JointSpec, Name, Pair, Quantity, SpringPart, SpringSpec, Table};

impl Resolver<'_> {
    pub(super) fn resolve_joints(&mut self, table: &Table<JointSpec>) -> Vec<Joint> {
        let mut joints = Vec::with_capacity(table.0.len());
        for ((name, joint), model) in table.0.iter().zip(self.joint_models.clone()) {
            let spec = &joint.value;
            let bodies = spec.kinds().next().map(|(_, pair)| self.bodies_of(name, pair));
            let sides = bodies.flatten();
            let at = self.joint_point(name, joint, sides);
            let (parent, child) = sides.map_or((Carrier::Ground, Carrier::Ground), |[(a, _), (b, _)]| (a, b));
            let surface = if model.holds_place() { self.surface(name, joint, sides) } else { None };
            joints.push(Joint {
                name: name.value.clone(),
                parent,
                child,
                at: at.unwrap_or(PointId::new(0)),
                surface: surface.map(Box::new),
                cut: spec.cut.as_ref().is_some_and(|cut| cut.value),
                drives: self.drives(name, spec, &model),
                passive: self.passive(name, joint, &model),
                clearance: None,
                model,
                span: name.span,
            });
        }
        joints
    }

    fn bodies_of<'n>(&mut self, name: &Name, pair: &'n Pair) -> Option<[(Carrier, &'n Name); 2]> {
        let what = format!("joint `{}`", name.value);
        let [parent, child] = pair.0.value.as_slice() else {
            self.wrong_count(pair.0.span, pair.0.value.len(), "2 bodies, the parent first", &what);
            return None;
        };
        let (a, b) = (self.carrier(parent, &what), self.carrier(child, &what));
        let (a, b) = (a?, b?);
        if a == b {
            let message = format!("joint `{}` connects `{}` with itself", name.value, parent.value);
            self.refuse(Code::SameBody, pair.0.span, message)
                .help("name two bodies; `ground` is the fixed one");
        }
        Some([(a, parent), (b, child)])
    }

    fn joint_point(
        &mut self,
        name: &Name,
        joint: &At<JointSpec>,
        sides: Option<[(Carrier, &Name); 2]>,
    ) -> Option<PointId> {
        let Some(at) = &joint.value.at else {
            let message = format!("joint `{}` does not say where it is", name.value);
            self.missing(joint.span, name.span, Code::MissingKey, message)
                .help("add `at = \"A\"`, a point of [points]");
            return None;
        };
        let what = format!("joint `{}`", name.value);
        let Some([parent, child]) = sides else { return self.point_named(at, &what) };
        if joint.value.origin.is_some() {
            // The parent has a point of its own.
            return self.point_on(at, Some(child), &what);
        }
        let point = self.point_on(at, Some(parent), &what)?;
        self.point_on(at, Some(child), &what);
        Some(point)
    }

    fn drives(&mut self, name: &Name, spec: &JointSpec, model: &JointModel) -> Vec<Drive> {
        let what = place("drive", "joint", name);
        if let (true, Some(drive)) = (model.is_ball(), &spec.drive) {
            let span = match drive {
                ByCoordinate::One(law) => law.span,
                ByCoordinate::Each(each) => each.span,
            };
            self.refuse(Code::NoSuchCoordinate, span, format!("{what}: a rotation has three angles")).help(
                "say all: `drive = { q1 = \"..\", q2 = \"..\", q3 = \"..\" }`, about x, the turned y and the twice turned z",
            );
            return Vec::new();
        }
        let laws = self.by_coordinate(spec.drive.as_ref(), model, &what);
        if model.is_driven_ball() && laws.len() < 3 {
            let given = laws.first().map_or(name.span, |(_, law)| law.span);
            self.refuse(Code::MissingKey, given, format!("{what}: the rotation of a ball is prescribed by three angles"))
                .help("add the others, 0 if need be; a joint that turns about one or two axes is `revolute` or `universal`");
        }
        laws.into_iter()
            .map(|(coordinate, law)| {
                let is = model.coordinates()[coordinate];
                let formula = self.formula(law, Some(is.dimension()), Allowed::TIME, &what);
                if is == Coordinate::Angle {
                    self.warn_turns_as_angle(law, &formula, &what);
                }
                self.check_smooth(&formula, &what);
                Drive { coordinate, law: formula }
            })
            .collect()
    }

    /// The forces of a drive and of a surface come from its second derivative: its value and slope must not jump.
    pub(super) fn check_smooth(&mut self, law: &Formula, what: &str) {
        let inputs: Vec<bool> = self.parameters.iter().map(|parameter| parameter.input).collect();
        let (order, function) = law.term.continuity(&|leaf| match leaf {
            Term::Time | Term::Place(_) => true,
            Term::Parameter(id) => inputs[id.index()],
            _ => false,
        });
        if order < 1 {
            let jumps = if order < 0 { "position" } else { "speed" };
            let message = format!("{what}: the {jumps} would jump, by `{function}` of what moves");
            self.refuse(Code::NotSmooth, law.span, message).help(
                "use `smooth_step`, `smooth_abs` or a motion law: `cycloidal(t/T)`, `poly345(t/T)`, `trapezoid(t/T)`",
            );
        }
    }

    fn passive(&mut self, name: &Name, joint: &At<JointSpec>, model: &JointModel) -> Vec<Passive> {
        let (spec, mut passive) = (&joint.value, Vec::new());
        if model.is_driven_ball() {
            let others = [("damping", &spec.damping), ("friction", &spec.friction), ("force", &spec.force)];
            for (key, written) in others {
                let Some(written) = written else { continue };
                let span = match written {
                    ByCoordinate::One(quantity) => quantity.span,
                    ByCoordinate::Each(each) => each.span,
                };
                let message = format!("joint `{}` has a drive and `{key}`", name.value);
                self.refuse(Code::ConflictingKeys, span, message)
                    .help("the drive of a ball moves it whatever else acts: take it away, or write a torque in [forces], which the drive then carries");
            }
            return passive;
        }
        for (key, written) in [("damping", &spec.damping), ("friction", &spec.friction)] {
            let what = place(key, "joint", name);
            if let (true, Some(ByCoordinate::One(quantity))) = (model.is_ball(), written) {
                // The one law that a joint without scalar coordinates can have: against the relative angular velocity.
                passive.push(self.damping(0, Coordinate::Angle, quantity, &what));
                continue;
            }
            for (coordinate, quantity) in self.by_coordinate(written.as_ref(), model, &what) {
                passive.push(self.damping(coordinate, model.coordinates()[coordinate], quantity, &what));
            }
        }
        // Those of a spherical joint are force elements.
        if let (Some(spring), false) = (&spec.spring, model.is_ball()) {
            self.springs((name, joint.span), spring, model, &mut passive);
        }
        passive.extend(self.dry_friction(name, spec, model));
        let what = place("force", "joint", name);
        for (coordinate, force) in self.by_coordinate(spec.force.as_ref(), model, &what) {
            let dimension = model.coordinates()[coordinate].force();
            let force = self.formula(force, Some(dimension), Allowed::STATE, &what);
            passive.push(Passive::Actuator { coordinate, force });
        }
        passive
    }

    fn damping(&mut self, coordinate: usize, is: Coordinate, quantity: &Quantity, what: &str) -> Passive {
        let coefficient = self.formula(quantity, Some(is.damping()), Allowed::PARAMETERS, what);
        self.check_positive(&coefficient, true, what);
        Passive::Damping { coordinate, coefficient }
    }

    fn springs(
        &mut self,
        (name, whole): (&Name, Span),
        spring: &SpringSpec,
        model: &JointModel,
        passive: &mut Vec<Passive>,
    ) {
        let what = place("spring", "joint", name);
        let parts = by_key([&spring.q, &spring.q1, &spring.q2, &spring.q3]);
        let mut written: Vec<(&str, [&Option<Quantity>; 3], Span)> = parts
            .map(|(key, part)| {
                let SpringPart { stiffness, rest, preload } = &part.value;
                (key, [stiffness, rest, preload], part.span)
            })
            .collect();
        let own = [&spring.stiffness, &spring.rest, &spring.preload];
        let first = own.into_iter().flatten().next();
        if first.is_some() || written.is_empty() {
            written.insert(0, ("", own, first.map_or(name.span, |quantity| quantity.span)));
        }
        for (key, [stiffness, rest, preload], span) in written {
            let Some(coordinate) = self.coordinate(key, model, span, &what) else { continue };
            let is = model.coordinates()[coordinate];
            let Some(stiffness) = stiffness else {
                self.lacking(whole, span, "stiffness", format!("{what} has no `stiffness`"))
                    .help(format!("add `stiffness = \"50 {}\"`", is.stiffness().si_unit()));
                continue;
            };
            let stiffness = self.formula(stiffness, Some(is.stiffness()), Allowed::PARAMETERS, &what);
            self.warn_pushing(&stiffness, &place("stiffness", "the spring of joint", name));
            let rest = match rest {
                Some(rest) => {
                    self.warn_degrees(rest, is, &what);
                    self.formula(rest, Some(is.dimension()), Allowed::PARAMETERS, &what)
                }
                None => Formula::number(0.0, is.dimension()),
            };
            let preload = match preload {
                Some(preload) => self.formula(preload, Some(is.force()), Allowed::PARAMETERS, &what),
                None => Formula::number(0.0, is.force()),
            };
            passive.push(Passive::Spring { coordinate, stiffness, rest, preload });
        }
    }

    /// Quantities with the coordinate that each is for.
    fn by_coordinate<'q>(
        &mut self,
        written: Option<&'q ByCoordinate>,
        model: &JointModel,
        what: &str,
    ) -> Vec<(usize, &'q Quantity)> {
        let list: Vec<(&str, &Quantity)> = match written {
            None => Vec::new(),
            Some(ByCoordinate::One(quantity)) => vec![("", quantity)],
            Some(ByCoordinate::Each(each)) => {
                let own = &each.value;
                by_key([&own.q, &own.q1, &own.q2, &own.q3]).collect()
            }
        };
        let mut found: Vec<(usize, &Quantity)> = Vec::new();
        for (key, quantity) in list {
            let Some(coordinate) = self.coordinate(key, model, quantity.span, what) else { continue };
            if found.iter().any(|(earlier, _)| *earlier == coordinate) {
                let message = format!("{what} is given twice for one coordinate");
                self.refuse(Code::ConflictingKeys, quantity.span, message);
                continue;
            }
            found.push((coordinate, quantity));
        }
        found
    }

    /// The coordinate that `key` names: none, `q`, or `q1` to `q3`.
    pub(super) fn coordinate(
        &mut self,
        key: &str,
        model: &JointModel,
        span: Span,
        what: &str,
    ) -> Option<usize> {
        let count = model.coordinates().len();
        let number = key.strip_prefix('q').and_then(|number| number.parse::<usize>().ok());
        let found = match number {
            None if count == 1 => Some(0),
            Some(number) if number <= count => number.checked_sub(1),
            _ => None,
        };
        // Which coordinates a joint has whose kind is not known, nobody can say.
        if found.is_some() || model.stands_in {
            return found;
        }
        let kind_name = model.kind.name;
        let (message, help) = match (count, number) {
            (0, _) => (
                format!("{what}: a {kind_name} joint has no coordinate for it"),
                if model.is_ball() {
                    "a spherical joint can have `damping`, one value, and a `spring`; other torques go into [forces]"
                } else {
                    "forces between the bodies go into [forces]"
                }
                .to_owned(),
            ),
            (1, _) => (
                format!("{what}: a {kind_name} joint has only the coordinate `q`"),
                "write the value alone".into(),
            ),
            (_, None) => (
                format!("{what}: a {kind_name} joint has {count} coordinates"),
                match count {
                    2 => "say which: `{ q1 = \"...\", q2 = \"...\" }`".to_owned(),
                    _ => "say which: `{ q1 = \"...\", q2 = \"...\", q3 = \"...\" }`".to_owned(),
                },
            ),
            (_, Some(_)) => (
                format!("{what}: a {kind_name} joint has no `{key}`"),
                format!("its coordinates are `q1` to `q{count}`"),
            ),
        };
        self.refuse(Code::NoSuchCoordinate, span, message).help(help);
        None
    }
}

/// What is written for coordinates, with the key of each.
pub(super) fn by_key<T>(parts: [&Option<T>; 4]) -> impl Iterator<Item = (&'static str, &T)> {
    let named = ["q", "q1", "q2", "q3"].into_iter().zip(parts);
    named.filter_map(|(key, part)| Some((key, part.as_ref()?)))
}
