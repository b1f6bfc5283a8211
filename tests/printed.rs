//! The README, the pages of docs and the book show what the program prints, and nothing else.
//!
//! A block that shows a command with its output is a `console` block: `$ linkwear ..`, then what comes out on stdout, or on
//! stderr where the command fails, or warnings and stdout where the block begins with a warning. A line `...` stands for any lines. Masked is the time that a run took, `in 1.574 s`,
//! and nothing else. The commands of a document run in one folder, in their order; those of `sh` blocks run too, unless they
//! have a placeholder such as FILE: these are listed below. Pages of the book run beside the files of book/src/mechanisms, and
//! what they draw is held against book/src/images, label by label.

mod command;
#[path = "support/labels.rs"]
mod labels;

use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use command::Folder;
use labels::compare_picture;

/// Commands of the documents that are not run, with the reason.
const NOT_RUN: [(&str, &str); 3] = [
    (
        "linkwear life FILE --mean --format json > life.json",
        "any mechanism that wears; tests/cli/fit.rs goes this way with a mean path",
    ),
    (
        "linkwear fit WEAR.csv --unit unit --wear wear_um --exposure cycles --lambda life.json --out fit.json",
        "the reader's own readings",
    ),
    ("linkwear life FILE --fit fit.json", "the mechanism and the readings before"),
];

/// A command and the output that a document shows; none for a command alone.
struct Shown {
    place: String,
    command: String,
    output: Option<Vec<String>>,
}

/// A fenced block: language, line of the fence from 1, lines within.
type Block<'t> = (&'t str, usize, Vec<&'t str>);

fn blocks<'t>(text: &'t str, document: &str) -> Vec<Block<'t>> {
    let (mut blocks, mut open) = (Vec::new(), None::<Block>);
    for (at, line) in text.lines().enumerate() {
        match (&mut open, line.trim_start().strip_prefix("```")) {
            (None, Some(language)) => open = Some((language, at + 1, Vec::new())),
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (Some((.., lines)), None) => lines.push(line),
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "{document}: a fence is not closed");
    blocks
}

fn shown(document: &str) -> Vec<Shown> {
    let text = fs::read_to_string(document).expect("a document");
    let mut all = Vec::new();
    for (language, line, lines) in blocks(&text, document) {
        let place = format!("{document}:{line}");
        match language {
            "console" => {
                assert!(
                    lines[0].starts_with("$ linkwear "),
                    "{place}: a console block begins with its command"
                );
                for line in lines {
                    match (line.strip_prefix("$ "), all.last_mut()) {
                        (Some(command), _) => all.push(Shown {
                            place: place.clone(),
                            command: command.to_owned(),
                            output: Some(Vec::new()),
                        }),
                        (None, Some(Shown { output: Some(output), .. })) => output.push(line.to_owned()),
                        (None, _) => panic!("{place}: `{line}` belongs to no command"),
                    }
                }
            }
            "sh" => all.extend(lines.into_iter().filter(|line| is_whole(line)).map(|line| Shown {
                place: place.clone(),
                command: line.to_owned(),
                output: None,
            })),
            _ => {}
        }
    }
    all
}

/// A command of ours without a placeholder, which would be in capitals.
fn is_whole(line: &str) -> bool {
    let is_placeholder = |word: &str| {
        let stem = word.split('.').next().unwrap_or(word);
        stem.len() > 1 && stem.chars().all(|letter| letter.is_ascii_uppercase())
    };
    line.starts_with("linkwear ") && !line.contains('>') && !line.split(' ').any(is_placeholder)
}

/// Words of a command line, double quotes holding words together.
fn words(command: &str) -> Vec<String> {
    let (mut words, mut is_quoted) = (vec![String::new()], false);
    for letter in command.chars() {
        match letter {
            '"' => is_quoted = !is_quoted,
            ' ' if !is_quoted => words.push(String::new()),
            _ => words.last_mut().expect("one at least").push(letter),
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// The line with the time that a run took as `in _ s`, and machine code in the place of what serves without.
fn masked(line: &str) -> String {
    let line = &["; compiled", ", compiled"].iter().fold(line.to_owned(), |line, serves| {
        let native = serves.replace("compiled", "native");
        line.strip_suffix(serves).map(|before| format!("{before}{native}")).unwrap_or(line)
    });
    let Some((before, rest)) = line.split_once(" in ") else { return line.trim_end().to_owned() };
    let time = rest.split_once(' ').filter(|(number, _)| number.parse::<f64>().is_ok());
    let unit = time.and_then(|(_, rest)| rest.strip_prefix("ms").or_else(|| rest.strip_prefix('s')));
    match unit.filter(|rest| rest.is_empty() || rest.starts_with(',')) {
        Some(rest) => format!("{before} in _ s{rest}"),
        None => line.trim_end().to_owned(),
    }
}

/// Whether an excerpt is one of these lines; otherwise the first of its lines that is not there.
fn found(excerpt: &[String], lines: &[String]) -> Result<(), String> {
    let mut parts = excerpt.split(|line| line == "...").peekable();
    let (mut at, mut is_anywhere) = (0, false);
    while let Some(part) = parts.next() {
        let fits = |at: usize| lines[at..].starts_with(part);
        let last = if is_anywhere { lines.len().saturating_sub(part.len()) } else { at };
        // The last part of an excerpt without dots behind it stands at the end.
        let places = if parts.peek().is_none() && is_anywhere { last.max(at)..=last } else { at..=last };
        let Some(place) = places.into_iter().find(|at| fits(*at)) else {
            let first = part.iter().find(|line| !lines[at..].contains(line)).or(part.first());
            return Err(first.cloned().unwrap_or_default());
        };
        (at, is_anywhere) = (place + part.len(), true);
    }
    if at == lines.len() { Ok(()) } else { Err(format!("(nothing, where there is) {}", lines[at])) }
}

/// Runs what a document shows; returns how many outputs were compared.
fn compare(document: &str) -> usize {
    let folder = Folder::new(&format!("printed-{}", document.replace(['/', '.'], "-")));
    for part in ["mechanisms", "examples"] {
        let target = fs::canonicalize(part).expect("a folder of the repository");
        std::os::unix::fs::symlink(target, folder.path(part)).expect("a link");
    }
    if is_of_book(document) {
        for entry in fs::read_dir("book/src/mechanisms").expect("mechanisms of the book") {
            let file = fs::canonicalize(entry.expect("an entry").path()).expect("a file");
            let name = file.file_name().and_then(|name| name.to_str()).expect("UTF-8").to_owned();
            std::os::unix::fs::symlink(&file, folder.path(&name)).expect("a link");
        }
    }
    let mut compared = 0;
    for Shown { place, command, output } in shown(document) {
        let words = words(&command);
        let arguments: Vec<&str> = words[1..].iter().map(String::as_str).collect();
        let answer = folder.linkwear(&arguments);
        let Some(expected) = output else {
            assert_eq!(answer.code, 0, "{place}: `{command}` fails:\n{}", answer.err);
            continue;
        };
        let shows_warnings = expected.first().is_some_and(|line| line.starts_with("warning["));
        let printed = match answer.code {
            0 if shows_warnings => &(answer.err + &answer.out),
            0 => {
                assert!(!answer.err.contains("warning"), "{place}: hides {}", answer.err);
                &answer.out
            }
            _ => &answer.err,
        };
        let [expected, lines]: [Vec<String>; 2] = [
            expected.iter().map(|line| masked(line)).collect(),
            printed.trim_end().lines().map(masked).collect(),
        ];
        if let Err(line) = found(&expected, &lines) {
            panic!("{place}: `{command}` does not print\n{line}\nbut\n{printed}");
        }
        compared += 1;
    }
    for name in folder.names().iter().filter(|name| is_of_book(document) && name.ends_with(".svg")) {
        compare_picture(Path::new("book/src/images").join(name).as_path(), &folder.read(name));
    }
    compared
}

fn is_of_book(document: &str) -> bool {
    document.starts_with("book/")
}

/// All pages by two threads: each command waits for one core most of the time. Those of `docs` begin, whose commands are the longest.
#[test]
fn readme_docs_and_book_show_what_the_program_prints() {
    let pages: Vec<String> = documents().into_iter().rev().collect();
    let (next, compared) = (AtomicUsize::new(0), [const { AtomicUsize::new(0) }; 2]);
    let work = || {
        while let Some(page) = pages.get(next.fetch_add(1, Ordering::Relaxed)) {
            compared[usize::from(is_of_book(page))].fetch_add(compare(page), Ordering::Relaxed);
        }
    };
    std::thread::scope(|scope| {
        [scope.spawn(work), scope.spawn(work)].map(|thread| thread.join().expect("a page"))
    });
    let [others, of_book] = compared.map(AtomicUsize::into_inner);
    assert!(others >= 20 && of_book >= 10, "{others} {of_book}");
}

#[test]
fn commands_that_are_not_run_are_listed_with_a_reason() {
    let mut left_out = Vec::new();
    for document in documents() {
        let text = fs::read_to_string(&document).expect("a document");
        let lines = blocks(&text, &document).into_iter().filter(|(language, ..)| *language == "sh");
        let ours = lines.flat_map(|(.., lines)| lines).filter(|line| line.starts_with("linkwear "));
        left_out.extend(ours.filter(|line| !is_whole(line)).map(str::to_owned));
    }
    assert_eq!(left_out, NOT_RUN.map(|(command, _)| command));
}

/// README, the pages of docs and those of the book.
fn documents() -> Vec<String> {
    let folders = ["docs", "book/src", "book/src/cookbook"];
    let files = folders.into_iter().flat_map(|folder| fs::read_dir(folder).expect("a folder of pages"));
    let pages = files.map(|entry| entry.expect("an entry").path());
    let pages = pages.filter(|path| path.extension().is_some_and(|extension| extension == "md"));
    let mut pages: Vec<String> = pages.map(|path| path.to_str().expect("UTF-8").to_owned()).collect();
    pages.sort();
    pages.insert(0, "README.md".to_owned());
    pages
}

/// Else an output could hide in a block of plain text, which nothing compares.
#[test]
fn output_of_commands_stands_in_console_blocks() {
    for document in &documents() {
        let text = fs::read_to_string(document).expect("a document");
        let lines: Vec<&str> = text.lines().collect();
        for (language, line, _) in blocks(&text, document) {
            let before = lines[..line - 1].iter().rev().skip_while(|line| line.is_empty());
            let mut paragraph = before.take_while(|line| !line.is_empty());
            let is_output =
                ["", "text"].contains(&language) && paragraph.any(|line| line.contains("`linkwear "));
            assert!(!is_output, "{document}:{line}: output of a command belongs into a console block");
        }
    }
}

#[test]
fn an_excerpt_leaves_lines_out_only_where_it_says_so() {
    let lines = |text: &str| -> Vec<String> { text.split(' ').map(str::to_owned).collect() };
    let printed = lines("a b c d e");
    for excerpt in ["a b c d e", "... e", "a ...", "a ... c ... e", "... b c ..."] {
        assert_eq!(found(&lines(excerpt), &printed), Ok(()), "{excerpt}");
    }
    for excerpt in ["a b c d", "b ...", "... d", "a ... x ...", "... c b ...", "a c ..."] {
        assert!(found(&lines(excerpt), &printed).is_err(), "{excerpt}");
    }
    assert_eq!(masked("5 turns (2.500 s) in 1.574 s, compiled"), "5 turns (2.500 s) in _ s, native");
    assert_eq!(masked("wear in 3 steps"), "wear in 3 steps");
}
