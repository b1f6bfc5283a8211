//! How joints with clearance wear: constants of Archard's law, its coefficient's factor, the wear of journals.

use linkwear_runtime::wear::{Area, DEFAULT_BINS};
use linkwear_runtime::{ContactInfo, GammaRates, WearInfo};

use super::clearance::PRESSURE;
use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::model::{Formula, Term, WearFactor};
use crate::spec::{At, Dimension, Name, Quantity, WearSpec};

const PER_LENGTH: Dimension = Dimension::of(-1, 0, 0);
const PRESSURE_SPEED: Dimension = Dimension::of(0, 1, -3);

impl Resolver<'_> {
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
    pub(super) fn wear_factor(
        &mut self,
        name: &Name,
        written: &At<WearSpec>,
        laws: &ContactInfo,
        room: usize,
    ) -> Option<WearFactor> {
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
        if live.len() > room {
            let (side, room) = match (laws.ball, room) {
                (true, _) => ("ball", "none".to_owned()),
                (_, 0) => ("guide", "none".to_owned()),
                _ => ("journal", room.to_string()),
            };
            let message = format!(
                "{what} reads {} tunable parameters and inputs; a {side} has room for {room}",
                live.len()
            );
            self.refuse(Code::BadClearance, written.span, message)
                .help("put them together in fewer inputs, or fix parameters with `tunable = false`");
        }
        self.check_factor(name, (&what, &formula), laws.wear.map_or(1e9, |wear| wear.hardness));
        // Of pressure or speed it may be zero somewhere, and what is live may change in a run.
        if live.is_empty() && formula.term.value_at(&self.values, None) == Some(0.0) {
            let message = format!("{what} is 0: the joint never wears");
            self.refuse(Code::NotPositive, written.span, message).label("it must be above 0").help(format!(
                "leave out the wear of `{}` if it does not wear; else give the factor, or leave it out, which is 1",
                name.value
            ));
        }
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
    pub(super) fn journal(
        &mut self,
        name: &Name,
        written: &At<WearSpec>,
        bush: &WearInfo,
        (ball, guide): (bool, bool),
    ) -> Option<f64> {
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
        if guide {
            let message = format!(
                "`{key}` of joint `{}`: a journal that slides along its bearing or tilts keeps no wear of its own",
                name.value
            );
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

    pub(super) fn wear(&mut self, name: &Name, written: &At<WearSpec>) -> WearInfo {
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
        if let (Some(written), Some(true), true) = (&own.feedback, own.profile, feedback != 1.0) {
            let message = format!(
                "joint `{}` has `feedback` other than 1 and `profile`: with its profile the worn surface itself is what bodies meet",
                name.value
            );
            self.refuse(Code::ConflictingKeys, written.span, message)
                .help("leave out one of them: `feedback` is for a clearance that grows alike all round");
        }
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
            area: own.area.as_ref().map_or_else(Area::default, |area| area.value.0),
            measure: own.measure.as_ref().map(|measure| measure.value.0),
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
