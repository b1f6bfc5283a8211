//! Controllers with a law of a file's own at sampled times: states, what becomes of them, what is put out.

use super::controllers::Draft;
use super::names::{bad_name, is_name};
use super::pid::limited;
use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::model::Formula;
use crate::spec::Dimension;

impl Resolver<'_> {
    pub(super) fn own_law(&mut self, draft: Draft<'_>) -> Option<Formula> {
        let Draft { name, span, spec, sample_time } = draft;
        let law = ["output", "states", "lower", "upper", "sample_time", "delay", "assumed", "doc"];
        for (key, place) in spec.written() {
            if !law.contains(&key) {
                let message = format!("controller `{}` has a law of its own and `{key}`", name.value);
                self.refuse(Code::ConflictingKeys, place, message)
                    .help("keep `output` and `states`, or the keys of a PID controller");
                return None;
            }
        }
        if sample_time.is_none() {
            let message = format!("controller `{}` has a law of its own, but no `sample_time`", name.value);
            self.missing(span, name.span, Code::BadController, message)
                .help("add `sample_time = \"1 ms\"`; a law that acts all the time is made of [states] and [sensors]");
            return None;
        }
        let Some(written) = &spec.output else {
            let message = format!("controller `{}` has states, but no `output`", name.value);
            self.missing(span, name.span, Code::MissingKey, message)
                .help("add `output = \"...\"`, a formula over its states and all that a force may depend on");
            return None;
        };
        let first = self.controllers.states.len();
        for (own, state) in &spec.states.0 {
            if !is_name(&own.value) {
                self.report(bad_name(own));
                return None;
            }
            let what = place("initial", "state", own);
            let initial = state.value.initial.as_ref().map_or_else(
                || Formula::number(0.0, Dimension::NONE),
                |initial| self.formula(initial, None, Allowed::PARAMETERS, &what),
            );
            let (id, _) = self.controller_state(format!("{}.{}", name.value, own.value), initial, own.span);
            if let Some(known) = self.controllers.known.last_mut() {
                known.states.push((own.value.clone(), id));
            }
        }
        for (at, (own, state)) in spec.states.0.iter().enumerate() {
            let Some(next) = &state.value.next else {
                let message =
                    format!("the state `{}` of controller `{}` has no `next`", own.value, name.value);
                self.missing(state.span, own.span, Code::MissingKey, message)
                    .help(r#"add `next = "..."`, its value from the next sample on"#);
                return None;
            };
            let dimension = self.controllers.states[first + at].initial.dimension;
            let next = self.formula(next, Some(dimension), Allowed::STATE, &place("next", "state", own));
            self.controllers.states[first + at].next = Some(next);
        }
        let output = self.formula(written, None, Allowed::STATE, &place("output", "controller", name));
        let limits = self.controller_limits(draft, output.dimension)?;
        let limits = limits.map(|limit| limit.map(|limit| limit.term));
        let term = limited(output.term.clone(), limits);
        self.put_out(draft, Formula { term, ..output }, spec.states.0.len())
    }
}
