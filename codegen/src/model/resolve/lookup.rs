//! Names of the file as ids, or a fault that says what was meant.

use super::names::Thing;
use super::resolver::Resolver;
use crate::diagnostic::{Code, Diagnostic};
use crate::id::{JointId, ParameterId, PointId};
use crate::model::Carrier;
use crate::spec::Name;

/// Names that a message lists at most.
const LISTED: usize = 12;

impl Resolver<'_> {
    /// What `pick` finds in the thing with this name; a name that nothing has, or something of another kind, is reported.
    fn named<T>(
        &mut self,
        name: &Name,
        wanted: &str,
        used_by: &str,
        pick: fn(Thing) -> Option<T>,
    ) -> Option<T> {
        let found = self.names.find(&name.value);
        if let Some(picked) = found.and_then(|(thing, _)| pick(thing)) {
            return Some(picked);
        }
        if self.names.is_lost(&name.value) {
            return None;
        }
        if let Some((thing, span)) = found {
            let message = format!("{used_by} needs a {wanted}, but `{}` is {}", name.value, thing.a());
            let known = self.listed(pick, wanted);
            self.refuse(Code::WrongKindOfName, name.span, message).also(span, "declared here").help(known);
            return None;
        }
        let message = format!("{used_by} names the {wanted} `{}`, which does not exist", name.value);
        let ground = (wanted == "body").then_some("ground");
        let known = self.names.known(|thing| pick(thing).is_some()).chain(ground);
        let mut fault = Diagnostic::new(Code::UnknownName, message)
            .at(name.span, format!("unknown {wanted}"))
            .did_you_mean(&name.value, known);
        if fault.help.is_empty() {
            fault = fault.help(self.listed(pick, wanted));
        }
        self.report(fault);
        None
    }

    /// The names that would do.
    fn listed<T>(&self, pick: fn(Thing) -> Option<T>, wanted: &str) -> String {
        let ground = (wanted == "body").then_some("ground");
        let known = self.names.known(|thing| pick(thing).is_some()).chain(ground);
        let listed: Vec<_> = known.take(LISTED).map(|name| format!("`{name}`")).collect();
        if listed.is_empty() {
            format!("there is no {wanted} yet")
        } else {
            format!("there are: {}", listed.join(", "))
        }
    }

    /// The body (or ground) with this name.
    pub(super) fn carrier(&mut self, name: &Name, used_by: &str) -> Option<Carrier> {
        if name.value == "ground" {
            return Some(Carrier::Ground);
        }
        self.named(name, "body", used_by, |thing| match thing {
            Thing::Body(id) => Some(Carrier::Body(id)),
            _ => None,
        })
    }

    /// The point with this name.
    pub(super) fn point_named(&mut self, name: &Name, used_by: &str) -> Option<PointId> {
        self.named(name, "point", used_by, |thing| if let Thing::Point(id) = thing { Some(id) } else { None })
    }

    /// The parameter or input with this name.
    pub(super) fn parameter_named(&mut self, name: &Name, used_by: &str) -> Option<ParameterId> {
        self.named(name, "parameter", used_by, |thing| match thing {
            Thing::Parameter(id) | Thing::Input(id) => Some(id),
            _ => None,
        })
    }

    /// The joint with this name.
    pub(super) fn joint_named(&mut self, name: &Name, used_by: &str) -> Option<JointId> {
        self.named(name, "joint", used_by, |thing| if let Thing::Joint(id) = thing { Some(id) } else { None })
    }
}

/// As a list in a sentence: "a, b or c".
pub(super) fn enumerated(texts: &[impl AsRef<str>], last: &str) -> String {
    let mut sentence = String::new();
    for (at, text) in texts.iter().enumerate() {
        let between = if at == 0 {
            ""
        } else if at + 1 < texts.len() {
            ", "
        } else {
            last
        };
        sentence.push_str(between);
        sentence.push_str(text.as_ref());
    }
    sentence
}
