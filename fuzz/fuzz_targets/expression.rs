//! See `linkwear_fuzz::expression`.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| linkwear_fuzz::expression(text));
