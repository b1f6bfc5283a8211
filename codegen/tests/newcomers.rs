//! Wrong files: each answer has its code, its place and the cure in one reading. `wrong_inputs.toml` lists them, the
//! mistakes that newcomers made with a first slider-crank among them.

use linkwear_codegen::compile::{Options, compile};
use linkwear_codegen::diagnostic::Diagnostics;
use linkwear_codegen::source::SourceFile;
use toml::{Table, Value};

const INPUTS: &str = include_str!("wrong_inputs.toml");

fn table(key: &str) -> Table {
    let inputs: Table = INPUTS.parse().expect("TOML");
    inputs[key].as_table().expect("a table").clone()
}

/// A file that is right.
fn right(name: &str) -> String {
    table("right")[name].as_str().expect("a text").to_owned()
}

fn answer(text: &str, overrides: &[(&str, &str)]) -> Diagnostics {
    let source = SourceFile { name: "press.toml".into(), text: text.into() };
    let overrides = overrides.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect();
    match compile(&source, &Options { overrides, ..Options::default() }) {
        Ok(compiled) => Diagnostics::from_list(compiled.warnings).located(&source),
        Err(errors) => errors,
    }
}

#[test]
fn right_files_are_taken_without_a_word() {
    for name in table("right").keys() {
        assert_eq!(answer(&right(name), &[]).to_string(), "", "{name}");
    }
}

#[test]
fn every_value_that_is_set_wrong_leads_to_its_cure() {
    for value in table("set")["press"].as_array().expect("a list") {
        let texts: Vec<&str> = value.as_array().expect("a list").iter().filter_map(Value::as_str).collect();
        let [code, name, given, cure] = texts[..] else { panic!("{value}") };
        let answer = answer(&right("press"), &[(name, given)]);
        let told = answer.entries().iter().any(|entry| entry.code == code && entry.help.contains(cure));
        assert!(told, "{value}: this is not in\n{answer}");
    }
}

/// Each line: code, line of the file, what is written for what (once), a phrase of the cure.
#[test]
fn every_mistake_leads_to_its_cure() {
    let (mut failures, mut asked) = (Vec::new(), 0);
    for (name, mistakes) in table("wrong") {
        let file = right(&name);
        for mistake in mistakes.as_array().expect("a list") {
            let texts: Vec<&str> =
                mistake.as_array().expect("a list").iter().filter_map(Value::as_str).collect();
            let [code, found, written, cure] = texts[..] else { panic!("{mistake}") };
            let line = mistake[1].as_integer();
            assert!(file.contains(found), "{name}: {found}");
            let answer = answer(&file.replacen(found, written, 1), &[]);
            let told = answer.entries().into_iter().any(|entry| {
                entry.code == code && Some(entry.line as i64) == line && entry.help.contains(cure)
            });
            if !told {
                failures.push(format!("{mistake}: this is not in\n{answer}"));
            }
            asked += 1;
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n\n"));
    assert!(asked >= 200, "{asked}");
}

#[test]
fn a_misspelt_kind_of_joint_is_one_mistake() {
    let misspelt = right("press")
        .replace("pin = { revolute =", "pin = { hinge =")
        .replace("R1 = { revolute =", "R1 = { hinge =");
    let initial = format!("{misspelt}\n[initial]\nR1 = \"0 deg\"\n");
    for text in [misspelt, initial] {
        let answer = answer(&text, &[]);
        let codes: Vec<_> = answer.entries().iter().map(|entry| entry.code).collect();
        assert_eq!(codes, ["E0104", "E0104"], "{answer}");
    }
}

/// What stands after `words` in an advice: a quantity in quotes, or a number.
fn literal<'h>(help: &'h str, words: &str) -> Option<&'h str> {
    let rest = help.split_once(words)?.1;
    match rest.strip_prefix('"') {
        Some(quoted) => Some(&rest[..quoted.find('"')? + 2]),
        None => rest.split([' ', ',', '`']).next().filter(|word| word.parse::<f64>().is_ok()),
    }
}

/// The text with each quantity in quotes and each number in turn replaced.
fn replaced(text: &str, by: &str) -> Vec<String> {
    let mut places: Vec<(usize, usize)> = Vec::new();
    let quotes: Vec<usize> = text.match_indices('"').map(|(at, _)| at).collect();
    places.extend(quotes.chunks_exact(2).map(|pair| (pair[0], pair[1] + 1)));
    let mut at = 0;
    for word in text.split_inclusive([' ', ',', '[', ']', '{', '}']) {
        let number = word.trim_end_matches([' ', ',', '[', ']', '{', '}']);
        if number.parse::<f64>().is_ok() {
            places.push((at, at + number.len()));
        }
        at += word.len();
    }
    places.into_iter().map(|(from, to)| format!("{}{by}{}", &text[..from], &text[to..])).collect()
}

#[test]
fn an_advised_quantity_is_taken_where_the_wrong_one_stood() {
    let mut followed = 0;
    for value in table("set")["press"].as_array().expect("a list") {
        let texts: Vec<&str> = value.as_array().expect("a list").iter().filter_map(Value::as_str).collect();
        let [code, name, given, _] = texts[..] else { panic!("{value}") };
        for entry in answer(&right("press"), &[(name, given)]).entries() {
            let Some(advised) = literal(&entry.help, &format!("--set {name}=")) else { continue };
            let after = answer(&right("press"), &[(name, advised.trim_matches('"'))]);
            assert!(after.entries().iter().all(|entry| entry.code != code), "{value}: {advised}\n{after}");
            followed += 1;
        }
    }
    assert!(followed >= 8, "{followed}");
    let mut followed = 0;
    for (name, mistakes) in table("wrong") {
        let file = right(&name);
        for mistake in mistakes.as_array().expect("a list") {
            let texts: Vec<&str> =
                mistake.as_array().expect("a list").iter().filter_map(Value::as_str).collect();
            let [code, found, written, _] = texts[..] else { panic!("{mistake}") };
            let wrong = answer(&file.replacen(found, written, 1), &[]).entries();
            // Several at once are several quantities.
            let told: Vec<_> = wrong.iter().filter(|entry| entry.code == code).collect();
            let [entry] = told[..] else { continue };
            let advised = |words: &str| literal(&entry.help, words);
            let Some(advised) = advised("something like ").or_else(|| advised("the unit that is meant: "))
            else {
                continue;
            };
            let is_taken = replaced(written, advised).iter().any(|written| {
                let after = answer(&file.replacen(found, written, 1), &[]).entries();
                after.iter().all(|entry| entry.code != code)
            });
            assert!(is_taken, "{mistake}: {advised} is refused too");
            followed += 1;
        }
    }
    assert!(followed >= 10, "{followed}");
}

#[test]
fn a_crank_that_is_too_long_is_told_where_it_ends() {
    // Without clearance: what holds it is kinematics.
    let ideal = right("press").split("[clearance.pin]").next().unwrap_or_default().replace("40 mm", "170 mm");
    let answer = answer(&ideal, &[]);
    // The rod stands across the guide where sin(phi) = 160/170.
    let entry = answer.entries().into_iter().find(|entry| entry.code == "W0116").expect("it cannot turn");
    assert!(entry.message.contains("turns only to 70.2 deg"), "{answer}");
}

#[test]
fn an_override_keeps_the_unit_of_the_file_and_turns_are_no_radians() {
    let wrong = |value: &str| {
        let entries = answer(&right("press"), &[("speed", value)]).entries();
        entries.into_iter().map(|entry| (entry.code, entry.help)).next()
    };
    let (code, help) = wrong("10").expect("an error");
    assert!(code == "E0304" && help.contains("--set speed=\"10 rpm\""), "{code} {help}");
    let (code, help) = wrong("10 rad/s").expect("an error");
    assert!(code == "E0303" && help.contains("a turn is 2*pi rad"), "{code} {help}");
    assert_eq!(wrong("5 Hz"), None);
    assert_eq!(wrong("5 1/s"), None);
}

#[test]
fn a_warning_is_switched_off_by_its_code() {
    let odd = right("press").replacen("steel = \"7850", "steel = \"7.85", 1);
    assert!(answer(&odd, &[]).entries().iter().all(|entry| entry.code == "W0113"));
    assert_eq!(answer(&format!("{odd}\n[check]\nallow = [\"W0113\"]\n"), &[]).to_string(), "");
}
