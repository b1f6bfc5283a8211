//! What a mechanism tells about itself: names, units, rows, channels. Written by the generator.
//! Out: [`Description`]. Never knows equations or numbers of a run.
//! Strings are `Cow` so that generated code can keep them in statics and the interpreter can own them.

use std::borrow::Cow;

use crate::contact::{Onset, Restitution, Stiffness, Strength};
use crate::wear::{Area, Measure};

/// Text that is static in generated code and owned elsewhere.
pub type Text = Cow<'static, str>;
/// A list that is static in generated code and owned elsewhere.
pub type List<T> = Cow<'static, [T]>;

/// A tunable parameter or an input, in the order of the input slice.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterInfo {
    /// Name in the file.
    pub name: Text,
    /// SI unit, "1" if it has none.
    pub unit: Text,
    /// Value in the file, in SI.
    pub default: f64,
}

/// What an input is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputRole {
    /// A signal that the file names.
    Value,
    /// The rate in time of the input before it, which a drive follows.
    RateOfPrevious,
}

/// One scalar of the free coordinates or speeds, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct VariableInfo {
    /// Column-like name, e.g. `R4.q`, `S2.q0`, `coupler.eta1`.
    pub name: Text,
    /// SI unit.
    pub unit: Text,
    /// Whether a start value was demanded in the file and must be met exactly (else it is a guess).
    pub held: bool,
}

/// One constraint row before redundant ones are dropped.
#[derive(Clone, Debug, PartialEq)]
pub struct RowInfo {
    /// The cut joint it belongs to.
    pub joint: Text,
    /// What it forbids, e.g. "translation along x of coupler".
    pub meaning: Text,
    /// True: residual in rad; false: residual in m.
    pub angular: bool,
    /// Index among the kept rows, or `None` if dropped as redundant.
    pub kept: Option<usize>,
}

/// A driver, in the order of the drive forces.
#[derive(Clone, Debug, PartialEq)]
pub struct DriverInfo {
    /// Joint that is driven.
    pub joint: Text,
    /// True for an angle [rad, N m], false for a length [m, N].
    pub angular: bool,
}

/// An output column of [`crate::Entry::Observe`].
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// `<element>.<quantity>`, e.g. `R1.Fx`.
    pub name: Text,
    /// SI unit as printed in brackets, e.g. `N m`.
    pub unit: Text,
    /// True for an angle recomputed with atan2: it jumps by 2 pi and recorders unwrap it, by its rate in the next column.
    pub wraps: bool,
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

/// Everything a program needs to run, record and explain a mechanism.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// Name of the mechanism.
    pub name: Text,
    /// Tunable parameters, then inputs with their defaults.
    pub parameters: List<ParameterInfo>,
    /// Inputs: of the last so many parameters, what they are. They may change with time.
    pub inputs: List<InputRole>,
    /// Free coordinates.
    pub coordinates: List<VariableInfo>,
    /// Free speeds.
    pub speeds: List<VariableInfo>,
    /// Every group of coordinates, driven ones included: the layout of [`crate::Entry::EquationsOfMotion`].
    pub motions: List<Motion>,
    /// First index, within the free coordinates, of every unit quaternion (4 long, scalar first).
    pub quaternions: List<usize>,
    /// Constraint rows, kept and dropped.
    pub rows: List<RowInfo>,
    /// Drivers.
    pub drivers: List<DriverInfo>,
    /// Output columns.
    pub channels: List<Channel>,
    /// Index of the first driver on a revolute joint: 2 pi of it is a turn.
    pub turn_driver: Option<usize>,
    /// Joints with clearance, in the order of [`crate::Entry::Contacts`].
    pub contacts: List<ContactInfo>,
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
}

impl WearInfo {
    /// Whether wear is kept by bearing angle.
    pub fn keeps_profile(&self) -> bool {
        self.profile || self.measure.is_some()
    }
}

/// The Gamma process of wear, [CS (21)]: dW ~ Gamma(shape alpha dLambda, rate beta). W and Lambda in metres here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GammaRates {
    /// Shape per mean wear [1/m].
    pub alpha: f64,
    /// Rate [1/m].
    pub beta: f64,
}

/// What generated code says about itself, as plain tables: names, units and flags in the order of the fields of
/// [`ParameterInfo`], [`VariableInfo`], [`RowInfo`], [`DriverInfo`] and [`Channel`].
#[derive(Clone, Copy, Debug)]
pub struct Tables {
    /// Name, unit, default.
    pub parameters: &'static [(&'static str, &'static str, f64)],
    /// See [`Description::inputs`].
    pub inputs: &'static [InputRole],
    /// Name, unit, held.
    pub coordinates: &'static [(&'static str, &'static str, bool)],
    /// Name, unit, held.
    pub speeds: &'static [(&'static str, &'static str, bool)],
    /// Groups of coordinates.
    pub motions: &'static [Motion],
    /// First coordinate of every quaternion.
    pub quaternions: &'static [usize],
    /// Joint, meaning, angular, kept.
    pub rows: &'static [(&'static str, &'static str, bool, Option<usize>)],
    /// Joint, angular.
    pub drivers: &'static [(&'static str, bool)],
    /// Name, unit, wraps.
    pub channels: &'static [(&'static str, &'static str, bool)],
    /// See [`Description::turn_driver`].
    pub turn_driver: Option<usize>,
    /// See [`Description::contacts`].
    pub contacts: &'static [ContactInfo],
}

impl Description {
    /// How many of the parameters are tunable ones; the others, behind them, are inputs.
    pub fn tunable(&self) -> usize {
        self.parameters.len().saturating_sub(self.inputs.len())
    }

    /// The inputs: name, SI unit and default of each, and what it is.
    pub fn input_infos(&self) -> impl Iterator<Item = (&ParameterInfo, InputRole)> {
        self.parameters[self.tunable()..].iter().zip(self.inputs.iter().copied())
    }

    /// Of every kept row, its row among all; fewer than `count` where the description misses one.
    pub(crate) fn kept_rows(&self, count: usize) -> Vec<usize> {
        (0..count).filter_map(|kept| self.rows.iter().position(|row| row.kept == Some(kept))).collect()
    }

    /// The description that the tables of generated code stand for.
    pub fn from_tables(name: &'static str, tables: Tables) -> Self {
        let variable = |&(name, unit, held): &(&'static str, &'static str, bool)| VariableInfo {
            name: name.into(),
            unit: unit.into(),
            held,
        };
        let parameter = |&(name, unit, default): &(&'static str, &'static str, f64)| ParameterInfo {
            name: name.into(),
            unit: unit.into(),
            default,
        };
        let row = |&(joint, meaning, angular, kept): &(&'static str, &'static str, bool, Option<usize>)| {
            RowInfo { joint: joint.into(), meaning: meaning.into(), angular, kept }
        };
        let driver = |&(joint, angular): &(&'static str, bool)| DriverInfo { joint: joint.into(), angular };
        let channel = |&(name, unit, wraps): &(&'static str, &'static str, bool)| Channel {
            name: name.into(),
            unit: unit.into(),
            wraps,
        };
        Self {
            name: name.into(),
            parameters: tables.parameters.iter().map(parameter).collect(),
            inputs: tables.inputs.into(),
            coordinates: tables.coordinates.iter().map(variable).collect(),
            speeds: tables.speeds.iter().map(variable).collect(),
            motions: tables.motions.into(),
            quaternions: tables.quaternions.into(),
            rows: tables.rows.iter().map(row).collect(),
            drivers: tables.drivers.iter().map(driver).collect(),
            channels: tables.channels.iter().map(channel).collect(),
            turn_driver: tables.turn_driver,
            contacts: tables.contacts.into(),
        }
    }
}
