//! What tests of every processor stand on.

pub(crate) mod random_tape;
