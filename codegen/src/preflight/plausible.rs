//! What a mechanism may have but hardly ever has: sizes far apart, odd materials, wide clearances, bodies that
//! nothing drives. In: a mechanism, its freedoms. Out: warnings, each with the number that is odd. Only ratios of
//! sizes count, so that a mechanism that is scaled as a whole is told the same.

use crate::diagnostic::{Code, Diagnostic};
use crate::id::BodyId;
use crate::model::{Amount, Body, Carrier, Clearance, Inertia, Joint, Mechanism};
use crate::source::Span;

use super::analysis::Analysis;
use super::losses;

/// A body is too long if it is longer than every other by more than this: linkages whose longest body is a hundred
/// times the next are not built, and a slip of units makes a factor of a thousand.
const TOO_LONG: f64 = 100.0;
/// A body is too short if it is shorter than every other by more than this: an eccentric of a few tenths of a
/// millimetre may drive a link of a metre.
const TOO_SHORT: f64 = 1e4;
/// A rod or box is too thick if its radius or width exceeds its length by more than this: a flywheel's does so ten times.
const TOO_THICK: f64 = 20.0;
/// A rod or box is too thin if it is longer than its radius or width by more than this: a wire of a metre has a tenth of a
/// millimetre, and a slip of units makes ten times as much of an ordinary rod.
const TOO_THIN: f64 = 1e4;
/// A radius of gyration is too large if it exceeds the size of the whole mechanism by more than this.
const TOO_FAR_OUT: f64 = 10.0;
/// A body is too heavy if it is heavier than every other, were these solid, by more than this: an aircraft on the smallest link
/// of its gear is below.
const TOO_HEAVY: f64 = 1e8;
/// Gravity [m/s^2] up to that in the fastest centrifuges, of a million times the earth's.
const GRAVITY: f64 = 1e7;
/// Densities [kg/m^3] from foams to just above osmium.
const DENSITIES: [f64; 2] = [10.0, 25_000.0];
/// Moduli of bearing pairs [Pa], from soft rubber on anything to diamond on diamond.
const MODULI: [f64; 2] = [100e6, 2e12];
/// Young's moduli [Pa], from the softest rubbers to just above diamond.
const YOUNGS_MODULI: [f64; 2] = [1e5, 1.5e12];
/// Hardnesses [Pa], from soft polymers to diamond.
const HARDNESSES: [f64; 2] = [1e6, 150e9];
/// Archard's k is the share of touching asperities that give a particle: severe wear of dry metals has 1e-2.
const WEAR_COEFFICIENT: f64 = 0.1;
/// Bearings have radial clearances of 1e-4 to 1e-2 of the journal's radius; published tests with
/// enlarged ones go to 5 %. Hertz's law is no longer one of a loose bearing far above.
const WIDE: f64 = 0.1;
/// A bearing with a worn depth of this share of its journal's radius has failed long before.
const DEEP: f64 = 0.25;

/// Remarks on what is odd.
pub fn remarks(mechanism: &Mechanism, analysis: &Analysis) -> Vec<Diagnostic> {
    let mut remarks = sizes(mechanism);
    remarks.extend(masses(mechanism));
    remarks.extend(gravity(mechanism));
    remarks.extend(mechanism.bodies.iter().filter_map(|body| density(mechanism, body)));
    remarks.extend(mechanism.bodies.iter().filter_map(young));
    for joint in &mechanism.joints {
        if let Some(clearance) = &joint.clearance {
            remarks.extend(bearing(mechanism, joint, clearance));
        }
    }
    remarks.extend(losses::remarks(mechanism));
    remarks.extend(loose(mechanism, analysis));
    remarks
}

/// A number with four digits, which is what people compare.
pub(super) fn shown(number: f64) -> f64 {
    format!("{number:.3e}").parse().unwrap_or(number)
}

/// With the prefix that people write: 2.5 mm, 80 MPa.
pub(super) fn with_unit(value: f64, unit: &str) -> String {
    const PREFIXES: [(f64, &str); 7] =
        [(1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "u"), (1e-9, "n")];
    let fits = |(size, prefix): &&(f64, &str)| {
        value.abs() >= *size && (unit != "m" || !matches!(*prefix, "G" | "M"))
    };
    let (size, prefix) = PREFIXES.iter().find(fits).unwrap_or(&(1.0, ""));
    format!("{} {prefix}{unit}", shown(value / size))
}

fn odd(code: Code, span: Span, message: String, help: &str) -> Diagnostic {
    Diagnostic::new(code, message).at(span, "").help(help)
}

/// Largest distance of the points at which a body is described or held [m].
pub(super) fn length(mechanism: &Mechanism, body: usize) -> f64 {
    let carrier = Carrier::Body(BodyId::new(body));
    let joints = mechanism.joints.iter().filter(|joint| joint.parent == carrier || joint.child == carrier);
    let points = joints.map(|joint| joint.at).chain(mechanism.bodies[body].inertia.points());
    let values = mechanism.parameter_values();
    let places: Vec<[f64; 3]> = points
        .map(|point| {
            let position = mechanism.point(point).position_for(carrier);
            std::array::from_fn(|axis| position[axis].value(&values).unwrap_or(0.0))
        })
        .collect();
    let pairs = places.iter().flat_map(|a| places.iter().map(move |b| (a, b)));
    pairs.map(|(a, b)| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()).fold(0.0, f64::max)
}

fn sizes(mechanism: &Mechanism) -> Vec<Diagnostic> {
    let lengths: Vec<f64> = (0..mechanism.bodies.len()).map(|body| length(mechanism, body)).collect();
    let mut order: Vec<usize> = (0..lengths.len()).filter(|body| lengths[*body] > 0.0).collect();
    order.sort_by(|a, b| lengths[*a].total_cmp(&lengths[*b]));
    let mut remarks = Vec::new();
    let mut apart = |odd_one: usize, next: usize, is: &str| {
        let (body, other) = (&mechanism.bodies[odd_one], &mechanism.bodies[next]);
        let [own, others] = [odd_one, next].map(|body| with_unit(lengths[body], "m"));
        let message =
            format!("`{}` is {own} long, `{}` {others}: one of them is too {is}", body.name, other.name);
        remarks.push(odd(
            Code::SizesApart,
            body.span,
            message,
            "check the units: m for mm is a factor of 1000",
        ));
    };
    match order.as_slice() {
        [.., next, longest] if lengths[*longest] > TOO_LONG * lengths[*next] => {
            apart(*longest, *next, "long")
        }
        [shortest, next, ..] if lengths[*next] > TOO_SHORT * lengths[*shortest] => {
            apart(*shortest, *next, "short")
        }
        _ => {}
    }
    let values = mechanism.parameter_values();
    let whole = lengths.iter().copied().fold(0.0, f64::max);
    for (body, length) in mechanism.bodies.iter().zip(&lengths) {
        let (what, size, limits) = match &body.inertia {
            Inertia::Rod { radius, .. } => {
                ("radius", radius.value(&values), [length / TOO_THIN, TOO_THICK * length])
            }
            Inertia::Box { width, .. } => {
                ("width", width[0].value(&values), [length / TOO_THIN, TOO_THICK * length])
            }
            Inertia::Given { mass, inertia, .. } => {
                let moment = inertia[..3].iter().filter_map(|own| own.value(&values)).fold(0.0, f64::max);
                let mass = mass.value(&values).filter(|mass| *mass > 0.0);
                let gyration = mass.map(|mass| (moment / mass).sqrt());
                ("radius of gyration", gyration, [0.0, TOO_FAR_OUT * whole])
            }
        };
        let Some(size) = size.filter(|size| limits[1] > 0.0 && is_odd(*size, limits)) else { continue };
        let of = if what == "radius of gyration" { "the longest body" } else { "it" };
        let other = with_unit(if what == "radius of gyration" { whole } else { *length }, "m");
        let message =
            format!("the {what} of `{}` is {}, while {of} is {other} long", body.name, with_unit(size, "m"));
        remarks.push(odd(Code::SizesApart, body.span, message, "check the units of its numbers"));
    }
    remarks
}

/// The body that is far heavier than all others. Of a body given by its density the mass of a cube is taken, which it has at most.
fn masses(mechanism: &Mechanism) -> Option<Diagnostic> {
    let values = mechanism.parameter_values();
    let mass = |(index, body): (usize, &Body)| match &body.inertia {
        Inertia::Given { mass, .. }
        | Inertia::Rod { amount: Amount::Mass(mass), .. }
        | Inertia::Box { amount: Amount::Mass(mass), .. } => mass.value(&values),
        Inertia::Rod { amount: Amount::Density(density), .. }
        | Inertia::Box { amount: Amount::Density(density), .. } => {
            density.value(&values).map(|density| density * length(mechanism, index).powi(3))
        }
    };
    let bodies = mechanism.bodies.iter().enumerate();
    let mut masses: Vec<(&Body, f64)> =
        bodies.filter_map(|body| Some((body.1, mass(body).filter(|mass| *mass > 0.0)?))).collect();
    masses.sort_by(|a, b| a.1.total_cmp(&b.1));
    let [.., (next, others), (heaviest, own)] = masses[..] else { return None };
    (own > TOO_HEAVY * others).then(|| {
        let message = format!(
            "`{}` has {} kg, `{}` {} kg at most",
            heaviest.name,
            shown(own),
            next.name,
            shown(others)
        );
        odd(Code::MassesApart, heaviest.span, message, "check the units: g for kg is a factor of 1000")
    })
}

fn gravity(mechanism: &Mechanism) -> Option<Diagnostic> {
    let values = mechanism.parameter_values();
    let sizes = mechanism.gravity.iter().filter_map(|part| Some((part, part.value(&values)?.abs())));
    let (part, size) = sizes.max_by(|a, b| a.1.total_cmp(&b.1))?;
    (size > GRAVITY).then(|| {
        let message = format!("gravity is {} m/s^2", shown(size));
        odd(Code::MassesApart, part.span, message, "the earth's is 9.81 m/s^2")
    })
}

fn density(mechanism: &Mechanism, body: &Body) -> Option<Diagnostic> {
    let (Inertia::Rod { amount, .. } | Inertia::Box { amount, .. }) = &body.inertia else { return None };
    let Amount::Density(formula) = amount else { return None };
    let density = formula.value(&mechanism.parameter_values())?;
    is_odd(density, DENSITIES).then(|| {
        let message = format!("the density of `{}` is {} kg/m^3", body.name, shown(density));
        odd(
            Code::OddMaterial,
            formula.span,
            message,
            "steel has 7850 kg/m^3, aluminium 2700, polymers about 1200",
        )
    })
}

fn young(body: &Body) -> Option<Diagnostic> {
    let (modulus, span) = body.flexible.as_ref()?.young?;
    is_odd(modulus, YOUNGS_MODULI).then(|| {
        let message = format!("Young's modulus of `{}` is {}", body.name, with_unit(modulus, "Pa"));
        odd(Code::OddMaterial, span, message, "steel has 210 GPa, aluminium 70 GPa, polymers 1 to 4 GPa")
    })
}

fn is_odd(value: f64, usual: [f64; 2]) -> bool {
    value < usual[0] || value > usual[1]
}

fn bearing(mechanism: &Mechanism, joint: &Joint, clearance: &Clearance) -> Vec<Diagnostic> {
    let (laws, places, name) = (&clearance.laws, clearance.places, &joint.name);
    let mut remarks = Vec::new();
    let mut remark = |code, span, message, help| remarks.push(odd(code, span, message, help));
    let radial = clearance.radial.value(&mechanism.parameter_values()).unwrap_or(0.0);
    let share = radial / laws.journal_radius;
    if share > WIDE {
        let message = format!(
            "the radial clearance of `{name}`, {}, is {} % of its journal's radius",
            with_unit(radial, "m"),
            shown(100.0 * share)
        );
        remark(
            Code::OddBearing,
            clearance.radial.span,
            message,
            "usual are 0.01 to 1 %; the clearance is the difference of the radii",
        );
    }
    if is_odd(laws.modulus, MODULI) {
        let message = format!("the contact modulus of `{name}` is {}", with_unit(laws.modulus, "Pa"));
        remark(
            Code::OddMaterial,
            places.modulus,
            message,
            "steel on steel has 115 GPa, a polymer on steel 1 to 4 GPa",
        );
    }
    let Some(wear) = &laws.wear else { return remarks };
    if is_odd(wear.hardness, HARDNESSES) {
        let message = format!("the hardness at `{name}` is {}", with_unit(wear.hardness, "Pa"));
        remark(
            Code::OddMaterial,
            places.hardness,
            message,
            "bearing steel has 7 GPa, bronze 1 GPa: 9.81 MPa times the Brinell number",
        );
    }
    if wear.coefficient > WEAR_COEFFICIENT {
        let message = format!("the wear coefficient k at `{name}` is {}", shown(wear.coefficient));
        remark(
            Code::OddMaterial,
            places.coefficient,
            message,
            "k has no dimension: 1e-9 well lubricated, 1e-4 to 1e-2 dry",
        );
    }
    if wear.threshold > DEEP * laws.journal_radius {
        let message = format!(
            "the wear threshold of `{name}`, {}, is {} % of its journal's radius, {}",
            with_unit(wear.threshold, "m"),
            shown(100.0 * wear.threshold / laws.journal_radius),
            with_unit(laws.journal_radius, "m")
        );
        remark(
            Code::OddBearing,
            places.threshold,
            message,
            "a bearing has failed long before; check the unit",
        );
    }
    remarks
}

/// Freedoms of a driven machine that nothing drives, springs, brakes or starts.
fn loose(mechanism: &Mechanism, analysis: &Analysis) -> Option<Diagnostic> {
    if analysis.drivers.is_empty() {
        return None;
    }
    let joints = mechanism.joints.iter();
    let play: usize = joints.clone().map(|joint| joint.model.loose().len()).sum();
    let passive = joints.filter(|joint| !joint.passive.is_empty());
    let passive: usize = passive.map(|joint| joint.model.start_values().len()).sum();
    let started = mechanism.starts.iter().filter(|start| start.held).count();
    // An element may hold as many freedoms as a bushing does.
    let springs = mechanism.couplings.iter().filter(|coupling| coupling.compliance.is_some()).count();
    let meant = passive + started + springs + 6 * mechanism.forces.len();
    let free = analysis.mobility.saturating_sub(analysis.drivers.len() + analysis.idle.len() + play);
    if free <= meant {
        return None;
    }
    let freedoms = if free == 1 { "one freedom that" } else { "freedoms that" };
    let message = format!(
        "mobility {} leaves {freedoms} nothing drives, springs, brakes or starts: {free} besides drivers, idle \
         freedoms and clearances",
        analysis.mobility
    );
    // A body that hangs by one joint is most likely what lost the other, unless that is driven or leaves it all freedom.
    let is_hanging = |body: &usize| {
        let carrier = Carrier::Body(BodyId::new(*body));
        let mut own =
            mechanism.joints.iter().filter(|joint| joint.parent == carrier || joint.child == carrier);
        let only = own.next().filter(|_| own.next().is_none());
        only.is_some_and(|joint| joint.drives.is_empty() && !joint.model.flies())
    };
    let hanging = (0..mechanism.bodies.len()).filter(is_hanging);
    let hanging: Vec<&Body> = hanging.map(|body| &mechanism.bodies[body]).collect();
    let flying = mechanism.joints.iter().filter(|joint| joint.model.flies()).map(|joint| joint.span);
    let flying: Vec<Span> = flying.collect();
    let driven = mechanism.joints.iter().find(|joint| !joint.drives.is_empty()).map(|joint| joint.span);
    let is_nobody = hanging.is_empty() && flying.is_empty();
    let warning = Diagnostic::new(Code::LooseBody, message)
        .at_each(hanging.iter().map(|body| body.span), "hangs by one joint")
        .at_each(flying, "leaves every freedom")
        .at_each(driven.filter(|_| is_nobody), "driven here");
    Some(warning.help(
        "add the joint that is missing; if a body is to swing or fly freely, give each freedom of its joint a start value in [initial]",
    ))
}
