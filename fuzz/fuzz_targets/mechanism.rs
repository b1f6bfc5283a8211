//! See `linkwear_fuzz::mechanism`.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| linkwear_fuzz::mechanism(text));
