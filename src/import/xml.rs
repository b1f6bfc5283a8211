//! Elements of an XML file with their lines. In: a node. Out: texts and numbers, faults with their line. Never knows which robot.

use roxmltree::{Document, Node};

use super::error::ImportError;

/// Elements that a file may have.
const NODES: u32 = 1_000_000;

/// A file, if it is XML.
pub fn document(text: &str) -> Result<Document<'_>, ImportError> {
    let options = roxmltree::ParsingOptions { nodes_limit: NODES, ..Default::default() };
    Document::parse_with_options(text, options).map_err(|error| {
        let line = error.pos().row as usize;
        ImportError::new(
            line,
            format!("this is no XML that can be read: {error}"),
            "give a URDF file; of a xacro file what `xacro FILE.xacro > FILE.urdf` makes of it",
        )
    })
}

/// Line of an element.
pub fn line(node: Node<'_, '_>) -> usize {
    node.document().text_pos_at(node.range().start).row as usize
}

/// Elements of a name right within another.
pub fn children<'a, 'i: 'a>(node: Node<'a, 'i>, name: &'a str) -> impl Iterator<Item = Node<'a, 'i>> + 'a {
    node.children().filter(move |child| child.is_element() && child.has_tag_name(name))
}

/// The only one, if there is one.
pub fn child<'a, 'i: 'a>(node: Node<'a, 'i>, name: &'a str) -> Option<Node<'a, 'i>> {
    children(node, name).next()
}

/// An attribute that has to be there.
pub fn needed<'a>(node: Node<'a, '_>, key: &str) -> Result<&'a str, ImportError> {
    node.attribute(key).map(str::trim).filter(|text| !text.is_empty()).ok_or_else(|| {
        let tag = node.tag_name().name();
        ImportError::new(
            line(node),
            format!("<{tag}> has no `{key}`"),
            format!("give it: `<{tag} {key}=\"..\">`"),
        )
    })
}

/// A finite number, or its default.
pub fn number(node: Node<'_, '_>, key: &str, default: Option<f64>) -> Result<f64, ImportError> {
    match (node.attribute(key), default) {
        (None, Some(default)) => Ok(default),
        _ => numbers(node, key, None::<[f64; 1]>).map(|[value]| value),
    }
}

/// So many finite numbers, or their default.
pub fn numbers<const N: usize>(
    node: Node<'_, '_>,
    key: &str,
    default: Option<[f64; N]>,
) -> Result<[f64; N], ImportError> {
    if let (None, Some(default)) = (node.attribute(key), default) {
        return Ok(default);
    }
    let text = needed(node, key)?;
    let found: Option<Vec<f64>> = text
        .split_whitespace()
        .map(|word| word.parse().ok().filter(|value: &f64| value.is_finite()))
        .collect();
    found.and_then(|found| found.try_into().ok()).ok_or_else(|| {
        let many = if N == 1 { "a number".to_owned() } else { format!("{N} numbers") };
        let tag = node.tag_name().name();
        ImportError::new(
            line(node),
            format!("`{key}` of <{tag}> is \"{text}\""),
            format!("{many} must stand there, finite, with a point and without units"),
        )
    })
}
