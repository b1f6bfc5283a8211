//! temp
mod data;
pub use data::{ModalData, Mode, Node, SecondOrder};
