//! Compiles the shipped mechanisms, as a user's build script does, if the feature `compile` is on.

#[cfg(feature = "compile")]
mod shipped {
    use std::env;
    use std::fs;
    use std::path::{Path, PathBuf};

    use linkwear_codegen::Builder;

    pub fn compile() {
        // A published package has them beside its sources, see .ci/packages.
        let folder =
            ["mechanisms", "../mechanisms"].map(Path::new).into_iter().find(|folder| folder.is_dir());
        let folder = folder.expect("the mechanisms are in `mechanisms`");
        let list = folder.join("shipped.rs");
        println!("cargo::rerun-if-changed={}", list.display());
        let text = fs::read_to_string(list).expect("the list can be read");
        let lines = text.lines().map(str::trim).filter(|line| !line.starts_with("//"));
        let files = lines
            .filter_map(|line| line.strip_suffix(','))
            .map(|name| folder.join(name).with_extension("toml"));
        files.fold(Builder::new(), Builder::mechanism).write_or_exit();
        let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo says where to write"));
        fs::write(out.join("shipped.rs"), text).expect("OUT_DIR can be written");
    }
}

fn main() {
    #[cfg(feature = "compile")]
    shipped::compile();
}
