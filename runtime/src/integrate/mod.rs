//! Integrators, one method per file. In: a [`Problem`]. Out: states. Allocate only when made.
//! Explicit methods never know mechanisms; the implicit one asks for their equations of motion.

mod adaptive;
mod dense;
mod dopri5;
mod expected;
mod generalized_alpha;
mod problem;
mod rk4;
mod rk43;
mod rodas5p;
mod stage_system;
mod step_control;
mod switching;

pub(crate) use adaptive::relative_error;
pub use adaptive::{Adaptive, Method};
pub use dopri5::Dopri5;
pub use generalized_alpha::GeneralizedAlpha;
pub use problem::{Beside, Problem, Stepped};
pub use rk4::Rk4;
pub use rk43::Rk43;
pub(crate) use rk43::{error_of, growth_of};
pub use rodas5p::Rodas5P;
pub(crate) use step_control::floored;
pub use switching::Switching;
