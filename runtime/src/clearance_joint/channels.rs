//! Output columns of joints with clearance, after the generated ones. In: a [`Description`], [`ContactState`]es.
//! Out: channels and their values, in the same order.

use super::joint::ContactState;
use crate::description::{Channel, Description};

type Value = fn(&ContactState) -> f64;
/// Suffix, unit and value of a column.
type Quantity = (&'static str, &'static str, Value);

const BALL: &[Quantity] = &[
    ("x", "m", |contact| contact.offset[0]),
    ("y", "m", |contact| contact.offset[1]),
    ("z", "m", |contact| contact.offset[2]),
    ("gap", "m", |contact| contact.gap),
    ("Fn", "N", |contact| contact.normal_force),
    ("vt", "m/s", |contact| contact.sliding_speed),
];

/// Which place of a journal that wears touches.
const WEARING: &[Quantity] = &[("journal_angle", "rad", ContactState::journal_angle)];

const JOURNAL: &[Quantity] = &[
    ("x", "m", |contact| contact.offset[0]),
    ("y", "m", |contact| contact.offset[1]),
    ("gap", "m", |contact| contact.gap),
    ("Fn", "N", |contact| contact.normal_force),
    ("vt", "m/s", |contact| contact.sliding_speed),
    ("contact_angle", "rad", ContactState::angle),
];

/// All columns of a mechanism: the generated ones, then those that contacts add; names that exist already are not
/// added.
#[derive(Clone, Debug, Default)]
pub(crate) struct Channels {
    /// Their names and units.
    pub(crate) channels: Vec<Channel>,
    /// Joint and value of those that contacts add.
    sources: Vec<(usize, &'static str, Value)>,
}

impl Channels {
    /// The columns of a mechanism.
    pub(crate) fn new(description: &Description) -> Self {
        let mut list = Self { channels: description.channels.to_vec(), sources: Vec::new() };
        for (joint, info) in description.contacts.iter().enumerate() {
            let own = if info.ball { BALL } else { JOURNAL };
            let more = if description.journal_ratio(joint).is_some() { WEARING } else { &[] };
            for (suffix, unit, value) in own.iter().chain(more) {
                let name = format!("{}.{suffix}", info.joint);
                if list.channels.iter().all(|channel| channel.name != name) {
                    // The contact angle keeps to (-pi, pi]: a bearing has no turns.
                    list.channels.push(Channel { name: name.into(), unit: (*unit).into(), wraps: false });
                    list.sources.push((joint, *suffix, *value));
                }
            }
        }
        list
    }

    /// Writes the values of the columns that contacts add.
    pub(crate) fn write(&self, contacts: &[ContactState], values: &mut [f64]) {
        for (value, new) in values.iter_mut().zip(self.values(contacts)) {
            *value = new;
        }
    }

    /// The values of the columns that contacts add.
    pub(crate) fn values<'c>(&'c self, contacts: &'c [ContactState]) -> impl Iterator<Item = f64> + 'c {
        self.sources.iter().map(|(joint, _, of)| of(&contacts[*joint]))
    }
}

/// All columns of a mechanism as runs have them: those of its equations, then those of its contacts.
pub fn channels(description: &Description) -> Vec<Channel> {
    Channels::new(description).channels
}

/// Of the columns that contacts add, in order: index of the joint among those with clearance, and what it is: `x`, `y`, `z`, `gap`, `Fn`,
/// `vt`, `contact_angle`, `journal_angle`.
pub fn contact_columns(description: &Description) -> Vec<(usize, &'static str)> {
    Channels::new(description).sources.iter().map(|(joint, quantity, _)| (*joint, *quantity)).collect()
}
