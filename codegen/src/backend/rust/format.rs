//! Tokens of the emitter as formatted text. Never knows what they say.

use proc_macro2::TokenStream;

/// Items as the formatter writes them.
pub fn format_items(tokens: TokenStream) -> String {
    #[expect(clippy::expect_used, reason = "the emitter's own tokens: a defect here, not in a user's file")]
    let file = syn::parse2(tokens).expect("emitted tokens are valid Rust");
    prettyplease::unparse(&file)
}
