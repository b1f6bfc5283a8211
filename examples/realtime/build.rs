fn main() {
    linkwear_codegen::Builder::new().mechanism("../../mechanisms/rssr.toml").write_or_exit();
}
