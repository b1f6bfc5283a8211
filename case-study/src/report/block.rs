//! A document as blocks, and how they read in Markdown and in HTML. In: texts. Out: texts. Never knows the study.

use std::fmt::Write as _;

use crate::markup::escaped as safe;

/// A piece of a document. Texts are plain; each form escapes what it has to.
#[derive(Clone, Debug, PartialEq)]
pub enum Block {
    /// A title: 1 for the document, 2 for a part.
    Heading(usize, &'static str),
    /// A paragraph.
    Text(String),
    /// A list of points.
    List(Vec<String>),
    /// A table with its caption.
    Table {
        /// What it shows.
        caption: String,
        /// Titles of the columns.
        head: Vec<String>,
        /// Cells.
        rows: Vec<Vec<String>>,
    },
    /// A figure by the name of its files.
    Figure {
        /// Name without extension.
        name: &'static str,
        /// What it shows.
        caption: String,
    },
}

/// A column of a table: its title, and its cell in the row of an item.
pub type Column<'c, T> = (&'c str, &'c dyn Fn(&T) -> String);

impl Block {
    /// A table with a row for every item.
    pub fn table<T>(
        caption: impl Into<String>,
        items: impl IntoIterator<Item = T>,
        columns: &[Column<'_, T>],
    ) -> Self {
        let row = |item: T| columns.iter().map(|(_, cell)| cell(&item)).collect();
        Self::Table {
            caption: caption.into(),
            head: columns.iter().map(|(title, _)| (*title).to_owned()).collect(),
            rows: items.into_iter().map(row).collect(),
        }
    }
}

/// The document in Markdown; figures are the SVG files beside it.
pub fn markdown(blocks: &[Block]) -> String {
    let mut text = String::new();
    for block in blocks {
        let _ = match block {
            Block::Heading(level, title) => writeln!(text, "{} {}\n", "#".repeat(*level), escaped(title)),
            Block::Text(words) => writeln!(text, "{}\n", escaped(words)),
            Block::List(points) => {
                points.iter().for_each(|point| text.push_str(&format!("- {}\n", escaped(point))));
                writeln!(text)
            }
            Block::Table { caption, head, rows } => {
                let line = |cells: &[String]| {
                    let cells: Vec<String> =
                        cells.iter().map(|cell| escaped(cell).replace('|', "\\|")).collect();
                    format!("| {} |\n", cells.join(" | "))
                };
                let rule = format!("|{}\n", " --- |".repeat(head.len()));
                let body: String = rows.iter().map(|row| line(row)).collect();
                writeln!(text, "**{}**\n\n{}{rule}{body}", escaped(caption), line(head))
            }
            Block::Figure { name, caption } => {
                let caption = escaped(caption);
                writeln!(text, "![{caption}]({name}.svg)\n\n*{caption}*\n")
            }
        };
    }
    format!("{}\n", text.trim_end())
}

/// Signs that Markdown would read as its own.
fn escaped(text: &str) -> String {
    let own = |letter: char| matches!(letter, '*' | '_' | '<' | '[' | ']' | '`');
    text.chars().flat_map(|letter| own(letter).then_some('\\').into_iter().chain([letter])).collect()
}

const STYLE: &str = "\
body { font: 11pt/1.45 Georgia, 'DejaVu Serif', serif; color: #111; max-width: 54rem; margin: 2rem auto; padding: 0 1rem; }
h1, h2 { font-family: 'Helvetica Neue', Arial, 'DejaVu Sans', sans-serif; line-height: 1.2; }
h2 { margin-top: 2.2rem; border-bottom: 1px solid #999; }
table { border-collapse: collapse; margin: .6rem 0 1.4rem; font-size: 9.5pt; }
caption { text-align: left; font-weight: bold; padding-bottom: .3rem; }
th, td { border-bottom: 1px solid #ccc; padding: .15rem .7rem .15rem 0; text-align: left; vertical-align: top; }
th { border-bottom: 2px solid #444; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
th.n { text-align: right; }
figure { margin: 1rem 0 1.6rem; } figure svg { max-width: 100%; height: auto; } figcaption { font-size: 9.5pt; }
@media print { body { margin: 0; max-width: none; font-size: 10pt; } figure, table, tr { break-inside: avoid; } h2 { break-after: avoid; } }
";

/// The document as one page that needs no other file. `svg_of` gives the picture of a figure.
pub fn html<'s>(title: &str, blocks: &[Block], svg_of: &dyn Fn(&str) -> Option<&'s str>) -> String {
    let mut text = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n<style>\n{STYLE}</style>\n</head>\n\
         <body>\n",
        safe(title)
    );
    for block in blocks {
        let _ = match block {
            Block::Heading(level, title) => writeln!(text, "<h{level}>{}</h{level}>", safe(title)),
            Block::Text(words) => writeln!(text, "<p>{}</p>", safe(words)),
            Block::List(points) => {
                let points: String =
                    points.iter().map(|point| format!("<li>{}</li>\n", safe(point))).collect();
                writeln!(text, "<ul>\n{points}</ul>")
            }
            Block::Table { caption, head, rows } => {
                let title = |(column, title): (usize, &String)| {
                    let numbers = rows.iter().filter(|row| is_number(&row[column])).count();
                    format!("<th{}>{}</th>", class(2 * numbers > rows.len()), safe(title))
                };
                let cell = |cell: &String| format!("<td{}>{}</td>", class(is_number(cell)), safe(cell));
                let line =
                    |row: &Vec<String>| format!("<tr>{}</tr>\n", row.iter().map(cell).collect::<String>());
                let head: String = head.iter().enumerate().map(title).collect();
                let body: String = rows.iter().map(line).collect();
                let caption = safe(caption);
                writeln!(text, "<table>\n<caption>{caption}</caption>\n<tr>{head}</tr>\n{body}</table>")
            }
            Block::Figure { name, caption } => {
                let picture = svg_of(name).unwrap_or_default();
                writeln!(text, "<figure>\n{picture}<figcaption>{}</figcaption>\n</figure>", safe(caption))
            }
        };
    }
    text.push_str("</body>\n</html>\n");
    text
}

/// The class of cells with numbers, and of the titles above most of them.
fn class(of_numbers: bool) -> &'static str {
    if of_numbers { " class=\"n\"" } else { "" }
}

fn is_number(cell: &str) -> bool {
    cell.trim_start_matches(['+', '-', '−', '±', ' ']).starts_with(|letter: char| letter.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blocks() -> Vec<Block> {
        vec![
            Block::Heading(2, "F_n < 3 & more"),
            Block::table("A table", [-1.5], &[("name", &|_| "a|b".into()), ("value", &f64::to_string)]),
            Block::Figure { name: "fig", caption: "A figure".into() },
        ]
    }

    #[test]
    fn markdown_shows_signs_as_they_are() {
        let text = markdown(&blocks());
        assert!(text.starts_with("## F\\_n \\< 3 & more\n"), "{text}");
        assert!(text.contains("| name | value |\n| --- | --- |\n| a\\|b | -1.5 |\n"), "{text}");
        assert!(text.contains("![A figure](fig.svg)"), "{text}");
    }

    #[test]
    fn a_page_holds_its_pictures_and_needs_nothing_else() {
        let text = html("T", &blocks(), &|name| (name == "fig").then_some("<svg></svg>\n"));
        assert!(text.contains("<h2>F_n &lt; 3 &amp; more</h2>"), "{text}");
        assert!(text.contains("<th>name</th><th class=\"n\">value</th>"), "{text}");
        assert!(text.contains("<td>a|b</td><td class=\"n\">-1.5</td>"), "{text}");
        assert!(text.contains("<svg></svg>\n<figcaption>A figure"), "{text}");
        assert!(!text.contains("<script") && !text.contains("src="));
    }
}
