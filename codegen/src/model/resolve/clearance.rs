//! Joints with clearance: which they are, and the constants of their laws of contact, friction and wear.

use linkwear_runtime::contact::{IMPACT_SPEED_FLOOR, Onset, Restitution, Stiffness, Strength};
use linkwear_runtime::wear::{Area, DEFAULT_BINS, MOST_LIVE};
use linkwear_runtime::{ContactInfo, GammaRates, WearInfo};

use super::inertia;
use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::model::{Axis, Clearance, Formula, Joint, Term, WearFactor};
use crate::source::Span;
use crate::spec::{At, ClearanceSpec, Dimension, File, Name, Quantity, WearSpec};

/// Speed below which friction is smoothed, unless the file says otherwise [m/s].
const FRICTION_SPEED: f64 = 1e-3;
/// Stribeck speed, unless the file says otherwise [m/s].
const STRIBECK_SPEED: f64 = 1e-2;

const PER_LENGTH: Dimension = Dimension::of(-1, 0, 0);
const PRESSURE: Dimension = Dimension::of(-1, 1, -2);
const PRESSURE_SPEED: Dimension = Dimension::of(0, 1, -3);
const SPEED: Dimension = Dimension::of(1, 0, -1);

impl Resolver<'_> {
    /// Gives the joints named in `[clearance]` their freedom.
    pub(super) fn add_clearance(&mut self, file: &File) {
        for (name, _) in &file.clearance.0 {
            let Some(id) = self.joint_named(name, "[clearance]") else { continue };
            let Some(model) = self.joint_models.get_mut(id.index()) else { continue };
            if model.kind.clearance.is_empty() {
                let message = format!("the {} joint `{}` cannot have clearance", model.kind.name, name.value);
                self.refuse(Code::BadClearance, name.span, message).help("revolute and spherical joints can");
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
            let journal =
                wear.zip(laws.wear).and_then(|((name, wear), law)| self.journal(name, wear, &law, ball));
            let value = self.value(&radial);
            if value >= laws.journal_radius {
                let message = format!(
                    "the clearance of joint `{}`, {value} m, is not less than its journal's radius, {} m",
                    name.value, laws.journal_radius
                );
                self.refuse(Code::BadClearance, radial.span, message)
                    .help("the clearance is the difference of the radii of bearing and journal");
            }
            let factor = wear.and_then(|(name, wear)| self.wear_factor(name, wear, &laws));
            joint.clearance = Some(Box::new(Clearance { radial, laws, journal, factor }));
        }
        for (name, _) in &file.wear.0 {
            let known = file.clearance.0.iter().any(|(other, _)| other.value == name.value);
            if self.joint_named(name, "[wear]").is_some() && !known {
                let message = format!("joint `{}` wears but has no clearance", name.value);
                self.refuse(Code::BadClearance, name.span, message)
                    .help(format!("add `[clearance.{}]`, the state that wear starts from", name.value));
            }
        }
    }

    fn radial(&mut self, name: &Name, written: &At<ClearanceSpec>) -> Formula {
        let what = place("radial", "clearance of joint", name);
        let Some(radial) = &written.value.radial else {
            self.lacks(name, written.span, "clearance", &[("radial", true, "\"10 um\"")]);
            return Formula::number(f64::NAN, Dimension::LENGTH);
        };
        let formula = self.formula(radial, Some(Dimension::LENGTH), Allowed::PARAMETERS, &what);
        self.check_positive(&formula, false, &what);
        formula
    }

    fn lacks(&mut self, name: &Name, span: Span, table: &str, keys: &[(&str, bool, &str)]) {
        for (key, _, example) in keys.iter().filter(|(_, missing, _)| *missing) {
            let message = format!("the {table} of joint `{}` has no `{key}`", name.value);
            self.refuse(Code::MissingKey, span, message).help(format!("add `{key} = {example}`"));
        }
    }

    /// A number fixed at generation, positive or, if allowed, zero.
    fn number(
        &mut self,
        name: &Name,
        (key, written): (&str, Option<&Quantity>),
        dimension: Dimension,
        zero_allowed: bool,
        default: f64,
    ) -> f64 {
        let Some(written) = written else { return default };
        let what = place(key, "joint", name);
        let formula = self.formula(written, Some(dimension), Allowed::CONSTANTS, &what);
        self.check_positive(&formula, zero_allowed, &what);
        self.value(&formula)
    }

    fn laws(&mut self, name: &Name, written: &At<ClearanceSpec>, ball: bool) -> ContactInfo {
        let own = &written.value;
        let lacking = [
            ("journal_radius", own.journal_radius.is_none(), "\"10 mm\""),
            ("length", own.length.is_none() && !ball, "\"20 mm\""),
            ("modulus", own.modulus.is_none(), "\"115 GPa\""),
        ];
        self.lacks(name, written.span, "clearance", &lacking);
        let friction = self.friction(name, own);
        let mut positive = |key: &str, written: &Option<Quantity>, dimension: Dimension, default: f64| {
            self.number(name, (key, written.as_ref()), dimension, false, default)
        };
        let journal_radius = positive("journal_radius", &own.journal_radius, Dimension::LENGTH, f64::NAN);
        let modulus = positive("modulus", &own.modulus, PRESSURE, f64::NAN);
        let given = own.stiffness.as_ref();
        let given = given.map(|_| positive("stiffness", &own.stiffness, Dimension::NONE, f64::NAN));
        let laws = ContactInfo {
            joint: name.value.clone().into(),
            ball,
            journal_radius,
            length: positive("length", &own.length, Dimension::LENGTH, 2.0 * journal_radius),
            modulus,
            stiffness: Stiffness::new(given, modulus),
            law: own.law.as_ref().map_or_else(Restitution::default, |law| law.value),
            restitution: positive("restitution", &own.restitution, Dimension::NONE, 1.0),
            exponent: positive("exponent", &own.exponent, Dimension::NONE, 1.5),
            impact_speed_floor: positive(
                "impact_speed_floor",
                &own.impact_speed_floor,
                SPEED,
                IMPACT_SPEED_FLOOR,
            ),
            friction,
            wear: None,
        };
        if let (Some(given), true) = (&own.restitution, laws.restitution > 1.0) {
            let message =
                format!("the coefficient of restitution of joint `{}` is {}", name.value, laws.restitution);
            self.refuse(Code::BadClearance, given.span, message).help("it lies above 0, and at most at 1");
        }
        laws
    }

    fn friction(&mut self, name: &Name, own: &ClearanceSpec) -> Option<(Strength, Onset, f64)> {
        if own.friction.is_none() {
            self.only_with_friction(name, own);
            return None;
        }
        let mut number = |key: &str, written: Option<&Quantity>, dimension, zero_allowed, default| {
            self.number(name, (key, written), dimension, zero_allowed, default)
        };
        let coefficient = number("friction", own.friction.as_ref(), Dimension::NONE, true, 0.0);
        let at_rest = own.static_friction.as_ref();
        let static_coefficient = number("static_friction", at_rest, Dimension::NONE, true, 0.0);
        let stribeck = own.stribeck_speed.as_ref().filter(|_| at_rest.is_some());
        let stribeck_speed = number("stribeck_speed", stribeck, SPEED, false, STRIBECK_SPEED);
        let at_rest = at_rest.map(|_| (static_coefficient, stribeck_speed));
        let written = own.friction_speed.as_ref().map_or(&[][..], |list| &list.value);
        let speeds = written.iter().map(|speed| number("friction_speed", Some(speed), SPEED, true, 0.0));
        let speeds: Vec<f64> = speeds.collect();
        self.check_onset(name, own, &speeds);
        let slope =
            self.fixed(name, "friction_slope", own.friction_slope.as_ref(), Dimension::of(-1, 0, 1), 0.0);
        let onset = Onset::new(speeds.first().copied().unwrap_or(FRICTION_SPEED), speeds.get(1).copied());
        Some((Strength::new(coefficient, at_rest), onset, slope))
    }

    /// Keys that friction would need, without friction.
    fn only_with_friction(&mut self, name: &Name, own: &ClearanceSpec) {
        const KEYS: &[&str] = &["static_friction", "stribeck_speed", "friction_slope", "friction_speed"];
        for (key, span) in own.written().into_iter().filter(|(key, _)| KEYS.contains(key)) {
            let message = format!("`{key}` of joint `{}` has no effect without `friction`", name.value);
            self.refuse(Code::BadClearance, span, message)
                .help("add `friction = 0.05`, the coefficient at high speed, or leave this out");
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
            self.refuse(Code::BadClearance, list.span, message).help(
                "give one above 0, `[\"1 mm/s\"]`, or two that rise, `[\"0.1 mm/s\", \"1 mm/s\"]` (Ambrosio)",
            );
        }
    }

    /// The scatter is said once: by rates, or by what it does to the first cycle.
    fn check_variation(&mut self, name: &Name, own: &WearSpec) {
        let Some(variation) = own.cycle_variation.as_ref() else { return };
        for (key, rate) in [("alpha", &own.alpha), ("beta", &own.beta)] {
            let Some(rate) = rate else { continue };
            let message =
                format!("the wear of joint `{}` has both `cycle_variation` and `{key}`", name.value);
            self.refuse(Code::ConflictingKeys, rate.span, message)
                .also(variation.span, "from which alpha and beta follow")
                .help("leave out one of them; `life` tells the alpha of a `cycle_variation`");
        }
    }

    /// The factor on the wear coefficient; nothing if it is one, or wrong and reported.
    fn wear_factor(&mut self, name: &Name, written: &At<WearSpec>, laws: &ContactInfo) -> Option<WearFactor> {
        let written = written.value.coefficient_factor.as_ref()?;
        let what = place("coefficient_factor", "joint", name);
        let formula = self.formula(written, Some(Dimension::NONE), Allowed::CONTACT, &what);
        let (mut live, mut has_time) = (Vec::new(), false);
        formula.term.visit(&mut |term| match term {
            Term::Parameter(id) if !live.contains(id) => {
                let parameter = &self.parameters[id.index()];
                if parameter.tunable || parameter.input {
                    live.push(*id);
                }
            }
            Term::Time => has_time = true,
            _ => {}
        });
        if has_time {
            let message = format!("{what} depends on the time");
            self.refuse(Code::NotAllowedHere, written.span, message)
                .help("let it depend on an input, which may change with time");
        }
        let most = if laws.ball { 0 } else { MOST_LIVE };
        if live.len() > most {
            let message = format!(
                "{what} reads {} tunable parameters and inputs; a {} has room for {most}",
                live.len(),
                if laws.ball { "ball" } else { "journal" }
            );
            self.refuse(Code::BadClearance, written.span, message)
                .help("put them together in fewer inputs, or fix parameters with `tunable = false`");
        }
        self.check_factor(name, (&what, &formula), laws.wear.map_or(1e9, |wear| wear.hardness));
        Some(WearFactor { formula, live })
    }

    /// Refuses what is below zero somewhere between no pressure and the hardness, at rest or fast.
    fn check_factor(&mut self, name: &Name, (what, formula): (&str, &Formula), hardness: f64) {
        let pressures = [0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0].map(|part| part * hardness);
        let speeds = [0.0, 1e-3, 1e-2, 1e-1, 1.0, 10.0];
        let points = pressures.iter().flat_map(|pressure| speeds.map(|speed| [*pressure, speed]));
        // Outside a table there is no number: a run tells where it needs one.
        let below = points.into_iter().find_map(|point| {
            let term = formula.term.with_arguments(&point);
            let value = self.value(&Formula { term, ..formula.clone() });
            (value < 0.0).then_some((point, value))
        });
        let Some(([pressure, speed], value)) = below else { return };
        let message = format!("{what} is {value:.4} at {pressure:.4e} Pa and {speed} m/s");
        self.refuse(Code::NotPositive, formula.span, message).label("it must not be negative").help(format!(
            "keep `{}` from wearing backwards: `max(0, ...)`, or a table with `outside = \"hold\"`",
            name.value
        ));
    }

    /// Worn volume of the journal over that of the bush; nothing if no key has it wear.
    fn journal(&mut self, name: &Name, written: &At<WearSpec>, bush: &WearInfo, ball: bool) -> Option<f64> {
        let own = &written.value;
        let keys = [
            ("hardness_ratio", &own.hardness_ratio),
            ("journal_hardness", &own.journal_hardness),
            ("journal_coefficient", &own.journal_coefficient),
        ];
        let first = keys.iter().find_map(|(key, written)| Some((*key, written.as_ref()?.span)));
        let (key, span) = first?;
        if ball {
            let message = format!("`{key}` of joint `{}`: a ball keeps no wear by angle", name.value);
            self.refuse(Code::BadClearance, span, message)
                .help("leave it out, and let `hardness` and `threshold` be those of the pair");
        }
        if let (Some(_), Some(hardness)) = (&own.hardness_ratio, &own.journal_hardness) {
            let message = format!(
                "the wear of joint `{}` has both `hardness_ratio` and `journal_hardness`",
                name.value
            );
            self.refuse(Code::ConflictingKeys, hardness.span, message)
                .also(span, "from which the hardness of the journal follows")
                .help("leave out one of them: `hardness_ratio` is `hardness` over `journal_hardness`");
        }
        let mut positive = |key: &str, written: &Option<Quantity>, dimension: Dimension, default: f64| {
            self.number(name, (key, written.as_ref()), dimension, false, default)
        };
        let ratio = positive("hardness_ratio", &own.hardness_ratio, Dimension::NONE, 1.0);
        let hardness = positive("journal_hardness", &own.journal_hardness, PRESSURE, bush.hardness);
        let coefficient =
            positive("journal_coefficient", &own.journal_coefficient, Dimension::NONE, bush.coefficient);
        Some(ratio * (bush.hardness / hardness) * (coefficient / bush.coefficient))
    }

    fn wear(&mut self, name: &Name, written: &At<WearSpec>) -> WearInfo {
        let own = &written.value;
        let lacking = [
            ("coefficient", own.coefficient.is_none(), "1e-8"),
            ("hardness", own.hardness.is_none(), "\"3.5 GPa\""),
            ("threshold", own.threshold.is_none(), "\"80 um\""),
        ];
        self.lacks(name, written.span, "wear", &lacking);
        let bins = own.bins.as_ref().map_or(DEFAULT_BINS, |bins| usize::try_from(bins.value).unwrap_or(0));
        if let (Some(bins), false) = (&own.bins, (8..=10_000).contains(&bins)) {
            let message = format!("the profile of joint `{}` has {} bearing angles", name.value, bins.value);
            self.refuse(Code::BadClearance, bins.span, message)
                .help("72 are one every 5 degrees; 8 to 10000 are possible");
        }
        self.check_variation(name, own);
        let feedback = self.number(name, ("feedback", own.feedback.as_ref()), Dimension::NONE, true, 1.0);
        let mut positive = |key: &str, written: &Option<Quantity>, dimension: Dimension, default: f64| {
            self.number(name, (key, written.as_ref()), dimension, false, default)
        };
        let revolutions = &own.revolutions_per_cycle;
        let pressure_speed = positive("pressure_speed", &own.pressure_speed, PRESSURE_SPEED, f64::NAN);
        let alpha = positive("alpha", &own.alpha, PER_LENGTH, f64::NAN);
        let beta = positive("beta", &own.beta, PER_LENGTH, f64::NAN);
        let variation = positive("cycle_variation", &own.cycle_variation, Dimension::NONE, f64::NAN);
        let [alpha, beta] =
            [(&own.alpha, alpha), (&own.beta, beta)].map(|(key, rate)| key.as_ref().map(|_| rate));
        WearInfo {
            coefficient: positive("coefficient", &own.coefficient, Dimension::NONE, f64::NAN),
            hardness: positive("hardness", &own.hardness, PRESSURE, f64::NAN),
            area: own.area.as_ref().map_or_else(Area::default, |area| area.value),
            measure: own.measure.as_ref().map(|measure| measure.value),
            feedback,
            profile: own.profile.unwrap_or(false),
            bins,
            threshold: positive("threshold", &own.threshold, Dimension::LENGTH, f64::NAN),
            revolutions_per_cycle: positive("revolutions_per_cycle", revolutions, Dimension::NONE, 1.0),
            pressure_speed: own.pressure_speed.as_ref().map(|_| pressure_speed),
            // The Gamma process; with one of its rates, wear has the mean that physics gives.
            scatter: alpha.or(beta).zip(beta.or(alpha)).map(|(alpha, beta)| GammaRates { alpha, beta }),
            cycle_variation: own.cycle_variation.as_ref().map(|_| variation),
        }
    }
}
