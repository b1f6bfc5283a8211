//! `life --mission`: what is told of segments, resumed and in shards; wrong choices.

use crate::command::{Folder, linkwear};

const DUTY: &str = "examples/data/four_bar_duty.toml";
/// Its joint chatters, and turns until it has settled are most of a life: only what is told of it is looked at.
const HASTY: [&str; 4] = ["life", DUTY, "--settle", "0"];

#[test]
fn a_mission_is_told_by_segments() {
    let life = linkwear(&[&HASTY[..], &["--mission", "shift", "--mean", "--format", "json"]].concat()).json();
    let segments = life["mission"]["segments"].as_array().expect("segments");
    let names: Vec<&str> = segments.iter().map(|one| one["name"].as_str().expect("a name")).collect();
    assert_eq!(names, ["idle", "light", "heavy"]);
    for key in ["time_share", "revolution_share"] {
        let sum: f64 = segments.iter().map(|one| one[key].as_f64().expect("a share")).sum();
        // Shares of a whole: rounding.
        assert!((sum - 1.0).abs() < 1e-12, "{key} {sum}");
    }
    let without = linkwear(&[&HASTY[..], &["--no-mission", "--mean", "--format", "json"]].concat()).json();
    assert!(without["mission"].is_null());
    assert_ne!(without["mean"], life["mean"]);
}

#[test]
fn lives_of_a_mission_are_the_same_in_shards_and_resumed() {
    let folder = Folder::new("life-missions");
    let lives = ["--mission", "shift", "--trajectories", "40", "--format", "json"];
    let words = [&HASTY[..], &lives].concat();
    let [whole, a, b, both] = ["whole", "a", "b", "both"].map(|name| folder.path(name));
    let told = linkwear(&[&words[..], &["--out", &whole]].concat()).json();
    for (part, out) in [("1/2", &a), ("2/2", &b)] {
        assert_eq!(linkwear(&[&words[..], &["--shard", part, "--out", out]].concat()).code, 0);
    }
    assert_eq!(linkwear(&["merge", &a, &b, "--out", &both]).code, 0);
    assert_eq!(folder.read("both/lives.csv"), folder.read("whole/lives.csv"));
    let again = linkwear(&[&words[..], &["--out", &whole, "--resume"]].concat()).json();
    assert_eq!((&again["mean"], &again["mission"]), (&told["mean"], &told["mission"]));
    // Another mission is another life.
    let other = ["--mission", "week", "--trajectories", "40", "--out", &whole, "--resume"];
    let answer = linkwear(&[&HASTY[..], &other].concat());
    assert_eq!(answer.code, 1, "{}", answer.out);
    assert!(answer.err.contains("mission"), "{}", answer.err);
}

/// No life is lived there, and what the names stand for changes nothing: a slip of the pen would go unseen.
#[test]
fn missions_and_fits_that_do_not_exist_are_told_where_no_life_is_lived_too() {
    let folder = Folder::new("life-missions-unlived");
    let page = folder.path("page.html");
    let still = "mechanisms/rssr_rigid.toml";
    let report = |more: [&str; 2]| linkwear(&[&["report", still, "-o", &page][..], &more].concat());
    let study = |more: [&str; 2]| {
        let words = ["study", still, "--vary", "speed=1 Hz,2 Hz", "--of", "peak.R1.F"];
        linkwear(&[&words[..], &more].concat())
    };
    for (more, cause) in
        [(["--mission", "shift"], "shift"), (["--fit", "none.json"], "no joint of this mechanism wears")]
    {
        for answer in [report(more), study(more)] {
            assert_eq!(answer.code, 2, "{more:?}: {}", answer.err);
            assert!(answer.err.contains(cause), "{}", answer.err);
        }
    }
    assert!(!std::fs::exists(&page).unwrap_or(true));
    let motions =
        ["study", DUTY, "--vary", "drag=1 N m s/rad,2 N m s/rad", "--of", "peak.R1.F", "--mission", "night"];
    let answer = linkwear(&motions);
    assert!(answer.code == 1 && answer.err.contains("C0006"), "{}", answer.err);
}

#[test]
fn wrong_choices_are_answered() {
    for (words, cause) in [
        (&["life", DUTY, "--mean"][..], "shift"),
        (&["life", DUTY, "--mean", "--mission", "night"], "night"),
        (&["life", "mechanisms/four_bar_wear.toml", "--mean", "--mission", "shift"], "shift"),
    ] {
        let answer = linkwear(words);
        assert_ne!(answer.code, 0, "{words:?}");
        assert!(answer.err.contains(cause), "{}", answer.err);
    }
    assert_eq!(linkwear(&["life", DUTY, "--mission", "shift", "--no-mission"]).code, 2);
}

#[test]
fn a_segment_at_rest_has_no_revolutions() {
    let folder = Folder::new("rest");
    let duty = std::fs::read_to_string(DUTY).expect("the example").replacen(
        r#"speed = "1 Hz""#,
        r#"speed = "0 Hz""#,
        1,
    );
    folder.write("duty.toml", &duty);
    let series = std::fs::read_to_string("examples/data/udds_feeder.csv").expect("its series");
    folder.write("udds_feeder.csv", &series);
    let answer = linkwear(&["life", &folder.path("duty.toml"), "--mission", "shift", "--mean"]);
    assert_eq!(answer.code, 1, "{}", answer.out);
    assert!(
        answer.err.contains("rests in segment `idle`") && answer.err.contains("leave the segment out"),
        "{}",
        answer.err
    );
}

/// An arm that goes to and fro as long one way as the other: in one bin it rests.
const ARM: &str = r#"spec = 1
name = "arm"
gravity = [0, 0, "-9.81 m/s^2"]
[parameters]
c0 = { value = "20 um", tunable = true }
speed = { value = "2 Hz", tunable = true }
[points]
O = [0, 0, 0]
A = ["200 mm", 0, 0]
[bodies]
arm = { rod = ["O", "A"], radius = "8 mm", density = "7850 kg/m^3" }
[joints]
R1 = { revolute = ["ground", "arm"], at = "O", axis = [0, 1, 0], drive = "2*pi*speed*t" }
[clearance.R1]
radial = "c0"
journal_radius = "10 mm"
length = "20 mm"
modulus = "115 GPa"
restitution = 0.9
friction = 0.05
[wear.R1]
coefficient = 1e-8
hardness = "3.5 GPa"
threshold = "80 um"
revolutions_per_cycle = 1e7
[missions.m]
series = "speeds.csv"
bins = 2
"#;

/// Its file, with the series beside it.
fn arm(folder: &Folder) -> String {
    folder.write("speeds.csv", "t [s],speed [Hz]\n0,-2\n1,2\n");
    folder.write("arm.toml", ARM)
}

#[test]
fn a_life_stands_where_half_as_many_bins_have_none() {
    let folder = Folder::new("to-and-fro");
    let file = arm(&folder);
    let answer = linkwear(&["life", &file, "--mean", "--step", "1e-4", "--settle", "0", "--format", "json"]);
    assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
    let life = answer.json();
    assert_eq!(life["mission"]["segments"].as_array().map(Vec::len), Some(2));
    assert!(life["mission"]["binning_error"].is_null());
    let warnings = life["warnings"].to_string();
    assert!(warnings.contains("binning") && warnings.contains("rests in segment `bin1`"), "{warnings}");
}

#[test]
fn what_a_mission_sets_anyway_is_told_where_it_varies() {
    let folder = Folder::new("set-anyway");
    let file = arm(&folder);
    let words = ["study", &file, "--of", "life.mean_path", "--mean", "--step", "1e-4", "--settle", "0"];
    let warnings = |vary: &str, more: &[&str]| {
        let answer = linkwear(&[&words[..], &["--vary", vary, "--format", "json"], more].concat()).json();
        assert_eq!(answer["failed"], 0);
        let told = answer["warnings"].to_string();
        told.matches("every segment of mission `m` sets `speed`").count()
    };
    assert_eq!(warnings("speed=1Hz,3Hz", &[]), 2);
    assert_eq!(warnings("speed=1Hz,3Hz", &["--no-mission"]), 0);
    assert_eq!(warnings("c0=20um,30um", &[]), 0);
    let words = ["life", &file, "--mean", "--step", "1e-4", "--settle", "0", "--format", "json"];
    let warnings = |more: &[&str]| {
        let told = linkwear(&[&words[..], more].concat()).json()["warnings"].to_string();
        told.matches("every segment of mission `m` sets `speed`: the value by --set changes nothing").count()
    };
    assert_eq!(warnings(&["--set", "speed=3 Hz"]), 1);
    assert_eq!(warnings(&["--set", "c0=30 um"]), 0);
}
