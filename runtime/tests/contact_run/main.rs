//! Runs of joints with clearance: impacts, balance of energy, wear integrals and their order, located onsets,
//! turns, default start.

#[path = "../common/mod.rs"]
mod common;

mod by_angle;
mod coefficient;
mod impacts;
mod journals;
mod loops;
mod refusals;
mod turn_by_turn;
mod wear_integral;
