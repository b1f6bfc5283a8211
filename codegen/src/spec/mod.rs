//! The file as written.
mod dimension;
pub use dimension::Dimension;
