//! How large a mechanism, its data and a run may be, in counts, so that any file ends or is refused within a minute
//! and 2 GiB.
//! Out: [`Limit`]s and the sentences of those that were broken. Never knows time or memory.

use crate::diagnostic::{Code, Diagnostic};

/// A count that may not be passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limit {
    /// What is counted, in the plural.
    pub what: &'static str,
    /// The largest count that is allowed.
    pub most: usize,
    /// What to do about it.
    pub help: &'static str,
}

/// Text of a mechanism file: a thousand times the shipped ones.
pub const FILE_BYTES: Limit =
    Limit { what: "bytes", most: 4 << 20, help: "describe copies of a group once, in a [repeat] table" };

/// Text of a file of data, which takes up to thirty times as much memory while it is read.
pub const DATA_BYTES: Limit =
    Limit { what: "bytes", most: 32 << 20, help: "give fewer modes, nodes or readings" };

/// A mesh: two million triangles of a binary file.
pub const MESH_BYTES: Limit =
    Limit { what: "bytes", most: 96 << 20, help: "export the mesh with fewer triangles" };

/// Bodies after `[repeat]` groups have made their copies. Preflight factors matrices of speeds by rows, which takes
/// a minute at six hundred.
pub const BODIES: Limit =
    Limit { what: "bodies", most: 400, help: "split the mechanism, or repeat a group less often" };

/// Generalised speeds, those of modes included; see [`BODIES`].
pub const SPEEDS: Limit =
    Limit { what: "generalised speeds", most: 600, help: "split the mechanism, or keep fewer modes" };

/// Files that a mechanism is put together of, each as often as it is included.
pub const PARTS: Limit =
    Limit { what: "included files", most: 200, help: "include fewer parts, or repeat a group within one" };

/// Points, joints, couplings, stops, forces, states and sensors each.
pub const ELEMENTS: Limit = Limit {
    what: "points, joints, couplings, stops, forces, states or sensors",
    most: 4_000,
    help: "split the mechanism, or repeat a group less often",
};

/// Nodes of the symbolic graph, of which each takes up to 2 kB while its code is written.
pub const EXPRESSIONS: Limit = Limit {
    what: "symbolic expressions",
    most: 1_000_000,
    help: "chains of flexible or coupled bodies grow with the square of their length: split the mechanism, or keep fewer modes",
};

/// Threads of one run; what it answers does not depend on them.
pub const THREADS: Limit = Limit { what: "threads", most: 1_024, help: "give as many as there are cores" };

/// Numbers that the rows of a run have in all: they stand in memory until they are written, 1.2 GB.
pub const ROW_NUMBERS: Limit =
    Limit { what: "numbers in rows", most: 150_000_000, help: "take fewer rows, or split the span" };

/// Points of a parameter study: their rows stand in memory until they are written.
pub const STUDY_POINTS: Limit =
    Limit { what: "points", most: 1_000_000, help: "vary less finely, or sample with --sample sobol:N" };

/// Rows of a table: each is a few operations wherever a formula calls it.
pub const TABLE_ROWS: Limit = Limit {
    what: "rows in a table",
    most: 256,
    help: "give fewer rows, as many as its bends need; a long series in time is an input",
};

/// Copies that one `[repeat]` group makes: more are a slip of the pen.
pub const CELLS: Limit = Limit { what: "cells", most: 10_000, help: "split the mechanism" };

impl Limit {
    /// The fault, if `count` is beyond the limit.
    pub fn broken_by(&self, count: usize) -> Option<Diagnostic> {
        (count > self.most).then(|| {
            let Self { what, most, help } = self;
            Diagnostic::new(
                Code::TooLarge,
                format!("this mechanism takes {count} {what} or more; {most} are possible"),
            )
            .help(*help)
        })
    }
}
