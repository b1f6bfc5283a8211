//! How equations are written. Knows nothing else.

/// How equations are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextFormat {
    /// Plain text.
    Text,
    /// Markdown with code blocks.
    Markdown,
    /// LaTeX, ready to be included.
    Latex,
}
