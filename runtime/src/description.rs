//! What a mechanism tells about itself: names, units, rows, channels. Made of the generator's tables.
//! Out: [`Description`]. Never knows equations or numbers of a run.
//! Lists are static in generated code and owned by the interpreter.

use std::borrow::Cow;
use std::sync::OnceLock;

use crate::manifold::groups;
use crate::mission::{MissionInfo, SegmentInfo};
pub use crate::tables::SAMPLE;
use crate::tables::{AllTables, CoefficientRow, ContactInfo, InputRole, JournalWear, Motion, Tables};
use crate::text::Text;
use crate::wear::Step;

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

/// How the names of columns begin whose signs say which pieces of formulas hold. `t` is no name that an element can have.
pub const SWITCH: &str = "t.switch";

/// How the names of columns begin, behind those of [`SWITCH`], that have how many rows the argument of a table has passed, with
/// the part of the way to the next: another piece of the table holds behind every whole number.
pub const ROW: &str = "t.row";

/// How the name of a column ends that has what is held next.
pub const NEXT: &str = ".next";
/// How the name of a speed ends that is no speed but a value.
pub const VALUE: &str = ".value";

/// How names of modal coordinates of a flexible body go on behind that of the body; their numbers follow, from 1.
pub const MODE: &str = ".eta";

/// A factor on the wear coefficient of a joint, by the state of its contact.
#[derive(Clone, Debug, PartialEq)]
pub struct CoefficientFactor {
    /// Index of the joint among those with clearance.
    pub contact: usize,
    /// How it is computed: of pressure, sliding speed, then as many parameters and inputs as
    /// [`MOST_LIVE`](crate::wear::MOST_LIVE), which the motion of the journal has in places that it leaves empty.
    pub steps: List<Step>,
}

/// How far the places of a flexible body move in its floating frame, where that is linear in its modal coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct BendInfo {
    /// The body.
    pub body: Text,
    /// Its length, by which its deflections are judged [m].
    pub length: f64,
    /// First of its modal coordinates among the free ones.
    pub first: usize,
    /// How many there are.
    pub modes: usize,
    /// Displacement in x, y, z per unit of each modal coordinate [m], mode by mode at one place after the other.
    pub shapes: List<f64>,
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
    /// Journals that wear too.
    pub journals: List<JournalWear>,
    /// Wear coefficients that depend on the state of the contact.
    pub coefficients: List<CoefficientFactor>,
    /// Which of the contacts are rods in bushes along which they may slide and in which they may lean, by index.
    pub guides: List<usize>,
    /// Duty cycles, in the order of the file.
    pub missions: List<MissionInfo>,
    /// Flexible bodies whose deflections runs look at. Tables of generated code have none.
    pub bends: List<BendInfo>,
}

/// Whether a coordinate has the name of a modal one.
fn is_modal(name: &str) -> bool {
    let number = name.rsplit_once(MODE).map(|(_, number)| number);
    number.is_some_and(|number| !number.is_empty() && number.bytes().all(|digit| digit.is_ascii_digit()))
}

impl Description {
    /// Worn volume of a journal over that of its bush, by its index among the joints with clearance; nothing if it does not
    /// wear.
    pub fn journal_ratio(&self, contact: usize) -> Option<f64> {
        self.journals.iter().find(|journal| journal.contact == contact).map(|journal| journal.ratio)
    }

    /// How many of the parameters are tunable ones; the others, behind them, are inputs.
    pub fn tunable(&self) -> usize {
        self.parameters.len().saturating_sub(self.inputs.len())
    }

    /// The inputs: name, SI unit and default of each, and what it is.
    pub fn input_infos(&self) -> impl Iterator<Item = (&ParameterInfo, InputRole)> {
        self.parameters[self.tunable()..].iter().zip(self.inputs.iter().copied())
    }

    /// Of every kept row, its row among all; fewer than `count` where the description misses one.
    pub fn kept_rows(&self, count: usize) -> Vec<usize> {
        (0..count).filter_map(|kept| self.rows.iter().position(|row| row.kept == Some(kept))).collect()
    }

    /// Whether a joint feeds back by angle what is worn off it.
    pub fn feeds_profiles_back(&self) -> bool {
        self.contacts.iter().any(|contact| contact.wear.is_some_and(|wear| wear.profile))
    }

    /// Modal coordinates of flexible bodies: places of coordinate and speed among the free ones.
    pub(crate) fn modes(&self) -> impl Iterator<Item = (usize, usize)> {
        let scalars = groups(&self.motions).filter(|group| group.motion == Motion::Scalar { driver: None });
        let places = scalars.map(|group| (group.coordinate, group.speed));
        places.filter(|(coordinate, _)| is_modal(&self.coordinates[*coordinate].name))
    }

    /// Of every free speed, whether it is one of turning.
    pub(crate) fn turning_speeds(&self) -> Vec<bool> {
        self.speeds.iter().map(|speed| speed.unit.starts_with("rad")).collect()
    }

    /// The columns that say which pieces of formulas hold: by their signs those of conditions, by their values those of rows.
    pub(crate) fn pieces(&self) -> [std::ops::Range<usize>; 2] {
        [SWITCH, ROW].map(|prefix| {
            let is_one = |channel: &Channel| channel.name.starts_with(prefix);
            let first = self.channels.iter().position(is_one).unwrap_or(self.channels.len());
            let count = self.channels[first..].iter().take_while(|channel| is_one(channel)).count();
            first..first + count
        })
    }

    /// Whether controllers act at sampled times: whoever takes steps must know of them.
    pub fn acts_at_samples(&self) -> bool {
        self.channels.iter().any(|channel| channel.name.starts_with(SAMPLE))
    }

    /// Controllers that act at sampled times: the column of their sample time; columns of what they hold next, and the speeds
    /// that hold it.
    pub(crate) fn samplers(&self) -> Vec<(usize, Vec<(usize, usize)>)> {
        let samples = |channel: &Channel| channel.name.starts_with(SAMPLE);
        let all = self.channels.iter().enumerate().filter(|(_, channel)| samples(channel));
        let speed =
            |stem: &str| self.speeds.iter().position(|speed| speed.name.strip_suffix(VALUE) == Some(stem));
        let held = |from: usize| {
            let next = self.channels[from + 1..].iter().map_while(|channel| channel.name.strip_suffix(NEXT));
            (from + 1..).zip(next).filter_map(|(column, stem)| Some((column, speed(stem)?))).collect()
        };
        all.map(|(column, _)| (column, held(column))).collect()
    }

    /// That of the mechanism in a segment of a mission: its laws of friction and wear.
    pub fn in_segment(&self, segment: &SegmentInfo) -> Self {
        let mut own = self.clone();
        for (contact, (friction, wear)) in own.contacts.to_mut().iter_mut().zip(&segment.factors) {
            *contact = contact.clone().scaled(*friction, *wear);
        }
        own
    }

    /// The description that the tables of generated code stand for.
    pub fn from_tables(tables: &Tables) -> Self {
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
            name: tables.name.into(),
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
            journals: List::Borrowed(&[]),
            coefficients: List::Borrowed(&[]),
            guides: List::Borrowed(&[]),
            missions: tables.missions.iter().map(MissionInfo::from_row).collect(),
            bends: List::Borrowed(&[]),
        }
    }
}

/// The description of a mechanism in generated code, made of its tables when it is first asked for.
#[derive(Debug)]
pub struct TabledDescription {
    all: &'static AllTables,
    made: OnceLock<Description>,
}

impl TabledDescription {
    /// Of these tables.
    pub const fn of(all: &'static AllTables) -> Self {
        Self { all, made: OnceLock::new() }
    }

    /// The description.
    pub fn get(&self) -> &Description {
        let factor = |&(contact, steps): &CoefficientRow| CoefficientFactor { contact, steps: steps.into() };
        self.made.get_or_init(|| Description {
            journals: self.all.journals.into(),
            coefficients: self.all.coefficients.iter().map(factor).collect(),
            guides: self.all.guides.into(),
            ..Description::from_tables(self.all.tables)
        })
    }
}
