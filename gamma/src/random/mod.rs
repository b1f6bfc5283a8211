//! Random numbers whose bits depend on where they are used and on nothing else: a generator of `rand`, and the
//! distributions whose draws must be the same on every machine. Never knows what is drawn.
//!
//! `rand_distr` draws normal, Gamma and inverse Gaussian numbers by way of the platform's math library wherever another
//! crate asks `num-traits` for `std`. The draws here use `libm` alone; `rand_distr` is the oracle of their tests.

mod ln_gamma;
mod normal;
mod stream;

pub use ln_gamma::LnGamma;
pub use normal::StandardNormal;
pub use stream::Stream;
