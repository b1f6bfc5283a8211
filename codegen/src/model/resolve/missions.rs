//! Duty cycles: segments with their parameters and factors, and how much of the time each takes.

use super::quantity::Allowed;
use super::resolver::Resolver;
use crate::diagnostic::Code;
use crate::id::ParameterId;
use crate::model::{Joint, Mission, Segment};
use crate::source::Span;
use crate::spec::{At, Dimension, File, Literal, MissionSpec, Name, Quantity, SegmentSpec, Table};

/// Shares may differ from 1 together by this much, and are made to: digits that were written down rounded.
const ROUNDED: f64 = 1e-3;

/// Bins of a series' columns, unless the file says otherwise.
const DEFAULT_BINS: i64 = 8;
/// And at most.
const MOST_BINS: usize = 64;

/// How much of a mission segments are, as far as all agree.
#[derive(Clone, Copy, PartialEq)]
enum By {
    Share,
    Duration,
}

/// The amount of a segment as written.
enum Written {
    Share(f64),
    Rest,
    Duration(f64),
}

impl Resolver<'_> {
    pub(super) fn resolve_missions(&mut self, file: &File, joints: &[Joint]) -> Vec<Mission> {
        let wears = joints.iter().filter_map(|joint| joint.clearance.as_ref());
        let wears = wears.filter(|clearance| clearance.laws.wear.is_some()).count() > 0;
        let mut missions: Vec<Mission> = Vec::new();
        for (name, written) in &file.missions.0 {
            self.check_mission_name(name);
            if !wears && !self.has_errors() {
                let message =
                    format!("the mission `{}` is of a mechanism in which nothing wears", name.value);
                self.refuse(Code::BadMission, name.span, message)
                    .help("give a joint `[clearance]` and `[wear]`: a mission says by what share of time it wears how");
            }
            missions.extend(self.mission(name, written, joints));
        }
        missions
    }

    fn check_mission_name(&mut self, name: &Name) {
        if !super::names::is_name(&name.value) {
            self.report(super::names::bad_name(name));
        }
    }

    fn mission(&mut self, name: &Name, written: &At<MissionSpec>, joints: &[Joint]) -> Option<Mission> {
        let own = &written.value;
        if let Some(series) = &own.series {
            return self.measured_mission(name, own, series);
        }
        if let Some(bins) = &own.bins {
            let message = format!("the mission `{}` has `bins` but no `series`", name.value);
            self.refuse(Code::ConflictingKeys, bins.span, message)
                .help("bins are those of a measured series, `series = \"shift.csv\"`; leave them out");
        }
        if own.segments.0.is_empty() {
            let message = format!("the mission `{}` has no segments", name.value);
            self.missing(written.span, name.span, Code::BadMission, message).help(format!(
                "add `[missions.{}.segments]` with a line for each, `full = {{ share = 0.3, set = {{ speed = \"2 Hz\" }} }}`",
                name.value
            ));
            return None;
        }
        let amounts: Vec<Option<Written>> =
            own.segments.0.iter().map(|(segment, written)| self.amount_of(segment, written)).collect();
        let segments: Vec<Segment> =
            own.segments.0.iter().map(|(segment, written)| self.segment(segment, written, joints)).collect();
        let amounts: Vec<Written> = amounts.into_iter().collect::<Option<_>>()?;
        let (by, amounts) = self.agree(name, &own.segments, &amounts)?;
        let segments = segments.into_iter().zip(amounts);
        let segments = segments.map(|(segment, amount)| Segment { amount, ..segment }).collect();
        let ordered = by == By::Duration;
        Some(Mission { name: name.value.clone(), ordered, segments, coarser: Vec::new() })
    }

    /// A mission whose segments are bins of a series.
    fn measured_mission(&mut self, name: &Name, own: &MissionSpec, series: &Name) -> Option<Mission> {
        if let Some((segment, _)) = own.segments.0.first() {
            let message = format!("the mission `{}` has segments and a series", name.value);
            self.refuse(Code::ConflictingKeys, series.span, message)
                .also(segment.span, "the first segment")
                .help("give one of them: bins of a series are segments by themselves");
            return None;
        }
        let bins = own.bins.as_ref().map_or(DEFAULT_BINS, |bins| bins.value);
        let Some(bins) = usize::try_from(bins).ok().filter(|bins| (1..=MOST_BINS).contains(bins)) else {
            let span = own.bins.as_ref().map_or(series.span, |bins| bins.span);
            let message = format!("the series of mission `{}` has {bins} bins", name.value);
            self.refuse(Code::BadMission, span, message).help("1 to 64 are possible; 8 are a good begin");
            return None;
        };
        let (segments, coarser) = self.series_segments(name, series, bins)?;
        Some(Mission { name: name.value.clone(), ordered: false, segments, coarser })
    }

    /// Share or duration, one of them.
    fn amount_of(&mut self, name: &Name, written: &At<SegmentSpec>) -> Option<Written> {
        self.check_mission_name(name);
        let SegmentSpec { share, duration, .. } = &written.value;
        match (share, duration) {
            (Some(share), Some(duration)) => {
                let message = format!("the segment `{}` has both `share` and `duration`", name.value);
                self.refuse(Code::ConflictingKeys, duration.span, message)
                    .also(share.span, "its share of the operating time")
                    .help("leave out one of them, the same in all segments of a mission");
                None
            }
            (None, None) => {
                let message =
                    format!("the segment `{}` does not say how much of the mission it is", name.value);
                self.missing(written.span, name.span, Code::MissingKey, message)
                    .help("add `share = 0.3`, of the operating time, or `duration = \"2 h\"`");
                None
            }
            (Some(Quantity { value: Literal::Text(text), .. }), None) if text == "rest" => {
                Some(Written::Rest)
            }
            (Some(share), None) => {
                let share = self.positive_of(name, ("share", share), Dimension::NONE, false)?;
                Some(Written::Share(share))
            }
            (None, Some(duration)) => {
                let duration = self.positive_of(name, ("duration", duration), Dimension::TIME, false)?;
                Some(Written::Duration(duration))
            }
        }
    }

    /// A number of a segment that is fixed at generation.
    fn positive_of(
        &mut self,
        name: &Name,
        (key, written): (&str, &Quantity),
        dimension: Dimension,
        zero_allowed: bool,
    ) -> Option<f64> {
        let what = format!("`{key}` of segment `{}`", name.value);
        let formula = self.formula(written, Some(dimension), Allowed::CONSTANTS, &what);
        self.check_positive(&formula, zero_allowed, &what);
        let value = self.value(&formula);
        (value > 0.0 || (zero_allowed && value == 0.0)).then_some(value)
    }

    /// All shares, which come to 1, or all durations.
    fn agree(
        &mut self,
        name: &Name,
        segments: &Table<SegmentSpec>,
        amounts: &[Written],
    ) -> Option<(By, Vec<f64>)> {
        let place = |at: usize| {
            let own = &segments.0[at].1.value;
            own.share.as_ref().or(own.duration.as_ref()).map_or(segments.0[at].0.span, |written| written.span)
        };
        let is_duration = |amount: &Written| matches!(amount, Written::Duration(_));
        let first = is_duration(&amounts[0]);
        if let Some(other) = amounts.iter().position(|amount| is_duration(amount) != first) {
            let message = format!("the mission `{}` has shares and durations", name.value);
            self.refuse(Code::ConflictingKeys, place(other), message)
                .also(place(0), "the first segment")
                .help("give a share of the operating time to all segments, or a duration to all");
            return None;
        }
        if first {
            let all = amounts.iter().map(|amount| if let Written::Duration(of) = amount { *of } else { 0.0 });
            return Some((By::Duration, all.collect()));
        }
        let share = |amount: &Written| if let Written::Share(share) = amount { *share } else { 0.0 };
        let sum: f64 = amounts.iter().map(share).sum();
        let rests: Vec<usize> =
            (0..amounts.len()).filter(|at| matches!(amounts[*at], Written::Rest)).collect();
        let whole = |sum: f64| format!("the shares of mission `{}` come to {sum}", name.value);
        let shares = match rests[..] {
            [] if (sum - 1.0).abs() > ROUNDED => {
                self.refuse(Code::BadMission, name.span, whole(sum))
                    .help("they are parts of the operating time and come to 1; `share = \"rest\"` takes what is left");
                return None;
            }
            [] if amounts.len() == 1 => vec![1.0],
            [] => amounts.iter().map(|amount| share(amount) / sum).collect(),
            [rest] if sum < 1.0 => {
                let mut shares: Vec<f64> = amounts.iter().map(share).collect();
                shares[rest] = 1.0 - sum;
                shares
            }
            [rest] => {
                self.refuse(Code::BadMission, place(rest), format!("{} before the rest", whole(sum)))
                    .help("nothing is left; give the others less, or leave this segment out");
                return None;
            }
            [first, second, ..] => {
                let message = format!("two segments of mission `{}` are the rest", name.value);
                self.refuse(Code::BadMission, place(second), message)
                    .also(place(first), "the first")
                    .help("give one of them its share as a number");
                return None;
            }
        };
        Some((By::Share, shares))
    }

    /// A segment without its amount.
    fn segment(&mut self, name: &Name, written: &At<SegmentSpec>, joints: &[Joint]) -> Segment {
        let own = &written.value;
        let values =
            own.set.0.iter().filter_map(|(parameter, value)| self.set_in(name, parameter, &value.value));
        let values = values.collect();
        let has = |of: fn(&Joint) -> bool| joints.iter().any(of);
        let friction = self.factor(name, ("friction", own.friction.as_ref()), has(has_friction), 1.0);
        let wear = self.factor(name, ("wear", own.wear.as_ref()), has(does_wear), 1.0);
        let mut of_joints = Vec::new();
        for (joint, factors) in &own.joints.0 {
            let Some(id) = self.joint_named(joint, &format!("segment `{}`", name.value)) else { continue };
            let Some(found) = joints.get(id.index()) else { continue };
            let keys = &factors.value;
            let friction = self.factor(
                name,
                (&format!("joints.{}.friction", joint.value), keys.friction.as_ref()),
                has_friction(found),
                friction,
            );
            let wear = self.factor(
                name,
                (&format!("joints.{}.wear", joint.value), keys.wear.as_ref()),
                does_wear(found),
                wear,
            );
            of_joints.push((joint.value.clone(), (friction, wear)));
        }
        Segment { name: name.value.clone(), amount: 1.0, values, factors: (friction, wear), of_joints }
    }

    /// A factor on what there must be something of.
    fn factor(
        &mut self,
        name: &Name,
        (key, written): (&str, Option<&Quantity>),
        applies: bool,
        default: f64,
    ) -> f64 {
        let Some(written) = written else { return default };
        let is_friction = key.ends_with("friction");
        let value = self.positive_of(name, (key, written), Dimension::NONE, is_friction);
        if !applies && !self.has_errors() {
            let what = if is_friction { "friction" } else { "wear" };
            let message =
                format!("`{key}` of segment `{}` has nothing to change: there is no {what}", name.value);
            self.refuse(Code::BadMission, written.span, message).help(if is_friction {
                "give the joint `friction = 0.05` in `[clearance]`, or leave the factor out"
            } else {
                "give the joint a `[wear]` table, or leave the factor out"
            });
        }
        value.unwrap_or(default)
    }

    /// A parameter or input and its value in a segment.
    fn set_in(&mut self, segment: &Name, name: &Name, value: &Quantity) -> Option<(ParameterId, f64)> {
        let id = self.segment_parameter(segment, name)?;
        let dimension = self.parameters[id.index()].dimension;
        let what = format!("`{}` in segment `{}`", name.value, segment.value);
        let formula = self.formula(value, Some(dimension), Allowed::CONSTANTS, &what);
        if let Some([message, help]) = self.other_turning(id.index(), self.turns_of(value).of, &what) {
            self.refuse(Code::UnitMismatch, value.span, message).help(help);
            return None;
        }
        let value = self.value(&formula);
        value.is_finite().then_some((id, value))
    }

    /// What may differ from segment to segment: a tunable parameter or an input.
    pub(super) fn segment_parameter(&mut self, segment: &Name, name: &Name) -> Option<ParameterId> {
        let id = self.parameter_named(name, &format!("segment `{}`", segment.value))?;
        let parameter = &self.parameters[id.index()];
        let (is_fixed, declared): (bool, Span) = (!parameter.tunable && !parameter.input, parameter.span);
        if is_fixed {
            let message =
                format!("segment `{}` sets `{}`, which is fixed at generation", segment.value, name.value);
            self.refuse(Code::BadMission, name.span, message).also(declared, "declared here").help(format!(
                "let it change: `{} = {{ value = .., tunable = true }}`, or make it an input",
                name.value
            ));
            return None;
        }
        Some(id)
    }
}

fn has_friction(joint: &Joint) -> bool {
    joint.clearance.as_ref().is_some_and(|clearance| clearance.laws.friction.is_some())
}

fn does_wear(joint: &Joint) -> bool {
    joint.clearance.as_ref().is_some_and(|clearance| clearance.laws.wear.is_some())
}
