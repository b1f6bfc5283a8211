//! The command that makes another shard of a study. In: the words of this process. Out: a line for a shell.

use std::ffi::{OsStr, OsString};

/// The command that was given, with `{shard}` and `{out}` in the place of what differs from shard to shard.
pub fn shard_command(arguments: impl Iterator<Item = OsString>) -> String {
    let mut words = vec!["linkwear".to_owned()];
    let mut arguments = arguments.skip(1);
    while let Some(argument) = arguments.next() {
        // Options are UTF-8, or clap would have refused them; paths need not be.
        let text = argument.to_string_lossy();
        let (name, has_value) = match text.split_once('=') {
            Some((name, _)) if name.starts_with("--") => (name, true),
            _ => (&*text, false),
        };
        let place = match name {
            "--shard" => Some("{shard}"),
            "--out" => Some("{out}"),
            "--format" => None,
            "--resume" => continue,
            _ => {
                words.push(quoted(&argument));
                continue;
            }
        };
        if !has_value {
            arguments.next();
        }
        words.extend(place.into_iter().flat_map(|place| [name.to_owned(), place.to_owned()]));
    }
    words.join(" ")
}

/// A word as a shell takes it for one.
fn quoted(word: &OsStr) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+%@".contains(c);
    match word.to_str() {
        Some(text) if !text.is_empty() && text.chars().all(is_plain) => text.to_owned(),
        Some(text) => format!("'{}'", text.replace('\'', "'\\''")),
        None => by_bytes(word),
    }
}

/// A word that is not UTF-8: `$'..'` has its other bytes by their numbers.
fn by_bytes(word: &OsStr) -> String {
    let chunks = word.as_encoded_bytes().utf8_chunks().map(|chunk| {
        let text = chunk.valid().replace('\\', "\\\\").replace('\'', "\\'");
        let others: String = chunk.invalid().iter().map(|byte| format!("\\x{byte:02x}")).collect();
        text + &others
    });
    format!("$'{}'", chunks.collect::<String>())
}

#[cfg(test)]
mod tests {
    #[cfg(unix)]
    use super::*;

    #[test]
    #[cfg(unix)]
    fn words_that_are_not_utf_8_stand_in_the_command_by_their_bytes() {
        use std::os::unix::ffi::OsStringExt as _;

        let words: [&[u8]; 9] = [
            b"lw",
            b"life",
            b"it's \xff.toml",
            b"--out",
            b"a\xff",
            b"--shard=1/2",
            b"--resume",
            b"--set",
            b"c0=5 um",
        ];
        let given = words.map(|word| OsString::from_vec(word.to_vec()));
        let told = shard_command(given.into_iter());
        assert_eq!(told, r"linkwear life $'it\'s \xff.toml' --out {out} --shard {shard} --set 'c0=5 um'");
    }
}
