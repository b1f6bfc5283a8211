//! The one line with which a program takes in what its build script generated.

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
