//! `fit`: data that cannot be read as they are meant, with their line, the cause and the cure.

use crate::command::{Folder, linkwear};
use serde_json::Value;

const COLUMNS: [&str; 6] = ["--unit", "unit", "--wear", "w", "--exposure", "h"];

/// A good table that wrong ones are made of.
const GOOD: &str = "unit,h,w\na,0,0\na,1,1\na,2,2.5\nb,0,0\nb,1,0.7\nb,2,1.9\n";

fn fit(bytes: &[u8], more: &[&str]) -> crate::command::Answer {
    let folder = Folder::new("fit-errors");
    let file = folder.path("data.csv");
    std::fs::write(&file, bytes).expect("a file");
    linkwear(&[&["fit", &file], &COLUMNS[..], more, &["--format", "json"]].concat())
}

/// The one error: message and help, and the line.
fn refused(bytes: &[u8], more: &[&str]) -> (String, Option<u64>) {
    let answer = fit(bytes, more);
    assert_eq!(answer.code, 1, "{}", answer.out);
    let error = answer.errors()[0].clone();
    let text = |key: &str| error[key].as_str().expect("a text").to_owned();
    (format!("{}; {}", text("message"), text("help")), error["line"].as_u64())
}

#[test]
fn the_line_of_a_row_is_that_of_its_first_letter() {
    for (name, table, line) in [
        ("comments before a bad cell", "# c\n\nunit,h,w\n# one\n\na,0,0\n\n# two\n# three\na,1,x\n", 10),
        ("comments before wear that falls", "unit,h,w\n# c\na,0,0\na,1,1\n# d\n\na,2,0.5\nb,0,0\nb,1,1\n", 7),
        ("empty lines before a short row", "unit,h,w\na,0,0\n\n   \na,1\n", 5),
        ("a row of two lines before", "unit,\"h\",w,\"a\nnote\"\na,0,0,\"of\ntwo\"\n# c\n\na,1,x,none\n", 7),
        ("line ends of other systems", "unit,h,w\r\n# c\r\n\r\na,0,0\r\n\r\na,1,x\r\n", 6),
        ("a lone carriage return", "unit,h,w\ra,0,0\r\ra,1,x\r", 4),
        ("a column that is missing", "# c\n\n# d\nunit,h\n", 4),
    ] {
        assert_eq!(refused(table.as_bytes(), &[]).1, Some(line), "{name}");
    }
}

#[test]
fn causes_and_cures_of_tables_from_elsewhere_are_told() {
    let replaced = |from: &str, to: &str| GOOD.replace(from, to).into_bytes();
    let utf16: Vec<u8> = "\u{feff}unit,h,w\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    let semicolons = GOOD.replace(',', ";").replace('.', ",");
    for (table, line, words) in [
        (replaced("b,0", ",0"), 5, ["`unit` is empty", "write a name"]),
        (replaced("b,", "b\0,"), 5, ["control character (U+0000)", "delete the character"]),
        (replaced("a,1,1", "a,1,\"1,000\""), 3, ["nobody knows", "`1000` if it parts thousands, `1.000` if"]),
        (semicolons.into_bytes(), 4, ["decimal commas", "write the file with commas, and decimal points"]),
        ([b"unit,h,w\na,0,0\nt", &b"\xfcr,0,0\n"[..]].concat(), 3, ["not UTF-8", "save it as UTF-8"]),
        (utf16, 1, ["UTF-16", "save it as UTF-8"]),
    ] {
        let (text, found) = refused(&table, &[]);
        assert!(words.iter().all(|words| text.contains(words)), "{text}");
        assert_eq!(found, Some(line), "{text}");
    }
    // A column of groups names things, too.
    let (text, line) = refused(b"unit,h,w,g\na,0,0,x\na,1,1,\n", &["--groups", "g"]);
    assert!(text.contains("`g` is empty") && line == Some(3), "{text}");
}

#[test]
fn rows_that_are_taken_as_comments_are_counted() {
    let (text, _) = refused(GOOD.replace("\na", "\n#a").replace("\nb", "\n#b").as_bytes(), &[]);
    assert!(text.contains("6 line(s)") && text.contains("begin with #") && text.contains("quotes"), "{text}");
    let (text, _) = refused(b"unit,h,w\n# nothing, as yet, today\n", &[]);
    assert!(text.contains("only a header"), "{text}");
    let warned = |table: &str| fit(table.as_bytes(), &[]).json()["warnings"].to_string();
    let more = GOOD.replace("b,", "c,").replace("unit,h,w\n", "");
    let some = format!("{GOOD}{}", more.replace("a,", "#a,"));
    assert!(warned(&some).contains("3 line(s) that look like readings"), "{}", warned(&some));
    assert_eq!(warned(&format!("# of 3, in um, by 2\n{GOOD}# so far, so good, no 3\n")), "[]");
}

#[test]
fn a_parameter_that_runs_off_is_one_that_is_sought() {
    // All wear within the last span: the larger the exponent, the better.
    let units = [9, 4, 14, 7]
        .map(|wear| format!("{wear},0,0\n{wear},1,0\n{wear},2,0\n{wear},3,0\n{wear},4,{wear}\n"));
    let late = format!("unit,h,w\n{}", units.concat());
    let (text, _) = refused(late.as_bytes(), &["--power-law", "--resolution", "1"]);
    assert!(text.contains("runs off, perhaps the exponent (--power-law)"), "{text}");
    let huge = GOOD
        .replace(".5", ".5e150")
        .replace(",1\n", ",1e150\n")
        .replace("0.7", "7e149")
        .replace("1.9", "1.9e150");
    let (text, _) = refused(huge.as_bytes(), &["--process", "inverse-gaussian"]);
    assert!(!text.contains("exponent") && text.contains("1e100") && text.contains("convert"), "{text}");
}

#[test]
fn a_fit_of_another_format_is_refused_by_its_readers() {
    let folder = Folder::new("fit-format");
    let file = folder.write("fit.json", "{\n\"format\": 99,\n\"alpha\": 1,\n\"beta\": 1\n}\n");
    for command in [&["predict", &file][..], &["plan", &file, "--preventive", "1", "--failure", "9"]] {
        let answer = linkwear(&[command, &["--threshold", "10", "--format", "json"]].concat());
        let error: Value = answer.errors()[0].clone();
        assert_eq!((answer.code, error["line"].as_u64()), (1, Some(2)), "{error}");
        assert!(error["message"].as_str().expect("a text").contains("reads fits of format 1"), "{error}");
    }
}

#[test]
fn wear_that_does_not_grow_and_wear_on_a_line_are_told_apart() {
    let falls = b"unit,h,w\na,1,4\na,2,2\na,3,1\nb,1,1\nb,2,-2.5\n";
    let (text, _) = refused(falls, &["--process", "wiener"]);
    assert!(text.contains("does not grow on average") && text.contains("sign of wear"), "{text}");
    let line = b"unit,h,w\na,0,0\na,1,1\na,2,2\nb,0,0\nb,1,1\nb,2,2\n";
    // Processes have other parameters than alpha.
    for process in ["gamma", "wiener", "inverse-gaussian"] {
        let (text, _) = refused(line, &["--process", process]);
        assert!(text.contains("without any scatter") && !text.contains("alpha"), "{process}: {text}");
    }
}

#[test]
fn so_few_replicates_that_no_interval_follows_are_refused_before_the_fit() {
    // No fit of these readings is made.
    let line = b"unit,h,w\na,0,0\na,1,1\na,2,2\nb,0,0\nb,1,1\nb,2,2\n";
    for few in ["1", "39"] {
        let answer = fit(line, &["--bootstrap", few]);
        assert_eq!((answer.code, answer.errors()[0]["code"].as_str()), (2, Some("C0001")));
        assert!(answer.out.contains("give 40 or more"), "{}", answer.out);
    }
    assert_eq!(fit(GOOD.as_bytes(), &["--bootstrap", "40"]).code, 0);
}
