//! Lives over analytic fine scales, whose wear per revolution is a formula of the clearance.

mod analytic;
mod by_profile;
mod stops;
mod tables;
mod trajectories;
