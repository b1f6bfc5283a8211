//! A file's text and places in it.
//! Knows nothing else.

/// A range of bytes in a source file. `0..0` means "nowhere in particular".
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Span {
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

impl From<std::ops::Range<usize>> for Span {
    fn from(range: std::ops::Range<usize>) -> Self {
        Self { start: range.start, end: range.end }
    }
}

/// A source file: its name as shown to people and its text.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// Path as the user gave it.
    pub name: String,
    /// Contents.
    pub text: String,
}

impl SourceFile {
    /// SHA-256 of the text, in hexadecimal.
    pub fn sha256(&self) -> String {
        hmac_sha256::Hash::hash(self.text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// Line and column, both from 1, of a byte offset; columns count characters.
    pub fn line_column(&self, offset: usize) -> (usize, usize) {
        // Line by line, not byte by byte: a thousand places in a file of megabytes are asked for.
        let before = &self.text[..self.text.floor_char_boundary(offset)];
        let start = before.rfind('\n').map_or(0, |at| at + 1);
        (before.matches('\n').count() + 1, before[start..].chars().count() + 1)
    }
}

/// A file and, behind its text, those of the files that it includes: one text for all places.
#[derive(Clone, Debug)]
pub struct Sources {
    whole: SourceFile,
    /// Where each included text begins, and its file.
    parts: Vec<(usize, String)>,
}

impl Default for Sources {
    fn default() -> Self {
        Self::new(SourceFile { name: String::new(), text: String::new() })
    }
}

impl Sources {
    /// A file alone.
    pub fn new(file: SourceFile) -> Self {
        Self { whole: file, parts: Vec::new() }
    }

    /// Adds an included file; gives where its text begins.
    pub fn add(&mut self, name: String, text: &str) -> usize {
        self.whole.text.push('\n');
        let start = self.whole.text.len();
        self.whole.text.push_str(text);
        self.parts.push((start, name));
        start
    }

    /// All texts, one behind the other.
    pub fn whole(&self) -> &SourceFile {
        &self.whole
    }

    /// Whether there is more than the file itself.
    pub fn has_parts(&self) -> bool {
        !self.parts.is_empty()
    }

    /// The file that a place is in, and where its text begins.
    pub fn file_at(&self, offset: usize) -> (SourceFile, usize) {
        let next = self.parts.iter().position(|(start, _)| *start > offset).unwrap_or(self.parts.len());
        let end = self.parts.get(next).map_or(self.whole.text.len(), |(start, _)| start - 1);
        let (start, name) = match next.checked_sub(1) {
            Some(at) => (self.parts[at].0, &self.parts[at].1),
            None => (0, &self.whole.name),
        };
        (SourceFile { name: name.clone(), text: self.whole.text[start..end].to_owned() }, start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_in_the_file_that_it_comes_from() {
        let mut sources = Sources::new(SourceFile { name: "host".into(), text: "ab\n".into() });
        assert_eq!(sources.add("part".into(), "cd"), 4);
        assert_eq!(sources.add("other".into(), ""), 7);
        let found = |at: usize| {
            let (file, start) = sources.file_at(at);
            (file.name, file.text, start)
        };
        assert_eq!(found(1), ("host".into(), "ab\n".into(), 0));
        assert_eq!(found(4), ("part".into(), "cd".into(), 4));
        assert_eq!(found(7), ("other".into(), String::new(), 7));
    }

    #[test]
    fn the_hash_is_the_published_one() {
        let source = SourceFile { name: String::new(), text: "abc".to_owned() };
        // SHA-256 of "abc", FIPS 180-2, appendix B.1.
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(source.sha256(), expected);
    }
}
