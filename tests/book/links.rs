//! Links within the repository: the file is there, and the heading. The book's own links are the same, rewritten by book/build.sh.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use super::stems;

/// Text without fenced blocks and without code in lines, where brackets mean something else.
fn prose(text: &str) -> String {
    let (mut prose, mut is_code) = (String::new(), false);
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            is_code = !is_code;
        } else if !is_code {
            let parts = line.split('`').step_by(2);
            prose.extend(parts.flat_map(|part| [part, "`"]));
            prose.push('\n');
        }
    }
    prose
}

/// Targets of links and pictures.
fn targets(text: &str) -> Vec<String> {
    let prose = prose(text);
    let starts = prose.match_indices("](").map(|(at, _)| &prose[at + 2..]);
    starts.filter_map(|rest| Some(rest.split_once(')')?.0.to_owned())).collect()
}

/// A heading as the end of an address, as GitHub and mdBook make it.
fn anchor(heading: &str) -> String {
    // Of a link only its text counts.
    let heading = heading.trim().replace("](", "\u{0}");
    let without_target = heading
        .split('\u{0}')
        .enumerate()
        .map(|(part, text)| if part == 0 { text } else { text.split_once(')').map_or("", |(_, rest)| rest) });
    let text: String = without_target.collect();
    let kept = text.chars().filter(|letter| letter.is_alphanumeric() || " -_".contains(*letter));
    kept.map(|letter| if letter == ' ' { '-' } else { letter }).collect::<String>().to_lowercase()
}

/// Anchors of a page's headings; of equal ones the second has -1 behind.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut is_code = false;
    for line in text.lines() {
        is_code ^= line.trim_start().starts_with("```");
        let Some(heading) = line.strip_prefix('#').filter(|_| !is_code) else { continue };
        let anchor = anchor(heading.trim_start_matches('#'));
        let numbered = (1..).map(|number| format!("{anchor}-{number}"));
        let free = std::iter::once(anchor.clone()).chain(numbered).find(|name| !found.contains(name));
        found.extend(free);
    }
    found
}

/// What is wrong with the links of a page.
fn dead_links(page: &str) -> Vec<String> {
    let text = fs::read_to_string(page).expect("a page");
    let folder = Path::new(page).parent().expect("a folder");
    let mut dead = Vec::new();
    for target in targets(&text) {
        if target.contains("://") || target.starts_with("mailto:") || target.contains("{{") {
            continue;
        }
        let (file, heading) = target.split_once('#').unwrap_or((&target, ""));
        let path = if file.is_empty() { Path::new(page).to_owned() } else { folder.join(file) };
        let is_there = if heading.is_empty() || path.extension().is_none_or(|extension| extension != "md") {
            path.exists()
        } else {
            fs::read_to_string(&path).is_ok_and(|text| anchors(&text).contains(heading))
        };
        if !is_there {
            dead.push(format!("{page}: {target}"));
        }
    }
    dead
}

fn pages() -> Vec<String> {
    let mut pages: Vec<String> =
        ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "python/README.md"].map(String::from).into();
    for folder in ["docs", "book/src", "book/src/cookbook"] {
        pages.extend(stems(folder, "md").into_iter().map(|stem| format!("{folder}/{stem}.md")));
    }
    pages
}

#[test]
fn every_link_leads_to_a_file_and_a_heading() {
    let dead: Vec<String> = pages().iter().flat_map(|page| dead_links(page)).collect();
    assert!(dead.is_empty(), "{dead:#?}");
}

#[test]
fn files_that_pages_include_are_there() {
    for page in pages() {
        let text = fs::read_to_string(&page).expect("a page");
        let includes = text.match_indices("{{#include ").map(|(at, start)| &text[at + start.len()..]);
        for name in includes.filter_map(|rest| Some(rest.split_once("}}")?.0)) {
            // Behind a colon stand lines.
            let name = name.split(':').next().unwrap_or_default();
            assert!(Path::new(&page).parent().expect("a folder").join(name).is_file(), "{page}: {name}");
        }
    }
}

/// mdBook leaves out a page that the summary does not have; pages of docs are added by book/build.sh.
#[test]
fn every_page_of_the_book_is_in_the_summary() {
    let summary = fs::read_to_string("book/src/SUMMARY.md").expect("the summary");
    let listed: BTreeSet<String> = targets(&summary).into_iter().collect();
    let of = |folder: &str, prefix: &str| -> Vec<String> {
        stems(folder, "md").into_iter().map(|stem| format!("{prefix}{stem}.md")).collect()
    };
    let pages = [of("book/src", ""), of("book/src/cookbook", "cookbook/")].concat();
    for page in pages.iter().filter(|page| *page != "SUMMARY.md") {
        assert!(listed.contains(page), "{page} is not in book/src/SUMMARY.md");
    }
}

#[test]
fn a_dead_link_is_found() {
    assert_eq!(targets("[a](b.md) `[c](d)` ![e](f.svg)"), ["b.md", "f.svg"]);
    assert_eq!(anchor(" `life --out`, and [more](x.md)"), "life---out-and-more");
    assert!(anchors("# A b\n## A b\n```\n# no\n```").iter().eq(["a-b", "a-b-1"]));
}
