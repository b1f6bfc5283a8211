//! The gallery: every mechanism in `mechanisms`, with its picture. A new file there appears by itself.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use serde_json::Value;

use super::command::{Folder, linkwear};
use super::labels::compare_picture;
use super::{compare_page, stems};

const HEAD: &str = "# Gallery

This page is made from the files in [mechanisms](../../mechanisms): each with its picture by `linkwear draw`, the sentence it begins with, and what `linkwear check` says of it.
`linkwear report FILE -o PAGE.html` makes a page of any of them on which it moves.
";

/// The sentence that a file begins with, in its comment.
fn first_sentence(file: &str) -> String {
    let lines = file.lines().map_while(|line| line.strip_prefix('#')).map(str::trim);
    let paragraph: Vec<&str> = lines.take_while(|line| !line.is_empty()).collect();
    let text = paragraph.join(" ");
    // A stop ends a sentence where a capital follows a word of some length: `P. Flores` goes on.
    let is_end = |&(at, _): &(usize, &str)| {
        let before = text[..at].rsplit([' ', '(']).next().unwrap_or_default();
        before.len() > 2 && text[at + 2..].starts_with(|letter: char| letter.is_uppercase())
    };
    let end = text.match_indices(". ").find(is_end).map_or(text.len(), |(at, _)| at + 1);
    text[..end].to_owned()
}

fn texts(list: &Value) -> Vec<&str> {
    list.as_array().expect("a list").iter().map(|item| item.as_str().expect("a text")).collect()
}

/// Bodies, joints, mobility and what is special, in a line.
fn what_it_is(check: &Value) -> String {
    let mut line =
        format!("{} bodies, {} joints, mobility {}", check["bodies"], check["joints"], check["mobility"]);
    if check["grubler"] != check["mobility"] {
        write!(line, " (by counting {})", check["grubler"]).expect("a text");
    }
    let more = [
        (texts(&check["drivers"]).join(", "), "driven: "),
        (texts(&check["idle"]).join("; "), "idle: "),
        (check["redundant"].as_array().expect("a list").len().to_string(), "redundant rows: "),
        (check["modal_coordinates"].to_string(), "modal coordinates: "),
    ];
    for (what, title) in more.iter().filter(|(what, _)| !what.is_empty() && what != "0") {
        write!(line, "; {title}{what}").expect("a text");
    }
    line
}

#[test]
fn the_gallery_shows_every_shipped_mechanism_as_it_is() {
    let folder = Folder::new("gallery");
    let mut page = HEAD.to_owned();
    let names = stems("mechanisms", "toml");
    for name in &names {
        let file = format!("mechanisms/{name}.toml");
        let check = linkwear(&["check", &file, "--format", "json"]).json();
        let picture = folder.path(&format!("{name}.svg"));
        assert_eq!(linkwear(&["draw", &file, "-o", &picture]).code, 0, "{file}");
        let kept = format!("book/src/images/gallery/{name}.svg");
        compare_picture(Path::new(&kept), &fs::read_to_string(&picture).expect("a picture"));

        let sentence = first_sentence(&fs::read_to_string(&file).expect("a mechanism"));
        writeln!(page, "\n## {name}\n\n{sentence}\n").expect("a text");
        writeln!(page, "![{name}](images/gallery/{name}.svg)\n").expect("a text");
        writeln!(page, "{}. [{file}](../../{file})\n", what_it_is(&check)).expect("a text");
        writeln!(page, "```bash\nlinkwear report {file} -o {name}.html\n```").expect("a text");
    }
    compare_page("book/src/gallery.md", &page);
    assert_eq!(stems("book/src/images/gallery", "svg"), names, "a picture of a mechanism that is gone");
}

#[test]
fn a_sentence_ends_where_the_next_begins() {
    assert_eq!(
        first_sentence("# By A. Flores, in two\n# lines. Then more.\nspec = 1"),
        "By A. Flores, in two lines."
    );
    assert_eq!(first_sentence("# Short\n#\n# More."), "Short");
}
