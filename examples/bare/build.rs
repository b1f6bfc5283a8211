fn main() {
    linkwear_codegen::Builder::new().mechanism("../../mechanisms/rssr.toml").with_start().write_or_exit();
}
