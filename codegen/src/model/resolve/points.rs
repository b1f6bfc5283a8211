//! Points: positions, and the body that carries each.

use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::{Code, nearest};
use crate::id::{BodyId, PointId};
use crate::model::{Body, Carrier, Coupling, Force, Formula, Joint, Point, Position};
use crate::source::Span;
use crate::spec::{At, Dimension, File, Name, POINT_KEYS, PerBody, PointSpec, Table, Triple, unknown_key};

impl Resolver<'_> {
    pub(super) fn resolve_points(&mut self, file: &File) {
        for (name, point) in &file.points.0 {
            let position = self.position_of(name, point);
            let carrier = self.explicit_carrier(name, &point.value, &position);
            self.points.push(Point {
                name: name.value.clone(),
                position,
                carrier,
                assumed: point.value.assumed,
                span: name.span,
            });
        }
    }

    fn position_of(&mut self, name: &Name, point: &At<PointSpec>) -> Position {
        let nowhere = Position::Shared(std::array::from_fn(|_| Formula::number(f64::NAN, Dimension::LENGTH)));
        let what = format!("point `{}`", name.value);
        match (&point.value.at, point.value.by_body.0.first()) {
            (Some(_), Some((key, _))) => {
                if self.names.find(&key.value).is_none()
                    && let Some(meant) = nearest(&key.value, POINT_KEYS.iter().copied())
                {
                    let message = unknown_key(&key.value);
                    self.refuse(Code::UnknownKey, key.span, message).help(format!("did you mean `{meant}`?"));
                    return nowhere;
                }
                let message = format!("{what} has `at`, and a position for `{}` beside it", key.value);
                self.refuse(Code::ConflictingKeys, key.span, message)
                    .help("positions by body go into `at`: `at = { crank = [...], rocker = [...] }`");
                nowhere
            }
            (Some(PerBody::Shared(triple)), None) => {
                Position::Shared(self.triple(triple, Dimension::LENGTH, Allowed::PARAMETERS, &what))
            }
            (Some(PerBody::Each(table)), None) => self.per_body(table, name).unwrap_or(nowhere),
            (None, Some(_)) => self.per_body(&point.value.by_body, name).unwrap_or(nowhere),
            (None, None) => {
                self.missing(point.span, name.span, Code::MissingKey, format!("{what} has no coordinates"))
                    .help(format!("write `{} = [\"0 mm\", \"0 mm\", \"0 mm\"]`", name.value));
                nowhere
            }
        }
    }

    fn per_body(&mut self, table: &Table<Triple>, name: &Name) -> Option<Position> {
        let mut positions = Vec::new();
        for (body, triple) in &table.0 {
            let what = format!("point `{}`", name.value);
            let carrier = self.carrier(body, &what);
            let position = self.triple(&triple.value, Dimension::LENGTH, Allowed::PARAMETERS, &what);
            positions.extend(carrier.map(|carrier| (carrier, position)));
        }
        (!positions.is_empty()).then_some(Position::PerBody(positions))
    }

    fn explicit_carrier(&mut self, name: &Name, point: &PointSpec, position: &Position) -> Carrier {
        let Some(on) = &point.on else { return Carrier::Ground };
        let Some(carrier) = self.carrier(on, &place("on", "point", name)) else { return Carrier::Ground };
        if let Position::PerBody(list) = position
            && !list.iter().any(|(body, _)| *body == carrier)
        {
            self.report_absent(&name.value, &on.value, on.span, name.span);
        }
        carrier
    }

    fn report_absent(&mut self, point: &str, body: &str, at: Span, declared: Span) {
        let message = format!("the point `{point}` has positions for some bodies, but none for `{body}`");
        self.refuse(Code::PointNotOnBody, at, message)
            .also(declared, "declared here")
            .help(format!("add `{body} = [...]` to the point, or use another point"));
    }

    /// The point with this name, as `carrier` (called `body`) sees it.
    pub(super) fn point_on(
        &mut self,
        name: &Name,
        carrier: Option<(Carrier, &Name)>,
        used_by: &str,
    ) -> Option<PointId> {
        let id = self.point_named(name, used_by)?;
        let point = &self.points[id.index()];
        if let (Position::PerBody(list), Some((carrier, body))) = (&point.position, carrier)
            && !list.iter().any(|(known, _)| *known == carrier)
        {
            let declared = point.span;
            self.report_absent(&name.value, &body.value, name.span, declared);
        }
        Some(id)
    }

    /// Position [m] with the parameters of the file.
    pub(super) fn position_value(&self, point: PointId, carrier: Carrier) -> [f64; 3] {
        self.values_of(self.points[point.index()].position_for(carrier))
    }

    /// The body whose material point each point is: the one written, else the first body described with it, else the
    /// child of the first joint there, else what carries the axes of wheels that mesh there, else the ground.
    pub(super) fn find_carriers(
        &mut self,
        file: &File,
        bodies: &[Body],
        joints: &[Joint],
        (forces, couplings): (&[Force], &[Coupling]),
    ) {
        for position in 0..self.points.len() {
            if file.points.0.get(position).is_some_and(|(_, point)| point.value.on.is_some()) {
                continue;
            }
            let id = PointId::new(position);
            let point = &self.points[position];
            let by_body = |body: usize| {
                let carrier = Carrier::Body(BodyId::new(body));
                let listed = match &point.position {
                    Position::PerBody(list) => list.iter().any(|(known, _)| *known == carrier),
                    Position::Shared(_) => false,
                };
                listed || bodies[body].inertia.points().contains(&id)
            };
            let body =
                (0..bodies.len()).find(|body| by_body(*body)).map(|body| Carrier::Body(BodyId::new(body)));
            let joint = || {
                let joint = joints.iter().find(|joint| joint.points().contains(&id))?;
                let [on_parent, on_child] = joint.points();
                let is_parents = joint.child == Carrier::Ground || (on_parent != on_child && on_parent == id);
                Some(if is_parents { joint.parent } else { joint.child })
            };
            let meshes = couplings.iter().filter(|coupling| coupling.at == Some(id));
            let mesh = || meshes.flat_map(|coupling| &coupling.meshes).next().map(|side| side.carrier);
            let found = body.or_else(joint).or_else(mesh);
            let held =
                |force: &Force| force.at.iter().zip(&force.bodies).any(|end| end == (&id, &Carrier::Ground));
            if found.is_none() && !forces.iter().any(held) && !self.has_errors() {
                self.warn_unplaced(id, bodies, forces);
            }
            self.points[position].carrier = found.unwrap_or(Carrier::Ground);
        }
    }
}
