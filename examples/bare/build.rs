fn main() {
    linkwear_codegen::Builder::new().mechanism("../../mechanisms/rssr_rigid.toml").write_or_exit();
}
