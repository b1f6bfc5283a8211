//! Published benchmarks as compiled code, for tests and measurements: linkwear itself runs them by its interpreter, so
//! that nobody who builds it waits for them.

use linkwear_shipped::mechanisms;

include!("../../mechanisms/benchmarks.rs");
