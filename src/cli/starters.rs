//! The files that `new` starts from.

use clap::ValueEnum;

/// What to start from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Starter {
    /// A crank-rocker in a plane, with a worn bush.
    FourBar,
    /// A crank, a rod and a ram with a worn pin, commented line by line.
    SliderCrank,
    /// A spatial four-bar with a flexible coupler and a worn crank bearing.
    Rssr,
}

impl Starter {
    /// The file, with `starter` for the mechanism's name.
    pub fn text(self) -> &'static str {
        match self {
            Self::FourBar => include_str!("starters/four_bar.toml"),
            Self::SliderCrank => include_str!("starters/slider_crank.toml"),
            Self::Rssr => include_str!("starters/rssr.toml"),
        }
    }
}
