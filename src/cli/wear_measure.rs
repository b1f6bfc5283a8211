//! Which measure of wear each joint has, what it assumes, and when to take another. In: a description. Out: a paragraph for people,
//! entries for machines. Never knows lives.

use std::fmt::Write as _;

use linkwear_runtime::life::WearOf;
use linkwear_runtime::wear::Measure;
use linkwear_runtime::{Description, WearInfo};
use serde_json::{Value, json};

/// What is said of one measure.
struct Words {
    /// As `measure` in a file, where that is a word of files.
    name: &'static str,
    what: String,
    assumes: String,
    instead: &'static str,
    conserves_volume: bool,
}

impl Words {
    fn of(wear: &WearInfo) -> Self {
        let bin = 360.0 / wear.bins as f64;
        match WearOf::described(wear) {
            WearOf::Depth => Self {
                name: "depth",
                what: format!("the depth by the contact area ({}), Archard's law as it stands", wear.area),
                assumes: "all of a turn's wear falls on one place as large as the contact (more than the worn volume, if it wanders)"
                    .to_owned(),
                instead: "contact that wanders round: measure = \"maximum\" if the deepest place decides, \"mean\" if the play does",
                conserves_volume: false,
            },
            WearOf::Profile(Measure::Maximum) => Self {
                name: Measure::Maximum.name(),
                what: format!("the largest depth by bearing angle, in bins of {bin:.4} deg"),
                assumes: "the joint has failed when its deepest place has; the worn volume is that of Archard's law".to_owned(),
                instead: "failure by play, all round: measure = \"mean\"; by one loaded place, as in the paper's Eq. 19: leave \
                          measure out",
                conserves_volume: true,
            },
            WearOf::Profile(Measure::Mean) => Self {
                name: Measure::Mean.name(),
                what: "the mean depth over all bearing angles".to_owned(),
                assumes: "the joint has failed when its play has grown so far on average; the worn volume is that of Archard's \
                          law, and a place may be far deeper"
                    .to_owned(),
                instead: "failure of one place, as of a lining: measure = \"maximum\"",
                conserves_volume: true,
            },
        }
    }
}

fn wearing(description: &Description) -> impl Iterator<Item = (&str, Words)> {
    let contacts = description.contacts.iter();
    contacts.filter_map(|contact| Some((&*contact.joint, Words::of(contact.wear.as_ref()?))))
}

/// A paragraph; nothing where nothing wears. Joints of one measure share their words.
pub fn text(description: &Description) -> String {
    let mut groups: Vec<(Vec<&str>, Words)> = Vec::new();
    for (joint, words) in wearing(description) {
        match groups.iter_mut().find(|(_, known)| known.what == words.what) {
            Some((joints, _)) => joints.push(joint),
            None => groups.push((vec![joint], words)),
        }
    }
    let mut text = String::new();
    for (joints, Words { what, assumes, instead, .. }) in groups {
        let joints = joints.join(", ");
        let _ = write!(text, "\nWear W of {joints} is {what}\n  assumes  {assumes}\n  else     {instead}\n");
    }
    text
}

/// One entry for each joint that wears.
pub fn entries(description: &Description) -> Vec<Value> {
    let entry = |(joint, words): (&str, Words)| {
        let Words { name, what, assumes, instead, conserves_volume } = words;
        json!({
            "joint": joint, "measure": name, "what": what, "assumes": assumes, "else": instead,
            "conserves_volume": conserves_volume,
        })
    };
    wearing(description).map(entry).collect()
}
