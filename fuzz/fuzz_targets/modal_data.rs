//! See `linkwear_fuzz::modal_data`.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| linkwear_fuzz::modal_data(text));
