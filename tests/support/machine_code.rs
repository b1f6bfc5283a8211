//! What tests run a mechanism on.

use linkwear_codegen::compile::Compiled;
use linkwear_native::Native;
use linkwear_runtime::System;

/// The equations as a user runs them: machine code, in the interpreter's bits (benchmarks/tests/bits.rs) and several times as fast. Where
/// this processor has none, the interpreter.
pub fn system(compiled: &Compiled) -> Box<dyn System<f64>> {
    match Native::with_laws(compiled.tapes(), compiled.sizes(), compiled.description()) {
        Ok(native) => Box::new(native),
        Err(_) => Box::new(compiled.interpreter()),
    }
}
