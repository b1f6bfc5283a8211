//! How many samples a study draws.

/// So many as the environment says by `RUNS`, else `usual`.
pub fn runs_or(usual: u64) -> u64 {
    std::env::var("RUNS").ok().and_then(|runs| runs.parse().ok()).unwrap_or(usual)
}
