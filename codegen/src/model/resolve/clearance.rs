//! Joints with clearance: which they are, how they give way, and the constants of their laws of contact and friction.

use linkwear_runtime::ContactInfo;
use linkwear_runtime::contact::{IMPACT_SPEED_FLOOR, Onset, Restitution, Stiffness, Strength};
use linkwear_runtime::wear::MOST_LIVE;

use super::inertia;
use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::model::{Axis, Clearance, ClearancePlaces, Ends, Formula, Joint, JointKind};
use crate::source::Span;
use crate::spec::{At, ClearanceSpec, Dimension, File, JointSpec, Name, Quantity};

/// Speed below which friction is smoothed, unless the file says otherwise [m/s].
const FRICTION_SPEED: f64 = 1e-3;
/// Directions that differ by less are drawn alike [rad]: rounding of numbers that a file gives with ten digits.
const ALIGNED: f64 = 1e-9;
/// Stribeck speed, unless the file says otherwise [m/s].
const STRIBECK_SPEED: f64 = 1e-2;

pub(super) const PRESSURE: Dimension = Dimension::of(-1, 1, -2);
const SPEED: Dimension = Dimension::of(1, 0, -1);

impl Resolver<'_> {
    /// Gives the joints named in `[clearance]` their freedom.
    pub(super) fn add_clearance(&mut self, file: &File) {
        for (name, written) in &file.clearance.0 {
            let Some(id) = self.joint_named(name, "[clearance]") else { continue };
            let known = self.joint_models.get(id.index()).filter(|model| !model.stands_in);
            let Some(kind) = known.map(|model| model.kind) else { continue };
            if self.joint_models[id.index()].is_driven_ball() {
                let message = format!(
                    "joint `{}`: a ball whose three angles are prescribed cannot have clearance",
                    name.value
                );
                self.refuse(Code::BadClearance, name.span, message).help(
                    "drive the body by another joint and leave `drive` out here, or take a `revolute` or `universal` joint, which may \
                     have both",
                );
                continue;
            }
            if kind.clearance.is_empty() {
                let message = format!("the {} joint `{}` cannot have clearance", kind.name, name.value);
                self.refuse(Code::BadClearance, name.span, message)
                    .help("revolute, prismatic, cylindrical, universal and spherical joints can");
                continue;
            }
            let tilt = self.tilt(name, written, kind);
            let hinges = if tilt.is_some() { self.hinges(file, name) } else { Vec::new() };
            let model = &mut self.joint_models[id.index()];
            (model.clearance, model.tilt) = (true, tilt);
            if let [axis] = model.axes[..] {
                model.axes.push(offset_axis(axis, &hinges));
            }
        }
    }

    /// Axes about which joints turn that are drawn where they are, first those of joints that share a body with this one.
    fn hinges(&self, file: &File, of: &Name) -> Vec<[f64; 3]> {
        let bodies = |joint: &At<JointSpec>| -> Vec<String> {
            let pair = joint.value.kinds().next().map(|(_, pair)| &pair.0.value);
            let names = pair.into_iter().flatten().map(|name| name.value.clone());
            names.filter(|name| name != "ground").collect()
        };
        let own = file.joints.0.iter().find(|(name, _)| name.value == of.value);
        let own = own.map_or_else(Vec::new, |(_, joint)| bodies(joint));
        let turning = file.joints.0.iter().zip(&self.joint_models).filter_map(|((_, joint), model)| {
            model.turn_about_axis()?;
            let axis = model.axes.first().filter(|axis| axis.parent == axis.child)?;
            Some((bodies(joint).iter().any(|body| own.contains(body)), axis.parent))
        });
        let (near, far): (Vec<_>, Vec<_>) = turning.partition(|(is_near, _)| *is_near);
        near.into_iter().chain(far).map(|(_, axis)| axis).collect()
    }

    /// Whether a journal tilts in its clearance, and which side has the ends that touch.
    fn tilt(&mut self, name: &Name, written: &At<ClearanceSpec>, kind: &JointKind) -> Option<Ends> {
        let own = &written.value;
        let keys =
            [("tilt", own.tilt.as_ref().map(|at| at.span)), ("ends", own.ends.as_ref().map(|at| at.span))];
        let first = keys.into_iter().find_map(|(key, span)| Some((key, span?)));
        if let (false, Some((key, span))) = (kind.tilts, first) {
            let message = format!(
                "`{key}` of joint `{}`: a {} joint has no journal that could tilt",
                name.value, kind.name
            );
            self.refuse(Code::BadClearance, span, message)
                .help("leave it out; revolute, prismatic and cylindrical joints have one");
            return None;
        }
        let slides = kind.slides_along_axis();
        if !own.tilt.as_ref().map_or(kind.tilts && slides, |tilt| tilt.value) {
            if let Some(ends) = &own.ends {
                let message =
                    format!("`ends` of joint `{}` has no effect on a journal that does not tilt", name.value);
                self.refuse(Code::BadClearance, ends.span, message)
                    .help("add `tilt = true`, or leave `ends` out");
            }
            return None;
        }
        if let (true, None) = (slides, &own.ends) {
            let message =
                format!("the clearance of joint `{}` does not say which side is the shorter one", name.value);
            self.refuse(Code::MissingKey, written.span, message).help(
                "add `ends = \"bearing\"` where a bush goes along a rod, `ends = \"journal\"` where a piston goes along a bore",
            );
        }
        Some(own.ends.as_ref().map_or(Ends::Bearing, |ends| ends.value))
    }

    pub(super) fn resolve_clearances(&mut self, file: &File, joints: &mut [Joint]) {
        for (name, written) in &file.clearance.0 {
            let Some(joint) = joints.iter_mut().find(|joint| joint.name == name.value) else { continue };
            let ball = !joint.model.kind.tilts;
            let guide = joint.model.is_loose_guide();
            let wear = file.wear.0.iter().find(|(other, _)| other.value == name.value);
            let radial = self.radial(name, written);
            let mut laws = self.laws(name, written, ball);
            laws.wear = wear.map(|(name, wear)| self.wear(name, wear));
            let journal = wear
                .zip(laws.wear)
                .and_then(|((name, wear), law)| self.journal(name, wear, &law, (ball, guide)));
            let value = self.value(&radial);
            if value >= laws.journal_radius {
                let message = format!(
                    "the clearance of joint `{}`, {}, is not less than its journal's radius, {}",
                    name.value,
                    self.told(&radial),
                    self.told_at(
                        written.value.journal_radius.as_ref().map_or(radial.span, |own| own.span),
                        laws.journal_radius,
                        Dimension::LENGTH
                    )
                );
                self.refuse(Code::BadClearance, radial.span, message)
                    .help("the clearance is the difference of the radii of bearing and journal");
            }
            let room = if ball || guide { 0 } else { MOST_LIVE };
            let factor = wear.and_then(|(name, wear)| self.wear_factor(name, wear, &laws, room));
            let place = |written: Option<&Quantity>| written.map_or(radial.span, |quantity| quantity.span);
            let wears = wear.map(|(_, wear)| &wear.value);
            let places = ClearancePlaces {
                modulus: place(written.value.modulus.as_ref()),
                friction: place(written.value.static_friction.as_ref().or(written.value.friction.as_ref())),
                hardness: place(wears.and_then(|wear| wear.hardness.as_ref())),
                coefficient: place(wears.and_then(|wear| wear.coefficient.as_ref())),
                threshold: place(wears.and_then(|wear| wear.threshold.as_ref())),
                cycle: wear.map_or(radial.span, |(_, table)| {
                    table.value.revolutions_per_cycle.as_ref().map_or(table.span, |quantity| quantity.span)
                }),
            };
            joint.clearance = Some(Box::new(Clearance { radial, laws, journal, factor, places }));
        }
        for (name, written) in &file.wear.0 {
            let known = file.clearance.0.iter().any(|(other, _)| other.value == name.value);
            // Its own faults are told beside that its joint is unknown.
            if !joints.iter().any(|joint| joint.name == name.value) {
                self.wear(name, written);
            }
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

    pub(super) fn lacks(&mut self, name: &Name, span: Span, table: &str, keys: &[(&str, bool, &str)]) {
        for (key, _, example) in keys.iter().filter(|(_, missing, _)| *missing) {
            let message = format!("the {table} of joint `{}` has no `{key}`", name.value);
            self.lacking(span, span, key, message).help(format!("add `{key} = {example}`"));
        }
    }

    /// A number fixed at generation, positive or, if allowed, zero.
    pub(super) fn number(
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
            law: own.law.as_ref().map_or_else(Restitution::default, |law| law.value.0),
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
        // What is not above zero has been reported already.
        if let (Some(given), true) = (&own.exponent, laws.exponent > 0.0 && laws.exponent < 1.0) {
            let message = format!("`exponent` of joint `{}` is {}", name.value, laws.exponent);
            self.refuse(Code::BadClearance, given.span, message)
                .help("it is at least 1: 1.5 for a ball in a socket, 1 for a layer of rubber or plastic");
        }
        laws
    }

    fn friction(&mut self, name: &Name, own: &ClearanceSpec) -> Option<(Strength, Onset, f64)> {
        if own.friction.is_none() {
            self.only_with_friction(name, own);
            return None;
        }
        if let (Some(written), None) = (&own.stribeck_speed, &own.static_friction) {
            let message =
                format!("`stribeck_speed` of joint `{}` has no effect without `static_friction`", name.value);
            self.refuse(Code::BadClearance, written.span, message)
                .help("add `static_friction = 0.1`, the coefficient at rest, or leave this out");
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
        let slope = own.friction_slope.as_ref().map_or(0.0, |written| {
            let what = place("friction_slope", "joint", name);
            let slope = self.formula(written, Some(Dimension::of(-1, 0, 1)), Allowed::CONSTANTS, &what);
            self.value(&slope)
        });
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
            let told = list.value.iter().zip(speeds);
            let told = told.map(|(own, speed)| self.told_at(own.span, *speed, Dimension::of(1, 0, -1)));
            let told: Vec<_> = told.collect();
            let message = format!("the friction speeds of joint `{}` are {}", name.value, told.join(", "));
            self.refuse(Code::BadClearance, list.span, message).help(
                "give one above 0, `[\"1 mm/s\"]`, or two that rise, `[\"0.1 mm/s\", \"1 mm/s\"]` (Ambrosio)",
            );
        }
    }
}

/// The direction of the offset's first component and of the first tilt, as near to e_x as the axis allows; or along a hinge across it.
///
/// Two tilts one after the other turn about one of their axes exactly, about others but for a roll that goes with their product. In
/// a planar mechanism a guide tilts about the direction of the hinges: were that none of the two axes, its key and its hinges would
/// hold it against each other.
fn offset_axis(axis: Axis, hinges: &[[f64; 3]]) -> Axis {
    let along = |direction: [f64; 3], normal: [f64; 3], angle: (f64, f64)| {
        let other = inertia::cross(normal, direction);
        std::array::from_fn(|i| angle.0 * direction[i] + angle.1 * other[i])
    };
    let [parent, child] = [axis.parent, axis.child].map(inertia::any_perpendicular);
    let across = |hinge: &&[f64; 3]| inertia::dot(**hinge, axis.parent).abs() < ALIGNED;
    let Some(hinge) = hinges.iter().find(across) else { return Axis { parent, child } };
    let angle = (inertia::dot(*hinge, parent), inertia::dot(*hinge, inertia::cross(axis.parent, parent)));
    if angle.0.abs().min(angle.1.abs()) < ALIGNED {
        return Axis { parent, child };
    }
    Axis { parent: along(parent, axis.parent, angle), child: along(child, axis.child, angle) }
}
