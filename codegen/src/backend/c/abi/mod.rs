//! A crate with an interface of C around the Rust source of a mechanism, for programs that link with Rust. In: a mechanism's source,
//! description, layout. Out: files. Never knows mechanics.

use std::fmt::Write;

use linkwear_runtime::{Description, Entry, Sizes};

use crate::tape::Tape;

use super::super::interface::{blocks, mass_is_left_out};
use super::super::names::plain;
use super::header;
use super::names::prefix;
use super::text::{block, comment};

/// What tells of a mass matrix that is left out: a code, who answers it, how the header has it.
const LEFT_OUT: &str =
    "/// All is written, but zeros stand in the place of the mass matrix.\nconst MASS_LEFT_OUT: c_int = 6;\n";
const ANSWER_LEFT_OUT: &str =
    "        if entry == Entry::EquationsOfMotion {\n            return Err(MASS_LEFT_OUT);\n        }\n";
const STATUS_LEFT_OUT: &str = ",\n    /* all is written, but zeros stand in the place of the mass matrix, which is left out of so long a mechanism */\n    PFX_MASS_LEFT_OUT = 6";

/// A file of the crate: where it lies, what is in it.
pub type CrateFile = (String, String);

/// All files of the crate, `mechanism` being the mechanism's Rust source.
pub fn crate_files(
    banner: &str,
    tapes: &[Tape],
    description: &Description,
    sizes: &Sizes,
    mechanism: String,
) -> Vec<CrateFile> {
    let lower = prefix(&description.name);
    let upper = lower.to_ascii_uppercase();
    let named = |text: &str| text.replace("pfx_", &format!("{lower}_")).replace("PFX_", &format!("{upper}_"));
    let pairs = |pairs: &mut dyn Iterator<Item = (&str, &str)>| {
        pairs.map(|(name, unit)| format!("\n    [c{name:?}, c{unit:?}],")).collect::<String>()
    };
    let parameters = pairs(&mut description.parameters.iter().map(|own| (&*own.name, &*own.unit)));
    let channels = pairs(&mut description.channels.iter().map(|own| (&*own.name, &*own.unit)));
    let entries: String =
        Entry::ALL.iter().map(|entry| format!("    pfx_{} => {entry:?},\n", entry.name())).collect();
    let left_out = tapes.iter().any(mass_is_left_out);
    let [code, answer] = if left_out { [LEFT_OUT, ANSWER_LEFT_OUT] } else { [""; 2] };
    let library = include_str!("lib.rs.txt").replace("ENTRIES", &entries);
    let library = library.replace("CODE_OF_MASS\n", code).replace("ANSWER_OF_MASS\n", answer);
    let library = named(&library)
        .replace("`NAME`", &format!("`{}`", comment(&description.name)))
        .replace("PARAMETER_COUNT", &description.parameters.len().to_string())
        .replace("CHANNEL_COUNT", &description.channels.len().to_string())
        .replace("PARAMETER_NAMES", &parameters)
        .replace("CHANNEL_NAMES", &channels);
    let manifest = include_str!("Cargo.toml.txt")
        .replace("NAME", &plain(&lower))
        .replace("VERSION", env!("CARGO_PKG_VERSION"));
    let declared = declarations(description, sizes, tapes);
    let guarded = format!(
        "{banner}#ifndef {upper}_H\n#define {upper}_H\n\n#include <stddef.h>\n\n#ifdef __cplusplus\nextern \"C\" {{\n#endif\n\n{}\n\
         #ifdef __cplusplus\n}}\n#endif\n\n#endif\n",
        named(&declared)
    );
    vec![
        ("Cargo.toml".to_owned(), manifest),
        ("src/lib.rs".to_owned(), library),
        ("src/mechanism.rs".to_owned(), mechanism),
        (format!("{lower}.h"), guarded),
    ]
}

fn declarations(description: &Description, sizes: &Sizes, tapes: &[Tape]) -> String {
    let mut text = header::lengths(description, sizes, false) + &header::places(description);
    let left_out = if tapes.iter().any(mass_is_left_out) { STATUS_LEFT_OUT } else { "" };
    text.push_str(&include_str!("status.h").replace("STATUS_OF_MASS", left_out));
    for tape in tapes {
        let mut lines = vec![tape.doc.clone(), String::new()];
        lines.extend(blocks(tape, str::to_owned).iter().map(|line| line.replace('`', "")));
        let _ = writeln!(
            text,
            "{}int pfx_{}(const double *x, size_t inputs, double *y, size_t outputs);\n",
            block(&lines),
            tape.name
        );
    }
    text + include_str!("functions.h")
}
