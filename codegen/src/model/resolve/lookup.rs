//! Names of the file as ids, or a fault that says what was meant.

use super::names::Thing;
use super::resolver::Resolver;
use crate::diagnostic::{Code, Diagnostic};
use crate::id::{JointId, PointId};
use crate::model::Carrier;
use crate::spec::Name;

impl Resolver<'_> {
    /// Reports a name that nothing has, or that something of another kind has.
    fn report_name(&mut self, name: &Name, wanted: &str, used_by: &str, fits: impl Fn(Thing) -> bool) {
        if self.names.is_lost(&name.value) {
            return;
        }
        let diagnostic = match self.names.find(&name.value) {
            Some((thing, span)) => {
                let message =
                    format!("{used_by} needs a {wanted}, but `{}` is a {}", name.value, thing.what());
                Diagnostic::new(Code::WrongKindOfName, message).at(name.span, "").also(span, "declared here")
            }
            None => {
                let message = format!("{used_by} names the {wanted} `{}`, which does not exist", name.value);
                let ground = (wanted == "body").then_some("ground");
                let known = self.names.known(fits).chain(ground);
                Diagnostic::new(Code::UnknownName, message)
                    .at(name.span, format!("unknown {wanted}"))
                    .did_you_mean(&name.value, known)
            }
        };
        self.report(diagnostic);
    }

    /// The body (or ground) with this name.
    pub(super) fn carrier(&mut self, name: &Name, used_by: &str) -> Option<Carrier> {
        if name.value == "ground" {
            return Some(Carrier::Ground);
        }
        if let Some((Thing::Body(id), _)) = self.names.find(&name.value) {
            return Some(Carrier::Body(id));
        }
        self.report_name(name, "body", used_by, |thing| matches!(thing, Thing::Body(_)));
        None
    }

    /// The point with this name.
    pub(super) fn point_named(&mut self, name: &Name, used_by: &str) -> Option<PointId> {
        if let Some((Thing::Point(id), _)) = self.names.find(&name.value) {
            return Some(id);
        }
        self.report_name(name, "point", used_by, |thing| matches!(thing, Thing::Point(_)));
        None
    }

    /// The joint with this name.
    pub(super) fn joint_named(&mut self, name: &Name, used_by: &str) -> Option<JointId> {
        if let Some((Thing::Joint(id), _)) = self.names.find(&name.value) {
            return Some(id);
        }
        self.report_name(name, "joint", used_by, |thing| matches!(thing, Thing::Joint(_)));
        None
    }
}
