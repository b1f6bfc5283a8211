//! Whether there are bodies at all, and whether joints connect each of them to the ground.

use super::resolver::Resolver;
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Carrier, Joint};
use crate::source::Span;
use crate::spec::File;

impl Resolver<'_> {
    pub(super) fn check_connected(&mut self, file: &File, joints: &[Joint]) {
        let bodies = &file.bodies.0;
        if bodies.is_empty() {
            let whole = Span { start: 0, end: self.source.text.len() };
            self.missing(whole, Span::default(), || {
                Diagnostic::new(Code::EmptyMechanism, "the mechanism has no bodies")
                    .help("add a table [bodies], for example `crank = { rod = [\"O\", \"A\"], radius = \"6 mm\", density = \"7850 kg/m^3\" }`")
            });
            return;
        }
        // A wrong joint would make its bodies look lost too.
        if self.has_errors() {
            return;
        }
        let mut reached = vec![false; bodies.len()];
        let known = |carrier: Carrier, reached: &[bool]| match carrier {
            Carrier::Ground => true,
            Carrier::Body(id) => reached[id.index()],
        };
        let mut grows = true;
        while grows {
            grows = false;
            for joint in joints {
                for (from, to) in [(joint.parent, joint.child), (joint.child, joint.parent)] {
                    if let (true, Carrier::Body(id)) = (known(from, &reached), to)
                        && !reached[id.index()]
                    {
                        reached[id.index()] = true;
                        grows = true;
                    }
                }
            }
        }
        let lost: Vec<_> = bodies
            .iter()
            .zip(&reached)
            .filter(|(_, reached)| !**reached)
            .map(|((name, _), _)| name)
            .collect();
        if let Some(first) = lost.first() {
            let names = lost.iter().map(|name| format!("`{}`", name.value)).collect::<Vec<_>>().join(", ");
            let message = format!("no chain of joints connects {names} to the ground");
            let mut fault = Diagnostic::new(Code::Disconnected, message).at(first.span, "");
            for name in &lost[1..] {
                fault = fault.also(name.span, "");
            }
            self.report(
                fault.help(
                    "add a joint; a body that flies freely has a joint `free = [\"ground\", \"body\"]`",
                ),
            );
        }
    }
}
