//! Compiles the shipped mechanisms, with the same few lines a user's build script has.
//! src/mechanisms.rs includes what this writes: keep the two lists equal.

fn main() {
    linkwear_codegen::Builder::new()
        .mechanism("mechanisms/pendulum.toml")
        .mechanism("mechanisms/four_bar.toml")
        .mechanism("mechanisms/slider_crank.toml")
        .mechanism("mechanisms/rssr_rigid.toml")
        .write_or_exit();
}
