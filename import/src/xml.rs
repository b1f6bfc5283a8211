//! Elements of an XML file with their places. In: text. Out: a tree of elements; texts and numbers of one, faults with their line. Never
//! knows which robot.

use std::sync::Arc;

use roxmltree::{Document, Node};

use super::error::ImportError;

/// Elements that a file may have.
const NODES: u32 = 1_000_000;
/// How deep elements may stand in each other: chains of bodies of any robot do. Each level is one of the stack.
const DEPTH: usize = 300;

/// An element with its attributes and what stands within it.
#[derive(Clone, Debug, Default)]
pub struct Element {
    pub tag: String,
    /// Whether it belongs to xacro's macros.
    pub is_macro: bool,
    pub attributes: Vec<(String, String)>,
    pub children: Vec<Element>,
    pub line: usize,
    /// Name of its file, where that is not the one that was given.
    pub file: Option<Arc<str>>,
}

/// The root element of a text, if it is XML; `file` is its name where another file includes it.
pub fn read(text: &str, file: Option<&Arc<str>>) -> Result<Element, ImportError> {
    let options = roxmltree::ParsingOptions { nodes_limit: NODES, ..Default::default() };
    let place = |line: usize, message: String| ImportError {
        file: file.map(|file| file.to_string()),
        ..ImportError::new(
            line,
            message,
            "give a URDF or MJCF file; of a xacro file what `xacro FILE.xacro > FILE.urdf` makes of it",
        )
    };
    let document = Document::parse_with_options(text, options).map_err(|error| {
        place(error.pos().row as usize, format!("this is no XML that can be read: {error}"))
    })?;
    // A place is asked for at every element, and to count its lines anew takes the longer the later it is.
    let ends: Vec<usize> =
        text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(at, _)| at).collect();
    element(document.root_element(), (file, &ends), 0).map_err(|line| {
        place(line, format!("this is no XML that can be read: elements stand more than {DEPTH} deep"))
    })
}

/// A node and all within it, by the ends of lines; the line at which it is too deep.
fn element(
    node: Node<'_, '_>,
    (file, ends): (Option<&Arc<str>>, &[usize]),
    depth: usize,
) -> Result<Element, usize> {
    let start = node.range().start;
    let line = ends.partition_point(|end| *end < start) + 1;
    if depth > DEPTH {
        return Err(line);
    }
    let within =
        node.children().filter(Node::is_element).map(|child| element(child, (file, ends), depth + 1));
    Ok(Element {
        tag: node.tag_name().name().to_owned(),
        is_macro: node.tag_name().namespace().is_some_and(|space| space.contains("xacro")),
        attributes: node
            .attributes()
            .map(|attribute| (attribute.name().to_owned(), attribute.value().to_owned()))
            .collect(),
        children: within.collect::<Result<_, _>>()?,
        line,
        file: file.cloned(),
    })
}

/// The finite numbers of a text.
pub fn numbers_of(text: &str) -> Option<Vec<f64>> {
    text.split_whitespace().map(|word| word.parse().ok().filter(|value: &f64| value.is_finite())).collect()
}

impl Element {
    /// What an attribute says.
    pub fn attribute(&self, key: &str) -> Option<&str> {
        self.attributes.iter().find(|(name, _)| name == key).map(|(_, value)| &**value)
    }

    /// It alone, with other attributes.
    pub fn with(&self, attributes: Vec<(String, String)>) -> Self {
        let (tag, file) = (self.tag.clone(), self.file.clone());
        Self { tag, attributes, line: self.line, file, ..Self::default() }
    }

    /// Elements of a name right within it.
    pub fn all<'a>(&'a self, tag: &'a str) -> impl Iterator<Item = &'a Self> + 'a {
        self.children.iter().filter(move |child| child.tag == tag)
    }

    /// The first of them.
    pub fn first(&self, tag: &str) -> Option<&Self> {
        self.children.iter().find(|child| child.tag == tag)
    }

    /// It and all within it, in the order of the file.
    pub fn descendants(&self) -> Vec<&Self> {
        let mut found = vec![self];
        for child in &self.children {
            found.extend(child.descendants());
        }
        found
    }

    /// What is wrong with it.
    pub fn fault(&self, message: impl Into<String>, cure: impl Into<String>) -> ImportError {
        ImportError {
            file: self.file.as_ref().map(|file| file.to_string()),
            ..ImportError::new(self.line, message, cure)
        }
    }

    /// An attribute that has to be there.
    pub fn needed(&self, key: &str) -> Result<&str, ImportError> {
        self.attribute(key).map(str::trim).filter(|text| !text.is_empty()).ok_or_else(|| {
            let tag = &self.tag;
            self.fault(format!("<{tag}> has no `{key}`"), format!("give it: `<{tag} {key}=\"..\">`"))
        })
    }

    /// A finite number, or its default.
    pub fn number(&self, key: &str, default: Option<f64>) -> Result<f64, ImportError> {
        match (self.attribute(key), default) {
            (None, Some(default)) => Ok(default),
            _ => self.numbers(key, None::<[f64; 1]>).map(|[value]| value),
        }
    }

    /// So many finite numbers, or their default.
    pub fn numbers<const N: usize>(
        &self,
        key: &str,
        default: Option<[f64; N]>,
    ) -> Result<[f64; N], ImportError> {
        if let (None, Some(default)) = (self.attribute(key), default) {
            return Ok(default);
        }
        let many = if N == 1 { "a number".to_owned() } else { format!("{N} numbers") };
        let found = self.list(key, &many)?;
        found.try_into().map_err(|_| self.no_numbers(key, &many))
    }

    /// Finite numbers, at most so many; none without the attribute.
    pub fn up_to(&self, key: &str, most: usize) -> Result<Vec<f64>, ImportError> {
        if self.attribute(key).is_none() {
            return Ok(Vec::new());
        }
        let many = format!("up to {most} numbers");
        let found = self.list(key, &many)?;
        if found.len() > most { Err(self.no_numbers(key, &many)) } else { Ok(found) }
    }

    fn list(&self, key: &str, many: &str) -> Result<Vec<f64>, ImportError> {
        numbers_of(self.needed(key)?).ok_or_else(|| self.no_numbers(key, many))
    }

    fn no_numbers(&self, key: &str, many: &str) -> ImportError {
        let (tag, text) = (&self.tag, self.attribute(key).unwrap_or_default());
        // Long lists are not read again by anybody.
        let shown: String = text.chars().take(80).collect();
        self.fault(
            format!("`{key}` of <{tag}> is \"{shown}\""),
            format!("{many} must stand there, finite, with a point and without units"),
        )
    }
}
