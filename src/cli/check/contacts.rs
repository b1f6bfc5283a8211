//! What a file says of clearance and wear, as it was read. In: a compiled mechanism. Out: tables for people, in the units of the
//! file, entries for machines. Never knows what comes of it.

use std::fmt::Write as _;

use linkwear_codegen::Compiled;
use linkwear_codegen::model::{Ends, Joint, Mechanism};
use linkwear_codegen::spec::{
    ClearanceSpec, Literal, Quantity, WearSpec, as_written, parse, parse_expression,
};
use linkwear_runtime::contact::{Onset, Strength};
use linkwear_runtime::{ContactInfo, WearInfo};

use super::super::answer::check::{ClearanceAnswer, FrictionAnswer, WearAnswer};
use super::super::table::table;
use crate::number::number;

/// Joints side by side in a table: more would be wider than a terminal.
const SIDE_BY_SIDE: usize = 4;

/// A joint with clearance, and what the file writes for it.
pub struct Contact<'a> {
    joint: &'a Joint,
    mechanism: &'a Mechanism,
    laws: &'a ContactInfo,
    /// Radial clearance [m].
    radial: Option<f64>,
    written: ClearanceSpec,
    worn: WearSpec,
}

/// All joints with clearance; `clearances` at the start, in the order of the description.
pub fn contacts<'a>(compiled: &'a Compiled, clearances: &[f64]) -> Vec<Contact<'a>> {
    let mechanism = &compiled.mechanism;
    let file = parse(&compiled.source).map(|spec| spec.file).unwrap_or_default();
    let description = compiled.description();
    let contacts = mechanism.joints.iter().filter_map(|joint| {
        let laws = &joint.clearance.as_ref()?.laws;
        let place = joint.contact_places().into_iter().next()?;
        let at = description.contacts.iter().position(|known| known.joint == place.laws.joint);
        let written = file.clearance.0.iter().find(|(name, _)| name.value == joint.name);
        let worn = file.wear.0.iter().find(|(name, _)| name.value == joint.name);
        Some(Contact {
            joint,
            mechanism,
            laws,
            radial: at.and_then(|at| clearances.get(at).copied()),
            written: written.map(|(_, spec)| spec.value.clone()).unwrap_or_default(),
            worn: worn.map(|(_, spec)| spec.value.clone()).unwrap_or_default(),
        })
    });
    contacts.collect()
}

/// A value with its unit, as the file has it: that of the quantity, or of the parameter that is named; else this one.
fn shown(mechanism: &Mechanism, written: Option<&Quantity>, value: f64, usual: &str) -> String {
    let of_text = |text: &str| {
        let unit = as_written(text).map(|(_, unit)| unit.to_owned());
        unit.or_else(|| {
            let parameter = mechanism.parameters.iter().find(|known| known.name == text.trim())?;
            parameter.written.as_ref().map(|(_, unit)| unit.clone())
        })
    };
    let unit = written.and_then(|quantity| match &quantity.value {
        Literal::Text(text) => of_text(text),
        Literal::Number(_) => None,
    });
    let unit = unit.unwrap_or_else(|| usual.to_owned());
    let size = |unit: &str| parse_expression(&format!("1 {unit}"), &|_| false).ok()?.quantity();
    let (unit, size) = match size(&unit) {
        Some((size, _)) => (unit, size),
        // A scale that is no multiple of a unit, such as Rockwell's.
        None => (usual.to_owned(), size(usual).map_or(1.0, |(size, _)| size)),
    };
    format!("{} {unit}", number(value / size)).trim_end().to_owned()
}

/// The tables of all of them.
pub fn text(contacts: &[Contact<'_>]) -> String {
    let mut text = String::new();
    let worn: Vec<&Contact<'_>> = contacts.iter().filter(|one| one.laws.wear.is_some()).collect();
    write_tables(&mut text, "Clearance", &contacts.iter().collect::<Vec<_>>(), |one| one.clearance_lines());
    write_tables(&mut text, "Wear", &worn, |one| one.wear_lines());
    text
}

/// Tables of some joints, a column for each.
fn write_tables(
    text: &mut String,
    title: &str,
    contacts: &[&Contact<'_>],
    lines: impl Fn(&Contact<'_>) -> Vec<(&'static str, String)>,
) {
    for contacts in contacts.chunks(SIDE_BY_SIDE) {
        let columns: Vec<Vec<(&str, String)>> = contacts.iter().map(|one| lines(one)).collect();
        let rows: Vec<Vec<String>> = (0..columns[0].len())
            .filter(|row| columns.iter().any(|column| !column[*row].1.is_empty()))
            .map(|row| {
                let name = columns[0][row].0.to_owned();
                [name].into_iter().chain(columns.iter().map(|column| column[row].1.clone())).collect()
            })
            .collect();
        let names = contacts.iter().map(|one| one.joint.name.as_str());
        let head: Vec<&str> = [""].into_iter().chain(names).collect();
        let _ = write!(text, "\n{title}\n{}", table(&head, &rows));
    }
}

impl Contact<'_> {
    fn quantity(&self, written: Option<&Quantity>, value: f64, usual: &str) -> String {
        shown(self.mechanism, written, value, usual)
    }

    /// Stiffness [N/m^n] at the file's clearance.
    fn stiffness(&self) -> Option<f64> {
        self.radial.map(|radial| self.laws.stiffness.value(self.laws.journal_radius, radial))
    }

    fn clearance_lines(&self) -> Vec<(&'static str, String)> {
        let (laws, written) = (self.laws, &self.written);
        let exponent = number(laws.exponent).trim_end_matches('0').trim_end_matches('.').to_owned();
        let stiffness = self.stiffness().map_or_else(String::new, |stiffness| {
            let from = if laws.stiffness.is_given() { "given" } else { "by modulus" };
            format!("{} N/m^{exponent}, {from}", number(stiffness))
        });
        let radial = self.radial.map_or_else(String::new, |radial| {
            let part = number(100.0 * radial / laws.journal_radius);
            let shown = self.quantity(written.radial.as_ref(), radial, "um");
            format!("{shown}, {part} % of the radius")
        });
        vec![
            ("bearing", self.mechanism.carrier_name(self.joint.parent).to_owned()),
            ("journal", self.mechanism.carrier_name(self.joint.child).to_owned()),
            ("radial", radial),
            ("journal_radius", self.quantity(written.journal_radius.as_ref(), laws.journal_radius, "mm")),
            ("length", self.quantity(written.length.as_ref(), laws.length, "mm")),
            ("touches", self.ends().map_or_else(String::new, |side| format!("with both ends of the {side}"))),
            ("modulus", self.quantity(written.modulus.as_ref(), laws.modulus, "GPa")),
            ("stiffness", stiffness),
            ("law", laws.law.to_string()),
            ("restitution", number(laws.restitution)),
            ("friction", friction(laws)),
        ]
    }

    fn wear_lines(&self) -> Vec<(&'static str, String)> {
        let Some(wear) = &self.laws.wear else { return Vec::new() };
        let written = &self.worn;
        let rate = |key: Option<&Quantity>, rate: Option<f64>| {
            rate.map_or_else(String::new, |rate| self.quantity(key, rate, "1/um"))
        };
        let variation = wear.cycle_variation.map_or_else(String::new, |part| {
            format!("{} % of the first cycle; life tells alpha", number(100.0 * part))
        });
        let alpha = rate(written.alpha.as_ref(), wear.scatter.map(|rates| rates.alpha));
        let is_random = wear.scatter.is_some() || wear.cycle_variation.is_some();
        let none = if is_random { "" } else { "none: a life is its mean" };
        let limit = wear.pressure_speed;
        vec![
            ("coefficient", self.quantity(written.coefficient.as_ref(), wear.coefficient, "")),
            ("factor on it", self.factor().unwrap_or_default()),
            ("hardness", self.quantity(written.hardness.as_ref(), wear.hardness, "GPa")),
            ("journal", self.journal_line()),
            ("threshold", self.quantity(written.threshold.as_ref(), wear.threshold, "um")),
            ("area", wear.area.to_string()),
            ("measure", wear.measure.map_or_else(String::new, |measure| measure.name().to_owned())),
            ("profile", if wear.profile { format!("{} bearing angles", wear.bins) } else { String::new() }),
            ("feedback", number(wear.feedback)),
            ("revolutions_per_cycle", number(wear.revolutions_per_cycle)),
            ("alpha", if alpha.is_empty() { none.to_owned() } else { alpha }),
            ("beta", rate(written.beta.as_ref(), wear.scatter.map(|rates| rates.beta))),
            ("cycle_variation", variation),
            (
                "pressure_speed",
                limit.map_or_else(String::new, |limit| {
                    self.quantity(written.pressure_speed.as_ref(), limit, "MPa m/s")
                }),
            ),
        ]
    }

    /// The factor on the wear coefficient as the file writes it.
    fn factor(&self) -> Option<String> {
        Some(match &self.worn.coefficient_factor.as_ref()?.value {
            Literal::Number(value) => number(*value),
            Literal::Text(text) => text.clone(),
        })
    }

    /// What of the bush's wear the journal has.
    fn journal_line(&self) -> String {
        let share = self.journal().map(number);
        share.map_or_else(String::new, |share| format!("wears too, {share} of the volume of the bush"))
    }

    fn journal(&self) -> Option<f64> {
        self.joint.clearance.as_ref()?.journal
    }

    /// The side whose ends touch, if its journal tilts.
    fn ends(&self) -> Option<&'static str> {
        self.joint.model.tilt.map(|ends| match ends {
            Ends::Bearing => "bearing",
            Ends::Journal => "journal",
        })
    }

    /// For machines.
    pub fn clearance_answer(&self) -> ClearanceAnswer<'_> {
        let laws = self.laws;
        ClearanceAnswer {
            joint: &self.joint.name,
            bearing: self.mechanism.carrier_name(self.joint.parent),
            journal: self.mechanism.carrier_name(self.joint.child),
            ball: laws.ball,
            radial_m: self.radial,
            journal_radius_m: laws.journal_radius,
            length_m: laws.length,
            ends: self.ends(),
            modulus_Pa: laws.modulus,
            stiffness: self.stiffness(),
            stiffness_given: laws.stiffness.is_given(),
            exponent: laws.exponent,
            law: laws.law.name(),
            restitution: laws.restitution,
            impact_speed_floor_m_per_s: laws.impact_speed_floor,
            friction: laws.friction.map(friction_answer),
        }
    }

    /// For machines, if it wears.
    pub fn wear_answer(&self) -> Option<WearAnswer<'_>> {
        let wear: &WearInfo = self.laws.wear.as_ref()?;
        Some(WearAnswer {
            joint: &self.joint.name,
            coefficient: wear.coefficient,
            hardness_Pa: wear.hardness,
            coefficient_factor: self.factor(),
            journal_ratio: self.journal(),
            threshold_m: wear.threshold,
            area: wear.area.name(),
            measure: wear.measure.map(|measure| measure.name()),
            profile: wear.profile,
            bins: wear.bins,
            feedback: wear.feedback,
            revolutions_per_cycle: wear.revolutions_per_cycle,
            pressure_speed_Pa_m_per_s: wear.pressure_speed,
            alpha_per_m: wear.scatter.map(|rates| rates.alpha),
            beta_per_m: wear.scatter.map(|rates| rates.beta),
            cycle_variation: wear.cycle_variation,
        })
    }
}

fn friction(laws: &ContactInfo) -> String {
    let Some((strength, onset, slope)) = laws.friction else { return "none".to_owned() };
    let (coefficient, at_rest) = strength.given();
    let mut text = number(coefficient);
    if let Some((at_rest, speed)) = at_rest {
        let _ = write!(text, ", at rest {} (Stribeck, {} mm/s)", number(at_rest), number(1e3 * speed));
    }
    if slope != 0.0 {
        let _ = write!(text, ", growing by {} s/m", number(slope));
    }
    let _ = match onset.given() {
        (speed, None) => write!(text, ", smoothed below {} mm/s", number(1e3 * speed)),
        (lower, Some(upper)) => {
            write!(text, ", from {} to {} mm/s (Ambrosio)", number(1e3 * lower), number(1e3 * upper))
        }
    };
    text
}

fn friction_answer((strength, onset, slope): (Strength, Onset, f64)) -> FrictionAnswer {
    let (coefficient, at_rest) = strength.given();
    let (first, second) = onset.given();
    FrictionAnswer {
        coefficient,
        static_coefficient: at_rest.map(|(coefficient, _)| coefficient),
        stribeck_speed_m_per_s: at_rest.map(|(_, speed)| speed),
        slope_s_per_m: slope,
        friction_speed_m_per_s: [first].into_iter().chain(second).collect(),
    }
}
