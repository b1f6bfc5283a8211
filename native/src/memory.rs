//! Where code is put and called, and what it calls. Both sides of this border, and they alone, have `unsafe`.

pub(crate) mod called;
pub(crate) mod code;
