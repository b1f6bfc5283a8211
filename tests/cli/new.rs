//! `new`: every starter goes all the way from the file to its life and its page.

use crate::command::Folder;
use serde_json::Value;

/// The commands that `new` tells to go on with all work, one after the other, without a warning.
fn goes_all_the_way(starter: &str) {
    let folder = Folder::new(&format!("new-{starter}"));
    let new = folder.linkwear(&["new", "mine", "--starter", starter, "--format", "json"]).json();
    assert_eq!(new["file"], "mine.toml");
    let next = new["next"].as_array().expect("commands").clone();
    let words: Vec<Vec<&str>> =
        next.iter().map(|line| line.as_str().expect("text").split(' ').skip(1).collect()).collect();
    let asked: Vec<&str> = words.iter().map(|words| words[0]).collect();
    assert_eq!(asked, ["check", "view", "simulate", "life", "report"], "{starter}");
    for mut words in words {
        if ["life", "report"].contains(&words[0]) {
            words.extend(["--trajectories", "50"]);
        }
        let told = folder.linkwear(&[&words[..], &["--format", "json"]].concat()).json();
        let warnings = told.get("warnings").cloned().unwrap_or(Value::Array(Vec::new()));
        assert_eq!(warnings, Value::Array(Vec::new()), "{starter}: {words:?}");
        if words[0] == "life" {
            let mean = told["mean"].as_f64().expect("cycles");
            // A life that a newcomer can follow cycle by cycle.
            assert!((5.0..100.0).contains(&mean), "{starter}: {mean}");
        }
    }
    assert_eq!(folder.names(), ["mine.html", "mine.toml", "mine_moving.html"]);
}

#[test]
fn the_four_bar_goes_all_the_way() {
    goes_all_the_way("four-bar");
}

#[test]
fn the_slider_crank_goes_all_the_way() {
    goes_all_the_way("slider-crank");
}

#[test]
fn the_spatial_four_bar_goes_all_the_way() {
    goes_all_the_way("rssr");
}

#[test]
fn a_starter_is_written_once_and_the_four_bar_is_the_default() {
    let folder = Folder::new("starter");
    let answer = folder.linkwear(&["new", "my_bars"]);
    assert!(answer.code == 0 && answer.out.contains("linkwear life my_bars.toml"), "{}", answer.out);
    let file = folder.read("my_bars.toml");
    assert!(file.contains("name = \"my_bars\"") && file.contains("four-bar") && !file.contains("starter"));
    let again = folder.linkwear(&["new", "my_bars", "--starter", "rssr"]);
    assert!(again.code == 1 && again.err.contains("C0004"), "{}", again.err);
    assert_eq!(folder.read("my_bars.toml"), file);
    let unknown = folder.linkwear(&["new", "other", "--starter", "slider"]);
    assert!(unknown.code == 2 && unknown.err.contains("slider-crank"), "{}", unknown.err);
}
