//! Small dense linear algebra on preallocated storage. In: row-major matrices as slices. Out: solutions
//! in slices of the caller. Never allocates after construction, never knows mechanisms.
//!
//! Order of summation is fixed, so results have the same bits on every machine.

mod cholesky;
mod lu;
mod orthogonal;
mod vector;

pub use cholesky::Cholesky;
pub use lu::Lu;
pub use orthogonal::Orthogonal;
pub use vector::{add_scaled, combine, dot, is_finite, largest, largest_of, same_bits};
