//! End stops: coordinate, limits and law; and whether anything starts beyond them.

use super::names::Thing;
use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::id::JointId;
use crate::model::{Coordinate, Formula, Joint, Start, Stop, StopLoss};
use crate::source::Span;
use crate::spec::{At, Dimension, Name, Quantity, StopSpec, Table};

/// Speed below which a stop damps in proportion to the speed, unless the file says otherwise [m/s]: that of joints with
/// clearance; of an angle the same at a radius of 0.1 m [rad/s].
const FLOOR: f64 = linkwear_runtime::contact::IMPACT_SPEED_FLOOR;
const ANGULAR_FLOOR: f64 = 10.0 * FLOOR;

/// A stop that is being resolved.
struct Draft<'a> {
    name: &'a Name,
    span: Span,
    spec: &'a StopSpec,
    is: Coordinate,
}

impl Resolver<'_> {
    pub(super) fn resolve_stops(
        &mut self,
        table: &Table<StopSpec>,
        joints: &[Joint],
        starts: &[Start],
    ) -> Vec<Stop> {
        let mut stops: Vec<Stop> = Vec::with_capacity(table.0.len());
        for (name, written) in &table.0 {
            let Some((joint, coordinate)) = self.stopped_coordinate(name, written) else { continue };
            let Some(model) = self.joint_models.get(joint.index()) else { continue };
            let is = model.coordinates()[coordinate];
            let draft = Draft { name, span: written.span, spec: &written.value, is };
            let Some(stop) = self.stop(&draft, joint, coordinate) else { continue };
            self.check_beyond(&stop, joints, starts);
            stops.push(stop);
        }
        stops
    }

    fn stopped_coordinate(&mut self, name: &Name, written: &At<StopSpec>) -> Option<(JointId, usize)> {
        let what = format!("stop `{}`", name.value);
        let Some(key) = &written.value.joint else {
            let message = format!("{what} does not say which joint it stops");
            self.missing(written.span, name.span, Code::MissingKey, message)
                .help("add `joint = \"slide\"`; of a joint with several coordinates `joint = \"C.q2\"`");
            return None;
        };
        // Joints of parts have a point in their names.
        let is_joint = matches!(self.names.find(&key.value), Some((Thing::Joint(_), _)));
        let parts = key.value.rsplit_once('.').filter(|_| !is_joint);
        let (joint_name, coordinate) = parts.unwrap_or((&key.value, ""));
        let joint = self.joint_named(&Name { span: key.span, value: joint_name.to_owned() }, &what)?;
        let model = self.joint_models.get(joint.index())?.clone();
        let coordinates = model.coordinates().len();
        if coordinate.is_empty() && coordinates > 1 {
            let message = format!("{what}: a {} joint has {coordinates} coordinates", model.kind.name);
            let joint = &key.value;
            self.refuse(Code::NoSuchCoordinate, key.span, message)
                .help(format!("say which: `joint = \"{joint}.q1\"`, or make a stop for each"));
            return None;
        }
        if model.stands_in {
            return None;
        }
        if coordinates == 0 {
            let message = format!("{what}: a {} joint has no coordinate to stop", model.kind.name);
            self.refuse(Code::NoSuchCoordinate, key.span, message)
                .help("stops are for angles and lengths of joints that have them: revolute, prismatic, cylindrical, universal, planar, slot and the like");
            return None;
        }
        if coordinates == 1 && !["", "q", "q1"].contains(&coordinate) {
            let message = format!("{what}: a {} joint has only the coordinate `q`", model.kind.name);
            self.refuse(Code::NoSuchCoordinate, key.span, message)
                .help(format!("write `joint = \"{joint_name}\"`"));
            return None;
        }
        Some((joint, self.coordinate(coordinate, &model, key.span, &what)?))
    }

    fn stop(&mut self, draft: &Draft<'_>, joint: JointId, coordinate: usize) -> Option<Stop> {
        let Draft { name, span, spec, is } = *draft;
        let limits = self.limits(draft)?;
        let Some(stiffness) = &spec.stiffness else {
            let message = format!("stop `{}` has no `stiffness`", name.value);
            let help = format!("add `stiffness = \"1e6 {}\"`", is.stiffness().si_unit());
            self.missing(span, name.span, Code::MissingKey, message).help(help);
            return None;
        };
        let what = place("stiffness", "stop", name);
        let stiffness = self.formula(stiffness, Some(is.stiffness()), Allowed::PARAMETERS, &what);
        self.check_positive(&stiffness, false, &what);
        Some(Stop {
            name: name.value.clone(),
            joint,
            coordinate,
            angular: is == Coordinate::Angle,
            limits,
            stiffness,
            power: self.power(draft)?,
            loss: self.loss(draft)?,
            span: name.span,
        })
    }

    fn limits(&mut self, draft: &Draft<'_>) -> Option<[Option<Formula>; 2]> {
        let Draft { name, span, spec, is } = *draft;
        let mut limit = |key: &str, written: &Option<Quantity>| {
            let what = place(key, "stop", name);
            let written = written.as_ref()?;
            self.warn_degrees(written, is, &what);
            Some(self.formula(written, Some(is.dimension()), Allowed::PARAMETERS, &what))
        };
        let limits = [limit("lower", &spec.lower), limit("upper", &spec.upper)];
        match &limits {
            [None, None] => {
                let message = format!("stop `{}` has neither `lower` nor `upper`", name.value);
                let example = if is == Coordinate::Angle { "30 deg" } else { "120 mm" };
                self.missing(span, name.span, Code::MissingKey, message)
                    .help(format!("add `upper = \"{example}\"`, where the coordinate meets the stop"));
                None
            }
            [Some(lower), Some(upper)] if self.value(lower) >= self.value(upper) => {
                let [least, most] = [lower, upper].map(|limit| self.told(limit));
                let message =
                    format!("stop `{}`: `lower` is {least}, which is not below `upper`, {most}", name.value);
                self.refuse(Code::BadStop, lower.span, message)
                    .help("the coordinate is free between them: swap them, or mind the signs");
                None
            }
            _ => Some(limits),
        }
    }

    /// Exponent and the depth that it is for; nothing for a linear stop.
    fn power(&mut self, draft: &Draft<'_>) -> Option<Option<(f64, f64)>> {
        let Draft { name, span, spec, is } = *draft;
        let exponent = self.stop_number(draft, "exponent", &spec.exponent, Dimension::NONE, 1.0);
        if exponent < 1.0 {
            let message = format!("`exponent` of stop `{}` is {exponent}", name.value);
            let at = spec.exponent.as_ref().map_or(name.span, |written| written.span);
            self.refuse(Code::BadStop, at, message)
                .help("it is at least 1: 1 for a spring, 1.5 for a ball on a plate");
            return None;
        }
        let depth = self.stop_number(draft, "depth", &spec.depth, is.dimension(), f64::NAN);
        if exponent == 1.0 {
            return Some(None);
        }
        if spec.depth.is_none() {
            let message = format!("stop `{}` has an `exponent`, but no `depth`", name.value);
            let example = if is == Coordinate::Angle { "1 deg" } else { "0.1 mm" };
            self.missing(span, name.span, Code::MissingKey, message)
                .help(format!("add `depth = \"{example}\"`, at which force over depth is `stiffness`"));
            return None;
        }
        Some(Some((exponent, depth)))
    }

    fn loss(&mut self, draft: &Draft<'_>) -> Option<StopLoss> {
        let Draft { name, span, spec, is } = *draft;
        if let Some(damping) = &spec.damping {
            let others = [
                ("restitution", spec.restitution.as_ref().map(|written| written.span)),
                ("law", spec.law.as_ref().map(|law| law.span)),
                ("impact_speed", spec.impact_speed.as_ref().map(|written| written.span)),
                ("impact_speed_floor", spec.impact_speed_floor.as_ref().map(|written| written.span)),
            ];
            if let Some((key, at)) = others.into_iter().find_map(|(key, span)| Some((key, span?))) {
                let message = format!("stop `{}` has `damping`, and `{key}` besides", name.value);
                self.refuse(Code::ConflictingKeys, at, message)
                    .help("give `damping`, or `restitution` with its law: both say what an impact loses");
                return None;
            }
            let what = place("damping", "stop", name);
            let damping = self.formula(damping, Some(is.damping()), Allowed::PARAMETERS, &what);
            self.check_positive(&damping, true, &what);
            return Some(StopLoss::Damping(damping));
        }
        let restitution = self.restitution(draft)?;
        let Some(law) = &spec.law else {
            if let Some(speed) = &spec.impact_speed {
                let message = format!("stop `{}` has an `impact_speed`, but no `law`", name.value);
                self.refuse(Code::ConflictingKeys, speed.span, message)
                    .help("without `law` the restitution holds at any speed: take it away, or add a `law`");
                return None;
            }
            let default = if is == Coordinate::Angle { ANGULAR_FLOOR } else { FLOOR };
            let floor = self.stop_speed(draft, "impact_speed_floor", &spec.impact_speed_floor, default)?;
            let returned = restitution * restitution;
            return Some(if returned == 1.0 {
                StopLoss::None
            } else {
                StopLoss::Hysteresis { returned, floor }
            });
        };
        if let Some(floor) = &spec.impact_speed_floor {
            let message = format!("`impact_speed_floor` means nothing for the law of stop `{}`", name.value);
            self.refuse(Code::ConflictingKeys, floor.span, message)
                .help("take it away, or take `law` and `impact_speed` away");
            return None;
        }
        if spec.impact_speed.is_none() {
            let message = format!("the law of stop `{}` needs an `impact_speed`", name.value);
            let example = if is == Coordinate::Angle { "5 rad/s" } else { "0.5 m/s" };
            self.missing(span, name.span, Code::MissingKey, message).help(format!(
                "add `impact_speed = \"{example}\"`, at which the restitution holds, or take `law` away: without it the restitution holds at any speed"
            ));
            return None;
        }
        let impact_speed = self.stop_speed(draft, "impact_speed", &spec.impact_speed, f64::NAN)?;
        match law.value.0.damping_factor(restitution) {
            Ok(factor) => Some(StopLoss::BySpeed { factor, impact_speed }),
            Err(fault) => {
                let at = spec.restitution.as_ref().map_or(name.span, |written| written.span);
                let message = format!("`restitution` of stop `{}`: {fault}", name.value);
                self.refuse(Code::BadStop, at, message).help("take a larger one, or another `law`");
                None
            }
        }
    }

    fn restitution(&mut self, draft: &Draft<'_>) -> Option<f64> {
        let Draft { name, spec, .. } = *draft;
        let Some(written) = &spec.restitution else { return Some(1.0) };
        let what = place("restitution", "stop", name);
        let formula = self.formula(written, Some(Dimension::NONE), Allowed::CONSTANTS, &what);
        let value = self.value(&formula);
        if (0.0..=1.0).contains(&value) {
            return Some(value);
        }
        if value.is_finite() {
            self.refuse(Code::BadStop, written.span, format!("{what} is {value}"))
                .help("it lies between 0, nothing comes back, and 1, nothing is lost");
        }
        None
    }

    /// A number fixed at generation and above zero.
    fn stop_number(
        &mut self,
        draft: &Draft<'_>,
        key: &str,
        written: &Option<Quantity>,
        dimension: Dimension,
        default: f64,
    ) -> f64 {
        let Some(written) = written else { return default };
        let what = place(key, "stop", draft.name);
        let formula = self.formula(written, Some(dimension), Allowed::CONSTANTS, &what);
        self.check_positive(&formula, false, &what);
        self.value(&formula)
    }

    fn stop_speed(
        &mut self,
        draft: &Draft<'_>,
        key: &str,
        written: &Option<Quantity>,
        default: f64,
    ) -> Option<Formula> {
        let dimension = draft.is.speed();
        let Some(written) = written else { return Some(Formula::number(default, dimension)) };
        let what = place(key, "stop", draft.name);
        let formula = self.formula(written, Some(dimension), Allowed::PARAMETERS, &what);
        if draft.is == Coordinate::Angle {
            self.warn_turns_as_angle(written, &formula, &what);
        }
        self.check_positive(&formula, false, &what);
        (self.value(&formula) > 0.0).then_some(formula)
    }

    /// Reports a start value or a drive that begins beyond the stop.
    fn check_beyond(&mut self, stop: &Stop, joints: &[Joint], starts: &[Start]) {
        let own =
            |start: &&Start| start.held && (start.joint, start.coordinate) == (stop.joint, stop.coordinate);
        let started = starts.iter().find(own).and_then(|start| start.position.as_ref());
        let drives = &joints[stop.joint.index()].drives;
        let driven = drives.iter().find(|drive| drive.coordinate == stop.coordinate).map(|drive| &drive.law);
        let Some(formula) = started.or(driven) else { return };
        let Some(position) = formula.value_at_time(&self.values, 0.0) else { return };
        let values = stop.limits.each_ref().map(|limit| limit.as_ref().map(|limit| self.value(limit)));
        let Some(passed) = stop.passed(position, values, 0.0) else { return };
        let message = stop.starts_beyond(&joints[stop.joint.index()].name, position, passed);
        self.refuse(Code::BadStop, formula.span, message)
            .also(stop.span, "stopped here")
            .help(Stop::START_BETWEEN);
    }
}
