//! `report DIR`: the page of a life that was lived before has the numbers of its folder; what is no such folder is refused with what
//! to do. Wear of random lives at whole cycles is that of the lives themselves.

use std::fs;

use crate::command::{Folder, linkwear};
use serde_json::Value;

/// Coarse steps: only numbers are compared.
const LIFE: [&str; 12] = [
    "mechanisms/rssr.toml",
    "--rigid",
    "--set",
    "speed=3Hz",
    "--step",
    "5e-5",
    "--settle",
    "0",
    "--seed",
    "7",
    "--trajectories",
    "40",
];

/// Lives into a folder.
fn lived(folder: &Folder, more: &[&str]) -> String {
    let out = folder.path("lived");
    let answer = linkwear(&[&["life"], &LIFE[..], more, &["--out", &out]].concat());
    assert_eq!(answer.code, 0, "{}", answer.err);
    out
}

/// The data that a page holds under a name.
fn data(page: &str, id: &str) -> Value {
    let head = format!("<script type=\"application/json\" id=\"{id}\">");
    let rest = page.split_once(&head).expect("the data").1;
    serde_json::from_str(rest.split_once("</script>").expect("an end").0).expect("JSON")
}

#[test]
fn a_page_of_a_folder_has_the_numbers_of_the_folder() {
    let folder = Folder::new("report-folder");
    let out = lived(&folder, &[]);
    let page = folder.path("page.html");
    let answer = linkwear(&["report", &out, "-o", &page]);
    assert_eq!(answer.code, 0, "{}", answer.err);
    let text = folder.read("page.html");
    let told: Value = serde_json::from_str(&folder.read("lived/life.json")).expect("JSON");
    assert_eq!(data(&text, "life"), told);
    // The picture is of the same mechanism: the parameter that was set, bodies taken as rigid.
    let simulation = data(&text, "simulation");
    assert_eq!(simulation["provenance"]["options"]["set"]["speed"], "3Hz");
    assert_eq!(simulation["provenance"]["options"]["rigid"], true);
    assert_eq!(simulation["provenance"]["file_sha256"], told["provenance"]["file_sha256"]);
    let again = linkwear(&[&["report"], &LIFE[..], &["-o", &page]].concat());
    assert_eq!(again.code, 0, "{}", again.err);
    assert_eq!(data(&folder.read("page.html"), "life"), told);
}

#[test]
fn what_is_no_finished_life_is_refused_with_what_to_do() {
    let folder = Folder::new("report-refused");
    let out = lived(&folder, &[]);
    let page = folder.path("page.html");
    let refused = |words: &[&str], message: &str, help: &str| {
        let answer = linkwear(&[&["report", &out, "-o", &page, "--format", "json"], words].concat());
        let error = answer.errors()[0].clone();
        let said = |key: &str| error[key].as_str().expect("a text").to_owned();
        assert!(answer.code != 0 && said("message").contains(message), "{error}");
        assert!(said("help").contains(help), "{error}");
        assert!(!fs::exists(&page).unwrap_or(true));
    };
    refused(&["--seed", "8"], "lived already: --seed", "leave it out");
    refused(&["--mission", "shift"], "lived already: --mission", "leave it out");
    refused(&["--no-mission"], "lived already: --no-mission", "leave it out");
    let mechanism = format!("{out}/mechanism/mechanism.toml");
    let text = fs::read_to_string(&mechanism).expect("the mechanism");
    fs::write(&mechanism, text.replacen("2 Hz", "4 Hz", 1) + "\n").expect("a file");
    refused(&[], "was changed", "put the file back");
    fs::remove_file(&mechanism).expect("a file");
    refused(&[], "is not kept", "--resume");
    fs::write(format!("{out}/life.json"), "{}").expect("a file");
    refused(&[], "is not what", "live the life again");
    fs::remove_file(format!("{out}/life.json")).expect("a file");
    refused(&[], "is not finished", "--resume");
    fs::remove_file(format!("{out}/life.journal")).expect("a file");
    refused(&[], "is no folder of a life", "--out DIR");
}

#[test]
fn the_spread_of_wear_is_that_of_the_lives() {
    let folder = Folder::new("report-spread");
    let out = lived(&folder, &[]);
    let told: Value = serde_json::from_str(&folder.read("lived/life.json")).expect("JSON");
    let spread = &told["wear_spread"];
    assert_eq!(spread["lives"], 40);
    let threshold = told["thresholds_m"]["R1"].as_f64().expect("a threshold");
    let lives = folder.read("lived/lives.csv");
    let whole: Vec<u64> = lives
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(2).expect("a column").parse().expect("cycles"))
        .collect();
    assert_eq!(whole.len(), 40);
    let mut last = [0.0; 3];
    for cycle in spread["cycles"].as_array().expect("cycles") {
        let number = cycle["cycle"].as_u64().expect("a number");
        // As many as lives.csv says have ended, and those alone are worn to the threshold.
        let ended = whole.iter().filter(|life| **life <= number).count();
        assert_eq!(cycle["ended"].as_f64(), Some(ended as f64 / 40.0), "{cycle}");
        let wear = &cycle["joints"][0]["wear_m"];
        let now = ["p10", "p50", "p90"].map(|key| wear[key].as_f64().expect("a number"));
        assert!(now.iter().zip(last).all(|(now, last)| *now >= last) && now.is_sorted(), "{cycle}");
        // Of 40 lives the quantiles lie between neighbours: at least so many of them are at the threshold.
        assert_eq!(now[0] == threshold, ended >= 37, "{cycle}");
        assert_eq!(now[2] == threshold, ended >= 5, "{cycle}");
        last = now;
    }
    assert_eq!(last, [threshold; 3]);
    let parts = told["histogram"].as_array().expect("parts").iter();
    let sum: f64 = parts.map(|part| part["part"].as_f64().expect("a part")).sum();
    assert!((sum - 1.0).abs() < 1e-12, "{sum}");
    // Threads and a journal that is gone on with change no bit.
    let json = [&["life"], &LIFE[..], &["--format", "json"]].concat();
    for more in [&["--threads", "1"][..], &["--threads", "3"], &["--out", &out, "--resume"]] {
        assert_eq!(linkwear(&[&json[..], more].concat()).json(), told, "{more:?}");
    }
}

#[test]
fn lives_by_the_dynamics_are_followed_and_their_journal_keeps_what_was_seen() {
    let folder = Folder::new("report-full");
    let life = [
        &["life", "mechanisms/rssr.toml", "--rigid", "--step", "5e-5", "--settle", "0", "--coupling", "full"]
            [..],
        &["--trajectories", "3", "--format", "json"],
    ]
    .concat();
    let out = folder.path("lived");
    let told = linkwear(&[&life[..], &["--out", &out]].concat()).json();
    assert_eq!(told["wear_spread"]["lives"], 3);
    assert!(told["wear_spread"]["cycles"].as_array().is_some_and(|cycles| cycles.len() > 10));
    assert_eq!(linkwear(&[&life[..], &["--out", &out, "--resume"]].concat()).json(), told);
}
