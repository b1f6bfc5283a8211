//! Which of a mechanism's missions a life is used for. Never knows what they are.

/// The mission that a life is used for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum MissionChoice {
    /// The only one of the mechanism, if it has one.
    #[default]
    Only,
    /// None, whatever the mechanism has: its own parameters all the time.
    None,
    /// The one of this name.
    Named(String),
}
