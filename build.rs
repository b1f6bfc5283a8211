//! Compiles the shipped mechanisms, as a user's build script does.

macro_rules! mechanisms {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => {
        const NAMES: &[&str] = &[$(stringify!($name)),*];
    };
}

include!("mechanisms/shipped.rs");

fn main() {
    let files = NAMES.iter().map(|name| format!("mechanisms/{name}.toml"));
    files.fold(linkwear_codegen::Builder::new(), |builder, file| builder.mechanism(file)).write_or_exit();
}
