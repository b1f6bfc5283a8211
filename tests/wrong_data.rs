//! Wrong files of data: each answer has its code, its place, what is wrong and the cure in one reading. `wrong_data.toml` lists
//! them; mechanisms have `codegen/tests/wrong_inputs.toml`.

mod command;

use std::fs;

use command::{Answer, Folder, linkwear};
use toml::{Table, Value};

fn inputs() -> Table {
    include_str!("wrong_data.toml").parse().expect("TOML")
}

fn texts(value: &Value) -> Vec<&str> {
    value.as_array().expect("a list").iter().filter_map(Value::as_str).collect()
}

struct Kind {
    folder: Folder,
    name: String,
    command: Vec<String>,
    right: String,
}

impl Kind {
    fn new(inputs: &Table, name: &str) -> Self {
        let folder = Folder::new(&format!("wrong-{name}"));
        let right = |name: &str| inputs["right"].get(name).and_then(Value::as_str).map(str::trim_start);
        let modal = || fs::read_to_string("tests/data/slider_crank_rod.toml").expect("modal data");
        let mechanism = fs::read_to_string("tests/data/flexible_slider_crank.toml").expect("a mechanism");
        folder.write("mechanism.toml", &mechanism.replace("slider_crank_rod.toml", "input"));
        folder.write("fit", right("fit").expect("a fit"));
        let command = texts(&inputs["command"][name]).into_iter().map(str::to_owned).collect();
        Self { name: name.to_owned(), command, right: right(name).map_or_else(modal, str::to_owned), folder }
    }

    fn ask(&self, text: &str, options: &[&str]) -> Answer {
        let input = self.folder.write("input", text);
        let (fit, mechanism) = (self.folder.path("fit"), self.folder.path("mechanism.toml"));
        let word = |word: &String| match word.as_str() {
            "INPUT" => input.clone(),
            "FIT" => fit.clone(),
            "MODAL" => mechanism.clone(),
            other => other.to_owned(),
        };
        let words: Vec<String> = self.command.iter().map(word).collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        linkwear(&[&words[..], options, &["--format", "json"]].concat())
    }
}

#[test]
fn every_mistake_in_data_leads_to_its_cure() {
    let inputs = inputs();
    let (mut failures, mut asked) = (Vec::new(), 0);
    for (name, mistakes) in inputs["wrong"].as_table().expect("a table") {
        let kind = Kind::new(&inputs, name);
        let answer = kind.ask(&kind.right, &[]);
        assert_eq!(answer.code, 0, "{}: {}", kind.name, answer.out);
        for mistake in mistakes.as_array().expect("a list") {
            let row = texts(mistake);
            let [code, found, written, cause, cure] = row[..5] else { panic!("{mistake}") };
            let line = mistake[1].as_integer().filter(|line| *line > 0);
            assert!(kind.right.contains(found), "{name}: {found}");
            let answer = kind.ask(&kind.right.replacen(found, written, 1), &row[5..]);
            let told = answer.code == 1
                && answer.errors().iter().any(|error| {
                    let text = |key: &str| error[key].as_str().unwrap_or_default();
                    // Where the cause is the cure, the message has both.
                    let has_cure = text("help").contains(cure) || text("message").contains(cure);
                    let has_cause = text("message").contains(cause);
                    text("code") == code && error["line"].as_i64() == line && has_cause && has_cure
                });
            if !told {
                failures.push(format!("{mistake}: this is not in\n{}{}", answer.out, answer.err));
            }
            asked += 1;
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n\n"));
    assert!(asked >= 50, "{asked}");
}
