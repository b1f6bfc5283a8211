//! Compiles the shipped mechanisms, with the same few lines a user's build script has.

fn main() {
    linkwear_codegen::Builder::new().mechanism("mechanisms/pendulum.toml").write_or_exit();
}
