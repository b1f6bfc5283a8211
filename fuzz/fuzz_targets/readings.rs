//! See `linkwear_fuzz::readings`.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| linkwear_fuzz::readings(text));
