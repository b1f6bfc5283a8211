//! The first measurements of lives, which all begin with unworn joints. In: what was measured. Out: the same when it is asked for again.
//! Never measures.

use super::settling::Orbit;
use super::steadiness::Steadiness;
use crate::life::JointWear;
use crate::wear::ContactMeasure;

/// So many are kept: those of a first cycle, in steps as long as it.
const MOST: usize = 4;

/// A measurement of joints worn so, that went on from an orbit or began.
pub(super) struct Known {
    pub joints: Vec<JointWear>,
    pub from: Option<Orbit>,
    pub measured: Vec<ContactMeasure>,
    pub steadiness: Vec<Vec<Steadiness>>,
    /// What it ended with.
    pub state: Option<Orbit>,
}

/// Those that every life makes.
#[derive(Default)]
pub(super) struct Beginning(Vec<Known>);

impl Beginning {
    /// One that was made before.
    pub fn find(&self, joints: &[JointWear], from: Option<&Orbit>) -> Option<&Known> {
        self.0.iter().find(|known| known.from.as_ref() == from && known.joints == joints)
    }

    /// Whether one that goes on from there, or began, will be asked for again.
    pub fn wants(&self, from: Option<&Orbit>) -> bool {
        let begins = from.is_none() || self.0.iter().any(|known| known.state.as_ref() == from);
        begins && self.0.len() < MOST
    }

    /// Keeps one.
    pub fn keep(&mut self, new: Known) {
        self.0.push(new);
    }
}
