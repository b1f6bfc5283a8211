//! Small dense linear algebra on preallocated storage. In: row-major matrices as slices. Out: solutions
//! in slices of the caller. Never allocates after construction, never knows mechanisms.
//!
//! Order of summation is fixed, so results have the same bits on every machine.

#[cfg(feature = "std")]
mod cholesky;
mod gram;
#[cfg(feature = "std")]
mod lu;
#[cfg(feature = "std")]
mod orthogonal;
mod vector;

#[cfg(feature = "std")]
pub use cholesky::Cholesky;
pub use gram::{factor_gram, solve_gram};
#[cfg(feature = "std")]
pub use lu::Lu;
#[cfg(feature = "std")]
pub use orthogonal::Orthogonal;
pub use vector::{add_scaled, combine, dot, is_finite, largest, largest_of, replace};
