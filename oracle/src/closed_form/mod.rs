//! Closed forms from textbooks, for tests of single mechanisms.
//! In: lengths, times. Out: positions, speeds, accelerations. Never knows descriptions or the oracle.

mod elliptic;
mod four_bar;
mod n_four_bar;
mod pendulum;
mod slider_crank;

pub use elliptic::{arithmetic_geometric_mean, jacobi};
pub use four_bar::{FourBar, FourBarMotion};
pub use n_four_bar::NFourBar;
pub use pendulum::Pendulum;
pub use slider_crank::{SliderCrank, SliderMotion};

/// An angle [rad] or length [m] with its first two time derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Position.
    pub position: f64,
    /// Speed.
    pub speed: f64,
    /// Acceleration.
    pub acceleration: f64,
}
