//! Compiles the published benchmarks.

macro_rules! mechanisms {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => {
        const NAMES: &[&str] = &[$(stringify!($name)),*];
    };
}

include!("../mechanisms/benchmarks.rs");

fn main() {
    let files = NAMES.iter().map(|name| format!("../mechanisms/{name}.toml"));
    files.fold(linkwear_codegen::Builder::new(), |builder, file| builder.mechanism(file)).write_or_exit();
}
