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

/// The columns that contacts add to those of generated code; names that exist already are left out.
#[derive(Clone, Debug, Default)]
pub struct ContactChannels {
    channels: Vec<Channel>,
    sources: Vec<(usize, Quantity)>,
}

impl ContactChannels {
    /// The columns of a mechanism: none without clearance.
    #[must_use]
    pub fn new(description: &Description) -> Self {
        let mut list = Self::default();
        for (joint, info) in description.contacts.iter().enumerate() {
            for (suffix, unit, quantity) in if info.ball { BALL } else { JOURNAL } {
                let name = format!("{}.{suffix}", info.joint);
                if description.channels.iter().all(|channel| channel.name != name) {
                    // The contact angle keeps to (-pi, pi]: a bearing has no turns.
                    list.channels.push(Channel { name: name.into(), unit: (*unit).into(), wraps: false });
                    list.sources.push((joint, *quantity));
                }
            }
        }
        list
    }

    /// The columns.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Writes their values, one per column.
    pub fn write(&self, contacts: &[ContactState], values: &mut [f64]) {
        for ((joint, quantity), value) in self.sources.iter().zip(values) {
            let touch = &contacts[*joint];
            *value = match quantity {
                Quantity::Offset(axis) => touch.offset[*axis],
                Quantity::Gap => touch.gap,
                Quantity::NormalForce => touch.normal_force,
                Quantity::SlidingSpeed => touch.sliding_speed,
                Quantity::Angle => touch.angle,
            };
        }
    }
}
