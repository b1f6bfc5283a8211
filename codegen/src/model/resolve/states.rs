//! State variables of the file's own: their start values and their rates.

use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::model::{Formula, StateVariable};
use crate::spec::{Dimension, StateSpec, Table};

impl Resolver<'_> {
    /// Start values, from which formulas know the dimensions of states.
    pub(super) fn declare_states(&mut self, table: &Table<StateSpec>) {
        for (name, state) in &table.0 {
            let initial = state.value.initial.as_ref().map_or_else(
                || Formula::number(0.0, Dimension::NONE),
                |initial| self.formula(initial, None, Allowed::PARAMETERS, &place("initial", "state", name)),
            );
            let known = self.value(&initial).is_finite();
            let turning = state.value.initial.as_ref().map(|initial| self.turns_of(initial).of);
            self.state_turning.push(turning.unwrap_or_default());
            self.states.push(known.then_some(initial));
        }
    }

    pub(super) fn resolve_states(&mut self, table: &Table<StateSpec>) -> Vec<StateVariable> {
        let mut states = Vec::with_capacity(table.0.len());
        for (at, (name, state)) in table.0.iter().enumerate() {
            let Some(rate) = &state.value.rate else {
                let message = format!("the state `{}` has no rate", name.value);
                self.missing(state.span, name.span, Code::MissingKey, message)
                    .help(r#"add `rate = "..."`, its change per second"#);
                continue;
            };
            let Some(initial) = self.states[at].clone() else { continue };
            let per_second = initial.dimension.over(Dimension::TIME);
            let rate = self.formula(rate, per_second, Allowed::STATE, &place("rate", "state", name));
            states.push(StateVariable {
                name: name.value.clone(),
                initial,
                rate,
                next: None,
                span: name.span,
            });
        }
        states
    }
}
