//! Couplings without teeth of their own: sets around one line, and relations that a file writes down.

use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use super::wheels::{Draft, Seat, terms};
use crate::diagnostic::Code;
use crate::id::BodyId;
use crate::model::{ByMultiplier, Coordinate, CoupledCoordinate, Coupling, ForceColumn, Formula, MeshSide};
use crate::spec::{Dimension, Literal, Name, Table};

/// Columns of a coaxial set: torques in the order of its bodies.
const TORQUES: [&str; 3] = ["T1", "T2", "T3"];

impl Resolver<'_> {
    /// Sun, ring and carrier, or side shafts and cage: three bodies that turn about one line.
    pub(super) fn coaxial(&mut self, draft: &Draft<'_>, wheels: &[BodyId]) -> Option<Coupling> {
        let seats = self.seats_on_one_line(draft, wheels)?;
        let ratio = match &draft.spec.teeth {
            None => 1.0,
            Some(list) => {
                let counts = self.counts(draft, "teeth", list, 2)?;
                if counts[0] >= counts[1] {
                    let message = format!(
                        "the sun of coupling `{}` has {} teeth, its ring {}",
                        draft.name.value, counts[0], counts[1]
                    );
                    self.refuse(Code::BadCoupling, list.span, message)
                        .help("the ring is around the sun: it has more teeth; name the sun first");
                    return None;
                }
                counts[1] / counts[0]
            }
        };
        let u = seats[0].axis;
        let shares = [1.0, ratio, -1.0 - ratio];
        let along = |seat: &Seat| seat.axis.iter().zip(u).map(|(a, b)| a * b).sum::<f64>().signum();
        let factors: Vec<f64> = seats.iter().zip(shares).map(|(seat, share)| share * along(seat)).collect();
        let signed = |value| ByMultiplier { signed: value, ..ByMultiplier::default() };
        let sides = seats.iter().zip(shares).map(|(seat, share)| MeshSide {
            body: seat.body,
            joint: seat.joint,
            carrier: seat.carrier,
            force: ByMultiplier::default(),
            moment: ByMultiplier { signed: u.map(|x| share * x), ..ByMultiplier::default() },
            slides: Vec::new(),
            pitch_circle: None,
        });
        let columns = TORQUES.into_iter().zip(shares);
        Some(Coupling {
            name: draft.name.value.clone(),
            kind: draft.kind.name,
            terms: terms(&seats, &factors),
            offset: Formula::number(0.0, Dimension::NONE),
            angular: true,
            compliance: self.compliance(draft, true)?,
            meshes: sides.collect(),
            columns: columns
                .map(|(name, share)| ForceColumn { name, unit: "N m", value: signed(share) })
                .collect(),
            at: None,
            span: draft.name.span,
        })
    }

    pub(super) fn relation(&mut self, draft: &Draft<'_>, table: &Table<Literal>) -> Option<Coupling> {
        let what = format!("`relation` of coupling `{}`", draft.name.value);
        let mut terms: Vec<CoupledCoordinate> = Vec::new();
        let mut sum: Option<Dimension> = None;
        for (key, quantity) in &table.0 {
            let is_joint = self.names.find(&key.value).is_some();
            let parts = key.value.rsplit_once('.').filter(|_| !is_joint);
            let (joint, coordinate) = parts.unwrap_or((&key.value, ""));
            let name = Name { span: key.span, value: joint.to_owned() };
            let joint = self.joint_named(&name, &what)?;
            let model = self.joint_models.get(joint.index())?.clone();
            let coordinate = self.coordinate(coordinate, &model, key.span, &what)?;
            let factor = self.formula(quantity, None, Allowed::PARAMETERS, &what);
            let value = self.value(&factor);
            if value == 0.0 || terms.iter().any(|term| (term.joint, term.coordinate) == (joint, coordinate)) {
                let why = if value == 0.0 { "with a factor of zero" } else { "twice" };
                let message = format!("{what} has `{}` {why}", key.value);
                self.refuse(Code::BadCoupling, key.span, message).help("take it away");
                return None;
            }
            let own = factor.dimension.times(model.coordinates()[coordinate].dimension());
            match own.filter(|own| [Dimension::NONE, Dimension::LENGTH].contains(own)) {
                Some(own) if sum.is_none_or(|sum| sum == own) => sum = Some(own),
                _ if value.is_nan() => return None,
                _ => {
                    let is_angle = model.coordinates()[coordinate] == Coordinate::Angle;
                    let message = format!(
                        "{what}: `{}` is {}, which does not add up with the other terms",
                        key.value,
                        if is_angle { "an angle" } else { "a length" }
                    );
                    self.refuse(Code::UnitMismatch, quantity.span, message).help(
                        "every factor times its coordinate is an angle, or every one a length: `{ R1 = 1, P1 = \"-400 1/m\" }`",
                    );
                    return None;
                }
            }
            terms.push(CoupledCoordinate { joint, coordinate, factor });
        }
        if terms.len() < 2 {
            self.wrong_count(draft.name.span, terms.len(), "2 coordinates or more", &what);
            return None;
        }
        let sum = sum?;
        let offset = match &draft.spec.offset {
            Some(offset) => {
                self.formula(offset, Some(sum), Allowed::PARAMETERS, &place("offset", "coupling", draft.name))
            }
            None => Formula::number(0.0, sum),
        };
        let angular = sum == Dimension::NONE;
        let value = ByMultiplier { signed: 1.0, ..ByMultiplier::default() };
        let (name, unit) = if angular { ("T", "N m") } else { ("F", "N") };
        Some(Coupling {
            name: draft.name.value.clone(),
            kind: draft.kind.name,
            terms,
            offset,
            angular,
            compliance: self.compliance(draft, angular)?,
            meshes: Vec::new(),
            columns: vec![ForceColumn { name, unit, value }],
            at: None,
            span: draft.name.span,
        })
    }
}
