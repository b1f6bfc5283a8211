//! Force elements: bodies, points and numbers, by the rows of [`FORCE_KINDS`].

use super::inertia;
use super::lookup::enumerated;
use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::id::PointId;
use crate::model::{Carrier, Force, Formula};
use crate::spec::{
    At, Bodies, Dimension, FORCE_KINDS, ForceKind, ForceSpec, ForceValue, Name, Pair, Table, Written,
};

/// A body with the name by which the file calls it.
type Side<'n> = Option<(Carrier, &'n Name)>;

impl Resolver<'_> {
    pub(super) fn resolve_forces(&mut self, table: &Table<ForceSpec>) -> Vec<Force> {
        let mut forces = Vec::with_capacity(table.0.len());
        for (name, force) in &table.0 {
            let mut kinds = FORCE_KINDS.iter().filter(|kind| kind.is_written(&force.value));
            match (kinds.next(), kinds.next()) {
                (Some(kind), None) => forces.extend(self.force(kind, name, force)),
                (None, _) => {
                    let message = format!("nothing says what force `{}` is", name.value);
                    let examples = listed(FORCE_KINDS.iter().map(|kind| kind.example));
                    let help = format!("write {}", enumerated(&examples, " or "));
                    self.missing(force.span, name.span, Code::NoKind, message).help(help);
                }
                _ => {
                    let message = format!("force `{}` is of several kinds", name.value);
                    let names = listed(FORCE_KINDS.iter().map(|kind| kind.name)).join(", ");
                    let help = format!("make one entry for each of {names}");
                    self.refuse(Code::ConflictingKeys, name.span, message).help(help);
                }
            }
        }
        forces
    }

    fn force(&mut self, kind: &'static ForceKind, name: &Name, force: &At<ForceSpec>) -> Option<Force> {
        let spec = &force.value;
        for (key, span) in spec.written() {
            if key != kind.name && !kind.keys.contains(&key) {
                let message = format!("`{key}` means nothing for the {} `{}`", kind.name, name.value);
                self.refuse(Code::ConflictingKeys, span, message).help("take it away");
            }
        }
        let sides = match kind.bodies {
            Bodies::Two(pair) => self.two_bodies(kind, name, pair(spec)?)?,
            Bodies::One(body) => self.body_and_reaction(kind, name, spec, body(spec)?),
        };
        let at = self.places(kind, name, force, sides);
        let called = match kind.bodies {
            Bodies::Two(_) => format!("the {} `{}`", kind.name, name.value),
            Bodies::One(_) => format!("force `{}`", name.value),
        };
        for (_, lack, help) in kind.needs.iter().filter(|(is_missing, ..)| is_missing(spec)) {
            let message = format!("{called} {lack}");
            self.missing(force.span, name.span, Code::MissingKey, message).help(*help);
        }
        let mut formulas: Vec<Formula> = Vec::new();
        for value in kind.values {
            let written = self.force_value(kind, name, spec, value);
            formulas.extend(written);
        }
        self.check_one_matrix(name, spec);
        let takes = |key| kind.keys.contains(&key);
        let directions = match spec.directions.as_ref().filter(|_| takes("directions")) {
            Some(written) => self.right_handed(written, &place("directions", "force", name)),
            None => inertia::AXES_OF_W,
        };
        let axes = self.body_or_ground("axes", name, spec.axes.as_ref().filter(|_| takes("axes")));
        let (bodies, at) = ([sides[0]?.0, sides[1]?.0], at?);
        if kind.points == 2 {
            let drawn = self.drawn_length(kind, name, bodies, at);
            let of_values = kind.values.iter().zip(&mut formulas);
            for (_, formula) in of_values.filter(|(value, _)| value.drawn && value.is_missing(spec)) {
                *formula = Formula { span: name.span, ..Formula::number(drawn, Dimension::LENGTH) };
            }
        }
        Some(Force {
            name: name.value.clone(),
            kind,
            bodies,
            at,
            directions,
            axes,
            formulas,
            of_joint: false,
            span: name.span,
        })
    }

    /// The bodies that an element of some kind connects.
    fn two_bodies<'n>(&mut self, kind: &ForceKind, name: &Name, pair: &'n Pair) -> Option<[Side<'n>; 2]> {
        let what = format!("force `{}`", name.value);
        let [a, b] = pair.0.value.as_slice() else {
            self.wrong_count(pair.0.span, pair.0.value.len(), "2 bodies", &what);
            return None;
        };
        let sides = [a, b].map(|body| self.carrier(body, &what).map(|carrier| (carrier, body)));
        if let [Some((first, _)), Some((second, _))] = sides
            && first == second
        {
            let message = format!("the {} `{}` connects `{}` with itself", kind.name, name.value, a.value);
            self.refuse(Code::SameBody, pair.0.span, message)
                .help("name two bodies; `ground` is the fixed one");
        }
        Some(sides)
    }

    fn body_and_reaction<'n>(
        &mut self,
        kind: &ForceKind,
        name: &Name,
        spec: &ForceSpec,
        body: &'n Name,
    ) -> [Side<'n>; 2] {
        let pushed = self.carrier(body, &place(kind.name, "force", name));
        let reaction = self.body_or_ground("reaction", name, spec.reaction.as_ref());
        if pushed == Some(reaction) {
            let message = format!("force `{}` acts on the body that takes its reaction", name.value);
            self.refuse(Code::SameBody, body.span, message).help("such a force does nothing");
        }
        [pushed.map(|carrier| (carrier, body)), Some((reaction, body))]
    }

    fn body_or_ground(&mut self, key: &str, name: &Name, written: Option<&Name>) -> Carrier {
        let body = written.and_then(|body| self.carrier(body, &place(key, "force", name)));
        body.unwrap_or(Carrier::Ground)
    }

    /// The points of `at`, each as its body sees it; any where the kind has none.
    fn places(
        &mut self,
        kind: &ForceKind,
        name: &Name,
        force: &At<ForceSpec>,
        sides: [Side<'_>; 2],
    ) -> Option<[PointId; 2]> {
        let what = format!("force `{}`", name.value);
        let (needed, help) = match kind.points {
            0 => return Some([PointId::new(0); 2]),
            1 => ("1 point", r#"add `at = "A"`"#),
            _ => ("2 points, one on each body", r#"add `at = ["A", "B"]`, a point on each body"#),
        };
        let Some(at) = &force.value.at else {
            let message = format!("{what} does not say where it acts");
            self.missing(force.span, name.span, Code::MissingKey, message).help(help);
            return None;
        };
        let (points, span) = at.names();
        if points.len() != kind.points {
            self.wrong_count(span, points.len(), needed, &place("at", "force", name));
            return None;
        }
        let first = self.point_on(&points[0], sides[0], &what);
        let second = match kind.bodies {
            _ if kind.points == 2 => self.point_on(&points[1], sides[1], &what),
            Bodies::Two(_) => first.and_then(|_| self.point_on(&points[0], sides[1], &what)),
            Bodies::One(_) => first,
        };
        Some([first?, second?])
    }

    fn force_value(
        &mut self,
        kind: &ForceKind,
        name: &Name,
        spec: &ForceSpec,
        value: &ForceValue,
    ) -> Vec<Formula> {
        let what = place(value.key, "force", name);
        let allowed = match kind.bodies {
            Bodies::Two(_) => Allowed::PARAMETERS,
            Bodies::One(_) => Allowed::STATE,
        };
        let zero = || Formula::number(0.0, value.dimension);
        let formulas = match value.written {
            Written::One(written) => vec![match written(spec) {
                Some(written) => self.formula(written, Some(value.dimension), allowed, &what),
                None => zero(),
            }],
            Written::Three(written) => match written(spec) {
                Some(written) => self.triple(written, value.dimension, allowed, &what).to_vec(),
                None => vec![zero(), zero(), zero()],
            },
            Written::Matrix(written, blocks) => {
                let [mixed, last] = blocks;
                return self.matrix(name, value.key, written(spec), [value.dimension, mixed, last]);
            }
        };
        for formula in formulas.iter().filter(|_| !value.signed && !value.is_missing(spec)) {
            self.check_positive(formula, value.zero, &what);
        }
        for formula in formulas.iter().filter(|_| value.signed && value.key == "stiffness") {
            self.warn_pushing(formula, &what);
        }
        formulas
    }

    /// Distance of the two points at the reference pose [m]; a warning if they coincide.
    fn drawn_length(&mut self, kind: &ForceKind, name: &Name, bodies: [Carrier; 2], at: [PointId; 2]) -> f64 {
        let ends = [0, 1].map(|side| self.position_value(at[side], bodies[side]));
        let length = inertia::distance(ends[0], ends[1]);
        if length == 0.0 {
            let message =
                format!("the ends of the {} `{}` coincide at the reference pose", kind.name, name.value);
            let help = "while they do, its force has no direction and the equations give no numbers";
            self.refuse(Code::SpringWithoutDirection, name.span, message).help(help);
        }
        length
    }
}

/// Each in backticks.
fn listed(texts: impl Iterator<Item = &'static str>) -> Vec<String> {
    texts.map(|text| format!("`{text}`")).collect()
}
