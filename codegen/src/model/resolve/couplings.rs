//! Couplings: which joint coordinates with which factors, by the rows of [`COUPLING_KINDS`].

use super::belt;
use super::coupling_numbers::RATIO;
use super::lookup::enumerated;
use super::mesh::{self, Mesh, Misfit, WheelAxis};
use super::resolver::Resolver;
use super::wheels::{Draft, Seating, terms};
use crate::diagnostic::Code;
use crate::id::{BodyId, PointId};
use crate::model::{Carrier, Coupling, ForceColumn, Formula, Joint, MeshSide};
use crate::source::Span;
use crate::spec::{At, COMPLIANCE_KEYS, COUPLING_KINDS, Dimension, File, Name};

/// Columns that are components of a tooth force.
const TOOTH: [&str; 3] = ["Ft", "Fr", "Fa"];
/// Those of a belt: its pull, and the tensions of both strands.
const BELT: [&str; 3] = ["Ft", "F1", "F2"];

impl Resolver<'_> {
    pub(super) fn resolve_couplings(&mut self, file: &File, joints: &[Joint]) -> Vec<Coupling> {
        let mut couplings = Vec::new();
        // Wrong joints have places and axes that nobody drew.
        let is_drawn = !self.has_errors();
        for (name, coupling) in &file.couplings.0 {
            let spec = &coupling.value;
            let mut kinds = COUPLING_KINDS.iter().filter(|kind| kind.is_written(spec));
            match (kinds.next(), kinds.next()) {
                (Some(kind), None) => {
                    let draft = Draft { kind, name, spec, file, joints };
                    if self.has_its_keys(&draft, coupling.span) && is_drawn {
                        couplings.extend(self.coupling(&draft));
                    }
                }
                (None, _) => {
                    let message = format!("nothing says what coupling `{}` is", name.value);
                    let examples = listed(COUPLING_KINDS.iter().map(|kind| kind.example));
                    let help = format!("write {}", enumerated(&examples, " or "));
                    self.missing(coupling.span, name.span, Code::NoKind, message).help(help);
                }
                _ => {
                    let message = format!("coupling `{}` is of several kinds", name.value);
                    let names = listed(COUPLING_KINDS.iter().map(|kind| kind.name)).join(", ");
                    let help = format!("make one entry for each of {names}");
                    self.refuse(Code::ConflictingKeys, name.span, message).help(help);
                }
            }
        }
        couplings
    }

    fn has_its_keys(&mut self, draft: &Draft<'_>, whole: Span) -> bool {
        let Draft { kind, name, spec, .. } = draft;
        let written = spec.written();
        for (key, span) in &written {
            if *key != kind.name && !kind.keys.contains(key) && !COMPLIANCE_KEYS.contains(key) {
                let message = format!(
                    "`{key}` means nothing for the coupling `{}`, which is {}",
                    name.value, kind.name
                );
                self.refuse(Code::ConflictingKeys, *span, message).help("take it away");
            }
        }
        let mut complete = true;
        for (key, help) in kind.needs {
            if !written.iter().any(|(known, _)| known == key) {
                complete = false;
                let message = format!("the coupling `{}` has no `{key}`", name.value);
                self.missing(whole, name.span, Code::MissingKey, message).help(*help);
            }
        }
        complete
    }

    fn coupling(&mut self, draft: &Draft<'_>) -> Option<Coupling> {
        let Some(names) = draft.kind.bodies.and_then(|bodies| bodies(draft.spec)) else {
            return self.relation(draft, draft.spec.relation.as_ref()?);
        };
        let wheels = self.wheels(draft, names)?;
        if draft.kind.count == 3 { self.coaxial(draft, &wheels) } else { self.pair(draft, &wheels) }
    }

    /// The bodies that a kind names.
    fn wheels(&mut self, draft: &Draft<'_>, names: &At<Vec<Name>>) -> Option<Vec<BodyId>> {
        let what = format!("coupling `{}`", draft.name.value);
        let count = draft.kind.count;
        if names.value.len() != count {
            self.wrong_count(names.span, names.value.len(), &format!("{count} bodies"), &what);
            return None;
        }
        let mut wheels = Vec::new();
        for name in &names.value {
            match self.carrier(name, &what)? {
                Carrier::Body(body) if wheels.contains(&body) => {
                    let message = format!("{what} names `{}` twice", name.value);
                    self.refuse(Code::SameBody, name.span, message).help("name different bodies");
                    return None;
                }
                Carrier::Body(body) => wheels.push(body),
                Carrier::Ground => {
                    let message = format!("{what} names the ground, which does not turn");
                    self.refuse(Code::SameBody, name.span, message)
                        .help("a wheel that stands still is a body with a `revolute` joint and `drive = 0`");
                    return None;
                }
            }
        }
        Some(wheels)
    }

    /// The point where wheels mesh, as their carrier sees it.
    fn mesh_point(&mut self, draft: &Draft<'_>, carrier: Carrier) -> Option<Option<(PointId, [f64; 3])>> {
        let Some(at) = &draft.spec.at else { return Some(None) };
        let point = self.point_named(at, &format!("coupling `{}`", draft.name.value))?;
        self.is_fixed(draft, point, carrier)?;
        Some(Some((point, self.position_value(point, carrier))))
    }

    /// Reports if a point that a mesh is drawn with moves with a tunable parameter.
    fn is_fixed(&mut self, draft: &Draft<'_>, point: PointId, carrier: Carrier) -> Option<()> {
        let position = self.points[point.index()].position_for(carrier).clone();
        if !position.iter().any(|formula| self.is_tunable(formula)) {
            return Some(());
        }
        let message = format!(
            "the coupling `{}` is drawn with the point `{}`, which moves with a tunable parameter",
            draft.name.value,
            self.points[point.index()].name
        );
        self.refuse(Code::TunableNotAllowed, draft.name.span, message)
            .help("radii follow from the drawing: take `tunable = true` away, or write a `relation`");
        None
    }

    /// Two wheels, a pinion and its rack, two pulleys.
    fn pair(&mut self, draft: &Draft<'_>, wheels: &[BodyId]) -> Option<Coupling> {
        let second = if draft.kind.name == "rack" { Seating::Slides } else { Seating::Turns };
        let seats = self.pair_of_seats(draft, [wheels[0], wheels[1]], second)?;
        let axes = [0, 1].map(|i| WheelAxis { centre: seats[i].centre, direction: seats[i].axis });
        let carrier = seats[0].carrier;
        for seat in &seats {
            self.is_fixed(draft, draft.joints[seat.joint.index()].at, Carrier::Body(seat.body))?;
        }
        let at = self.mesh_point(draft, carrier)?;
        let mesh = self.mesh(draft, axes, at.map(|(_, place)| place))?;
        if axes.iter().any(|axis| axis.centre.iter().any(|x| !x.is_finite())) {
            return None;
        }
        let mesh = match mesh {
            Ok(mesh) => mesh,
            Err((message, help)) => {
                let message = format!("the coupling `{}` cannot be: {message}", draft.name.value);
                self.refuse(Code::BadCoupling, draft.name.span, message).help(help);
                return None;
            }
        };
        let names = if draft.kind.name == "belt" { BELT } else { TOOTH };
        let columns = names.into_iter().zip(mesh.components);
        let side = |i: usize| MeshSide {
            body: seats[i].body,
            joint: seats[i].joint,
            carrier,
            force: mesh.sides[i].force,
            moment: mesh.sides[i].moment,
            slides: if i == 1 && second == Seating::Slides { seats[1].slides() } else { Vec::new() },
            pitch_circle: mesh.sides[i].circle,
        };
        Some(Coupling {
            name: draft.name.value.clone(),
            kind: draft.kind.name,
            terms: terms(&seats, &mesh.factors),
            offset: Formula::number(0.0, Dimension::LENGTH),
            angular: false,
            compliance: self.compliance(draft, false)?,
            meshes: vec![side(0), side(1)],
            columns: columns.map(|(name, value)| ForceColumn { name, unit: "N", value }).collect(),
            at: at.map(|(point, _)| point),
            span: draft.name.span,
        })
    }

    /// The geometry of a kind; nothing if a number of it is wrong, which is reported.
    fn mesh(
        &mut self,
        draft: &Draft<'_>,
        axes: [WheelAxis; 2],
        at: Option<[f64; 3]>,
    ) -> Option<Result<Mesh, Misfit>> {
        let spec = draft.spec;
        let both = |counts: Vec<f64>| [counts[0], counts[1]];
        let module = self.module(draft)?;
        let teeth = self.teeth(draft)?;
        if draft.kind.name == "rack" {
            let count = match &spec.teeth {
                Some(list) => Some(self.counts(draft, "teeth", list, 1)?[0]),
                None => None,
            };
            return Some(mesh::rack(axes[0], axes[1], teeth.pressure, (count, module, at?)));
        }
        if draft.kind.name == "belt" {
            return self.belt(draft, axes);
        }
        let counts = both(self.counts(draft, "teeth", spec.teeth.as_ref()?, 2)?);
        let internal = spec.internal.as_ref().is_some_and(|internal| internal.value);
        Some(match draft.kind.name {
            "bevel" => mesh::bevel(axes, counts, teeth.pressure, (module, at?)),
            "worm" => mesh::worm(axes, counts, module?, teeth),
            _ => mesh::parallel(axes, counts, internal, teeth, (module, at)),
        })
    }

    fn belt(&mut self, draft: &Draft<'_>, axes: [WheelAxis; 2]) -> Option<Result<Mesh, Misfit>> {
        let spec = draft.spec;
        let radii = self.counts(draft, "radii", spec.radii.as_ref()?, 2)?;
        if let Some(list) = &spec.teeth {
            let counts = self.counts(draft, "teeth", list, 2)?;
            if (radii[0] * counts[1] - radii[1] * counts[0]).abs() > RATIO * radii[0] * counts[1] {
                let message =
                    format!("`radii` and `teeth` of coupling `{}` have different ratios", draft.name.value);
                self.refuse(Code::BadCoupling, list.span, message)
                    .help("correct one of them, or leave `teeth` out");
                return None;
            }
        }
        let crossed = spec.crossed.as_ref().is_some_and(|crossed| crossed.value);
        let tension = self.tension(draft)?;
        Some(belt::belt(axes, [radii[0], radii[1]], crossed, tension))
    }
}

/// Each in backticks.
fn listed(texts: impl Iterator<Item = &'static str>) -> Vec<String> {
    texts.map(|text| format!("`{text}`")).collect()
}
