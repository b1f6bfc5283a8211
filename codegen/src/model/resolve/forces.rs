//! Force elements: springs between points, forces and torques by formula.

use super::inertia;
use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::{Code, Diagnostic};
use crate::id::PointId;
use crate::model::{AppliedForce, AppliedTorque, Bushing, Carrier, Force, ForceKind, Formula, Spring};
use crate::source::Span;
use crate::spec::{At, BushingPart, Dimension, ForceSpec, Name, Pair, Quantity, Table};

impl Resolver<'_> {
    pub(super) fn resolve_forces(&mut self, table: &Table<ForceSpec>) -> Vec<Force> {
        let mut forces = Vec::with_capacity(table.0.len());
        for (name, force) in &table.0 {
            let spec = &force.value;
            let kind = match (&spec.spring, &spec.bushing, &spec.force, &spec.torque) {
                (Some(pair), None, None, None) => self.spring(name, force, pair),
                (None, Some(pair), None, None) => self.bushing(name, force, pair),
                (None, None, Some(body), None) => self.push(name, force, body),
                (None, None, None, Some(body)) => self.turn(name, force, body),
                (None, None, None, None) => {
                    self.missing(force.span, name.span, || {
                        Diagnostic::new(Code::NoKind, format!("nothing says what force `{}` is", name.value)).help(
                            "write `spring = [\"ground\", \"rocker\"]`, `bushing = [\"ground\", \"engine\"]`, `force = \"crank\"` or `torque = \"crank\"`",
                        )
                    });
                    None
                }
                _ => {
                    let message = format!("force `{}` is of several kinds", name.value);
                    let fault = Diagnostic::new(Code::ConflictingKeys, message).at(name.span, "");
                    self.report(
                        fault.help("make one entry for each of `spring`, `bushing`, `force`, `torque`"),
                    );
                    None
                }
            };
            forces.extend(kind.map(|kind| Force { name: name.value.clone(), kind, span: name.span }));
        }
        forces
    }

    /// Keys of another kind of force element.
    fn check_stray_keys(&mut self, name: &Name, kind: &str, spec: &ForceSpec) {
        let (spring, bushing) = (kind == "spring", kind == "bushing");
        let by_formula = !spring && !bushing;
        let keys = [
            ("translation", spec.translation.as_ref().map(|part| part.span), bushing),
            ("rotation", spec.rotation.as_ref().map(|part| part.span), bushing),
            ("directions", spec.directions.as_ref().map(|list| list.span), bushing),
            ("stiffness", spec.stiffness.as_ref().map(|q| q.span), spring),
            ("length", spec.length.as_ref().map(|q| q.span), spring),
            ("damping", spec.damping.as_ref().map(|q| q.span), spring),
            ("preload", spec.preload.as_ref().map(|q| q.span), spring),
            ("components", spec.components.as_ref().map(|triple| triple.0.span), by_formula),
            ("axes", spec.axes.as_ref().map(|axes| axes.span), by_formula),
            ("reaction", spec.reaction.as_ref().map(|body| body.span), by_formula),
            ("at", spec.at.as_ref().map(|at| at.0.span), kind != "torque"),
        ];
        for (key, span, fits) in keys {
            if let (Some(span), false) = (span, fits) {
                let message = format!("`{key}` means nothing for the {kind} `{}`", name.value);
                self.report(
                    Diagnostic::new(Code::ConflictingKeys, message).at(span, "").help("take it away"),
                );
            }
        }
    }

    /// The points of `at`, as many as `bodies`, each as its body sees it.
    fn places<const N: usize>(
        &mut self,
        name: &Name,
        force: &At<ForceSpec>,
        bodies: [Option<(Carrier, &Name)>; N],
    ) -> Option<[PointId; N]> {
        let what = format!("force `{}`", name.value);
        let needed = if N == 1 { "1 point" } else { "2 points, one on each body" };
        let Some(at) = &force.value.at else {
            self.missing(force.span, name.span, || {
                Diagnostic::new(Code::MissingKey, format!("{what} does not say where it acts")).help(
                    if N == 1 {
                        "add `at = \"A\"`"
                    } else {
                        "add `at = [\"A\", \"B\"]`, a point on each body"
                    },
                )
            });
            return None;
        };
        if at.0.value.len() != N {
            self.wrong_count(at.0.span, at.0.value.len(), needed, &place("at", "force", name));
            return None;
        }
        let points: Vec<_> =
            (0..N).map(|side| self.point_on(&at.0.value[side], bodies[side], &what)).collect();
        let points = points.into_iter().collect::<Option<Vec<_>>>()?;
        points.try_into().ok()
    }

    /// The bodies that an element of some kind connects.
    fn two_bodies<'n>(
        &mut self,
        name: &Name,
        kind: &str,
        pair: &'n Pair,
    ) -> Option<[Option<(Carrier, &'n Name)>; 2]> {
        let what = format!("force `{}`", name.value);
        let [a, b] = pair.0.value.as_slice() else {
            self.wrong_count(pair.0.span, pair.0.value.len(), "2 bodies", &what);
            return None;
        };
        let sides = [a, b].map(|body| self.carrier(body, &what).map(|carrier| (carrier, body)));
        if let ([Some((first, _)), Some((second, _))], true) = (sides, a.value == b.value)
            && first == second
        {
            let message = format!("the {kind} `{}` connects `{}` with itself", name.value, a.value);
            self.report(Diagnostic::new(Code::SameBody, message).at(pair.0.span, ""));
        }
        Some(sides)
    }

    fn bushing(&mut self, name: &Name, force: &At<ForceSpec>, pair: &Pair) -> Option<ForceKind> {
        let spec = &force.value;
        self.check_stray_keys(name, "bushing", spec);
        let sides = self.two_bodies(name, "bushing", pair)?;
        let at = self.places(name, force, [sides[0]]);
        if let (Some(places), Some(_)) = (&spec.at, at) {
            self.point_on(&places.0.value[0], sides[1], &format!("force `{}`", name.value));
        }
        if spec.translation.is_none() && spec.rotation.is_none() {
            self.missing(force.span, name.span, || {
                let message = format!("the bushing `{}` has neither stiffness nor damping", name.value);
                Diagnostic::new(Code::MissingKey, message).help(
                    "add for example `translation = { stiffness = [\"1 kN/mm\", \"1 kN/mm\", \"2 kN/mm\"] }`",
                )
            });
        }
        let mut three = |part: Option<&At<BushingPart>>, key: &str, dimension: Dimension| {
            let written = part.and_then(|part| match key {
                "stiffness" => part.value.stiffness.as_ref(),
                _ => part.value.damping.as_ref(),
            });
            let Some(written) = written else {
                return std::array::from_fn(|_| Formula::number(0.0, dimension));
            };
            let what = place(key, "force", name);
            let formulas = self.triple(written, dimension, Allowed::PARAMETERS, &what);
            formulas.iter().for_each(|formula| self.check_positive(formula, true, &what));
            formulas
        };
        let (translation, rotation) = (spec.translation.as_ref(), spec.rotation.as_ref());
        let [stiffness, damping] = [("stiffness", -2), ("damping", -1)]
            .map(|(key, time)| three(translation, key, Dimension::of(0, 1, time)));
        let [turning_stiffness, turning_damping] = [("stiffness", -2), ("damping", -1)]
            .map(|(key, time)| three(rotation, key, Dimension::of(2, 1, time)));
        let axes = spec
            .directions
            .as_ref()
            .map_or(inertia::AXES_OF_W, |axes| self.right_handed(axes, &place("directions", "force", name)));
        let (bodies, [at]) = ([sides[0]?.0, sides[1]?.0], at?);
        Some(ForceKind::Bushing(Bushing {
            bodies,
            at,
            axes,
            stiffness,
            damping,
            turning_stiffness,
            turning_damping,
        }))
    }

    fn spring(&mut self, name: &Name, force: &At<ForceSpec>, pair: &Pair) -> Option<ForceKind> {
        let spec = &force.value;
        self.check_stray_keys(name, "spring", spec);
        let sides = self.two_bodies(name, "spring", pair)?;
        let at = self.places(name, force, sides);
        let or_zero =
            |this: &mut Self, quantity: &Option<Quantity>, key: &str, dimension: Dimension| match quantity {
                Some(quantity) => {
                    this.formula(quantity, Some(dimension), Allowed::PARAMETERS, &place(key, "force", name))
                }
                None => Formula::number(0.0, dimension),
            };
        let stiffness = or_zero(self, &spec.stiffness, "stiffness", Dimension::of(0, 1, -2));
        let rest = or_zero(self, &spec.length, "length", Dimension::LENGTH);
        let damping = or_zero(self, &spec.damping, "damping", Dimension::of(0, 1, -1));
        let preload = or_zero(self, &spec.preload, "preload", Dimension::FORCE);
        self.check_positive(&rest, true, &place("length", "force", name));
        self.check_positive(&damping, true, &place("damping", "force", name));
        if spec.stiffness.is_some() && spec.length.is_none() {
            self.missing(force.span, name.span, || {
                Diagnostic::new(
                    Code::MissingKey,
                    format!("the spring `{}` has no unloaded `length`", name.value),
                )
                .help("add `length = \"100 mm\"`, or `length = 0` if it always pulls")
            });
        }
        if spec.stiffness.is_none() && spec.damping.is_none() && spec.preload.is_none() {
            self.missing(force.span, name.span, || {
                Diagnostic::new(
                    Code::MissingKey,
                    format!("the spring `{}` has neither stiffness, damping nor preload", name.value),
                )
                .help("add for example `stiffness = \"500 N/m\", length = \"100 mm\"`")
            });
        }
        let bodies = [sides[0]?.0, sides[1]?.0];
        let at = at?;
        self.warn_no_direction(name, bodies, at);
        Some(ForceKind::Spring(Spring { bodies, at, stiffness, rest, damping, preload }))
    }

    fn warn_no_direction(&mut self, name: &Name, bodies: [Carrier; 2], at: [PointId; 2]) {
        let ends = [0, 1].map(|side| self.position_value(at[side], bodies[side]));
        if inertia::distance(ends[0], ends[1]) == 0.0 {
            let message = format!("the ends of the spring `{}` coincide at the reference pose", name.value);
            self.report(
                Diagnostic::new(Code::SpringWithoutDirection, message)
                    .at(name.span, "")
                    .help("while they do, its force has no direction and the equations give no numbers"),
            );
        }
    }

    fn push(&mut self, name: &Name, force: &At<ForceSpec>, body: &Name) -> Option<ForceKind> {
        self.check_stray_keys(name, "force", &force.value);
        let what = place("force", "force", name);
        let pushed = self.carrier(body, &what);
        let at = self.places(name, force, [pushed.map(|carrier| (carrier, body))]);
        let components = self.components(name, force, Dimension::FORCE);
        let (reaction, axes) = self.sides(name, &force.value, pushed, body.span);
        let [at] = at?;
        Some(ForceKind::Force(AppliedForce { body: pushed?, reaction, at, components: components?, axes }))
    }

    fn turn(&mut self, name: &Name, force: &At<ForceSpec>, body: &Name) -> Option<ForceKind> {
        self.check_stray_keys(name, "torque", &force.value);
        let turned = self.carrier(body, &place("torque", "force", name));
        let components = self.components(name, force, Dimension::TORQUE);
        let (reaction, axes) = self.sides(name, &force.value, turned, body.span);
        Some(ForceKind::Torque(AppliedTorque { body: turned?, reaction, components: components?, axes }))
    }

    fn components(
        &mut self,
        name: &Name,
        force: &At<ForceSpec>,
        dimension: Dimension,
    ) -> Option<[Formula; 3]> {
        let Some(components) = &force.value.components else {
            self.missing(force.span, name.span, || {
                let zero = dimension.si_unit();
                Diagnostic::new(Code::MissingKey, format!("force `{}` has no `components`", name.value))
                    .help(format!("add `components = [0, 0, \"-10 {zero}\"]`"))
            });
            return None;
        };
        Some(self.triple(components, dimension, Allowed::STATE, &place("components", "force", name)))
    }

    /// Who takes the reaction, and whose axes the components are in.
    fn sides(
        &mut self,
        name: &Name,
        spec: &ForceSpec,
        body: Option<Carrier>,
        at: Span,
    ) -> (Carrier, Carrier) {
        let mut of = |key: &str, written: &Option<Name>| match written {
            Some(written) => self.carrier(written, &place(key, "force", name)).unwrap_or(Carrier::Ground),
            None => Carrier::Ground,
        };
        let (reaction, axes) = (of("reaction", &spec.reaction), of("axes", &spec.axes));
        if body == Some(reaction) {
            let message = format!("force `{}` acts on the body that takes its reaction", name.value);
            self.report(
                Diagnostic::new(Code::SameBody, message).at(at, "").help("such a force does nothing"),
            );
        }
        (reaction, axes)
    }
}
