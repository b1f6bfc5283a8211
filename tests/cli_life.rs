//! `life`: the coupled wear of the case study from the command line.

mod command;

use command::linkwear;

const RSSR: &str = "mechanisms/rssr.toml";

#[test]
fn the_case_study_lives_about_twenty_five_cycles() {
    let life = linkwear(&["life", RSSR, "--format", "json"]).json();
    let mean = life["mean"].as_f64().expect("a number");
    // The file's revolutions per cycle make it 25.1, by a hand calculation good to a tenth of a cycle.
    assert!((mean - 25.1).abs() < 0.1, "{mean}");
    assert_eq!(life["mean_whole_cycles"], 26.0);
    assert_eq!(life["trajectories"], 1);
    for key in ["std", "cov", "seed"] {
        assert!(life[key].is_number(), "{key}");
    }
    assert!(life["quantiles"]["p50"].is_number());
    let cycles = life["cycles"].as_array().expect("a list");
    assert_eq!(cycles.len(), 26);
    let clearance = |at: usize| cycles[at]["joints"][0]["clearance_m"].as_f64().expect("a number");
    assert!(clearance(25) > clearance(0));
    // Half of the table against all of it, which the resonances of the coupler bound.
    assert!(life["table_error"].as_f64().expect("a number") < 5e-3);
}

#[test]
fn a_mechanism_that_cannot_wear_says_what_is_missing() {
    let answer = linkwear(&["life", "mechanisms/rssr_rigid.toml", "--format", "json"]);
    assert_eq!(answer.code, 1);
    let message = answer.errors()[0]["message"].as_str().expect("a text").to_owned();
    assert!(message.contains("[wear.R1]"), "{message}");
}
