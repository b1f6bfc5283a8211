//! The one line with which a program takes in what its build script generated, and the one with which that describes itself.

/// Includes the solver that `linkwear_codegen::Builder` generated for `mechanisms/<name>.toml`.
/// Put it into a module of its own: `mod rssr { linkwear_runtime::include_mechanism!("rssr"); }`.
#[macro_export]
macro_rules! include_mechanism {
    ($name:expr) => {
        #[allow(
            dead_code,
            unused_imports,
            unused_qualifications,
            missing_docs,
            clippy::all,
            clippy::pedantic
        )]
        mod generated {
            include!(concat!(env!("OUT_DIR"), "/", $name, ".rs"));
        }
        #[allow(unused_imports)]
        pub use generated::*;
    };
}

/// Declares `ALL_TABLES` and `description()` beside the `TABLES` of generated code; without the feature `std` the first alone.
#[macro_export]
macro_rules! describe_mechanism {
    ($tables:ident) => {
        $crate::describe_mechanism!(@all &$tables, &[], &[], &[]);
    };
    ($tables:ident, $journals:ident, $coefficients:ident) => {
        $crate::describe_mechanism!(@all &$tables, &$journals, &$coefficients, &[]);
    };
    ($tables:ident, $journals:ident, $coefficients:ident, $guides:ident) => {
        $crate::describe_mechanism!(@all &$tables, &$journals, &$coefficients, &$guides);
    };
    (@all $tables:expr, $journals:expr, $coefficients:expr, $guides:expr) => {
        /// All tables of the mechanism, for steps without std.
        pub static ALL_TABLES: $crate::AllTables = $crate::AllTables {
            tables: $tables,
            journals: $journals,
            coefficients: $coefficients,
            guides: $guides,
        };
        $crate::describe_all_tables!();
    };
}

/// Declares `description()` beside `ALL_TABLES`.
#[cfg(feature = "std")]
#[doc(hidden)]
#[macro_export]
macro_rules! describe_all_tables {
    () => {
        /// Names and units of parameters, coordinates, rows and output columns.
        pub fn description() -> &'static $crate::Description {
            static DESCRIPTION: $crate::TabledDescription = $crate::TabledDescription::of(&ALL_TABLES);
            DESCRIPTION.get()
        }
    };
}

/// Nothing without the feature `std`.
#[cfg(not(feature = "std"))]
#[doc(hidden)]
#[macro_export]
macro_rules! describe_all_tables {
    () => {};
}
