//! What tests of every processor stand on.

pub(crate) mod calls;
pub(crate) mod random_tape;
