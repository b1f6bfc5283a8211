//! PID controllers as written: gains with the units that fit, limits, the time in which the integral gives way.

use super::super::piecewise::Piecewise;
use super::controllers::Draft;
use super::pid::{Pid, call, over};
use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::id::StateId;
use crate::model::{self, Formula, Term};
use crate::spec::{Dimension, Quantity};

impl Resolver<'_> {
    pub(super) fn pid(&mut self, draft: Draft<'_>) -> Option<Formula> {
        let Draft { name, span, spec, sample_time } = draft;
        let what = |key: &str| place(key, "controller", name);
        let (Some(measured), Some(setpoint)) = (&spec.measured, &spec.setpoint) else {
            let key = if spec.measured.is_none() { "measured" } else { "setpoint" };
            let message = format!("controller `{}` has no `{key}`", name.value);
            self.missing(span, name.span, Code::MissingKey, message).help(
                "write what is controlled and what it should be: `measured = \"shaft.v\"`, `setpoint = \"12 rad/s\"`; or a law of its own, `output`",
            );
            return None;
        };
        let both = [(measured, what("measured")), (setpoint, what("setpoint"))];
        let measured = self.formula(measured, None, Allowed::STATE, &what("measured"));
        if measured.is_wrong() {
            return None;
        }
        let of = measured.dimension;
        let setpoint = self.formula(setpoint, Some(of), Allowed::STATE, &what("setpoint"));
        if self.turns_of(both[0].0).of.differs_from(self.turns_of(both[1].0).of) {
            // One of them counts radians, and is silent.
            let formulas = [&measured, &setpoint];
            both.iter()
                .zip(formulas)
                .for_each(|((written, what), formula)| self.warn_turns_as_angle(written, formula, what));
        }
        let unit = self.unit_of_output(draft, of)?;
        let mut gain = |key: &str, written: &Option<Quantity>, seconds: i32| {
            let per = unit
                .and_then(|unit| unit.over(of))
                .and_then(|unit| unit.times(Dimension::of(0, 0, i8::try_from(seconds).ok()?)));
            written.as_ref().map(|written| self.formula(written, per, Allowed::PARAMETERS, &what(key)))
        };
        let proportional = gain("proportional", &spec.proportional, 0);
        let integral = gain("integral", &spec.integral, -1);
        let derivative = gain("derivative", &spec.derivative, 1);
        let unit = unit?;
        let lag = self.derivative_filter(draft)?;
        let limits = self.controller_limits(draft, unit)?;
        let feedforward = spec.feedforward.as_ref();
        let feedforward = feedforward
            .map(|written| self.formula(written, Some(unit), Allowed::STATE, &what("feedforward")));
        let mut weight = |key: &str, written: &Option<Quantity>, default: f64| {
            let own = written.as_ref();
            own.map_or(Term::Number(default), |own| {
                self.formula(own, Some(Dimension::NONE), Allowed::PARAMETERS, &what(key)).term
            })
        };
        let weights = [
            weight("setpoint_weight", &spec.setpoint_weight, 1.0),
            weight("derivative_weight", &spec.derivative_weight, 0.0),
        ];
        let limited = limits.iter().any(Option::is_some) && integral.is_some();
        let tracking = self.tracking(draft, limited, [&proportional, &integral, &derivative])?;
        let initial = spec.initial.as_ref().map_or_else(
            || Formula::number(0.0, unit),
            |written| self.formula(written, Some(unit), Allowed::PARAMETERS, &what("initial")),
        );
        let term = |formula: Option<Formula>| formula.map(|formula| formula.term);
        // Made first, filled in when it is known what they do.
        let mut state = |suffix: &str, initial: Formula| {
            self.controller_state(format!("{}.{suffix}", name.value), initial, name.span)
        };
        let kept = integral.is_some().then(|| state("integral", initial));
        let filter = lag.is_some().then(|| state("filtered", Formula::number(0.0, of)));
        let value = |own: Option<(StateId, usize)>| own.map(|(id, _)| Term::State(id));
        let action = Pid {
            measured: measured.term.clone(),
            setpoint: setpoint.term,
            proportional: term(proportional),
            integral: term(integral),
            derivative: term(derivative).zip(lag),
            weights,
            feedforward: term(feedforward),
            limits: limits.map(term),
            tracking,
            sample_time,
        }
        .action([value(kept), value(filter)]);
        for (own, does) in [(kept, action.integral), (filter, action.filtered)] {
            let (Some((_, place)), Some(term)) = (own, does) else { continue };
            let state = &mut self.controllers.states[place];
            if sample_time.is_some() {
                state.next = Some(Formula { term, dimension: state.initial.dimension, span: name.span });
            } else {
                (state.rate.term, state.rate.span) = (term, name.span);
            }
        }
        let states = usize::from(kept.is_some()) + usize::from(filter.is_some());
        self.put_out(draft, Formula { term: action.output, dimension: unit, span: name.span }, states)
    }

    /// What a controller puts out, by the first of its gains: outer nothing if it has none, inner if its unit is none.
    fn unit_of_output(&mut self, draft: Draft<'_>, of: Dimension) -> Option<Option<Dimension>> {
        let Draft { name, span, spec, .. } = draft;
        let gains = [
            ("proportional", &spec.proportional, 0),
            ("integral", &spec.integral, 1),
            ("derivative", &spec.derivative, -1),
        ];
        let first = gains.into_iter().find_map(|(key, gain, seconds)| Some((key, gain.as_ref()?, seconds)));
        let Some((key, gain, seconds)) = first else {
            let message = format!("controller `{}` has no gain", name.value);
            self.missing(span, name.span, Code::MissingKey, message)
                .help("add `proportional`, `integral` or `derivative`, the output over the error; or a law of its own, `output`");
            return None;
        };
        let before = self.diagnostics.len();
        let formula = self.formula(gain, None, Allowed::PARAMETERS, &place(key, "controller", name));
        if self.value(&formula).is_nan() {
            return None;
        }
        // It is read once more with the others, and told there.
        self.diagnostics.truncate(before);
        let time = Dimension::of(0, 0, seconds);
        Some(formula.dimension.times(of).and_then(|unit| unit.times(time)))
    }

    /// Time constant of the filter of the derivative; outer nothing if it is wrong.
    fn derivative_filter(&mut self, draft: Draft<'_>) -> Option<Option<Term>> {
        let Draft { name, span, spec, sample_time } = draft;
        let what = place("derivative_filter", "controller", name);
        let lag = spec.derivative_filter.as_ref();
        let lag = lag.map(|written| self.formula(written, Some(Dimension::TIME), Allowed::PARAMETERS, &what));
        let Some(_) = &spec.derivative else {
            if let Some(lag) = lag {
                let message =
                    format!("controller `{}` has `derivative_filter`, but no `derivative`", name.value);
                self.refuse(Code::ConflictingKeys, lag.span, message)
                    .help("take it away, or add `derivative`");
            }
            return Some(None);
        };
        match lag {
            Some(lag) => {
                self.check_positive(&lag, sample_time.is_some(), &what);
                Some(Some(lag.term))
            }
            None if sample_time.is_some() => Some(Some(Term::Number(0.0))),
            None => {
                let message =
                    format!("controller `{}` has `derivative`, but no `derivative_filter`", name.value);
                self.missing(span, name.span, Code::MissingKey, message).help(
                    "no machine takes a rate without a lag: add `derivative_filter = \"2 ms\"`; or let a joint's speed be fed back, `feedforward = \"-gain*shaft.v\"`",
                );
                None
            }
        }
    }

    pub(super) fn controller_limits(
        &mut self,
        draft: Draft<'_>,
        unit: Dimension,
    ) -> Option<[Option<Formula>; 2]> {
        let Draft { name, spec, .. } = draft;
        let mut limit = |key: &str, written: &Option<Quantity>| {
            let own = written.as_ref();
            own.map(|own| self.formula(own, Some(unit), Allowed::STATE, &place(key, "controller", name)))
        };
        let limits = [limit("lower", &spec.lower), limit("upper", &spec.upper)];
        if let [Some(lower), Some(upper)] = &limits
            && self.value(lower) >= self.value(upper)
        {
            let [least, most] = [lower, upper].map(|limit| self.told(limit));
            let message = format!(
                "controller `{}`: `lower` is {least}, which is not below `upper`, {most}",
                name.value
            );
            self.refuse(Code::BadController, lower.span, message)
                .help("the output stays between them: swap them, or mind the signs");
            return None;
        }
        Some(limits)
    }

    /// In what time the integral gives way; outer nothing if it is wrong.
    fn tracking(
        &mut self,
        draft: Draft<'_>,
        limited: bool,
        [proportional, integral, derivative]: [&Option<Formula>; 3],
    ) -> Option<Option<Term>> {
        let Draft { name, span, spec, sample_time } = draft;
        let what = place("tracking", "controller", name);
        if let Some(written) = &spec.tracking {
            let tracking = self.formula(written, Some(Dimension::TIME), Allowed::PARAMETERS, &what);
            self.check_positive(&tracking, false, &what);
            if !limited {
                let message = format!(
                    "controller `{}` has `tracking`, but no integral that a limit holds up",
                    name.value
                );
                self.refuse(Code::ConflictingKeys, written.span, message)
                    .help("take it away, or add `integral` and `lower` or `upper`");
                return None;
            }
            let value = self.value(&tracking);
            if let Some(least) = sample_time.filter(|least| value > 0.0 && value < 0.999 * *least) {
                let message = format!("{what} is {value} s, less than `sample_time`, {least} s");
                self.refuse(Code::BadController, written.span, message)
                    .help("in one sample the integral gives way once: the shortest time is `sample_time`");
                return None;
            }
            return Some(Some(tracking.term));
        }
        let Some(integral) = integral.as_ref().filter(|_| limited) else { return Some(None) };
        let size = |gain: &Option<Formula>| gain.as_ref().map_or(0.0, |gain| self.value(gain));
        let ratio = |gain: &Option<Formula>| {
            let gain = gain.as_ref()?;
            Some(over(gain.term.clone(), integral.term.clone()))
        };
        // The reset time, or where there is a derivative the mean of both times of the controller.
        let found = if size(derivative) / self.value(integral) > 0.0 {
            ratio(derivative).map(|square| Term::Call(model::Function::Sqrt, vec![square]))
        } else if size(proportional) / self.value(integral) > 0.0 {
            ratio(proportional)
        } else {
            None
        };
        if found.is_none() {
            let message = format!(
                "controller `{}` has limits, and no time in which its integral gives way",
                name.value
            );
            self.missing(span, name.span, Code::MissingKey, message)
                .help("add `tracking = \"50 ms\"`: it follows from the gains where integral and proportional gain have one sign");
            return None;
        }
        let least = sample_time.map(Term::Number);
        Some(found.map(|time| match least {
            Some(least) => call(Piecewise::Max, [time, least]),
            None => time,
        }))
    }
}
