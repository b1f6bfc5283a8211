fn main() {
    linkwear_codegen::Builder::new().mechanism("mechanisms/swing.toml").write_or_exit();
}
