//! What a simulation tells of contacts.

/// A contact that closed or opened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactEvent {
    /// Time [s]; of an opening the end of the step in which it opened.
    pub t: f64,
    /// Index of the joint with clearance.
    pub joint: usize,
    /// Whether it touches from here on.
    pub closes: bool,
}
