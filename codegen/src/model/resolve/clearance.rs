//! Joints with clearance: which they are, and the constants of their laws of contact, friction and wear.

use linkwear_runtime::contact::{IMPACT_SPEED_FLOOR, Onset, Restitution, Stiffness, Strength};
use linkwear_runtime::wear::{Area, DEFAULT_BINS};
use linkwear_runtime::{ContactInfo, GammaRates, WearInfo};

use super::inertia;
use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Axis, Clearance, Formula, Joint};
use crate::spec::{At, ClearanceSpec, Dimension, File, Name, Quantity, WearSpec};

/// Speed below which friction is smoothed, unless the file says otherwise [m/s].
const FRICTION_SPEED: f64 = 1e-3;
/// Stribeck speed, unless the file says otherwise [m/s].
const STRIBECK_SPEED: f64 = 1e-2;

impl Resolver<'_> {
    /// Gives the joints named in `[clearance]` their freedom.
    pub(super) fn add_clearance(&mut self, file: &File) {
        for (name, _) in &file.clearance.0 {
            let Some(id) = self.joint_named(name, "[clearance]") else { continue };
            let Some(model) = self.joint_models.get_mut(id.index()) else { continue };
            if model.kind.clearance.is_empty() {
                let message = format!("the {} joint `{}` cannot have clearance", model.kind.name, name.value);
                let fault = Diagnostic::new(Code::BadClearance, message).at(name.span, "");
                self.report(fault.help("revolute and spherical joints can"));
                continue;
            }
            model.clearance = true;
            if let [axis] = model.axes[..] {
                // The direction of the offset's first component, as near to e_x as the axis allows.
                let [parent, child] = [axis.parent, axis.child].map(inertia::any_perpendicular);
                model.axes.push(Axis { parent, child });
            }
        }
    }

    pub(super) fn resolve_clearances(&mut self, file: &File, joints: &mut [Joint]) {
        for (name, written) in &file.clearance.0 {
            let Some(joint) = joints.iter_mut().find(|joint| joint.name == name.value) else { continue };
            let ball = joint.model.is_ball();
            let wear = file.wear.0.iter().find(|(other, _)| other.value == name.value);
            let radial = self.radial(name, written);
            let mut laws = self.laws(name, written, ball);
            laws.wear = wear.map(|(name, wear)| self.wear(name, wear));
            let value = self.value(&radial);
            if value >= laws.journal_radius {
                let message = format!(
                    "the clearance of joint `{}`, {value} m, is not less than its journal's radius, {} m",
                    name.value, laws.journal_radius
                );
                let fault = Diagnostic::new(Code::BadClearance, message).at(radial.span, "");
                self.report(
                    fault.help("the clearance is the difference of the radii of bearing and journal"),
                );
            }
            joint.clearance = Some(Box::new(Clearance { radial, laws }));
        }
        for (name, _) in &file.wear.0 {
            let known = file.clearance.0.iter().any(|(other, _)| other.value == name.value);
            if self.joint_named(name, "[wear]").is_some() && !known {
                let message = format!("joint `{}` wears but has no clearance", name.value);
                let fault = Diagnostic::new(Code::BadClearance, message).at(name.span, "");
                self.report(
                    fault.help(format!("add `[clearance.{}]`, the state that wear starts from", name.value)),
                );
            }
        }
    }

    fn radial(&mut self, name: &Name, written: &At<ClearanceSpec>) -> Formula {
        let what = place("radial", "clearance of joint", name);
        let Some(radial) = &written.value.radial else {
            self.lacks(name, written.span, "clearance", "radial", "\"10 um\"");
            return Formula::number(f64::NAN, Dimension::LENGTH);
        };
        let formula = self.formula(radial, Some(Dimension::LENGTH), Allowed::PARAMETERS, &what);
        self.check_positive(&formula, false, &what);
        formula
    }

    fn lacks(&mut self, name: &Name, span: crate::source::Span, table: &str, key: &str, example: &str) {
        let message = format!("the {table} of joint `{}` has no `{key}`", name.value);
        let fault = Diagnostic::new(Code::MissingKey, message).at(span, "");
        self.report(fault.help(format!("add `{key} = {example}`")));
    }

    /// A positive number fixed at generation.
    fn positive(
        &mut self,
        name: &Name,
        key: &str,
        written: Option<&Quantity>,
        dimension: Dimension,
        default: f64,
    ) -> f64 {
        let Some(written) = written else { return default };
        let what = place(key, "joint", name);
        let formula = self.formula(written, Some(dimension), Allowed::CONSTANTS, &what);
        self.check_positive(&formula, false, &what);
        self.value(&formula)
    }

    /// A number from 0 on, fixed at generation.
    fn not_negative(
        &mut self,
        name: &Name,
        key: &str,
        written: Option<&Quantity>,
        dimension: Dimension,
        default: f64,
    ) -> f64 {
        let Some(written) = written else { return default };
        let what = place(key, "joint", name);
        let formula = self.formula(written, Some(dimension), Allowed::CONSTANTS, &what);
        self.check_positive(&formula, true, &what);
        self.value(&formula)
    }

    fn laws(&mut self, name: &Name, written: &At<ClearanceSpec>, ball: bool) -> ContactInfo {
        let own = &written.value;
        let pressure = Dimension::of(-1, 1, -2);
        if own.journal_radius.is_none() {
            self.lacks(name, written.span, "clearance", "journal_radius", "\"10 mm\"");
        }
        if own.length.is_none() && !ball {
            self.lacks(name, written.span, "clearance", "length", "\"20 mm\"");
        }
        if own.modulus.is_none() {
            self.lacks(name, written.span, "clearance", "modulus", "\"115 GPa\"");
        }
        let journal_radius =
            self.positive(name, "journal_radius", own.journal_radius.as_ref(), Dimension::LENGTH, f64::NAN);
        let length =
            self.positive(name, "length", own.length.as_ref(), Dimension::LENGTH, 2.0 * journal_radius);
        let modulus = self.positive(name, "modulus", own.modulus.as_ref(), pressure, f64::NAN);
        let stiffness = match &own.stiffness {
            Some(given) => {
                Stiffness::Given(self.positive(name, "stiffness", Some(given), Dimension::NONE, f64::NAN))
            }
            None => Stiffness::Hertz { modulus },
        };
        let restitution = self.positive(name, "restitution", own.restitution.as_ref(), Dimension::NONE, 1.0);
        if let (Some(given), true) = (&own.restitution, restitution > 1.0) {
            let message =
                format!("the coefficient of restitution of joint `{}` is {restitution}", name.value);
            let fault = Diagnostic::new(Code::BadClearance, message).at(given.span, "");
            self.report(fault.help("it lies above 0, and at most at 1"));
        }
        ContactInfo {
            joint: name.value.clone().into(),
            ball,
            journal_radius,
            length,
            modulus,
            stiffness,
            law: own.law.as_ref().map_or_else(Restitution::default, |law| law.value),
            restitution,
            exponent: self.positive(name, "exponent", own.exponent.as_ref(), Dimension::NONE, 1.5),
            impact_speed_floor: self.positive(
                name,
                "impact_speed_floor",
                own.impact_speed_floor.as_ref(),
                Dimension::of(1, 0, -1),
                IMPACT_SPEED_FLOOR,
            ),
            friction: self.friction(name, own),
            wear: None,
        }
    }

    fn friction(&mut self, name: &Name, own: &ClearanceSpec) -> Option<(Strength, Onset, f64)> {
        if own.friction.is_none() {
            self.only_with_friction(name, own);
            return None;
        }
        let speed = Dimension::of(1, 0, -1);
        let coefficient = self.not_negative(name, "friction", own.friction.as_ref(), Dimension::NONE, 0.0);
        let strength = match &own.static_friction {
            Some(at_rest) => Strength::Stribeck {
                static_coefficient: self.not_negative(
                    name,
                    "static_friction",
                    Some(at_rest),
                    Dimension::NONE,
                    0.0,
                ),
                kinetic_coefficient: coefficient,
                stribeck_speed: self.positive(
                    name,
                    "stribeck_speed",
                    own.stribeck_speed.as_ref(),
                    speed,
                    STRIBECK_SPEED,
                ),
                exponent: 2.0,
            },
            None => Strength::Coulomb { coefficient },
        };
        let speeds: Vec<f64> = own
            .friction_speed
            .as_ref()
            .map_or(&[][..], |list| &list.value)
            .iter()
            .map(|written| self.not_negative(name, "friction_speed", Some(written), speed, 0.0))
            .collect();
        let onset = match speeds.as_slice() {
            [] => Onset::Smoothed { speed: FRICTION_SPEED },
            [speed] => Onset::Smoothed { speed: *speed },
            [lower, upper, ..] => Onset::Ambrosio { lower: *lower, upper: *upper },
        };
        self.check_onset(name, own, &speeds);
        let slope =
            self.fixed(name, "friction_slope", own.friction_slope.as_ref(), Dimension::of(-1, 0, 1), 0.0);
        Some((strength, onset, slope))
    }

    /// Keys that friction would need, without friction.
    fn only_with_friction(&mut self, name: &Name, own: &ClearanceSpec) {
        let speeds = own.friction_speed.as_ref().map(|list| list.span);
        let keys = [
            ("static_friction", own.static_friction.as_ref().map(|key| key.span)),
            ("stribeck_speed", own.stribeck_speed.as_ref().map(|key| key.span)),
            ("friction_slope", own.friction_slope.as_ref().map(|key| key.span)),
            ("friction_speed", speeds),
        ];
        for (key, span) in keys {
            let Some(span) = span else { continue };
            let message = format!("`{key}` of joint `{}` has no effect without `friction`", name.value);
            let fault = Diagnostic::new(Code::BadClearance, message).at(span, "");
            self.report(
                fault.help("add `friction = 0.05`, the coefficient at high speed, or leave this out"),
            );
        }
    }

    /// Speeds below which friction is smoothed: one above 0, or two that rise.
    fn check_onset(&mut self, name: &Name, own: &ClearanceSpec, speeds: &[f64]) {
        let Some(list) = &own.friction_speed else { return };
        let fits = match speeds {
            [speed] => *speed > 0.0,
            [lower, upper] => *lower >= 0.0 && upper > lower,
            _ => false,
        };
        // What is no number has been reported already.
        if !fits && speeds.iter().all(|speed| speed.is_finite()) {
            let message = format!("the friction speeds of joint `{}` are {speeds:?} m/s", name.value);
            let fault = Diagnostic::new(Code::BadClearance, message).at(list.span, "");
            self.report(fault.help(
                "give one above 0, `[\"1 mm/s\"]`, or two that rise, `[\"0.1 mm/s\", \"1 mm/s\"]` (Ambrosio)",
            ));
        }
    }

    /// The Gamma process; with one of its rates, wear has the mean that physics gives.
    fn scatter(&mut self, name: &Name, own: &WearSpec) -> Option<GammaRates> {
        let per_length = Dimension::of(-1, 0, 0);
        let [alpha, beta] = [("alpha", &own.alpha), ("beta", &own.beta)].map(|(key, written)| {
            let written = written.as_ref()?;
            Some(self.positive(name, key, Some(written), per_length, f64::NAN))
        });
        Some(GammaRates { alpha: alpha.or(beta)?, beta: beta.or(alpha)? })
    }

    fn wear(&mut self, name: &Name, written: &At<WearSpec>) -> WearInfo {
        let own = &written.value;
        let pressure = Dimension::of(-1, 1, -2);
        let needed = [
            ("coefficient", own.coefficient.is_none(), "1e-8"),
            ("hardness", own.hardness.is_none(), "\"3.5 GPa\""),
            ("threshold", own.threshold.is_none(), "\"80 um\""),
        ];
        for (key, missing, example) in needed {
            if missing {
                self.lacks(name, written.span, "wear", key, example);
            }
        }
        let bins = own.bins.as_ref().map_or(DEFAULT_BINS, |bins| usize::try_from(bins.value).unwrap_or(0));
        if let (Some(bins), false) = (&own.bins, (8..=10_000).contains(&bins)) {
            let message = format!("the profile of joint `{}` has {} bearing angles", name.value, bins.value);
            let fault = Diagnostic::new(Code::BadClearance, message).at(bins.span, "");
            self.report(fault.help("72 are one every 5 degrees; 8 to 10000 are possible"));
        }
        WearInfo {
            coefficient: self.positive(
                name,
                "coefficient",
                own.coefficient.as_ref(),
                Dimension::NONE,
                f64::NAN,
            ),
            hardness: self.positive(name, "hardness", own.hardness.as_ref(), pressure, f64::NAN),
            area: own.area.as_ref().map_or_else(Area::default, |area| area.value),
            measure: own.measure.as_ref().map(|measure| measure.value),
            feedback: self.not_negative(name, "feedback", own.feedback.as_ref(), Dimension::NONE, 1.0),
            profile: own.profile.unwrap_or(false),
            bins,
            threshold: self.positive(name, "threshold", own.threshold.as_ref(), Dimension::LENGTH, f64::NAN),
            revolutions_per_cycle: self.positive(
                name,
                "revolutions_per_cycle",
                own.revolutions_per_cycle.as_ref(),
                Dimension::NONE,
                1.0,
            ),
            pressure_speed: own.pressure_speed.as_ref().map(|limit| {
                self.positive(name, "pressure_speed", Some(limit), Dimension::of(0, 1, -3), f64::NAN)
            }),
            scatter: self.scatter(name, own),
        }
    }
}
