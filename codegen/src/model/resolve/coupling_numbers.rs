//! Numbers of couplings, which are fixed at generation: teeth, radii, angles, modules.

use super::mesh::Teeth;
use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use super::wheels::Draft;
use crate::diagnostic::Code;
use crate::model::{Compliance, Coordinate, Formula};
use crate::spec::{At, Dimension, Hand, Quantity};

/// What a number must be.
#[derive(Clone, Copy)]
struct Is {
    dimension: Dimension,
    default: f64,
    least: f64,
    /// Whether the least is not allowed itself.
    least_out: bool,
    below: f64,
    help: &'static str,
}

/// 20 degrees, the pressure angle of ISO 53.
const PRESSURE: Is = Is {
    dimension: Dimension::NONE,
    default: std::f64::consts::PI / 9.0,
    least: 0.0,
    least_out: false,
    below: std::f64::consts::FRAC_PI_4,
    help: "pressure angles are from 0 to 45 deg, mostly 20 deg; write the unit",
};

const HELIX: Is = Is {
    dimension: Dimension::NONE,
    default: 0.0,
    least: 0.0,
    least_out: false,
    below: std::f64::consts::FRAC_PI_3,
    help: "helix angles are from 0 to 60 deg; write the unit, and `hand = \"left\"` for a left-hand helix",
};

const MODULE: Is = Is {
    dimension: Dimension::LENGTH,
    default: 0.0,
    least: 0.0,
    least_out: true,
    below: f64::INFINITY,
    help: "the module is positive",
};

const TENSION: Is = Is {
    dimension: Dimension::FORCE,
    default: 0.0,
    least: 0.0,
    least_out: false,
    below: f64::INFINITY,
    help: "a belt can only pull",
};

/// Ratios of radii and teeth agree to what drawings give.
pub(super) const RATIO: f64 = 1e-3;

fn unit_of(dimension: Dimension) -> String {
    if dimension == Dimension::NONE { String::new() } else { format!(" {}", dimension.si_unit()) }
}

impl Resolver<'_> {
    /// Numbers of teeth or radii, all above zero.
    pub(super) fn counts(
        &mut self,
        draft: &Draft<'_>,
        key: &str,
        list: &At<Vec<Quantity>>,
        needed: usize,
    ) -> Option<Vec<f64>> {
        let what = place(key, "coupling", draft.name);
        if list.value.len() != needed {
            self.wrong_count(list.span, list.value.len(), &needed.to_string(), &what);
            return None;
        }
        let dimension = if key == "radii" { Dimension::LENGTH } else { Dimension::NONE };
        let mut values = Vec::new();
        for quantity in &list.value {
            let formula = self.formula(quantity, Some(dimension), Allowed::CONSTANTS, &what);
            self.check_positive(&formula, false, &what);
            let value = self.value(&formula);
            if dimension == Dimension::NONE && value.fract() != 0.0 && value.is_finite() {
                let message = format!("{what} has {value}, but teeth are counted");
                self.refuse(Code::BadCoupling, quantity.span, message).help("write whole numbers");
                return None;
            }
            values.push(value);
        }
        values.iter().all(|value| *value > 0.0).then_some(values)
    }

    /// A number of a coupling that is fixed at generation; the default where nothing is written.
    fn number_within(
        &mut self,
        draft: &Draft<'_>,
        key: &str,
        written: Option<&Quantity>,
        is: Is,
    ) -> Option<f64> {
        let Some(written) = written else { return Some(is.default) };
        let what = place(key, "coupling", draft.name);
        let formula = self.formula(written, Some(is.dimension), Allowed::CONSTANTS, &what);
        let value = self.value(&formula);
        if !value.is_finite() {
            return None;
        }
        if value < is.least || value >= is.below || (is.least_out && value == is.least) {
            let message = format!("{what} is {value}{}", unit_of(is.dimension));
            self.refuse(Code::BadCoupling, written.span, message).help(is.help);
            return None;
        }
        Some(value)
    }

    pub(super) fn teeth(&mut self, draft: &Draft<'_>) -> Option<Teeth> {
        let hand = draft.spec.hand.as_ref().map_or(Hand::Right, |hand| hand.value);
        Some(Teeth {
            pressure: self.number_within(
                draft,
                "pressure_angle",
                draft.spec.pressure_angle.as_ref(),
                PRESSURE,
            )?,
            helix: self.number_within(draft, "helix_angle", draft.spec.helix_angle.as_ref(), HELIX)?,
            hand: if hand == Hand::Right { 1.0 } else { -1.0 },
        })
    }

    pub(super) fn module(&mut self, draft: &Draft<'_>) -> Option<Option<f64>> {
        let Some(module) = &draft.spec.module else { return Some(None) };
        self.number_within(draft, "module", Some(module), MODULE).map(Some)
    }

    /// Tension of a belt's strands at rest.
    pub(super) fn tension(&mut self, draft: &Draft<'_>) -> Option<f64> {
        self.number_within(draft, "tension", draft.spec.tension.as_ref(), TENSION)
    }

    /// How a coupling gives way whose sum is an angle or a length; nothing where a number is wrong, which is reported.
    pub(super) fn compliance(&mut self, draft: &Draft<'_>, angular: bool) -> Option<Option<Compliance>> {
        let spec = draft.spec;
        let sum = if angular { Coordinate::Angle } else { Coordinate::Length };
        let Some(stiffness) = &spec.stiffness else {
            let lost = [("damping", &spec.damping), ("backlash", &spec.backlash)];
            let Some((key, written)) = lost.into_iter().find(|(_, written)| written.is_some()) else {
                return Some(None);
            };
            let span = written.as_ref().map_or(draft.name.span, |written| written.span);
            let message = format!("the coupling `{}` has `{key}`, but no `stiffness`", draft.name.value);
            self.refuse(Code::MissingKey, span, message).help(format!(
                "add `stiffness = \"1e8 {}\"`; without it a coupling is rigid",
                sum.stiffness().si_unit()
            ));
            return None;
        };
        let mut number = |key: &str, written: Option<&Quantity>, dimension, zero_allowed| {
            let what = place(key, "coupling", draft.name);
            let Some(written) = written else { return Formula::number(0.0, dimension) };
            let formula = self.formula(written, Some(dimension), Allowed::PARAMETERS, &what);
            self.check_positive(&formula, zero_allowed, &what);
            formula
        };
        Some(Some(Compliance {
            stiffness: number("stiffness", Some(stiffness), sum.stiffness(), false),
            damping: number("damping", spec.damping.as_ref(), sum.damping(), true),
            backlash: number("backlash", spec.backlash.as_ref(), sum.dimension(), true),
        }))
    }
}
