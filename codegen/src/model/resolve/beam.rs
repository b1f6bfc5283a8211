//! A flexible body as a beam along its rod, tube or box: where it lies, what it consists of, what is looked at.
//! Out: [`Flexible`]. The modes themselves are computed by [`crate::flexible`].

use super::flexible::{Bending, hinges, section_axes};
use super::inertia;
use super::resolver::{Resolver, place};
use super::section::{SAME_PLACE, outer_stress};
use crate::diagnostic::Code;
use crate::flexible::{
    Beam, BeamError, BeamInput, Counts, MODE_LIMIT, Material, ModalData, Node, Section, Theory,
};
use crate::id::PointId;
use crate::model::{Flexible, Inertia, LeftOut, Station};
use crate::spec::{At, Dimension, FlexibleSpec, Name, Quantity, TheorySpec};

/// Places along the link whose displacement and stress are columns, as shares of its length, unless the file
/// names others. The middle always is.
const STATIONS: [f64; 2] = [0.25, 0.75];

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
    pub(super) fn beam(&mut self, of: Bending<'_>) -> Option<Flexible> {
        let Bending { name, spec, .. } = of;
        let axis = self.link_axis(of)?;
        let input = self.beam_input(of, &axis);
        let counts = input.as_ref().map(|input| input.modes);
        let plain = spec.value.steps.is_none() && spec.value.masses.is_none() && spec.value.section.is_none();
        if plain && counts == Some(Counts::default()) || self.has_errors() {
            return None;
        }
        let input = input?;
        match self.solved(of, &axis, &input) {
            Ok(flexible) => Some(flexible),
            Err(error) => {
                let message = format!("the flexible body `{}` has no modes: {error}", name.value);
                self.refuse(Code::BadModes, spec.span, message).help("change that value in `flexible`");
                None
            }
        }
    }

    fn link_axis(&mut self, of: Bending<'_>) -> Option<Axis> {
        let Bending { name, carrier, spec, body, joints, .. } = of;
        let (Inertia::Rod { ends, .. } | Inertia::Box { ends, .. }) = &body.inertia else {
            let message = format!("only a rod, tube or box bends by itself, not `{}`", name.value);
            self.refuse(Code::ConflictingKeys, spec.span, message)
                .help("name a file of modal data: `flexible = { data = \"body.toml\", origin = \"P\" }`");
            return None;
        };
        let [start, end] = ends.map(|point| self.fixed_position(name, point, carrier));
        let x = inertia::unit(inertia::between(start, end))?;
        let given = spec.value.section.as_ref().and_then(|section| section.value.y_axis.as_ref());
        let drawn = spec.value.drawn;
        let chosen = || {
            let hinges: Vec<_> = hinges(carrier, joints).into_iter().map(|axis| drawn.before(axis)).collect();
            section_axes(drawn.before(x), &hinges).map(|axis| drawn.after(axis))
        };
        let along = match (&body.inertia, given) {
            (_, Some(axis)) => self.direction(axis, &place("y_axis", "body", name)),
            (Inertia::Box { width_axis, .. }, None) => Some(*width_axis),
            _ => drawn.is_turned().then(|| chosen()[1]),
        };
        let frame = match along.and_then(|y| inertia::unit(inertia::perpendicular_part(y, x))) {
            Some(y) => [x, y, inertia::cross(x, y)],
            None => chosen(),
        };
        Some(Axis { origin: ends[0], start, frame, length: inertia::distance(start, end) })
    }

    fn beam_input(&mut self, of: Bending<'_>, axis: &Axis) -> Option<BeamInput> {
        let Bending { name, spec, body, .. } = of;
        let own = &spec.value;
        let count = |this: &mut Self, key: &str, written: Option<&Quantity>| {
            let value = this.fixed(name, key, written, Dimension::NONE, 0.0);
            if let Some(written) = written
                && !value.is_nan()
                && !(value.fract() == 0.0 && (0.0..=MODE_LIMIT as f64).contains(&value))
            {
                let message = format!("{} is {value}, not a number of modes", place(key, "body", name));
                let help = format!("write a whole number from 0 to {MODE_LIMIT}");
                this.refuse(Code::BadModes, written.span, message).help(help);
                return 0;
            }
            // Checked above to be a small whole number, or not known, which is reported.
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
            self.lacking(spec.span, spec.span, key, message).help(format!("add `{key} = {example}`"));
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
            self.refuse(Code::BadModes, written.span, message)
                .help("1 is linear; 2 adds foreshortening and geometric stiffness");
        }
        let along = of.uses.iter().map(|own| axis.local(self.fixed_position(name, own.point, of.carrier))[0]);
        let along: Vec<f64> = along.collect();
        let hold = self.hold(of, &along, &axis.frame, axis.length)?;
        let second_order = order == 2;
        Some(BeamInput { segments, masses, theory, hold, modes, damping_ratio, second_order })
    }

    fn solved(&mut self, of: Bending<'_>, axis: &Axis, input: &BeamInput) -> Result<Flexible, BeamError> {
        let Bending { name, carrier, spec, uses, .. } = of;
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
        let modulus = input.segments.first().map(|segment| segment.material.youngs_modulus);
        let young = modulus.zip(spec.value.young.as_ref().map(|written| written.span));
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
            young,
            damped: spec.value.damping.as_ref().map_or(spec.span, |written| written.span),
            left_out: left_out
                .map(|(name, frequency)| LeftOut {
                    name: name.to_owned(),
                    torsion: name == "torsion",
                    frequency,
                })
                .to_vec(),
            data: data.with_equal_numbers(),
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
        let shares: Vec<f64> = match &spec.value.stations {
            None => STATIONS.to_vec(),
            Some(written) => {
                let shares = written.value.iter();
                shares.map(|x| self.fixed(name, "stations", Some(x), Dimension::NONE, 0.5)).collect()
            }
        };
        let numbered = shares.into_iter().enumerate().map(|(at, share)| ((at + 1).to_string(), share));
        std::iter::once((String::new(), 0.5)).chain(numbered).collect()
    }
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
