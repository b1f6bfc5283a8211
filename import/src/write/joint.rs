//! A joint of a robot and what it is called in a mechanism file.

use super::super::robot::Joint;

/// A joint that is written.
pub struct Written<'a> {
    pub joint: &'a Joint,
    /// Its number in the robot.
    pub number: usize,
    pub name: String,
    /// Name of its point.
    pub at: String,
}
