//! Which measure of wear each joint has, what it assumes, and when to take another. In: a description. Out: a paragraph for people,
//! entries for machines. Never knows lives.

use std::fmt::Write as _;

use linkwear_runtime::life::WearOf;
use linkwear_runtime::wear::Measure;
use linkwear_runtime::{ContactInfo, Description, WearInfo};
use serde::{Deserialize, Serialize};

/// What is said of the measure of one joint.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct WearMeasure {
    /// The joint.
    pub joint: String,
    /// As `measure` in a file, where that is a word of files.
    pub measure: String,
    /// What W is.
    pub what: String,
    /// What it takes for granted.
    pub assumes: String,
    /// When to take another.
    #[serde(rename = "else")]
    pub instead: String,
    /// Whether the worn volume is that of Archard's law.
    pub conserves_volume: bool,
}

impl WearMeasure {
    fn of(joint: &str, wear: &WearInfo, journal: bool) -> Self {
        let bin = 360.0 / wear.bins as f64;
        let (measure, what, assumes, instead) = match WearOf::described(wear) {
            WearOf::Depth => (
                "depth",
                format!("the depth by the contact area ({}), Archard's law as it stands", wear.area),
                "all of a turn's wear falls on one place as large as the contact (more than the worn volume, if it wanders)",
                "contact that wanders round: measure = \"maximum\" if the deepest place decides, \"mean\" if the play does",
            ),
            WearOf::Profile(Measure::Maximum) => (
                Measure::Maximum.name(),
                format!("the largest depth by bearing angle, in bins of {bin:.4} deg"),
                "the joint has failed when its deepest place has; the worn volume is that of Archard's law",
                "failure by play, all round: measure = \"mean\"; by one loaded place, as in the paper's Eq. 19: leave \
                 measure out",
            ),
            WearOf::Profile(Measure::Mean) => (
                Measure::Mean.name(),
                "the mean depth over all bearing angles".to_owned(),
                "the joint has failed when its play has grown so far on average; the worn volume is that of Archard's \
                 law, and a place may be far deeper",
                "failure of one place, as of a lining: measure = \"maximum\"",
            ),
        };
        let beside = match WearOf::described(wear) {
            _ if !journal => "",
            WearOf::Profile(Measure::Maximum) => ", of the bush and of the journal together",
            _ => ", and the mean depth of the journal over its angle",
        };
        let what = what + beside;
        Self {
            joint: joint.to_owned(),
            measure: measure.to_owned(),
            what,
            assumes: assumes.to_owned(),
            instead: instead.to_owned(),
            conserves_volume: measure != "depth",
        }
    }
}

/// One for each joint that wears.
pub fn wear_measures(description: &Description) -> Vec<WearMeasure> {
    let contacts = description.contacts.iter().enumerate();
    let of = |(at, contact): (usize, &ContactInfo)| {
        let wear = contact.wear.as_ref()?;
        Some(WearMeasure::of(&contact.joint, wear, description.journal_ratio(at).is_some()))
    };
    contacts.filter_map(of).collect()
}

/// A paragraph; nothing where nothing wears. Joints of one measure share their words.
pub fn paragraph(measures: &[WearMeasure]) -> String {
    let mut groups: Vec<(Vec<&str>, &WearMeasure)> = Vec::new();
    for measure in measures {
        match groups.iter_mut().find(|(_, known)| known.what == measure.what) {
            Some((joints, _)) => joints.push(&measure.joint),
            None => groups.push((vec![&measure.joint], measure)),
        }
    }
    let mut text = String::new();
    for (joints, WearMeasure { what, assumes, instead, .. }) in groups {
        let joints = joints.join(", ");
        let _ = write!(text, "\nWear W of {joints} is {what}\n  assumes  {assumes}\n  else     {instead}\n");
    }
    text
}
