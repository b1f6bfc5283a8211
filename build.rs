//! Hands on the library inside units of FMI, if its feature is on. That is the crate `fmu`, which cargo
//! has compiled to run this script.

#[cfg(feature = "fmu")]
mod unit {
    use std::env;
    use std::fs;
    use std::path::{Path, PathBuf};

    pub fn hand_on() {
        let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo says where to write"));
        let system = env::var("CARGO_CFG_TARGET_OS").unwrap_or_default();
        let ending = match &*system {
            "windows" => ".dll",
            "macos" => ".dylib",
            _ => ".so",
        };
        // For another processor there is none: this script runs here.
        let same = env::var_os("TARGET") == env::var_os("HOST");
        let beside = out.ancestors().nth(3).map(|profile| profile.join("deps"));
        let found = beside.filter(|_| same).and_then(|folder| newest(&folder, ending));
        let library = out.join("unit-library");
        match found {
            Some(file) => drop(fs::copy(file, library).expect("the library can be copied")),
            None => {
                println!(
                    "cargo::warning=the library of the crate `fmu` is not found: `linkwear fmu` will write no units"
                );
                fs::write(library, []).expect("OUT_DIR can be written");
            }
        }
    }

    /// The library compiled last: cargo leaves older ones of other settings.
    fn newest(folder: &Path, ending: &str) -> Option<PathBuf> {
        let files = fs::read_dir(folder).ok()?.filter_map(Result::ok);
        let libraries = files.filter(|file| {
            let name = file.file_name().to_string_lossy().into_owned();
            name.trim_start_matches("lib").starts_with("linkwear_fmu") && name.ends_with(ending)
        });
        let made = libraries.filter_map(|file| Some((file.metadata().ok()?.modified().ok()?, file.path())));
        made.max().map(|(_, path)| path)
    }
}

fn main() {
    #[cfg(feature = "fmu")]
    unit::hand_on();
}
