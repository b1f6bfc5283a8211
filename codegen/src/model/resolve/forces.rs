//! Force elements: springs between points, forces and torques by formula.

use super::quantity::Allowed;
use super::{Resolver, inertia, place};
use crate::diagnostic::{Code, Diagnostic};
use crate::id::PointId;
use crate::model::{Carrier, Force, ForceKind, Formula};
use crate::source::Span;
use crate::spec::{At, Dimension, ForceSpec, Name, Pair, Quantity, Table};

impl Resolver<'_> {
    pub(super) fn resolve_forces(&mut self, table: &Table<ForceSpec>) -> Vec<Force> {
        let mut forces = Vec::with_capacity(table.0.len());
        for (name, force) in &table.0 {
            let spec = &force.value;
            let kind = match (&spec.spring, &spec.force, &spec.torque) {
                (Some(pair), None, None) => self.spring(name, force, pair),
                (None, Some(body), None) => self.push(name, force, body),
                (None, None, Some(body)) => self.turn(name, force, body),
                (None, None, None) => {
                    self.missing(force.span, name.span, || {
                        Diagnostic::new(Code::NoKind, format!("nothing says what force `{}` is", name.value)).help(
                            "write `spring = [\"ground\", \"rocker\"]`, `force = \"crank\"` or `torque = \"crank\"`",
                        )
                    });
                    None
                }
                _ => {
                    let message = format!("force `{}` is of several kinds", name.value);
                    let fault = Diagnostic::new(Code::ConflictingKeys, message).at(name.span, "");
                    self.report(fault.help("make one entry for each of `spring`, `force`, `torque`"));
                    None
                }
            };
            forces.extend(kind.map(|kind| Force { name: name.value.clone(), kind, span: name.span }));
        }
        forces
    }

    /// Keys of another kind of force element.
    fn check_stray_keys(&mut self, name: &Name, kind: &str, spec: &ForceSpec) {
        let spring = kind == "spring";
        let keys = [
            ("stiffness", spec.stiffness.as_ref().map(|q| q.span), spring),
            ("length", spec.length.as_ref().map(|q| q.span), spring),
            ("damping", spec.damping.as_ref().map(|q| q.span), spring),
            ("preload", spec.preload.as_ref().map(|q| q.span), spring),
            ("components", spec.components.as_ref().map(|triple| triple.0.span), !spring),
            ("axes", spec.axes.as_ref().map(|axes| axes.span), !spring),
            ("reaction", spec.reaction.as_ref().map(|body| body.span), !spring),
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

    fn spring(&mut self, name: &Name, force: &At<ForceSpec>, pair: &Pair) -> Option<ForceKind> {
        let spec = &force.value;
        self.check_stray_keys(name, "spring", spec);
        let what = format!("force `{}`", name.value);
        let [a, b] = pair.0.value.as_slice() else {
            self.wrong_count(pair.0.span, pair.0.value.len(), "2 bodies", &what);
            return None;
        };
        let sides =
            [self.carrier(a, &what).map(|body| (body, a)), self.carrier(b, &what).map(|body| (body, b))];
        if let ([Some((first, _)), Some((second, _))], true) = (sides, a.value == b.value)
            && first == second
        {
            let message = format!("the spring `{}` connects `{}` with itself", name.value, a.value);
            self.report(Diagnostic::new(Code::SameBody, message).at(pair.0.span, ""));
        }
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
        Some(ForceKind::Spring { bodies, at, stiffness, rest, damping, preload })
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
        Some(ForceKind::Force { body: pushed?, reaction, at, components: components?, axes })
    }

    fn turn(&mut self, name: &Name, force: &At<ForceSpec>, body: &Name) -> Option<ForceKind> {
        self.check_stray_keys(name, "torque", &force.value);
        let turned = self.carrier(body, &place("torque", "force", name));
        let components = self.components(name, force, Dimension::TORQUE);
        let (reaction, axes) = self.sides(name, &force.value, turned, body.span);
        Some(ForceKind::Torque { body: turned?, reaction, components: components?, axes })
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
