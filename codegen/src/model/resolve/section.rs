//! What a beam consists of: its sections piece by piece, its material and concentrated masses.

use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::flexible::{ConcentratedMass, Material, Outline, Properties, Section, Segment, Strain};
use crate::model::{Amount, Formula, Inertia};
use crate::spec::{At, Dimension, FlexibleSpec, Name, Quantity, SectionSpec, StepSpec, Widths};

/// Two places nearer than this share of the length are one: positions written with six digits differ by less.
pub(super) const SAME_PLACE: f64 = 1e-6;

impl Resolver<'_> {
    pub(super) fn section(&mut self, name: &Name, spec: &FlexibleSpec, inertia: &Inertia) -> Section {
        if let Some(section) = &spec.section {
            return self.general_section(name, section);
        }
        let sizes = match inertia {
            Inertia::Rod { radius, inner_radius, .. } => vec![radius.clone(), inner_radius.clone()],
            Inertia::Box { width, .. } => width.to_vec(),
            Inertia::Given { .. } => Vec::new(),
        };
        for size in &sizes {
            self.refuse_tunable(size, &format!("the section of the flexible body `{}`", name.value));
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
                self.lacking(section.span, section.span, key, message)
                    .help("a section has `area`, `Iy`, `Iz`, and may have `J` and `fibres`");
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

    pub(super) fn density(&mut self, name: &Name, inertia: &Inertia, section: &Section, length: f64) -> f64 {
        let (Inertia::Rod { amount, .. } | Inertia::Box { amount, .. }) = inertia else { return f64::NAN };
        let formula = match amount {
            Amount::Density(formula) | Amount::Mass(formula) => formula,
        };
        self.refuse_tunable(formula, &format!("the mass of the flexible body `{}`", name.value));
        let value = self.value(formula);
        match amount {
            Amount::Density(_) => value,
            Amount::Mass(_) => value / (section.properties(0.3).area * length),
        }
    }

    pub(super) fn refuse_tunable(&mut self, formula: &Formula, what: &str) {
        if self.is_tunable(formula) {
            self.refuse(Code::TunableNotAllowed, formula.span, format!("{what} is tunable"))
                .help("modes are computed at generation; take the `tunable` mark away");
        }
    }

    /// Pieces from the first end to the second; what the steps leave has the body's own section.
    pub(super) fn segments(
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
                self.refuse(Code::BadModes, step.span, message)
                    .help(format!("steps end in rising order, from {start} m up to {length} m"));
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

    pub(super) fn point_masses(&mut self, name: &Name, spec: &FlexibleSpec) -> Vec<ConcentratedMass> {
        let written = spec.masses.as_ref().map_or(&[][..], |masses| &masses.value).iter();
        let masses = written.map(|At { value: own, .. }| ConcentratedMass {
            x: self.fixed(name, "at", own.at.as_ref(), Dimension::LENGTH, f64::NAN),
            mass: self.fixed(name, "mass", own.mass.as_ref(), Dimension::MASS, f64::NAN),
            inertia: [0.0; 3],
        });
        masses.collect()
    }
}

fn round(outer: f64, inner: f64) -> Section {
    if inner > 0.0 { Section::Tube { outer, inner } } else { Section::Round { radius: outer } }
}

/// Bending stress at the outer fibres in +y and +z per unit of each modal coordinate [Pa].
pub(super) fn outer_stress(strain: &Strain) -> Vec<[f64; 2]> {
    let (y, z) = match strain.outline {
        Outline::Round { radius } => (radius, radius),
        Outline::Box { y, z } => (y, z),
    };
    let curvatures = strain.curvature_y.iter().zip(&strain.curvature_z);
    curvatures
        .map(|(about_y, about_z)| [-strain.youngs_modulus * y * about_z, strain.youngs_modulus * z * about_y])
        .collect()
}
