//! Small dense linear algebra on preallocated storage. In: row-major matrices as slices. Out: solutions
//! in slices of the caller. Never knows mechanisms. Matrices that are mostly zeros, as Jacobians of long mechanisms, allocate as they
//! are reduced; all else never does after construction.
//!
//! Order of summation is fixed, so results have the same bits on every machine.

#[cfg(feature = "std")]
mod cholesky;
#[cfg(feature = "std")]
mod entries;
mod gram;
#[cfg(feature = "std")]
mod lu;
#[cfg(feature = "std")]
mod orthogonal;
#[cfg(feature = "std")]
mod shortest;
#[cfg(feature = "std")]
mod sparse_qr;
mod vector;

#[cfg(feature = "std")]
pub use cholesky::Cholesky;
#[cfg(feature = "std")]
pub use entries::{Entries, add_products, entries_of, largest_entry, length, subtract};
pub use gram::{factor_gram, solve_gram};
#[cfg(feature = "std")]
pub use lu::Lu;
#[cfg(feature = "std")]
pub use orthogonal::Orthogonal;
#[cfg(feature = "std")]
pub use shortest::Shortest;
#[cfg(feature = "std")]
pub use sparse_qr::SparseQr;
pub use vector::{add_scaled, combine, dot, is_finite, largest, largest_of, replace, same_bits};
