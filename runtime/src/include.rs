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

/// Declares `description()` beside the `TABLES` of generated code. Empty without the feature `std`.
#[cfg(feature = "std")]
#[macro_export]
macro_rules! describe_mechanism {
    ($tables:ident) => {
        /// Names and units of parameters, coordinates, rows and output columns.
        pub fn description() -> &'static $crate::Description {
            static DESCRIPTION: $crate::TabledDescription = $crate::TabledDescription::new(&$tables);
            DESCRIPTION.get()
        }
    };
    ($tables:ident, $journals:ident, $coefficients:ident) => {
        /// Names and units of parameters, coordinates, rows and output columns.
        pub fn description() -> &'static $crate::Description {
            static DESCRIPTION: $crate::TabledDescription =
                $crate::TabledDescription::with_wear(&$tables, &$journals, &$coefficients);
            DESCRIPTION.get()
        }
    };
    ($tables:ident, $journals:ident, $coefficients:ident, $guides:ident) => {
        /// Names and units of parameters, coordinates, rows and output columns.
        pub fn description() -> &'static $crate::Description {
            static DESCRIPTION: $crate::TabledDescription =
                $crate::TabledDescription::with_guides(&$tables, &$journals, &$coefficients, &$guides);
            DESCRIPTION.get()
        }
    };
}

/// Declares `description()` beside the `TABLES` of generated code. Empty without the feature `std`.
#[cfg(not(feature = "std"))]
#[macro_export]
macro_rules! describe_mechanism {
    ($tables:ident $(, $more:ident)*) => {};
}
