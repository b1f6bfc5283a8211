//! The shipped mechanisms, compiled in by this package's build script.
//! Out: one module each, and [`SHIPPED`] to find them by the bytes of their file.
//! Never knows the generator: what is here is what any crate gets from its own build script.

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

macro_rules! shipped {
    ($($(#[$doc:meta])* $name:ident = $file:literal),* $(,)?) => {
        $(
            $(#[$doc])*
            #[allow(unused_qualifications, clippy::all, reason = "generated code")]
            pub mod $name {
                linkwear_runtime::include_mechanism!($file);
            }
        )*

        /// Every shipped mechanism, in the order of `build.rs`.
        pub static SHIPPED: &[Shipped] = &[$(Shipped {
            name: $file,
            source_sha256: $name::SOURCE_SHA256,
            description: $name::description,
            system: || Box::new($name::Mechanism::default()),
        }),*];
    };
}

shipped! {
    /// A bar that swings about one revolute joint.
    pendulum = "pendulum",
}
