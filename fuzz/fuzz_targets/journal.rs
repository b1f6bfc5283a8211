//! See `linkwear_fuzz::journal`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| linkwear_fuzz::journal(bytes));
