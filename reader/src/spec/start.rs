//! Start values as written.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::texts::{tables, texts_of};
use super::written::{At, Quantity};

/// Start values of a joint.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
#[serde(rename = "$linkwear::ByForm")]
#[cfg_attr(test, derive(JsonSchema), schemars(rename = "StartSpec", untagged))]
pub enum StartSpec {
    /// Position of the only coordinate.
    #[serde(rename = "scalar")]
    One(Quantity),
    /// Positions in order.
    List(At<Vec<Quantity>>),
    /// Positions and speeds by name.
    Table(Box<At<StartTable>>),
}

tables! {
    /// Start positions (`q`, or `q1`, `q2` ...) and speeds (`v`, or `v1`, `v2` ...).
    #[allow(missing_docs, reason = "one line above says all")]
    pub struct StartTable {
        /// [rad or m; any; default 0; e.g. "10 deg"]
        pub q: Option<Quantity>,
        /// [rad or m; any; default 0; e.g. "10 deg"]
        pub q1: Option<Quantity>,
        /// [rad or m; any; default 0; e.g. "10 deg"]
        pub q2: Option<Quantity>,
        /// [rad or m; any; default 0; e.g. "10 deg"]
        pub q3: Option<Quantity>,
        /// [rad or m; any; default 0; e.g. "10 deg"]
        pub q4: Option<Quantity>,
        /// [rad or m; any; default 0; e.g. "10 deg"]
        pub q5: Option<Quantity>,
        /// [rad or m; any; default 0; e.g. "10 deg"]
        pub q6: Option<Quantity>,
        /// [1/s or m/s; any; default 0; e.g. "2 rad/s"]
        pub v: Option<Quantity>,
        /// [1/s or m/s; any; default 0; e.g. "2 rad/s"]
        pub v1: Option<Quantity>,
        /// [1/s or m/s; any; default 0; e.g. "2 rad/s"]
        pub v2: Option<Quantity>,
        /// [1/s or m/s; any; default 0; e.g. "2 rad/s"]
        pub v3: Option<Quantity>,
        /// [1/s or m/s; any; default 0; e.g. "2 rad/s"]
        pub v4: Option<Quantity>,
        /// [1/s or m/s; any; default 0; e.g. "2 rad/s"]
        pub v5: Option<Quantity>,
        /// [1/s or m/s; any; default 0; e.g. "2 rad/s"]
        pub v6: Option<Quantity>,
        /// Modal coordinates of a flexible body.
        /// [1; any; default 0; e.g. [1e-4, 0]]
        pub eta: Option<At<Vec<Quantity>>>,
        /// Modal speeds of a flexible body.
        /// [1; any; default 0; e.g. [0, 0]]
        pub eta_v: Option<At<Vec<Quantity>>>,
    }
}

texts_of! { enum StartSpec { One, List, Table } }
