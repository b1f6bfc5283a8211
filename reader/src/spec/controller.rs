//! Controllers as written: `[controllers.<name>]`.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::doc::Doc;
use super::texts::{tables, texts_of};
use super::written::{Quantity, Table};

tables! {
    /// A controller: PID with limits, or a law of its own at sampled times. Its name stands for what it puts out.
    #[cfg_attr(test, schemars(extend("anyOf" = [
        { "required": ["output", "sample_time"] },
        {
            "required": ["measured", "setpoint"],
            "anyOf": [
                { "required": ["proportional"] }, { "required": ["integral"] }, { "required": ["derivative"] }
            ]
        }
    ])))]
    pub struct ControllerSpec {
        /// What is controlled, over all that a force may depend on, sensors and the controllers above it included.
        /// [any unit; required but for `output`; e.g. "shaft.v"]
        pub measured: Option<Quantity>,
        /// What it should be: a formula, a table, an input.
        /// [unit of `measured`; required but for `output`; e.g. "12 rad/s"]
        pub setpoint: Option<Quantity>,
        /// Gain on the error: output over error.
        /// [any unit; over parameters; one of the three gains is required; e.g. "0.8 N m s"]
        pub proportional: Option<Quantity>,
        /// Gain on the integral of the error: output over error and time.
        /// [unit of the output over error and time; over parameters; default none; e.g. "6 N m"]
        pub integral: Option<Quantity>,
        /// Gain on the rate of the error: output times time over error.
        /// [unit of the output times time over error; over parameters; default none; e.g. "20 N m s^2"]
        pub derivative: Option<Quantity>,
        /// Time constant of the lag that the rate of the error is taken behind.
        /// [s; above 0, with `sample_time` from 0; required with `derivative` without `sample_time`; e.g. "2 ms"]
        pub derivative_filter: Option<Quantity>,
        /// Part of the setpoint that the proportional gain sees.
        /// [1; over parameters; default 1; e.g. 0.5]
        pub setpoint_weight: Option<Quantity>,
        /// Part of the setpoint that the derivative gain sees; 0 lets steps of the setpoint pass without a kick.
        /// [1; over parameters; default 0; e.g. 1]
        pub derivative_weight: Option<Quantity>,
        /// Added before the limits, over all that a force may depend on.
        /// [unit of the output; default 0; e.g. "gravity_torque"]
        pub feedforward: Option<Quantity>,
        /// Least output.
        /// [unit of the output; below `upper`; default none; e.g. "-3 N m"]
        pub lower: Option<Quantity>,
        /// Largest output.
        /// [unit of the output; above `lower`; default none; e.g. "3 N m"]
        pub upper: Option<Quantity>,
        /// Time in which the integral gives way while the output is at a limit.
        /// [s; above 0, at least `sample_time`; default from the gains; e.g. "50 ms"]
        pub tracking: Option<Quantity>,
        /// Value of the integral at the start.
        /// [unit of the output; over parameters; default 0; e.g. "1 N m"]
        pub initial: Option<Quantity>,
        /// Time from sample to sample: it acts at its multiples and holds its output between them. Without, it acts all the time.
        /// [s; above 0; fixed at generation; default none; e.g. "1 ms"]
        pub sample_time: Option<Quantity>,
        /// What is computed at a sample is put out at the next one.
        /// [true or false; default false; e.g. true]
        pub delay: bool,
        /// A law of its own instead of PID, over all that a force may depend on and its `states`.
        /// [any unit; with `sample_time`; default none; e.g. "2 N m/rad*(target - shaft.q) + lead.x"]
        pub output: Option<Quantity>,
        /// States of a law of its own: formulas ask for them as `controller.state`.
        /// [table; with `output`; default none; e.g. { x = { initial = "0 rad", next = "shaft.q" } }]
        pub states: Table<ControllerStateSpec>,
        /// Our own assumption.
        /// [mark]
        pub assumed: bool,
        /// What it is.
        /// [text]
        pub doc: Option<Doc>,
    }
}

tables! {
    /// A number that a controller keeps from sample to sample.
    #[cfg_attr(test, schemars(extend("required" = ["next"])))]
    pub struct ControllerStateSpec {
        /// Value at the start; its unit is that of the state.
        /// [any unit; over parameters; default 0; e.g. "0 rad"]
        pub initial: Option<Quantity>,
        /// Value from the next sample on, over all that a force may depend on and the states of the controller as they were.
        /// [unit of the state; required; e.g. "0.9*lead.x + 0.1*shaft.q"]
        pub next: Option<Quantity>,
        /// What it is.
        /// [text]
        pub doc: Option<Doc>,
    }
}
