//! Springs of spherical joints: elastic mounts that are stiff against rotation alone.

use super::inertia;
use super::joints::by_key;
use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::model::{Coordinate, Force, Formula, Joint, Term};
use crate::source::Span;
use crate::spec::{Dimension, ELASTIC, JointSpec, Name, Quantity, SpringPart, SpringSpec, Table};

/// Numbers of an elastic mount by axis, before its matrices: stiffness, damping, both for rotations, preload of both.
const BY_AXIS: usize = 18;
/// With the matrices.
const ALL: usize = BY_AXIS + 72;

impl Resolver<'_> {
    /// One for every spherical joint with a spring.
    pub(super) fn ball_springs(&mut self, table: &Table<JointSpec>, joints: &[Joint]) -> Vec<Force> {
        let mut forces = Vec::new();
        for ((name, written), joint) in table.0.iter().zip(joints) {
            let Some(spring) = written
                .value
                .spring
                .as_ref()
                .filter(|_| joint.model.is_ball() || joint.model.is_driven_ball())
            else {
                continue;
            };
            let [stiffness, preload] = self.ball_spring((name, written.span), spring);
            let mut formulas = vec![Formula::number(0.0, Dimension::NONE); ALL];
            formulas[6..9].clone_from_slice(&stiffness);
            formulas[15..BY_AXIS].clone_from_slice(&preload);
            let mut force = Force::new(ELASTIC, [joint.parent, joint.child], [joint.at; 2], formulas);
            force.name.clone_from(&name.value);
            force.directions = inertia::AXES_OF_W;
            force.of_joint = true;
            force.span = name.span;
            forces.push(force);
        }
        forces
    }

    /// Stiffness, and preload with what rest angles add to it, by component of the rotation vector.
    fn ball_spring(&mut self, (name, whole): (&Name, Span), spring: &SpringSpec) -> [[Formula; 3]; 2] {
        let what = place("spring", "joint", name);
        let torque = |value: f64| Formula::number(value, Dimension::TORQUE);
        let mut found = [[0.0; 3], [0.0; 3]].map(|list| list.map(torque));
        let parts: Vec<_> = by_key([&spring.q, &spring.q1, &spring.q2, &spring.q3]).collect();
        if let Some(stiffness) = &spring.stiffness {
            if let Some((_, part)) = parts.first() {
                let message = format!("{what} has one `stiffness`, and others by component");
                self.refuse(Code::ConflictingKeys, part.span, message).help("keep one of them");
            }
            found[0] = [0, 1, 2]
                .map(|_| self.formula(stiffness, Some(Dimension::TORQUE), Allowed::PARAMETERS, &what));
        }
        for written in [&spring.rest, &spring.preload].into_iter().flatten() {
            let message = format!("{what}: a rotation has three components");
            self.refuse(Code::NoSuchCoordinate, written.span, message)
                .help("say which: `spring = { q3 = { stiffness = \"5 N m/rad\", rest = \"10 deg\" } }`");
        }
        if spring.stiffness.is_none() && parts.is_empty() {
            let message = format!("{what} has no `stiffness`");
            self.lacking(whole, name.span, "stiffness", message).help("add `stiffness = \"50 N m/rad\"`");
        }
        for (key, part) in parts {
            let Some(component) = ["q1", "q2", "q3"].iter().position(|known| *known == key) else {
                let message = format!("{what}: a rotation has the components `q1` to `q3`, not `{key}`");
                self.refuse(Code::NoSuchCoordinate, part.span, message)
                    .help("they are those of its start value: about x, y and z of the ground");
                continue;
            };
            let SpringPart { stiffness, rest, preload } = &part.value;
            let Some(stiffness) = stiffness else {
                self.lacking(part.span, part.span, "stiffness", format!("{what} has no `stiffness`"))
                    .help("add `stiffness = \"50 N m/rad\"`");
                continue;
            };
            let mut read = |quantity: &Quantity, dimension| {
                self.formula(quantity, Some(dimension), Allowed::PARAMETERS, &what)
            };
            let stiffness = read(stiffness, Dimension::TORQUE);
            if let Some(preload) = preload {
                found[1][component] = read(preload, Dimension::TORQUE);
            }
            if let Some(rest) = rest {
                let turned = read(rest, Dimension::NONE);
                self.warn_degrees(rest, Coordinate::Angle, &what);
                let product = Term::Mul(Box::new(stiffness.term.clone()), Box::new(turned.term));
                let own = &mut found[1][component];
                own.term = Term::Sub(Box::new(own.term.clone()), Box::new(product));
            }
            found[0][component] = stiffness;
        }
        for formula in &found[0] {
            self.check_positive(formula, true, &what);
        }
        found
    }
}
