//! Pictures that are kept (SVG), held against new ones by what is written in them: names and numbers. Colours and strokes may change.

use std::fs;
use std::path::Path;

/// The texts in a picture, in their order.
fn labels(picture: &str) -> Vec<&str> {
    let ends = picture.match_indices("</text>").map(|(at, _)| &picture[..at]);
    ends.map(|before| before.rsplit('>').next().unwrap_or_default()).collect()
}

/// Fails if the kept picture does not say what the new one says; writes the new one if it is asked to.
pub fn compare_picture(kept: &Path, new: &str) {
    if std::env::var_os("LINKWEAR_WRITE_BOOK").is_some() {
        fs::write(kept, new).expect("the picture is written");
    }
    let shown = fs::read_to_string(kept).unwrap_or_default();
    assert!(!labels(new).is_empty(), "{}: nothing is named", kept.display());
    assert!(
        labels(&shown) == labels(new),
        "{} is not what the program draws: LINKWEAR_WRITE_BOOK=1 cargo test --test book --test printed",
        kept.display()
    );
}
