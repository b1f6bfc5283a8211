//! End stops as written.

use linkwear_runtime::contact::Restitution;
#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::doc::Doc;
use super::texts::{tables, texts_of};
use super::word::Word;
use super::written::{At, Name, Quantity};

tables! {
    /// End stops of one joint coordinate: they only push, beyond `lower` and `upper`.
    #[cfg_attr(test, schemars(extend("required" = ["joint", "stiffness"], "anyOf" = [
        { "required": ["lower"] }, { "required": ["upper"] }
    ])))]
    pub struct StopSpec {
        /// The joint; one coordinate of a joint with several is written as `"C.q2"`.
        /// [joint; required; e.g. "slide"]
        pub joint: Option<Name>,
        /// Position of the stop from below.
        /// [rad or m; below `upper`; default none; e.g. "-30 deg"]
        pub lower: Option<Quantity>,
        /// Position of the stop from above.
        /// [rad or m; above `lower`; default none; e.g. "120 mm"]
        pub upper: Option<Quantity>,
        /// Stiffness: force over depth, with an exponent at the depth `depth`.
        /// [N m or N/m; above 0; required; e.g. "1e6 N/m"]
        pub stiffness: Option<Quantity>,
        /// Viscous damping while in contact, instead of `restitution`.
        /// [N m s or N s/m; from 0; default 0; e.g. "200 N s/m"]
        pub damping: Option<Quantity>,
        /// Coefficient of restitution.
        /// [1; 0 to 1; default 1; e.g. 0.6]
        pub restitution: Option<Quantity>,
        /// Law of restitution at `impact_speed`, instead of the one that holds at any speed.
        /// [word; default none; e.g. "hunt_crossley"]
        pub law: Option<At<Word<Restitution>>>,
        /// Impact speed that the damping of `law` is made for.
        /// [rad/s or m/s; above 0; required with `law`; e.g. "0.5 m/s"]
        pub impact_speed: Option<Quantity>,
        /// Speed below which a stop without `law` damps in proportion to the speed.
        /// [rad/s or m/s; above 0; default 0.01 rad/s or 1 mm/s; e.g. "1 mm/s"]
        pub impact_speed_floor: Option<Quantity>,
        /// Exponent of the depth.
        /// [1; from 1; default 1; e.g. 1.5]
        pub exponent: Option<Quantity>,
        /// Depth at which force over depth is `stiffness`.
        /// [rad or m; above 0; required with an `exponent` but 1; e.g. "0.1 mm"]
        pub depth: Option<Quantity>,
        /// Our own assumption.
        /// [mark]
        pub assumed: bool,
        /// What it is.
        /// [text]
        pub doc: Option<Doc>,
    }
}
