//! Bodies: which of the descriptions it is, and that its numbers are possible.

use super::inertia;
use super::names::Thing;
use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::{Code, Diagnostic};
use crate::id::{BodyId, PointId};
use crate::model::{Amount, Body, Carrier, Formula, Inertia, Point, Position};
use crate::source::Span;
use crate::spec::{At, BodySpec, Centre, Dimension, Name, Pair, Quantity, Table, Widths};

impl Resolver<'_> {
    pub(super) fn resolve_bodies(&mut self, table: &Table<BodySpec>) -> Vec<Body> {
        let bodies = table.0.iter().enumerate();
        let bodies = bodies.map(|(position, (name, body))| Body {
            name: name.value.clone(),
            inertia: self.inertia_of(Carrier::Body(BodyId::new(position)), name, body),
            flexible: None,
            span: name.span,
        });
        bodies.collect()
    }

    fn inertia_of(&mut self, carrier: Carrier, name: &Name, body: &At<BodySpec>) -> Inertia {
        let spec = &body.value;
        let kinds = [("rod", &spec.rod), ("tube", &spec.tube), ("box", &spec.cuboid)];
        let mut written = kinds.iter().filter_map(|(key, pair)| pair.as_ref().map(|pair| (*key, pair)));
        let Some((kind, pair)) = written.next() else {
            return self.given(carrier, name, body);
        };
        if let Some((other, _)) = written.next() {
            let message = format!("body `{}` is both a {kind} and a {other}", name.value);
            self.refuse(Code::ConflictingKeys, name.span, message).help("choose one");
        }
        if spec.massless {
            let message = format!("body `{}` is a {kind} and has no mass", name.value);
            self.refuse(Code::ConflictingKeys, name.span, message).help("choose one");
        }
        self.check_stray(name, kind, spec);
        let ends = self.ends(carrier, name, kind, pair);
        let amount = self.amount(name, body);
        if kind == "box" {
            return self.cuboid(carrier, name, body, ends, amount);
        }
        let radius = self.required(name, body, &spec.radius, "radius", Dimension::LENGTH);
        self.check_positive(&radius, false, &place("radius", "body", name));
        let inner_radius = if kind == "tube" {
            self.inner_radius(name, body, &radius)
        } else {
            Formula::number(0.0, Dimension::LENGTH)
        };
        Inertia::Rod { ends, radius, inner_radius, amount }
    }

    /// Keys that another description of a body has.
    fn check_stray(&mut self, name: &Name, kind: &str, spec: &BodySpec) {
        let (round, tube, cuboid, given) =
            (kind == "rod" || kind == "tube", kind == "tube", kind == "box", kind == "centre");
        for (key, span) in spec.written() {
            let (fits, owner) = match key {
                "mass" | "inertia" | "axes" | "flexible" if spec.massless => (false, "a body that has mass"),
                "radius" => (round, "a rod or tube"),
                "inner_radius" => (tube, "a tube"),
                "width" | "width_axis" => (cuboid, "a box"),
                "density" => (!given, "a rod, tube or box"),
                "centre" | "inertia" | "axes" => (given, "a body with `mass`, `centre` and `inertia`"),
                _ => continue,
            };
            if !fits {
                let message = format!("`{key}` of body `{}` belongs to {owner}", name.value);
                self.refuse(Code::ConflictingKeys, span, message).help("take it away");
            }
        }
    }

    fn ends(&mut self, carrier: Carrier, name: &Name, kind: &str, pair: &Pair) -> [PointId; 2] {
        let what = format!("body `{}`", name.value);
        let nowhere = [PointId::new(0); 2];
        let [a, b] = pair.0.value.as_slice() else {
            self.wrong_count(pair.0.span, pair.0.value.len(), "2 points", &place(kind, "body", name));
            return nowhere;
        };
        let as_seen = Some((carrier, name));
        let (from, to) = (self.point_on(a, as_seen, &what), self.point_on(b, as_seen, &what));
        let (Some(from), Some(to)) = (from, to) else { return nowhere };
        let (start, end) = (self.position_value(from, carrier), self.position_value(to, carrier));
        if inertia::distance(start, end) == 0.0 {
            let message = format!(
                "the {kind} `{}` has no length: `{}` and `{}` are one place",
                name.value, a.value, b.value
            );
            self.refuse(Code::ZeroLength, pair.0.span, message)
                .help("move one of the points, or name another");
        }
        [from, to]
    }

    fn amount(&mut self, name: &Name, body: &At<BodySpec>) -> Amount {
        let spec = &body.value;
        if let (Some(density), Some(mass)) = (&spec.density, &spec.mass) {
            let message =
                format!("body `{}` has a density and a mass: one follows from the other", name.value);
            self.refuse(Code::ConflictingKeys, mass.span, message)
                .also(density.span, "")
                .help("keep one of them");
        }
        if let Some(mass) = &spec.mass {
            let what = place("mass", "body", name);
            let mass = self.formula(mass, Some(Dimension::MASS), Allowed::PARAMETERS, &what);
            self.check_positive(&mass, false, &what);
            return Amount::Mass(mass);
        }
        let density = self.required(name, body, &spec.density, "density", Dimension::of(-3, 1, 0));
        self.check_positive(&density, false, &place("density", "body", name));
        Amount::Density(density)
    }

    /// A quantity that must be there.
    fn required(
        &mut self,
        name: &Name,
        body: &At<BodySpec>,
        quantity: &Option<Quantity>,
        key: &str,
        dimension: Dimension,
    ) -> Formula {
        if let Some(quantity) = quantity {
            return self.formula(quantity, Some(dimension), Allowed::PARAMETERS, &place(key, "body", name));
        }
        let or = if key == "density" { " or `mass`" } else { "" };
        let example = match key {
            "radius" => "6 mm".to_owned(),
            "inner_radius" => "5 mm".to_owned(),
            _ => dimension.example(),
        };
        let message = format!("body `{}` has no `{key}`{or}", name.value);
        self.missing(body.span, name.span, Code::MissingKey, message)
            .help(format!("add `{key} = \"{example}\"`"));
        Formula::number(f64::NAN, dimension)
    }

    fn inner_radius(&mut self, name: &Name, body: &At<BodySpec>, radius: &Formula) -> Formula {
        let inner = self.required(name, body, &body.value.inner_radius, "inner_radius", Dimension::LENGTH);
        let what = place("inner_radius", "body", name);
        self.check_positive(&inner, true, &what);
        let (inside, outside) = (self.value(&inner), self.value(radius));
        if inside >= outside && outside > 0.0 {
            let message =
                format!("{what} is {}, not less than `radius`, {}", self.told(&inner), self.told(radius));
            self.refuse(Code::NotPositive, inner.span, message).label("no wall is left");
        }
        inner
    }

    fn cuboid(
        &mut self,
        carrier: Carrier,
        name: &Name,
        body: &At<BodySpec>,
        ends: [PointId; 2],
        amount: Amount,
    ) -> Inertia {
        let what = place("width", "body", name);
        let edges = match &body.value.width {
            Some(Widths::Square(edge)) => [edge, edge].map(Some),
            Some(Widths::Rectangle(list)) => {
                if list.value.len() != 2 {
                    self.wrong_count(list.span, list.value.len(), "2", &what);
                }
                [list.value.first(), list.value.get(1)]
            }
            None => {
                let message = format!("box `{}` has no `width`", name.value);
                self.missing(body.span, name.span, Code::MissingKey, message).help(
                    "add `width = \"10 mm\"`, or two edges and `width_axis`, the direction of the first",
                );
                [None, None]
            }
        };
        let width = edges.map(|edge| match edge {
            Some(edge) => self.formula(edge, Some(Dimension::LENGTH), Allowed::PARAMETERS, &what),
            None => Formula::number(f64::NAN, Dimension::LENGTH),
        });
        self.check_positive(&width[0], false, &what);
        if matches!(body.value.width, Some(Widths::Rectangle(_))) {
            self.check_positive(&width[1], false, &what);
        }
        let width_axis = self.width_axis(carrier, name, body, ends);
        Inertia::Box { ends, width, width_axis, amount }
    }

    /// The direction written, made to be at right angles to the long edge; any such for a square box.
    fn width_axis(
        &mut self,
        carrier: Carrier,
        name: &Name,
        body: &At<BodySpec>,
        ends: [PointId; 2],
    ) -> [f64; 3] {
        if self.points.is_empty() {
            return [1.0, 0.0, 0.0];
        }
        let along = inertia::unit(inertia::between(
            self.position_value(ends[0], carrier),
            self.position_value(ends[1], carrier),
        ));
        let Some(axis) = &body.value.width_axis else {
            if let Some(Widths::Rectangle(list)) = &body.value.width {
                let message = format!("box `{}` does not say which way its widths point", name.value);
                self.missing(body.span, list.span, Code::MissingKey, message)
                    .help("add `width_axis = [0, 0, 1]`, the direction of the first of `width`");
            }
            let along = along.unwrap_or([1.0, 0.0, 0.0]);
            let drawn = body.value.flexible.as_ref().map(|bent| bent.value.drawn).unwrap_or_default();
            if !drawn.is_turned() {
                return inertia::any_perpendicular(along);
            }
            // Turned with the drawing, and made to be at right angles to the last place.
            let across = drawn.after(inertia::any_perpendicular(drawn.before(along)));
            return inertia::unit(inertia::perpendicular_part(across, along)).unwrap_or(across);
        };
        let what = place("width_axis", "body", name);
        let (Some(axis_value), Some(along)) = (self.direction(axis, &what), along) else {
            return [1.0, 0.0, 0.0];
        };
        let across = inertia::perpendicular_part(axis_value, along);
        // A tunable length could turn the edge away from an axis that was made to fit it only once.
        let turns = ends.iter().any(|end| {
            let position = self.points[end.index()].position_for(carrier);
            position.iter().any(|x| self.is_tunable(x))
        });
        let slanted = inertia::dot(axis_value, along).abs();
        let fault = match inertia::unit(across) {
            // 1e-6 rad: nearer than that the direction across is only rounding.
            Some(across) if slanted < 1.0 - 1e-12 => {
                if !turns || slanted < 1e-9 {
                    return across;
                }
                Diagnostic::new(Code::NotPerpendicular, format!("{what} is not at right angles to the long edge"))
                    .help("the edge depends on a tunable parameter, so the direction cannot be corrected once for all")
            }
            _ => Diagnostic::new(Code::ParallelAxes, format!("{what} points along the box"))
                .help("it is the direction of the first of `width`, across the box"),
        };
        self.report(fault.at(axis.0.span, ""));
        axis_value
    }

    /// Mass, centre and inertia as numbers from elsewhere.
    fn given(&mut self, carrier: Carrier, name: &Name, body: &At<BodySpec>) -> Inertia {
        let spec = &body.value;
        if spec.centre.is_none() && spec.inertia.is_none() && !spec.massless {
            let message = format!("nothing says what body `{}` is", name.value);
            self.missing(body.span, name.span, Code::NoKind, message)
                .help("write `rod = [\"A\", \"B\"]`, `tube`, `box`, or `mass`, `centre` and `inertia`");
        } else {
            self.check_stray(name, "centre", spec);
        }
        let mass = if spec.massless {
            Formula::number(0.0, Dimension::MASS)
        } else if spec.centre.is_none() && spec.mass.is_none() {
            Formula::number(f64::NAN, Dimension::MASS)
        } else {
            let mass = self.required(name, body, &spec.mass, "mass", Dimension::MASS);
            self.check_positive(&mass, false, &place("mass", "body", name));
            mass
        };
        let centre = match &spec.centre {
            Some(Centre::Point(point)) => {
                self.point_on(point, Some((carrier, name)), &format!("body `{}`", name.value))
            }
            Some(Centre::At(triple)) => {
                let position = self.triple(
                    triple,
                    Dimension::LENGTH,
                    Allowed::PARAMETERS,
                    &place("centre", "body", name),
                );
                Some(self.add_point(format!("{}_centre", name.value), position, carrier, triple.0.span))
            }
            None => {
                if spec.inertia.is_some() || spec.massless {
                    let message = format!("body `{}` has no `centre`", name.value);
                    self.missing(body.span, name.span, Code::MissingKey, message)
                        .help("add `centre = \"P\"`, a point, or its coordinates");
                }
                None
            }
        };
        let (inertia, axes) = self.given_inertia(name, spec);
        Inertia::Given { mass, centre: centre.unwrap_or(PointId::new(0)), inertia, axes }
    }

    fn add_point(&mut self, name: String, position: [Formula; 3], carrier: Carrier, span: Span) -> PointId {
        let id = PointId::new(self.points.len());
        self.names.declare(&Name { span, value: name.clone() }, Thing::Point(id), &mut self.diagnostics);
        let position = Position::Shared(position);
        self.points.push(Point { name, position, carrier, assumed: false, span });
        id
    }
}
