//! Text of users in markup and in data of a script. In: text, JSON. Out: text that ends no element. Never knows what it says.

use serde::Serialize;

/// As text or as an attribute in double quotes.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// As the contents of a script element that holds data.
pub fn data(value: &impl Serialize) -> String {
    // Within JSON a `<` stands in strings only, and may stand there in this form.
    serde_json::to_string(value).unwrap_or_default().replace('<', "\\u003c")
}
