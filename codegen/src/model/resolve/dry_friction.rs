//! Dry friction of joints: its numbers, and the joints that can have it.

use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::model::{Coordinate, DryFriction, Formula, JointModel, Passive};
use crate::spec::{Dimension, JointSpec, Name, Quantity};

/// Speed within which friction changes its sign, unless the file says otherwise [rad/s] and [m/s].
const ONSET: [f64; 2] = [1e-2, 1e-3];

impl Resolver<'_> {
    pub(super) fn dry_friction(
        &mut self,
        name: &Name,
        spec: &JointSpec,
        model: &JointModel,
    ) -> Option<Passive> {
        let written = spec.dry_friction.as_ref()?;
        let what = place("dry_friction", "joint", name);
        let (is_hinge, kind) = (model.is_hinge(), model.kind.name);
        if !(is_hinge || model.is_guide()) {
            self.refuse(Code::NoSuchCoordinate, written.span, format!("{what}: not for a {kind} joint"))
                .help("revolute and prismatic joints can have dry friction; others take `force` with a formula over `Fx`, `Fy`, `Fz`");
            return None;
        }
        let spec = &written.value;
        let Some(coefficient) = &spec.coefficient else {
            self.missing(
                written.span,
                written.span,
                Code::MissingKey,
                format!("{what} has no `coefficient`"),
            )
            .help("add `coefficient = 0.1`");
            return None;
        };
        let is = if is_hinge { Coordinate::Angle } else { Coordinate::Length };
        let coefficient = self.friction_number(coefficient, Dimension::NONE, true, &what);
        let at_rest = match &spec.at_rest {
            Some(at_rest) => self.friction_number(at_rest, Dimension::NONE, true, &what),
            None => coefficient.clone(),
        };
        let mut positive = |written: &Option<Quantity>, dimension| {
            written.as_ref().map(|quantity| self.friction_number(quantity, dimension, false, &what))
        };
        let stribeck_speed = positive(&spec.stribeck_speed, is.speed());
        let default = Formula::number(ONSET[usize::from(!is_hinge)], is.speed());
        let onset = positive(&spec.onset, is.speed()).unwrap_or(default);
        let radius = positive(&spec.radius, Dimension::LENGTH);
        let length = positive(&spec.length, Dimension::LENGTH);
        let speeds = [(&spec.stribeck_speed, stribeck_speed.as_ref()), (&spec.onset, Some(&onset))];
        for (written, formula) in speeds.into_iter().filter(|_| is_hinge) {
            if let (Some(written), Some(formula)) = (written, formula) {
                self.warn_turns_as_angle(written, formula, &what);
            }
        }
        if spec.at_rest.is_some() != stribeck_speed.is_some() {
            let message = format!("{what}: `at_rest` and `stribeck_speed` say something only together");
            self.missing(written.span, written.span, Code::MissingKey, message)
                .help("give both: the coefficient falls from `at_rest` to `coefficient` by `stribeck_speed`");
        }
        match (is_hinge, &spec.radius) {
            (true, None) => {
                let message = format!("{what} of a revolute joint needs the `radius` of its bearing");
                self.missing(written.span, written.span, Code::MissingKey, message)
                    .help("add `radius = \"10 mm\"`");
            }
            (false, Some(radius)) => {
                let message = format!("{what}: a prismatic joint has no `radius`");
                self.refuse(Code::ConflictingKeys, radius.span, message).help("take it away");
            }
            _ => {}
        }
        let friction = DryFriction { coefficient, at_rest, stribeck_speed, onset, radius, length };
        Some(Passive::DryFriction(Box::new(friction)))
    }

    fn friction_number(
        &mut self,
        written: &Quantity,
        dimension: Dimension,
        zero_allowed: bool,
        what: &str,
    ) -> Formula {
        let formula = self.formula(written, Some(dimension), Allowed::PARAMETERS, what);
        self.check_positive(&formula, zero_allowed, what);
        formula
    }
}
