//! The one namespace: what every name of the file stands for.

use std::collections::HashMap;

use crate::diagnostic::{Code, Diagnostic};
use crate::id::{BodyId, ForceId, JointId, ParameterId, PointId, StateId};
use crate::source::Span;
use crate::spec::{File, Name, Table};

/// Names with a meaning of their own.
const RESERVED: &[(&str, &str)] = &[
    ("t", "the time"),
    ("pi", "the number"),
    ("energy", "a column of the output"),
    ("ground", "the fixed frame"),
];

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Thing {
    Parameter(ParameterId),
    /// Among the parameters, behind them.
    Input(ParameterId),
    Point(PointId),
    Body(BodyId),
    Joint(JointId),
    Coupling,
    Stop,
    Force(ForceId),
    /// A file that is included.
    Part,
    State(StateId),
    /// By its place in the table.
    Sensor(usize),
    /// By its place in the table.
    Controller(usize),
}

impl Thing {
    pub(super) fn what(self) -> &'static str {
        match self {
            Self::Parameter(_) => "parameter",
            Self::Input(_) => "input",
            Self::Point(_) => "point",
            Self::Body(_) => "body",
            Self::Joint(_) => "joint",
            Self::Coupling => "coupling",
            Self::Stop => "stop",
            Self::Force(_) => "force",
            Self::Part => "part",
            Self::State(_) => "state",
            Self::Sensor(_) => "sensor",
            Self::Controller(_) => "controller",
        }
    }

    /// With its article.
    pub(super) fn a(self) -> String {
        let article = if self.what().starts_with('i') { "an" } else { "a" };
        format!("{article} {}", self.what())
    }
}

/// All names, in the order of the tables.
pub(super) struct Names {
    things: Vec<(String, Thing, Span)>,
    by_name: HashMap<String, usize>,
    foreseen: Vec<String>,
    /// Names that the user wrote but that were left out or are given twice: nothing follows from their absence.
    lost: Vec<String>,
}

impl Names {
    pub(super) fn new(lost: &[String]) -> Self {
        Self { things: Vec::new(), by_name: HashMap::new(), foreseen: Vec::new(), lost: lost.to_vec() }
    }

    /// Whether a fault with this name is only the consequence of another.
    pub(super) fn is_lost(&self, name: &str) -> bool {
        self.lost.iter().any(|lost| lost == name || is_inside(name, lost))
    }

    /// Whether the name belongs to something that is not known yet: parameters come before all else.
    pub(super) fn is_foreseen(&self, name: &str) -> bool {
        self.foreseen.iter().any(|known| known == name)
    }

    /// Takes note of all names before anything is resolved: formulas ask whether a word is a name.
    pub(super) fn foresee(&mut self, file: &File) {
        self.foreseen.extend(file.parameters.0.iter().map(|(name, _)| name.value.clone()));
        self.foreseen.extend(file.inputs.0.iter().map(|(name, _)| name.value.clone()));
        self.foreseen.extend(file.points.0.iter().map(|(name, _)| name.value.clone()));
        self.foreseen.extend(file.joints.0.iter().map(|(name, _)| name.value.clone()));
        self.foreseen.extend(file.states.0.iter().map(|(name, _)| name.value.clone()));
        self.foreseen.extend(file.sensors.0.iter().map(|(name, _)| name.value.clone()));
        self.foreseen.extend(file.controllers.0.iter().map(|(name, _)| name.value.clone()));
    }

    /// Whether a word in a formula is a name.
    pub(super) fn is_name(&self, word: &str) -> bool {
        let is_of_lost = || self.lost.iter().any(|lost| is_inside(word, lost));
        word == "t"
            || word == "pi"
            || self.by_name.contains_key(word)
            || self.is_foreseen(word)
            || is_of_lost()
    }

    /// Whether something may be called so: a plain name, perhaps behind that of a part.
    pub(super) fn may_be(&self, name: &str) -> bool {
        match name.rsplit_once('.') {
            Some((part, inner)) => matches!(self.find(part), Some((Thing::Part, _))) && is_name(inner),
            None => is_name(name),
        }
    }

    pub(super) fn declare_all(&mut self, file: &File, faults: &mut Vec<Diagnostic>) {
        self.declare_table(&file.points, |at| Thing::Point(PointId::new(at)), faults);
        self.declare_table(&file.bodies, |at| Thing::Body(BodyId::new(at)), faults);
        self.declare_table(&file.joints, |at| Thing::Joint(JointId::new(at)), faults);
        self.declare_table(&file.couplings, |_| Thing::Coupling, faults);
        self.declare_table(&file.stops, |_| Thing::Stop, faults);
        self.declare_table(&file.forces, |at| Thing::Force(ForceId::new(at)), faults);
        self.declare_table(&file.states, |at| Thing::State(StateId::new(at)), faults);
        self.declare_table(&file.sensors, Thing::Sensor, faults);
        self.declare_table(&file.controllers, Thing::Controller, faults);
        self.foreseen.clear();
    }

    pub(super) fn declare_table<T>(
        &mut self,
        table: &Table<T>,
        thing: impl Fn(usize) -> Thing,
        faults: &mut Vec<Diagnostic>,
    ) {
        for (position, (name, _)) in table.0.iter().enumerate() {
            self.declare(name, thing(position), faults);
        }
    }

    pub(super) fn declare(&mut self, name: &Name, thing: Thing, faults: &mut Vec<Diagnostic>) {
        if !self.may_be(&name.value) {
            faults.push(bad_name(name));
        } else if let Some((_, meaning)) = RESERVED.iter().find(|(reserved, _)| *reserved == name.value) {
            faults.push(
                Diagnostic::new(
                    Code::ReservedName,
                    format!("the name `{}` is reserved: it is {meaning}", name.value),
                )
                .at(name.span, "")
                .help(format!("choose another name for this {}", thing.what())),
            );
        }
        if let Some(earlier) = self.by_name.get(&name.value) {
            let (_, other, span) = &self.things[*earlier];
            let message = format!("the name `{}` is given to {} and to {}", name.value, other.a(), thing.a());
            faults.push(
                Diagnostic::new(Code::DuplicateName, message)
                    .at(name.span, "second")
                    .also(*span, "first")
                    .help("parameters, inputs, points, bodies, joints, couplings, stops, forces, states, sensors, controllers and parts share one set of names"),
            );
            self.lost.push(name.value.clone());
            return;
        }
        self.by_name.insert(name.value.clone(), self.things.len());
        self.things.push((name.value.clone(), thing, name.span));
    }

    pub(super) fn find(&self, name: &str) -> Option<(Thing, Span)> {
        self.by_name.get(name).map(|at| (self.things[*at].1, self.things[*at].2))
    }

    /// Names of things of a kind, in the order of the file.
    pub(super) fn known(&self, wanted: impl Fn(Thing) -> bool) -> impl Iterator<Item = &str> {
        self.things.iter().filter(move |(_, thing, _)| wanted(*thing)).map(|(name, ..)| name.as_str())
    }
}

/// Whether a name is one within a part: `left.R1` in `left`.
fn is_inside(name: &str, part: &str) -> bool {
    name.strip_prefix(part).is_some_and(|rest| rest.starts_with('.'))
}

/// Letters, digits and `_`, a letter first.
pub(super) fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

pub(super) fn bad_name(name: &Name) -> Diagnostic {
    Diagnostic::new(Code::BadName, format!("`{}` cannot be a name", name.value))
        .at(name.span, "")
        .help("names are made of the letters a-z and A-Z, digits and `_`, and start with a letter")
}
