//! A flexible body as a beam along its rod, tube or box: sections, pieces, masses, how it is held.
//! Out: [`Flexible`]. The modes themselves are computed by [`crate::flexible`].

use super::flexible::{Use, Written, hinges, section_axes};
use super::inertia;
use super::resolver::{Resolver, place};
use crate::diagnostic::{Code, Diagnostic};
use crate::flexible::{
    Attachment, Beam, BeamError, BeamInput, ConcentratedMass, Counts, Hold, Material, ModalData, Node,
    Outline, Properties, Section, Segment, Theory,
};
use crate::id::PointId;
use crate::model::{Amount, Body, Carrier, Flexible, Inertia, Joint, LeftOut, Station};
use crate::spec::{
    At, Dimension, FlexibleSpec, HeldSpec, Name, Quantity, SectionSpec, StepSpec, TheorySpec, Widths,
};

/// Places along the link whose displacement and stress are columns, as shares of its length, unless the file
/// names others. The middle always is.
const STATIONS: [f64; 2] = [0.25, 0.75];

/// Two places nearer than this share of the length are one: positions written with six digits differ by less.
const SAME_PLACE: f64 = 1e-6;

/// Where the link lies.
struct Axis {
    origin: PointId,
    start: [f64; 3],
    frame: [[f64; 3]; 3],
    length: f64,
}

impl Axis {
    /// Components of a place in the floating frame.
    fn local(&self, place: [f64; 3]) -> [f64; 3] {
        let arm = inertia::between(self.start, place);
        self.frame.map(|axis| inertia::dot(axis, arm))
    }
}

impl Resolver<'_> {
    /// The beam's constants; nothing if the file asks for no modes, or if something is wrong.
    pub(super) fn beam(
        &mut self,
        carrier: Carrier,
        written: Written<'_>,
        body: &Body,
        joints: &[Joint],
        uses: &[Use],
    ) -> Option<Flexible> {
        let (name, _, spec) = written;
        let axis = self.link_axis(carrier, name, spec, body, joints)?;
        let input = self.beam_input(carrier, name, (spec, body), &axis, uses);
        let counts = input.as_ref().map(|input| input.modes);
        let plain = spec.value.steps.is_none() && spec.value.masses.is_none() && spec.value.section.is_none();
        if plain && counts == Some(Counts::default()) || self.has_errors() {
            return None;
        }
        let input = input?;
        match self.solved(carrier, name, (spec, &axis), &input, uses) {
            Ok(flexible) => Some(flexible),
            Err(error) => {
                let message = format!("the flexible body `{}` has no modes: {error}", name.value);
                self.report(Diagnostic::new(Code::BadModes, message).at(spec.span, ""));
                None
            }
        }
    }

    fn link_axis(
        &mut self,
        carrier: Carrier,
        name: &Name,
        spec: &At<FlexibleSpec>,
        body: &Body,
        joints: &[Joint],
    ) -> Option<Axis> {
        let (Inertia::Rod { ends, .. } | Inertia::Box { ends, .. }) = &body.inertia else {
            let message = format!("only a rod, tube or box bends by itself, not `{}`", name.value);
            let fault = Diagnostic::new(Code::ConflictingKeys, message).at(spec.span, "");
            self.report(
                fault
                    .help("name a file of modal data: `flexible = { data = \"body.toml\", origin = \"P\" }`"),
            );
            return None;
        };
        let [start, end] = ends.map(|point| self.fixed_position(name, point, carrier));
        let x = inertia::unit(inertia::between(start, end))?;
        let given = spec.value.section.as_ref().and_then(|section| section.value.y_axis.as_ref());
        let along = match (&body.inertia, given) {
            (_, Some(axis)) => self.direction(axis, &place("y_axis", "body", name)),
            (Inertia::Box { width_axis, .. }, None) => Some(*width_axis),
            _ => None,
        };
        let frame = match along.and_then(|y| inertia::unit(inertia::perpendicular_part(y, x))) {
            Some(y) => [x, y, inertia::cross(x, y)],
            None => section_axes(x, &hinges(carrier, joints)),
        };
        Some(Axis { origin: ends[0], start, frame, length: inertia::distance(start, end) })
    }

    fn beam_input(
        &mut self,
        carrier: Carrier,
        name: &Name,
        (spec, body): (&At<FlexibleSpec>, &Body),
        axis: &Axis,
        uses: &[Use],
    ) -> Option<BeamInput> {
        let own = &spec.value;
        let count = |this: &mut Self, key: &str, written: Option<&Quantity>| {
            let value = this.fixed(name, key, written, Dimension::NONE, 0.0);
            if let Some(written) = written
                && !(value.fract() == 0.0 && (0.0..=100.0).contains(&value))
            {
                let message = format!("{} is {value}, not a number of modes", place(key, "body", name));
                let fault = Diagnostic::new(Code::BadModes, message).at(written.span, "");
                this.report(fault.help("write a whole number, for instance 6"));
                return 0;
            }
            // Checked above to be a small whole number.
            value as usize
        };
        let modes = Counts {
            bending: count(self, "modes", own.modes.as_ref()),
            axial: count(self, "axial", own.axial.as_ref()),
            torsion: count(self, "torsion", own.torsion.as_ref()),
        };
        if own.young.is_none() || own.modes.is_none() {
            let key = if own.young.is_none() { "young" } else { "modes" };
            let example = if own.young.is_none() { "\"210 GPa\"" } else { "6" };
            let message = format!("the flexible body `{}` has no `{key}`", name.value);
            let fault = Diagnostic::new(Code::MissingKey, message).at(spec.span, "");
            self.report(fault.help(format!("add `{key} = {example}`")));
        }
        let pressure = Dimension::of(-1, 1, -2);
        let youngs_modulus = self.fixed(name, "young", own.young.as_ref(), pressure, f64::NAN);
        let poisson_ratio = self.fixed(name, "poisson", own.poisson.as_ref(), Dimension::NONE, 0.3);
        let damping_ratio = self.fixed(name, "damping", own.damping.as_ref(), Dimension::NONE, 0.0);
        let section = self.section(name, own, &body.inertia);
        let density = self.density(name, &body.inertia, &section, axis.length);
        let material = Material { youngs_modulus, poisson_ratio, density };
        let mut segments = self.segments(name, own.steps.as_ref(), axis.length, section, material);
        if let Some(written) = &own.shear_coefficient {
            let kappa = self.fixed(name, "shear_coefficient", Some(written), Dimension::NONE, 1.0);
            for segment in &mut segments {
                let mut properties = segment.section.properties(poisson_ratio);
                properties.shear = Some([kappa; 2]);
                segment.section = Section::General(properties);
            }
        }
        let masses = self.point_masses(name, own);
        let theory = match own.theory.as_ref().map_or(TheorySpec::Timoshenko, |theory| theory.value) {
            TheorySpec::EulerBernoulli => Theory::EulerBernoulli,
            TheorySpec::Rayleigh => Theory::Rayleigh,
            TheorySpec::Timoshenko => Theory::Timoshenko,
        };
        let order = own.order.as_ref().map_or(1, |order| order.value);
        if let (Some(written), false) = (&own.order, order == 1 || order == 2) {
            let message = format!("`order` of body `{}` is {order}", name.value);
            let fault = Diagnostic::new(Code::BadModes, message).at(written.span, "");
            self.report(fault.help("1 is linear; 2 adds foreshortening and geometric stiffness"));
        }
        let hold = self.hold(carrier, name, own.held.as_ref(), axis, uses)?;
        let second_order = order == 2;
        Some(BeamInput { segments, masses, theory, hold, modes, damping_ratio, second_order })
    }

    fn section(&mut self, name: &Name, spec: &FlexibleSpec, inertia: &Inertia) -> Section {
        if let Some(section) = &spec.section {
            return self.general_section(name, section);
        }
        match inertia {
            Inertia::Rod { radius, inner_radius, .. } => round(self.value(radius), self.value(inner_radius)),
            Inertia::Box { width, .. } => {
                let [y, z] = self.values_of(width);
                Section::Rectangle { y, z }
            }
            Inertia::Given { .. } => round(f64::NAN, 0.0),
        }
    }

    fn general_section(&mut self, name: &Name, section: &At<SectionSpec>) -> Section {
        let own = &section.value;
        let (square, fourth) = (Dimension::of(2, 0, 0), Dimension::of(4, 0, 0));
        for (key, written) in [("area", &own.area), ("Iy", &own.iy), ("Iz", &own.iz)] {
            if written.is_none() {
                let message = format!("the section of body `{}` has no `{key}`", name.value);
                let fault = Diagnostic::new(Code::MissingKey, message).at(section.span, "");
                self.report(fault.help("a section has `area`, `Iy`, `Iz`, and may have `J` and `fibres`"));
            }
        }
        let area = self.fixed(name, "area", own.area.as_ref(), square, f64::NAN);
        let iy = self.fixed(name, "Iy", own.iy.as_ref(), fourth, f64::NAN);
        let iz = self.fixed(name, "Iz", own.iz.as_ref(), fourth, f64::NAN);
        let torsion = self.fixed(name, "J", own.j.as_ref(), fourth, iy + iz);
        let fibres = own.fibres.as_ref().map(|list| {
            if list.value.len() != 2 {
                self.wrong_count(list.span, list.value.len(), "2 distances", &place("fibres", "body", name));
            }
            let at = |this: &mut Self, index: usize| {
                this.fixed(name, "fibres", list.value.get(index), Dimension::LENGTH, f64::NAN)
            };
            Outline::Box { y: at(self, 0), z: at(self, 1) }
        });
        Section::General(Properties { area, iy, iz, torsion, shear: None, outline: fibres })
    }

    fn density(&mut self, name: &Name, inertia: &Inertia, section: &Section, length: f64) -> f64 {
        let (Inertia::Rod { amount, .. } | Inertia::Box { amount, .. }) = inertia else { return f64::NAN };
        let formula = match amount {
            Amount::Density(formula) | Amount::Mass(formula) => formula,
        };
        if formula.depends_on(&|id| self.parameters[id.index()].tunable) {
            let message = format!("the mass of the flexible body `{}` is tunable", name.value);
            let fault = Diagnostic::new(Code::TunableNotAllowed, message).at(formula.span, "");
            self.report(fault.help("modes are computed at generation; take the `tunable` mark away"));
        }
        let value = self.value(formula);
        match amount {
            Amount::Density(_) => value,
            Amount::Mass(_) => value / (section.properties(0.3).area * length),
        }
    }

    /// Pieces from the first end to the second; what the steps leave has the body's own section.
    fn segments(
        &mut self,
        name: &Name,
        steps: Option<&At<Vec<At<StepSpec>>>>,
        length: f64,
        section: Section,
        material: Material,
    ) -> Vec<Segment> {
        let mut segments = Vec::new();
        let mut start = 0.0;
        for step in steps.map_or(&[][..], |steps| &steps.value) {
            let own = &step.value;
            let end = self.fixed(name, "to", own.to.as_ref(), Dimension::LENGTH, f64::NAN);
            if end <= start || end > length * (1.0 + SAME_PLACE) || end.is_nan() {
                let message = format!("a step of body `{}` ends at {end} m", name.value);
                let fault = Diagnostic::new(Code::BadModes, message).at(step.span, "");
                self.report(
                    fault.help(format!("steps end in rising order, from {start} m up to {length} m")),
                );
                break;
            }
            let own_section = match (&own.radius, &own.width) {
                (Some(radius), _) => {
                    let outer = self.fixed(name, "radius", Some(radius), Dimension::LENGTH, f64::NAN);
                    let inner =
                        self.fixed(name, "inner_radius", own.inner_radius.as_ref(), Dimension::LENGTH, 0.0);
                    round(outer, inner)
                }
                (None, Some(width)) => self.rectangle(name, width),
                (None, None) => section,
            };
            let end = end.min(length);
            segments.push(Segment { length: end - start, section: own_section, material });
            start = end;
        }
        if length - start > SAME_PLACE * length {
            segments.push(Segment { length: length - start, section, material });
        }
        segments
    }

    fn rectangle(&mut self, name: &Name, width: &Widths) -> Section {
        let edges: Vec<&Quantity> = match width {
            Widths::Square(edge) => vec![edge, edge],
            Widths::Rectangle(list) => list.value.iter().collect(),
        };
        let at = |this: &mut Self, index: usize| {
            this.fixed(name, "width", edges.get(index).copied(), Dimension::LENGTH, f64::NAN)
        };
        Section::Rectangle { y: at(self, 0), z: at(self, 1) }
    }

    fn point_masses(&mut self, name: &Name, spec: &FlexibleSpec) -> Vec<ConcentratedMass> {
        let mut masses = Vec::new();
        for mass in spec.masses.as_ref().map_or(&[][..], |masses| &masses.value) {
            let x = self.fixed(name, "at", mass.value.at.as_ref(), Dimension::LENGTH, f64::NAN);
            let value = self.fixed(name, "mass", mass.value.mass.as_ref(), Dimension::MASS, f64::NAN);
            masses.push(ConcentratedMass { x, mass: value, inertia: [0.0; 3] });
        }
        masses
    }

    /// As the file says; else by the number of places where joints hold the link.
    fn hold(
        &mut self,
        carrier: Carrier,
        name: &Name,
        held: Option<&At<HeldSpec>>,
        axis: &Axis,
        uses: &[Use],
    ) -> Option<Hold> {
        let mut places: Vec<Attachment> = Vec::new();
        for own in uses.iter().filter(|own| own.held) {
            let x = axis.local(self.fixed_position(name, own.point, carrier))[0];
            match places.iter_mut().find(|known| (known.x - x).abs() < SAME_PLACE * axis.length) {
                Some(known) => known.rotation |= own.turns,
                None => places.push(Attachment { x, rotation: own.turns }),
            }
        }
        places.sort_by(|a, b| a.x.total_cmp(&b.x));
        let default = match places.len() {
            0 => HeldSpec::Free,
            1 => HeldSpec::Clamped,
            2 => HeldSpec::Pinned,
            _ => HeldSpec::CraigBampton,
        };
        match held.map_or(default, |held| held.value) {
            HeldSpec::Clamped if held.is_none() && places[0].x.abs() > SAME_PLACE * axis.length => {
                // Held somewhere else than at its first end: the mean axes favour no place.
                Some(Hold::Free)
            }
            HeldSpec::Clamped => Some(Hold::Clamped),
            HeldSpec::Free => Some(Hold::Free),
            HeldSpec::Pinned if places.len() >= 2 => {
                Some(Hold::Pinned(Some([places[0].x, places[places.len() - 1].x])))
            }
            HeldSpec::Pinned => Some(Hold::Pinned(None)),
            HeldSpec::CraigBampton if places.len() >= 2 => {
                // Moments bend a link between revolutes only if they are passed across its ends.
                let middle = 1..places.len() - 1;
                for (index, place) in places.iter_mut().enumerate() {
                    place.rotation &= middle.contains(&index);
                }
                Some(Hold::CraigBampton(places))
            }
            HeldSpec::CraigBampton => {
                let message = format!("`{}` is held at fewer than two places", name.value);
                let fault =
                    Diagnostic::new(Code::BadModes, message).at(held.map_or(name.span, |h| h.span), "");
                self.report(fault.help("take `held` away"));
                None
            }
        }
    }

    fn solved(
        &mut self,
        carrier: Carrier,
        name: &Name,
        (spec, axis): (&At<FlexibleSpec>, &Axis),
        input: &BeamInput,
        uses: &[Use],
    ) -> Result<Flexible, BeamError> {
        let beam = Beam::new(input)?;
        let mut data = beam.modal_data(&[])?;
        if let Some(frequencies) = &spec.value.frequencies {
            self.tune(name, &mut data, frequencies, input.damping_ratio);
        }
        let mut nodes = Vec::new();
        for own in uses {
            let label = self.points[own.point.index()].name.clone();
            let local = axis.local(self.fixed_position(name, own.point, carrier));
            nodes.push((own.point, data.nodes.len()));
            data.nodes.push(beyond_axis(beam.node(&label, local[0])?, local));
        }
        let mut stations = Vec::new();
        for (label, share) in self.shares(name, spec) {
            let node = beam.node(&format!("station{label}"), share * axis.length)?;
            let stress = node.strain.as_ref().map(outer_stress);
            stations.push(Station { name: label, node: data.nodes.len(), stress });
            data.nodes.push(node);
        }
        let truncated = beam.truncated();
        let left_out = [
            ("bending along y", truncated.y),
            ("bending along z", truncated.z),
            ("axial", truncated.axial),
            ("torsion", truncated.torsion),
        ];
        Ok(Flexible {
            axes: axis.frame,
            origin: axis.origin,
            nodes,
            stations,
            start: vec![[0.0; 2]; data.modes.len()],
            left_out: left_out.map(|(name, frequency)| LeftOut { name: name.to_owned(), frequency }).to_vec(),
            data,
        })
    }

    /// Replaces the computed frequencies.
    fn tune(&mut self, name: &Name, data: &mut ModalData, list: &At<Vec<Quantity>>, zeta: f64) {
        if list.value.len() != data.modes.len() {
            let what = place("frequencies", "body", name);
            self.wrong_count(list.span, list.value.len(), &data.modes.len().to_string(), &what);
            return;
        }
        for (k, written) in list.value.iter().enumerate() {
            let hertz = Dimension::of(0, 0, -1);
            let frequency = self.fixed(name, "frequencies", Some(written), hertz, f64::NAN);
            let omega = std::f64::consts::TAU * frequency;
            data.modes[k].frequency = frequency;
            data.stiffness[k][k] = omega * omega;
            data.damping[k][k] = 2.0 * zeta * omega;
        }
    }

    /// Stations by label: the middle has none.
    fn shares(&mut self, name: &Name, spec: &At<FlexibleSpec>) -> Vec<(String, f64)> {
        let mut list = vec![(String::new(), 0.5)];
        match &spec.value.stations {
            None => {
                list.extend(STATIONS.iter().enumerate().map(|(at, share)| ((at + 1).to_string(), *share)));
            }
            Some(written) => {
                for (at, share) in written.value.iter().enumerate() {
                    let value = self.fixed(name, "stations", Some(share), Dimension::NONE, 0.5);
                    list.push(((at + 1).to_string(), value));
                }
            }
        }
        list
    }
}

fn round(outer: f64, inner: f64) -> Section {
    if inner > 0.0 { Section::Tube { outer, inner } } else { Section::Round { radius: outer } }
}

/// A node beside the axis moves with the section: `phi + psi x arm`.
fn beyond_axis(mut node: Node, local: [f64; 3]) -> Node {
    let arm = [0.0, local[1], local[2]];
    // Rounding of a projection; a real arm is longer.
    if arm.iter().all(|x| x.abs() < SAME_PLACE * local[0].abs().max(1e-3)) {
        return node;
    }
    for (displacement, rotation) in node.displacement.iter_mut().zip(&node.rotation) {
        let lever = inertia::cross(*rotation, arm);
        for (x, lever) in displacement.iter_mut().zip(lever) {
            *x += lever;
        }
    }
    (node.position[1], node.position[2]) = (arm[1], arm[2]);
    node
}

/// Bending stress at the outer fibres in +y and +z per unit of each modal coordinate [Pa].
fn outer_stress(strain: &crate::flexible::Strain) -> Vec<[f64; 2]> {
    let (y, z) = match strain.outline {
        Outline::Round { radius } => (radius, radius),
        Outline::Box { y, z } => (y, z),
    };
    let curvatures = strain.curvature_y.iter().zip(&strain.curvature_z);
    curvatures
        .map(|(about_y, about_z)| [-strain.youngs_modulus * y * about_z, strain.youngs_modulus * z * about_y])
        .collect()
}
