//! What tests of every processor stand on.

pub(crate) mod calls;
#[cfg(target_arch = "x86_64")]
pub(crate) mod extremes;
pub(crate) mod random_tape;
