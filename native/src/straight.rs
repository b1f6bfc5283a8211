//! Straight-line code, as far as it is the same for every processor: a tape's operations as a graph, their order, the
//! place of every value. In: tapes, a [`Processor`](allocate::Processor). Out: [`Written`](write::Written), machine code
//! and what it wants beside it.

pub(crate) mod allocate;
pub(crate) mod bounds;
mod extremes;
mod frame;
pub(crate) mod fuse;
pub(crate) mod graph;
pub(crate) mod lower;
mod number;
#[cfg(target_arch = "x86_64")]
mod operands;
mod order;
pub(crate) mod place;
mod pool;
mod sines;
#[cfg(test)]
pub(crate) mod tests;
mod uses;
pub(crate) mod write;
