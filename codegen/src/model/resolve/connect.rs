//! Whether there are bodies at all, and whether joints connect each of them to the ground.

use std::collections::HashSet;

use super::resolver::Resolver;
use crate::diagnostic::{Code, Diagnostic};
use crate::id::BodyId;
use crate::model::{Carrier, Joint};
use crate::source::Span;
use crate::spec::File;

impl Resolver<'_> {
    pub(super) fn check_connected(&mut self, file: &File, joints: &[Joint]) {
        let bodies = &file.bodies.0;
        // Cells that could not be made, or a part that could not be read, may be all the bodies there are.
        let not_made =
            |fault: &Diagnostic| matches!(fault.code, Code::BadRepeat | Code::TooLarge | Code::BadInclude);
        if bodies.is_empty() && !self.diagnostics.iter().any(not_made) {
            let message = "the mechanism has no bodies";
            self.missing(self.whole_file(), Span::default(), Code::EmptyMechanism, message).help(
                r#"add a table [bodies], for example `crank = { rod = ["O", "A"], radius = "6 mm", density = "7850 kg/m^3" }`"#,
            );
            return;
        }
        // A wrong joint would make its bodies look lost too.
        if self.has_errors() {
            return;
        }
        let mut reached = HashSet::from([Carrier::Ground]);
        while let Some(next) = joints.iter().find_map(|joint| {
            let (parent, child) = (joint.parent, joint.child);
            match (reached.contains(&parent), reached.contains(&child)) {
                (true, false) => Some(child),
                (false, true) => Some(parent),
                _ => None,
            }
        }) {
            reached.insert(next);
        }
        let is_lost = |index: &usize| !reached.contains(&Carrier::Body(BodyId::new(*index)));
        let lost: Vec<_> = (0..bodies.len()).filter(is_lost).map(|index| &bodies[index].0).collect();
        if let Some(first) = lost.first() {
            let names = lost.iter().map(|name| format!("`{}`", name.value)).collect::<Vec<_>>().join(", ");
            let message = format!("no chain of joints connects {names} to the ground");
            let mut fault = self.refuse(Code::Disconnected, first.span, message);
            for name in &lost[1..] {
                fault = fault.also(name.span, "");
            }
            fault.help("add a joint; a body that flies freely has a joint `free = [\"ground\", \"body\"]`");
        }
    }
}
