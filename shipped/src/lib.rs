//! The shipped mechanisms, compiled by this package's build script if its feature `compile` is on.
//! Out: one module each, and [`SHIPPED`] to find them by the bytes of their file.
//! Never knows the generator: what is here is what any crate gets from its own build script.
//!
//! A package of its own: generated code computes, and is optimised; the program around it asks and prints, and is compiled fast.

use linkwear_runtime::{Description, System};

/// A mechanism that was compiled into this program.
#[derive(Clone, Copy)]
pub struct Shipped {
    /// Name of its file without `.toml`.
    pub name: &'static str,
    /// SHA-256 of the bytes of its file, in lower-case hexadecimal.
    pub source_sha256: &'static str,
    /// Names, units and columns.
    pub description: fn() -> &'static Description,
    /// The compiled equations. Parameters are inputs of every entry.
    pub system: fn() -> Box<dyn System<f64>>,
}

/// Modules of compiled mechanisms, and a table `SHIPPED` of them, from a list of `/// what it is` and `name,`.
#[macro_export]
macro_rules! mechanisms {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => {
        $(
            $(#[$doc])*
            pub mod $name {
                ::linkwear_runtime::include_mechanism!(stringify!($name));
            }
        )*

        /// Every mechanism of the list, in its order.
        pub static SHIPPED: &[$crate::Shipped] = &[$($crate::Shipped {
            name: stringify!($name),
            source_sha256: $name::SOURCE_SHA256,
            description: $name::description,
            system: || ::std::boxed::Box::new($name::Mechanism::default()),
        }),*];
    };
}

#[cfg(feature = "compile")]
include!(concat!(env!("OUT_DIR"), "/shipped.rs"));
#[cfg(not(feature = "compile"))]
mechanisms! {}
