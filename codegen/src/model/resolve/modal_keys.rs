//! What must not stand beside modal data, because the data hold it. In: a body as written, its data. Out: faults.

use super::flexible::Bending;
use super::resolver::Resolver;
use crate::diagnostic::Code;
use crate::flexible::ModalData;
use crate::model::{Amount, Inertia};
use crate::spec::{BodySpec, FlexibleSpec, Name};

/// Keys of beams.
const BEAM: &[&str] = &[
    "young",
    "poisson",
    "modes",
    "axial",
    "torsion",
    "damping",
    "theory",
    "held",
    "order",
    "frequencies",
    "shear_coefficient",
    "section",
    "steps",
    "masses",
    "stations",
];
/// Keys of a body's inertia.
const INERTIA: &[&str] = &["inertia", "axes"];
/// A body's own mass is that of its data up to this part: of three digits, or of a shape that stands for it.
const SAME_MASS: f64 = 0.01;

impl Resolver<'_> {
    /// Refuses keys that would have no effect.
    pub(super) fn check_modal_keys(&mut self, name: &Name, body: &BodySpec, spec: &FlexibleSpec) {
        let of_beam = spec.written().into_iter().filter(|(key, _)| BEAM.contains(key));
        let of_body = body.written().into_iter().filter(|(key, _)| INERTIA.contains(key));
        let owners = of_beam.map(|key| (key, "a beam")).chain(of_body.map(|key| (key, "a rigid body")));
        for ((key, span), owner) in owners {
            let message = format!("`{key}` of body `{}` belongs to {owner}, not to modal data", name.value);
            self.refuse(Code::ConflictingKeys, span, message).help("take it away");
        }
    }

    /// Refuses a mass that is not that of the data, which counts.
    pub(super) fn check_modal_mass(&mut self, of: Bending<'_>, data: &ModalData) {
        let (formula, size) = match &of.body.inertia {
            Inertia::Given { mass, .. } => (mass, 1.0),
            Inertia::Rod { amount, .. } | Inertia::Box { amount, .. } => match amount {
                Amount::Mass(mass) => (mass, 1.0),
                Amount::Density(density) => (density, self.volume(of)),
            },
        };
        self.refuse_tunable(formula, &format!("the mass of the flexible body `{}`", of.name.value));
        let own = size * self.value(formula);
        // What is not a number is told elsewhere.
        if (own - data.mass).abs() > SAME_MASS * data.mass {
            let message =
                format!("the body `{}` has {own:.4} kg, its modal data {:.4} kg", of.name.value, data.mass);
            let help = format!("the data count: write `mass = \"{} kg\"`", data.mass);
            self.refuse(Code::BadModalData, formula.span, message).help(help);
        }
    }

    /// Warns of masses of modes that are not those of their couplings.
    pub(super) fn warn_modal_products(&mut self, file: &Name, data: &ModalData) {
        let Some((modes, [mass, product])) = data.mass_beside_products() else { return };
        let [one, other] = modes.map(|mode| &data.modes[mode].name);
        let of = if one == other { format!("mode `{one}`") } else { format!("modes `{one}`, `{other}`") };
        let message = format!(
            "the modal data `{}`: `mass_matrix` has {mass:.6} for {of}, and the trace of their `coupling` is {product:.6}",
            file.value
        );
        self.refuse(Code::ModalMass, file.span, message)
            .help("the mass of modes is the trace of their coupling: have the data written again by the program that made them");
    }

    /// Of a rod, tube or box [m³].
    fn volume(&self, of: Bending<'_>) -> f64 {
        let (ends, area) = match &of.body.inertia {
            Inertia::Rod { ends, radius, inner_radius, .. } => {
                let [outer, inner] = [radius, inner_radius].map(|radius| self.value(radius));
                (ends, std::f64::consts::PI * (outer * outer - inner * inner))
            }
            Inertia::Box { ends, width, .. } => (ends, self.value(&width[0]) * self.value(&width[1])),
            Inertia::Given { .. } => return f64::NAN,
        };
        let [start, end] = ends.map(|point| self.position_value(point, of.carrier));
        super::inertia::distance(start, end) * area
    }
}
