//! A consistent start: coordinates that close every loop, speeds that keep them closed.
//! In: a mechanism, parameters, a time. Out: [`State`], or an [`AssemblyError`] that names what is in the
//! way. Never integrates. May allocate: it runs once.
//!
//! Positions by Gauss-Newton with minimum-norm steps from the guess, so that the position reached is near
//! it and the branch is the guess's; speeds by one minimum-norm solve from the wish.

mod consistent;
mod half_turns;
mod held;
mod newton;
mod offset;
mod placing;
mod reactions;
mod sliding;
mod speeds;
mod state;
mod static_contact;
mod units;
mod within_clearance;

pub use consistent::{assemble, assemble_with, close_loops};
pub use offset::{motion_sizes, offset_columns, rows_of_free_offsets};
pub use placing::place;
pub(crate) use placing::place_moving;
pub use state::State;
pub use static_contact::{assemble_static_contact, check_clearances, resting_contacts};
pub(crate) use static_contact::{assemble_under_way, rest_under_way};
