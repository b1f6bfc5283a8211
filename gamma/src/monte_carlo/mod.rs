//! Lives whose drawn wear changes what wears next, by Monte Carlo. In: a fine scale, settings of the coarse scale,
//! rates of the Gamma process. Out: lives of trajectories. Never knows equations, files or terminals.

mod draw;
mod side_by_side;
mod trajectories;

pub use draw::{GammaDraw, GammaMean, MICRO, PER_METRE};
pub use side_by_side::Heard;
pub use trajectories::{Ended, Keep, Lives, MonteCarlo, Scale};
