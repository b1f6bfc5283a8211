//! Joints with clearance: constants of their laws, and the places where both sides touch. Never knows equations.

use linkwear_runtime::ContactInfo;

use super::{Formula, Joint, Mechanism};
use crate::id::ParameterId;
use crate::source::Span;

/// A joint with clearance.
#[derive(Clone, Debug)]
pub struct Clearance {
    /// Radial clearance [m], a formula over parameters.
    pub radial: Formula,
    /// Laws of contact, friction and wear with their constants. Of a guide with two ends each has them, with half of the length.
    pub laws: ContactInfo,
    /// Worn volume of the journal over that of the bush, if it wears too.
    pub journal: Option<f64>,
    /// Factor on the wear coefficient, if it varies: over pressure and sliding speed, places 0 and 1.
    pub factor: Option<WearFactor>,
    /// Where the file has them.
    pub places: ClearancePlaces,
}

/// Where the file has numbers of a joint with clearance; where it has none, the place of the clearance.
#[derive(Clone, Copy, Debug)]
pub struct ClearancePlaces {
    /// Of the contact modulus.
    pub modulus: Span,
    /// Of the coefficient of friction, of that at rest if there is one.
    pub friction: Span,
    /// Of the hardness.
    pub hardness: Span,
    /// Of the wear coefficient.
    pub coefficient: Span,
    /// Of the wear threshold.
    pub threshold: Span,
    /// Of the revolutions that a cycle stands for, of the table [wear] where these are not written.
    pub cycle: Span,
}

/// A place where the two sides of a joint with clearance touch.
#[derive(Clone, Debug)]
pub struct ContactPlace {
    /// Laws of this place; the name is that of the joint, of an end with `.end1` or `.end2` behind it.
    pub laws: ContactInfo,
    /// How far it lies along the joint's axis, from the point of the side that has it [m].
    pub along: f64,
}

/// What is behind a joint's name for the ends of its journal or bearing, against the axis and along it.
const ENDS: [(&str, f64); 2] = [("end1", -0.5), ("end2", 0.5)];

impl Joint {
    /// Where its two sides touch; nowhere in an ideal joint.
    pub fn contact_places(&self) -> Vec<ContactPlace> {
        let Some(clearance) = &self.clearance else { return Vec::new() };
        let laws = &clearance.laws;
        if self.model.tilt.is_none() {
            return vec![ContactPlace { laws: laws.clone(), along: 0.0 }];
        }
        let end = |(name, part): (&str, f64)| ContactPlace {
            laws: ContactInfo {
                joint: format!("{}.{name}", self.name).into(),
                length: 0.5 * laws.length,
                ..laws.clone()
            },
            along: part * laws.length,
        };
        ENDS.map(end).to_vec()
    }
}

/// A factor on a wear coefficient.
#[derive(Clone, Debug)]
pub struct WearFactor {
    /// The formula.
    pub formula: Formula,
    /// Tunable parameters and inputs that it reads.
    pub live: Vec<ParameterId>,
}

impl Mechanism {
    /// The joint that a contact belongs to, by the contact's name.
    pub fn joint_of_contact(&self, name: &str) -> Option<&Joint> {
        let named = |name: &str| self.joints.iter().find(|joint| joint.name == name);
        named(name).or_else(|| {
            let (joint, end) = name.rsplit_once('.')?;
            ENDS.iter().any(|(known, _)| *known == end).then(|| named(joint)).flatten()
        })
    }
}
