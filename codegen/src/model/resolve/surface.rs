//! Where the point of a joint may be, as seen from a point of the parent: at a distance, or on a surface.

use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::id::PointId;
use crate::model::{Carrier, Formula, Function, Surface, Term};
use crate::spec::{At, Dimension, JointSpec, Name, Quantity};

impl Resolver<'_> {
    /// What a joint of such a kind demands; nothing if it is wrong and reported.
    pub(super) fn surface(
        &mut self,
        name: &Name,
        joint: &At<JointSpec>,
        sides: Option<[(Carrier, &Name); 2]>,
    ) -> Option<Surface> {
        let spec = &joint.value;
        let Some(origin) = &spec.origin else {
            let message =
                format!("joint `{}` does not say from which point of its parent it sees `at`", name.value);
            self.missing(joint.span, name.span, Code::MissingKey, message)
                .help("add `origin = \"O\"`, a point of the first body");
            return None;
        };
        let [parent, child] = sides?;
        let origin = self.point_on(origin, Some(parent), &format!("joint `{}`", name.value))?;
        let equation = if spec.distance.is_some() {
            let at = spec.at.as_ref()?;
            let at = self.point_on(at, Some(child), &format!("joint `{}`", name.value))?;
            self.sphere(name, spec.length.as_ref(), [(origin, parent.0), (at, child.0)])?
        } else if let Some(equation) = &spec.equation {
            let what = place("equation", "joint", name);
            let formula = self.formula(equation, Some(Dimension::LENGTH), Allowed::PLACE, &what);
            self.check_smooth(&formula, &what);
            let mut seen = false;
            formula.term.visit(&mut |term| seen |= matches!(term, Term::Place(_)));
            let wrong = matches!(formula.term, Term::Number(value) if value.is_nan());
            if !seen && !wrong {
                let message = format!("{what} does not depend on the place: it has no direction to push in");
                self.refuse(Code::ZeroAxis, equation.span, message)
                    .help("write it over `x`, `y` and `z`, for example `sqrt(x^2 + y^2) - 30 mm`");
                return None;
            }
            formula
        } else {
            let message = format!("joint `{}` has no `equation`", name.value);
            self.missing(joint.span, name.span, Code::MissingKey, message)
                .help("add for example `equation = \"sqrt(x^2 + y^2) - 30 mm\"`, a length that is zero on the surface");
            return None;
        };
        Some(Surface { origin, equation })
    }

    /// `sqrt(x² + y² + z²)` less the length, which is that of the drawing by default.
    fn sphere(
        &mut self,
        name: &Name,
        length: Option<&Quantity>,
        ends: [(PointId, Carrier); 2],
    ) -> Option<Formula> {
        let length = match length {
            Some(written) => {
                let what = place("length", "joint", name);
                let length = self.formula(written, Some(Dimension::LENGTH), Allowed::PARAMETERS, &what);
                self.check_positive(&length, false, &what);
                length
            }
            None => {
                let [from, to] =
                    ends.map(|(point, side)| self.points[point.index()].position_for(side).clone());
                let apart = [0, 1, 2]
                    .map(|i| Term::Sub(Box::new(to[i].term.clone()), Box::new(from[i].term.clone())));
                let length = Formula { term: norm(apart), dimension: Dimension::LENGTH, span: name.span };
                if self.value(&length) == 0.0 {
                    let message =
                        format!("the points of the distance joint `{}` are one point as drawn", name.value);
                    self.refuse(Code::ZeroLength, name.span, message)
                        .help("give its `length`, or take a `spherical` joint");
                    return None;
                }
                length
            }
        };
        let term = Term::Sub(Box::new(norm([0, 1, 2].map(Term::Place))), Box::new(length.term.clone()));
        Some(Formula { term, ..length })
    }
}

fn norm(components: [Term; 3]) -> Term {
    let [x, y, z] = components.map(|component| Box::new(Term::Power(Box::new(component), 2)));
    Term::Call(Function::Sqrt, vec![Term::Add(Box::new(Term::Add(x, y)), z)])
}
