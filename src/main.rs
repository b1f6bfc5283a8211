//! The command line of linkwear. Everything it does is in [`linkwear::cli`].

#![deny(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::todo,
    clippy::unimplemented,
    clippy::unreachable
)]

fn main() -> std::process::ExitCode {
    linkwear::cli::run()
}
