//! Random numbers whose bits depend on where they are used and on nothing else: a generator of `rand`, and the
//! distributions whose draws must be the same on every machine. Never knows what is drawn.
//!
//! `rand_distr` draws normal, Gamma and inverse Gaussian numbers by way of the platform's math library wherever another
//! crate asks `num-traits` for `std`. The draws here use `libm` alone; `rand_distr` is the oracle of their tests.

mod blocks;
mod elementary;
mod lanes;
mod ln_gamma;
mod normal;
mod stream;
mod width;

pub(crate) use lanes::gamma_draws;
pub use ln_gamma::LnGamma;
pub use normal::StandardNormal;
pub use stream::Stream;
