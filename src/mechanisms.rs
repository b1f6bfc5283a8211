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
    /// Planar four-bar with four revolute joints: three of its constraint rows are redundant.
    four_bar = "four_bar",
    /// Slider-crank with a driven crank.
    slider_crank = "slider_crank",
    /// The case study's spatial four-bar, rigid, with ideal joints.
    rssr_rigid = "rssr_rigid",
    /// The case study's spatial four-bar with a flexible coupler and ideal joints.
    rssr_flexible = "rssr_flexible",
    /// The case study: flexible coupler, and a wearing bearing with clearance at the crank.
    rssr = "rssr",
    /// The case study's four-bar with a wearing ball between crank and coupler.
    rssr_ball_wear = "rssr_ball_wear",
    /// The planar four-bar with two wearing bearings.
    four_bar_wear = "four_bar_wear",
    /// Slider-crank with a loose pin at its slider, by Flores and Ambrosio.
    slider_crank_clearance = "slider_crank_clearance",
    /// Andrews' squeezing mechanism: seven bodies, three loops, a spring and a motor.
    andrews = "andrews",
    /// Two parallelogram cells; passes positions where it could go on in several ways.
    n_four_bar_2 = "n_four_bar_2",
    /// Forty parallelogram cells.
    n_four_bar_40 = "n_four_bar_40",
    /// Bricard's six revolutes: overconstrained, yet it moves.
    bricard = "bricard",
    /// Bennett's four skew revolutes: overconstrained, yet it moves.
    bennett = "bennett",
    /// The stiff flyball governor.
    flyball = "flyball",
    /// A six-bar with two loops.
    six_bar = "six_bar",
    /// A spatial slider-crank with a universal joint.
    spatial_slider_crank = "spatial_slider_crank",
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shipped_file_is_compiled_in_and_carries_its_own_name() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/mechanisms");
        let files = std::fs::read_dir(folder).expect("mechanisms folder");
        let mut names: Vec<String> = files
            .map(|entry| entry.expect("an entry").path())
            .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
            .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
            .collect();
        names.sort();
        let mut compiled: Vec<&str> = SHIPPED.iter().map(|shipped| shipped.name).collect();
        compiled.sort_unstable();
        assert_eq!(names, compiled);
        for shipped in SHIPPED {
            assert_eq!((shipped.description)().name, shipped.name);
        }
    }
}
