//! The file as written: places kept, names unresolved, quantities still text.
//! In: a [`crate::source::SourceFile`]. Out: [`Spec`]. Never knows mechanics or ids.

mod dimension;
mod failure;
mod file;
mod forms;
mod parse;
mod read;
mod repeat;
mod schema;
mod syntax;
mod unit;
mod written;

pub use dimension::Dimension;
pub use file::{
    BodySpec, ByCoordinate, Centre, ClearanceSpec, ClosureSpec, EachCoordinate, File, FlexibleSpec,
    ForceSpec, HeldSpec, JointSpec, Parameter, Places, PointMassSpec, PointSpec, RepeatSpec, SectionSpec,
    SpringPart, SpringSpec, StartSpec, StartTable, StepSpec, TheorySpec, WearSpec, Widths,
};
pub use parse::{Spec, parse};
pub use repeat::{expand, group_spans};
pub use schema::json_schema;
pub use syntax::{Expression, Form, Operator, SyntaxError, parse_expression};
pub use written::{At, Literal, Name, Pair, PerBody, Quantity, Table, Triple};
