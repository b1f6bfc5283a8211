//! Controllers: from the keys of `[controllers]` to states and formulas, which their names stand for. What it puts out at sampled times
//! is a state that is held between them.

use super::known_controllers::{Controller, Controllers};
use super::quantity::{Allowed, Here, Resolved};
use super::resolver::{Resolver, place};
use super::responses::Member;
use crate::diagnostic::{Code, Severity};
use crate::id::StateId;
use crate::model::{self, Formula, Sampler, StateVariable, Term};
use crate::source::Span;
use crate::spec::{At, ControllerSpec, Dimension, Name, Quantity, Table, Turning};

/// A controller that is being read.
#[derive(Clone, Copy)]
pub(super) struct Draft<'a> {
    pub(super) name: &'a Name,
    pub(super) span: Span,
    pub(super) spec: &'a ControllerSpec,
    /// From sample to sample [s]; nothing of one that acts all the time.
    pub(super) sample_time: Option<f64>,
}

impl Resolver<'_> {
    /// All of them, from the first on: each may ask for those above it.
    pub(super) fn resolve_controllers(&mut self, table: &Table<ControllerSpec>) {
        for (name, own) in &table.0 {
            self.controllers.known.push(Controller {
                name: name.value.clone(),
                output: None,
                states: Vec::new(),
            });
            let first = self.states.len();
            let output = self.controller(name, own);
            let states = &self.controllers.states;
            let own_names = states.iter().skip(states.len() + first - self.states.len()).enumerate();
            let prefix = format!("{}.", name.value);
            let named = own_names.filter_map(|(at, state)| {
                Some((state.name.strip_prefix(&prefix)?.to_owned(), StateId::new(first + at)))
            });
            let named = named.collect();
            if let Some(known) = self.controllers.known.last_mut() {
                (known.output, known.states) = (output, named);
            }
        }
    }

    /// What is left of them when all formulas are read: their states, their samples, and what those put out that are no state.
    pub(super) fn take_controllers(&mut self) -> (Vec<StateVariable>, Vec<Sampler>, Vec<model::Sensor>) {
        let Controllers { known, states, samplers } = std::mem::take(&mut self.controllers);
        let outputs = known.into_iter().filter_map(|own| Some((own.name, own.output?)));
        let continuous = outputs.filter(|(_, output)| !matches!(output.term, Term::State(_)));
        let columns = continuous
            .map(|(name, value)| model::Sensor { name, value, turning: Turning::default() })
            .collect();
        (states, samplers, columns)
    }

    /// What the name of a controller stands for.
    pub(super) fn controller_term(&mut self, name: &str, at: usize, here: Here<'_>) -> Resolved {
        if at + 1 < self.controllers.known.len()
            || (at < self.controllers.known.len() && !self.reading_controller)
        {
            let output = self.controllers.known[at].output.as_ref()?;
            return Some((output.term.clone(), output.dimension));
        }
        if at + 1 == self.controllers.known.len() {
            let message = format!("the controller `{name}` asks for what it puts out itself");
            self.refuse_in(here, Code::BadController, &message)
                .help("keep what it needs in a state of its own: `states = { last = { next = \"...\" } }`");
            return None;
        }
        let message = format!("the controller `{name}` acts later");
        self.refuse_in(here, Code::BadController, &message).help(
            "controllers act in the order of the file, after the sensors: a controller can use those above it, a sensor none. Move it up; of two that ask for each other, let one follow the other with a lag, by a state in [states]",
        );
        None
    }

    /// A state of a controller.
    pub(super) fn controller_member(&self, at: usize, member: &str) -> Option<Member> {
        let own = self.controllers.known.get(at)?;
        if let Some((_, id)) = own.states.iter().find(|(known, _)| known == member) {
            let dimension = self.states.get(id.index())?.as_ref()?.dimension;
            return Some(Ok((Term::State(*id), dimension)));
        }
        // Of one that is wrong nobody knows its states.
        own.output.as_ref().or(self.reading_controller.then_some(&Formula::number(0.0, Dimension::NONE)))?;
        let names: Vec<String> = own.states.iter().map(|(name, _)| format!("`{name}`")).collect();
        Some(Err(match &names[..] {
            [] => "this controller has no states; its name stands for what it puts out".to_owned(),
            _ => format!("its states are {}; its name stands for what it puts out", names.join(", ")),
        }))
    }

    fn controller(&mut self, name: &Name, own: &At<ControllerSpec>) -> Option<Formula> {
        let spec = &own.value;
        let mut draft = Draft { name, span: own.span, spec, sample_time: None };
        draft.sample_time = match &spec.sample_time {
            Some(written) => Some(self.sample_time(draft, written)?),
            None => None,
        };
        if spec.delay && draft.sample_time.is_none() {
            let message = format!("controller `{}` has `delay`, but no `sample_time`", name.value);
            self.missing(own.span, name.span, Code::BadController, message)
                .help("a delay is one sample: add `sample_time = \"1 ms\"`, or take `delay` away");
            return None;
        }
        let before = self.diagnostics.len();
        self.reading_controller = true;
        let output = if spec.output.is_some() || !spec.states.0.is_empty() {
            self.own_law(draft)
        } else {
            self.pid(draft)
        };
        self.reading_controller = false;
        // Nothing follows from one that is wrong.
        let wrong = self.diagnostics[before..].iter().any(|fault| fault.severity == Severity::Error);
        output.filter(|_| !wrong)
    }

    fn sample_time(&mut self, draft: Draft<'_>, written: &Quantity) -> Option<f64> {
        let what = place("sample_time", "controller", draft.name);
        let formula = self.formula(written, Some(Dimension::TIME), Allowed::CONSTANTS, &what);
        let value = self.value(&formula);
        if value > 0.0 {
            return Some(value);
        }
        if value <= 0.0 {
            let message = format!("{what} is {}: it would act all the time at once", self.told(&formula));
            self.refuse(Code::BadController, written.span, message)
                .help("write the time from sample to sample, such as \"1 ms\"; without it the controller acts all the time");
        }
        None
    }

    /// What a controller puts out, `states` of it being made: at sampled times a state more, with a delay two.
    pub(super) fn put_out(&mut self, draft: Draft<'_>, output: Formula, states: usize) -> Option<Formula> {
        let Draft { name, spec, sample_time, .. } = draft;
        let Some(sample_time) = sample_time else { return Some(output) };
        let first = self.states.len() - states;
        let dimension = output.dimension;
        let mut hold = |suffix: &str, next: Formula| {
            let initial = Formula::number(0.0, dimension);
            let (id, place) = self.controller_state(format!("{}{suffix}", name.value), initial, name.span);
            self.controllers.states[place].next = Some(next);
            Formula { term: Term::State(id), dimension, span: name.span }
        };
        let held = if spec.delay {
            let pending = hold(".pending", output);
            hold("", pending)
        } else {
            hold("", output)
        };
        self.controllers.samplers.push(Sampler { sample_time, states: first..self.states.len() });
        Some(held)
    }

    /// A state of a controller that does nothing yet; its place among those of controllers.
    pub(super) fn controller_state(
        &mut self,
        name: String,
        initial: Formula,
        span: Span,
    ) -> (StateId, usize) {
        let (id, place) = (StateId::new(self.states.len()), self.controllers.states.len());
        self.states.push(Some(initial.clone()));
        let rate = Formula::number(0.0, initial.dimension.over(Dimension::TIME).unwrap_or_default());
        self.controllers.states.push(StateVariable { name, initial, rate, next: None, span });
        (id, place)
    }
}
