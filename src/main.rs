//! The command line of linkwear. Everything it does is in [`cli`].

#![deny(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::todo,
    clippy::unimplemented,
    clippy::unreachable
)]

mod cli;

fn main() -> std::process::ExitCode {
    cli::run()
}
