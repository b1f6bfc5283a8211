//! See `linkwear_fuzz::fit_file`.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| linkwear_fuzz::fit_file(text));
