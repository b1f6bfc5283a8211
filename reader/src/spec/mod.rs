//! The file as written: places kept, names unresolved, quantities still text.
//! In: a [`crate::source::SourceFile`]. Out: [`Spec`]. Never knows mechanics or ids.

mod body;
mod compose;
mod controller;
mod coupling;
mod dimension;
mod doc;
mod drawn;
mod failure;
mod file;
mod force;
mod include;
mod joint;
mod mission;
mod not_toml;
mod parse;
mod placed;
mod point;
mod read;
mod repeat;
mod rockwell;
#[cfg(test)]
mod schema;
mod scope;
mod sensor;
mod start;
mod state;
mod stop;
mod syntax;
mod table;
mod texts;
mod told;
mod turning;
mod unit;
mod word;
mod words;
mod written;

pub use body::{
    BodySpec, Centre, FlexibleSpec, HeldSpec, PointMassSpec, SectionSpec, StepSpec, TheorySpec, Widths,
};
pub use compose::{Composed, composed};
pub use controller::{ControllerSpec, ControllerStateSpec};
pub use coupling::{COMPLIANCE_KEYS, COUPLING_KINDS, CouplingKind, CouplingSpec, Hand, NamedBodies};
pub use dimension::Dimension;
pub use drawn::Drawn;
pub use failure::unknown_key;
pub use file::{
    CellValues, CheckSpec, ClearanceSpec, Closure, Ends, File, Input, InputTable, Parameter, ParameterTable,
    RepeatSpec, WearSpec,
};
pub use force::{
    Bodies, ByAxis, ELASTIC, FORCE_KINDS, ForceKind, ForceSpec, ForceValue, Need, Places, SixNumbers, Written,
};
pub use include::{IncludeSpec, RotationSpec};
pub use joint::{ByCoordinate, DryFrictionSpec, EachCoordinate, JointSpec, SpringPart, SpringSpec};
pub use mission::{MissionSpec, SegmentJointSpec, SegmentSpec};
pub use parse::{Spec, parse};
pub use point::{POINT_KEYS, PointSpec};
pub use repeat::{expand, group_spans};
pub use sensor::{Sensor, SensorTable};
pub use start::{StartSpec, StartTable};
pub use state::StateSpec;
pub use stop::StopSpec;
pub use syntax::{
    Expression, Form, Operator, Relation, SyntaxError, UnitSize, as_written, parse_expression, unit_size,
};
pub use table::{Interpolation, Outside, TableSpec};
pub use told::Told;
pub use turning::Turning;
pub use word::Word;
pub use written::{At, Literal, Name, Pair, PerBody, Quantity, Table, Triple};
