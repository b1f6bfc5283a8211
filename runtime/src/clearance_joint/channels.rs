//! Output columns of joints with clearance, after the generated ones. In: a [`Description`], [`ContactState`]es.
//! Out: channels and their values, in the same order.

use super::joint::ContactState;
use crate::description::{Channel, Description};

/// One quantity of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Quantity {
    Offset(usize),
    Gap,
    NormalForce,
    SlidingSpeed,
    Angle,
}

const BALL: &[(&str, &str, Quantity)] = &[
    ("x", "m", Quantity::Offset(0)),
    ("y", "m", Quantity::Offset(1)),
    ("z", "m", Quantity::Offset(2)),
    ("gap", "m", Quantity::Gap),
    ("Fn", "N", Quantity::NormalForce),
    ("vt", "m/s", Quantity::SlidingSpeed),
];

const JOURNAL: &[(&str, &str, Quantity)] = &[
    ("x", "m", Quantity::Offset(0)),
    ("y", "m", Quantity::Offset(1)),
    ("gap", "m", Quantity::Gap),
    ("Fn", "N", Quantity::NormalForce),
    ("vt", "m/s", Quantity::SlidingSpeed),
    ("contact_angle", "rad", Quantity::Angle),
];

/// All columns of a mechanism: the generated ones, then those that contacts add; names that exist already are not
/// added.
#[derive(Clone, Debug, Default)]
pub(crate) struct Channels {
    /// Their names and units.
    pub(crate) channels: Vec<Channel>,
    sources: Vec<(usize, Quantity)>,
}

impl Channels {
    /// The columns of a mechanism.
    pub(crate) fn new(description: &Description) -> Self {
        let mut list = Self { channels: description.channels.to_vec(), sources: Vec::new() };
        for (joint, info) in description.contacts.iter().enumerate() {
            for (suffix, unit, quantity) in if info.ball { BALL } else { JOURNAL } {
                let name = format!("{}.{suffix}", info.joint);
                if list.channels.iter().all(|channel| channel.name != name) {
                    // The contact angle keeps to (-pi, pi]: a bearing has no turns.
                    list.channels.push(Channel { name: name.into(), unit: (*unit).into(), wraps: false });
                    list.sources.push((joint, *quantity));
                }
            }
        }
        list
    }

    /// Writes the values of the columns that contacts add.
    pub(crate) fn write(&self, contacts: &[ContactState], values: &mut [f64]) {
        for ((joint, quantity), value) in self.sources.iter().zip(values) {
            let contact = &contacts[*joint];
            *value = match quantity {
                Quantity::Offset(axis) => contact.offset[*axis],
                Quantity::Gap => contact.gap,
                Quantity::NormalForce => contact.normal_force,
                Quantity::SlidingSpeed => contact.sliding_speed,
                Quantity::Angle => contact.angle,
            };
        }
    }
}
