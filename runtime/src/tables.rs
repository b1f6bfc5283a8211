//! What generated code says about its mechanism, as plain statics. Out: [`Tables`], laws of contact and wear.
//! Never knows equations or numbers of a run.

use crate::contact::{Onset, Restitution, Stiffness, Strength};
use crate::text::Text;
use crate::wear::{Area, Measure, Step};

/// What an input is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputRole {
    /// A signal that the file names.
    Value,
    /// The rate in time of the input before it, which a drive follows.
    RateOfPrevious,
}

/// How one group of coordinates moves with its speeds. In tree order, driven ones included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// One coordinate, one speed: `q̇ = v`. Holds the driver's index if it is driven.
    Scalar {
        /// Index of the driver that prescribes it.
        driver: Option<usize>,
    },
    /// Unit quaternion (scalar first) of the body's frame in W; speed: absolute angular velocity in
    /// the body's own frame. 4 coordinates, 3 speeds.
    Rotation,
    /// Quaternion as in `Rotation`, then the position of the frame's origin in W; speeds: absolute
    /// angular velocity, then absolute velocity of the origin, both in the body's own frame.
    /// 7 coordinates, 6 speeds.
    Pose,
}

/// A joint with clearance: what the laws of contact, friction and wear need. SI.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactInfo {
    /// The joint.
    pub joint: Text,
    /// A ball in a socket; else a journal in a bearing, free in the two directions across its axis.
    pub ball: bool,
    /// Radius of the journal or ball [m].
    pub journal_radius: f64,
    /// Length of the bearing [m]; for a ball the socket's diameter.
    pub length: f64,
    /// Elastic modulus E* of the pair [Pa].
    pub modulus: f64,
    /// Stiffness of the contact.
    pub stiffness: Stiffness,
    /// Law of restitution.
    pub law: Restitution,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Exponent of penetration in the normal force.
    pub exponent: f64,
    /// Least impact speed that damping is related to [m/s].
    pub impact_speed_floor: f64,
    /// Friction: strength, onset, slope over sliding speed [s/m]; nothing without friction.
    pub friction: Option<(Strength, Onset, f64)>,
    /// Wear; nothing if the joint does not wear.
    pub wear: Option<WearInfo>,
}

impl ContactInfo {
    /// The same with so many times the friction and the wear coefficient.
    pub fn scaled(mut self, friction: f64, wear: f64) -> Self {
        if let Some((strength, _, slope)) = &mut self.friction {
            (*strength, *slope) = (strength.scaled(friction), friction * *slope);
        }
        if let Some(law) = &mut self.wear {
            law.coefficient *= wear;
        }
        self
    }
}

/// How a joint wears, and when it has failed. SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WearInfo {
    /// Dimensionless wear coefficient k of Archard's law.
    pub coefficient: f64,
    /// Hardness of the softer side [Pa].
    pub hardness: f64,
    /// Model of the contact area.
    pub area: Area,
    /// What of the depth by bearing angle counts as wear W; if nothing, W is the depth by the model of the area (with
    /// `profile`, the mean).
    pub measure: Option<Measure>,
    /// Growth of the clearance per wear, gamma of `c + gamma dW`.
    pub feedback: f64,
    /// Feeds the worn profile back to the local gap, instead of the scalar clearance.
    pub profile: bool,
    /// Bearing angles of the profile.
    pub bins: usize,
    /// Wear at which the joint has failed, `W_crit` [m].
    pub threshold: f64,
    /// Revolutions that one cycle of the life stands for.
    pub revolutions_per_cycle: f64,
    /// Limit of mean pressure times sliding speed [Pa m/s], if one is known.
    pub pressure_speed: Option<f64>,
    /// Scatter of the wear increments; if nothing, only the mean is known.
    pub scatter: Option<GammaRates>,
    /// The same by the coefficient of variation of what the first cycle wears, instead of `scatter`: alpha and beta are what gives
    /// it.
    pub cycle_variation: Option<f64>,
}

impl WearInfo {
    /// Whether wear is kept by bearing angle.
    pub fn keeps_profile(&self) -> bool {
        self.profile || self.measure.is_some()
    }
}

/// How the journal of a joint wears beside its bush, which [`WearInfo`] is about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JournalWear {
    /// Index of the joint among those with clearance.
    pub contact: usize,
    /// Volume that the journal loses over that of the bush by the same work of friction: (k/H of the journal)/(k/H of the
    /// bush).
    pub ratio: f64,
}

/// A factor on the wear coefficient of a joint: its index among those with clearance, the steps of
/// [`factor`](crate::wear::factor).
pub type CoefficientRow = (usize, &'static [Step]);

/// The Gamma process of wear, [CS (21)]: dW ~ Gamma(shape alpha dLambda, rate beta). W and Lambda in metres here.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GammaRates {
    /// Shape per mean wear [1/m].
    pub alpha: f64,
    /// Rate [1/m].
    pub beta: f64,
}

/// A segment of a duty cycle: name, share of the operating time or duration [s], parameters that differ by index and value,
/// factors on friction and wear of every joint with clearance.
pub type SegmentRow = (&'static str, f64, &'static [(usize, f64)], &'static [(f64, f64)]);

/// A duty cycle: name, whether its amounts are durations in order, its segments, those in half as many bins.
pub type MissionRow = (&'static str, bool, &'static [SegmentRow], &'static [SegmentRow]);

/// How the names of columns begin that have the time from sample to sample [s] of a controller. Behind each stand columns of what
/// the controller holds from its next sample on: `<name>` with `.next`, held by the speed `<name>` with `.value`.
pub const SAMPLE: &str = "t.sample";

/// All that generated code says about itself: its tables, and those that few mechanisms have.
#[derive(Clone, Copy, Debug)]
pub struct AllTables {
    /// Names, units, rows, columns, laws of contact.
    pub tables: &'static Tables,
    /// Journals that wear beside their bushes.
    pub journals: &'static [JournalWear],
    /// Factors on wear coefficients.
    pub coefficients: &'static [CoefficientRow],
    /// Which of the contacts are rods in bushes along which they may slide and in which they may lean, by index.
    pub guides: &'static [usize],
}

/// A consistent start, as generated code has it where it was asked for: found when the code was generated, with the values of the
/// file, for programs that cannot assemble.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Coordinates and speeds at t = 0.
    pub state: &'static [f64],
    /// Natural size of the motion along every speed: small where it moves a journal in its bearing.
    pub sizes: &'static [f64],
}

/// What generated code says about itself, as plain tables: names, units and flags a row for each. With the
/// feature `std`, `description()` of generated code makes a `Description` of them.
#[derive(Clone, Copy, Debug)]
pub struct Tables {
    /// Name of the mechanism.
    pub name: &'static str,
    /// Tunable parameters, then inputs: name, SI unit, value in the file.
    pub parameters: &'static [(&'static str, &'static str, f64)],
    /// Of the last so many parameters, what they are. They may change with time.
    pub inputs: &'static [InputRole],
    /// Free coordinates: name, unit, held.
    pub coordinates: &'static [(&'static str, &'static str, bool)],
    /// Free speeds: name, unit, held.
    pub speeds: &'static [(&'static str, &'static str, bool)],
    /// Every group of coordinates, driven ones included: the layout of [`crate::Entry::EquationsOfMotion`].
    pub motions: &'static [Motion],
    /// First index, within the free coordinates, of every unit quaternion (4 long, scalar first).
    pub quaternions: &'static [usize],
    /// Constraint rows: joint, meaning, whether the residual is an angle, index among the kept rows.
    pub rows: &'static [(&'static str, &'static str, bool, Option<usize>)],
    /// Drivers: joint, whether it is an angle [rad, N m] or a length [m, N].
    pub drivers: &'static [(&'static str, bool)],
    /// Output columns: name, SI unit, whether it is an angle that jumps by 2 pi.
    pub channels: &'static [(&'static str, &'static str, bool)],
    /// Index of the first driver on a revolute joint: 2 pi of it is a turn.
    pub turn_driver: Option<usize>,
    /// Joints with clearance, in the order of [`crate::Entry::Contacts`].
    pub contacts: &'static [ContactInfo],
    /// Duty cycles.
    pub missions: &'static [MissionRow],
}
