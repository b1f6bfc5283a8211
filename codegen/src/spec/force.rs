//! Springs, forces and torques as written.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::doc::Doc;
use super::texts::{tables, texts_of};
use super::written::{At, Name, Pair, Quantity, Triple};

tables! {
    /// A force element: exactly one of `spring`, `bushing`, `force`, `torque`.
    #[cfg_attr(test, schemars(extend("oneOf" = [
        { "required": ["spring", "at"] }, { "required": ["bushing", "at"] },
        { "required": ["force", "at", "components"] },
        { "required": ["torque", "components"] }
    ])))]
    pub struct ForceSpec {
        /// Spring and damper between two bodies.
        pub spring: Option<Pair>,
        /// Elastic mount between two bodies.
        pub bushing: Option<Pair>,
        /// Body that is pushed.
        pub force: Option<Name>,
        /// Body that is turned.
        pub torque: Option<Name>,
        /// Point of a force or bushing, or the two points of a spring.
        pub at: Option<Places>,
        /// Stiffness of a spring.
        pub stiffness: Option<Quantity>,
        /// Unloaded length of a spring.
        pub length: Option<Quantity>,
        /// Damping of a spring along its line.
        pub damping: Option<Quantity>,
        /// Constant pull of a spring.
        pub preload: Option<Quantity>,
        /// Stiffness and damping of a bushing along its axes.
        pub translation: Option<At<BushingPart>>,
        /// Stiffness and damping of a bushing about its axes.
        pub rotation: Option<At<BushingPart>>,
        /// Axes of a bushing at the reference pose: two or three directions at right angles; those of the ground by default.
        pub directions: Option<At<Vec<Triple>>>,
        /// Components of a force or torque.
        pub components: Option<Triple>,
        /// Axes of the components: "ground" (default) or a body they turn with.
        pub axes: Option<Name>,
        /// Body that takes the reaction; "ground" by default.
        pub reaction: Option<Name>,
        /// Our own assumption.
        pub assumed: bool,
        /// What it is.
        pub doc: Option<Doc>,
    }

    /// Stiffness and damping of a bushing, axis by axis.
    pub struct BushingPart {
        /// Stiffness; 0 by default.
        pub stiffness: Option<Triple>,
        /// Damping; 0 by default.
        pub damping: Option<Triple>,
    }
}

/// One point or several.
#[derive(Clone, Debug)]
pub struct Places(pub At<Vec<Name>>);

texts_of! { struct Places { 0 } }
