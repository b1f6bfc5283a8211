//! `identify`: what a simulated curve with noise was made with is found again, what cannot be told is not, and wrong questions are
//! answered with what to write.

use crate::command::{Answer, Folder, linkwear};
use serde_json::Value;

const DRIVE: &str = "examples/data/rocker_drive.toml";
const TORQUE: &str = "examples/data/rocker_torque.csv";
const DAMPER: &str = "c_rocker=0.005..0.5 N m s/rad";
const LOAD: &str = "m_load=0.1 kg..2 kg";

fn identify(words: &[&str]) -> Answer {
    linkwear(&[&["identify", DRIVE], words, &["--format", "json"]].concat())
}

fn parameter<'v>(answer: &'v Value, name: &str) -> &'v Value {
    let all = answer["parameters"].as_array().expect("a list");
    all.iter().find(|one| one["name"] == name).expect(name)
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[test]
fn damper_and_load_are_found_in_a_noisy_torque() {
    let words = ["--free", DAMPER, "--free", LOAD, "--measured", TORQUE];
    let answer = identify(&words).json();
    // What the file says that the curve was made with.
    for (name, truth) in [("c_rocker", 0.05), ("m_load", 0.5)] {
        let one = parameter(&answer, name);
        assert_eq!(one["state"], "estimated");
        let [lower, upper] = ["lower", "upper"].map(|end| number(&one["interval95"][end]));
        assert!(lower < truth && truth < upper, "{one}");
        assert!(upper - lower < 0.2 * truth, "{one}");
    }
    // Of 161 readings the noise is known to 6 %: four times that.
    let noise = number(&answer["groups"][0]["noise"]);
    assert!((noise / 0.05 - 1.0).abs() < 0.24, "{noise}");
    assert_eq!(answer["warnings"].as_array().map(Vec::len), Some(0), "{}", answer["warnings"]);
    // The words go on to the next command, and the answer is the same the next time.
    let set: Vec<&str> = answer["set"].as_array().expect("words").iter().filter_map(Value::as_str).collect();
    let next = [&["simulate", DRIVE], &["--set", set[0], "--set", set[1]][..]].concat();
    assert_eq!(linkwear(&next).code, 0);
    assert_eq!(identify(&words).json(), answer);
}

#[test]
fn of_two_loads_only_what_both_do_is_told() {
    let clamp = "m_clamp=10 g..1 kg";
    let answer = identify(&["--free", DAMPER, "--free", LOAD, "--free", clamp, "--measured", TORQUE]).json();
    for name in ["m_load", "m_clamp"] {
        let one = parameter(&answer, name);
        assert_eq!((&one["state"], &one["estimate"]), (&"not_identified".into(), &Value::Null));
    }
    assert_eq!(parameter(&answer, "c_rocker")["state"], "estimated");
    assert_eq!(answer["combinations"].as_array().map(Vec::len), Some(1));
    assert_eq!(answer["minima"].as_array().map(Vec::len), Some(1), "{}", answer["minima"]);
}

#[test]
fn wrong_questions_are_answered_with_what_to_write() {
    let folder = Folder::new("identify-wrong");
    let curve = |name: &str, text: &str| folder.write(name, text);
    let good = "t [s],R1.drive [N m]\n0,1\n0.1,2\n0.2,1.5\n0.3,1\n";
    let with = |head: &str| good.replace("R1.drive [N m]", head);
    let cases = [
        (curve("column.csv", &with("R1.driv [N m]")), DAMPER, "C0011", "did you mean `R1.drive`?"),
        (curve("unit.csv", &with("R1.drive [N]")), DAMPER, "C0011", "same kind as N m"),
        (curve("bare.csv", &with("R1.drive")), DAMPER, "C0011", "`R1.drive [N m]`"),
        // In degrees or in radians.
        (curve("bare_angle.csv", &with("R4.q")), DAMPER, "C0011", "`R4.q [rad]`"),
        (curve("nan.csv", &good.replace("1.5", "nan")), DAMPER, "C0011", "write a number"),
        (curve("falls.csv", &good.replace("0.2,", "0.05,")), DAMPER, "C0011", "one row per instant"),
        (curve("early.csv", &good.replace("\n0,", "\n-0.1,")), DAMPER, "C0011", "--settle"),
        (curve("same.csv", "t [s],R1.drive [N m]\n0,1\n0.1,1\n0.2,1\n"), DAMPER, "C0011", "--noise"),
        (curve("few.csv", "t [s],R1.drive [N m]\n0,1\n"), DAMPER, "C0011", "measure more"),
        (curve("good.csv", good), "c_rocker=0.5..0.005 N m s/rad", "C0001", "NAME=LO..HI"),
        (curve("good.csv", good), "c_rocker=0.005,0.5", "C0001", "NAME=LO..HI"),
        (curve("good.csv", good), "b=290 mm..310 kg", "C0001", "NAME=LO..HI"),
        (curve("good.csv", good), "speed=1 rad/s..8 rad/s", "E0303", "a turn is 2*pi rad"),
        (
            curve("angle.csv", "t [s],R1.q [rad]\n0,0\n0.1,1.3\n0.2,2.5\n"),
            DAMPER,
            "C0016",
            "leave --free c_rocker out",
        ),
        (curve("good.csv", good), "b=2 m..3 m", "C0015", ""),
    ];
    for (file, free, code, help) in cases {
        let answer = identify(&["--free", free, "--measured", &file]);
        let error = &answer.errors()[0];
        assert_eq!(error["code"], code, "{file} {free}: {error}");
        assert!(error["help"].as_str().is_some_and(|text| text.contains(help)), "{file} {free}: {error}");
        // The option that was given, and no other.
        assert!(!error.to_string().contains("--vary"), "{file} {free}: {error}");
    }
    let file = folder.path("good.csv");
    let angles = folder.write("angles.csv", "t [s],R4.q [rad]\n0,1\n0.1,1.1\n0.2,1.2\n");
    for (words, code) in [
        (&["--free", DAMPER, "--free", DAMPER, "--measured", &file][..], "C0001"),
        (&["--free", DAMPER, "--set", "c_rocker=0.1 N m s/rad", "--measured", &file], "C0001"),
        (&["--free", DAMPER, "--measured", &file, "--noise", "R1.drive=0.1 N"], "C0001"),
        (&["--free", DAMPER, "--measured", &file, "--noise", "R4.q=0.1"], "C0001"),
        (&["--free", DAMPER, "--measured", &file, "--of", "R4.q"], "C0011"),
        (&["--free", DAMPER, "--measured", &angles, "--noise", "R4.q=0.1"], "C0001"),
        (&["--free", DAMPER, "--measured", &angles, "--noise", "R4.q=0.1 mm"], "C0001"),
        (&["--measured", &file], "C0001"),
        (&["--free", DAMPER], "C0001"),
        (&["--free", DAMPER, "--inspections", &format!("R4={file}"), "--time", "t", "--wear", "w"], "C0006"),
    ] {
        assert_eq!(identify(words).errors()[0]["code"], code, "{words:?}");
    }
}

const BUSH: &str = "examples/data/worn_bush.toml";
const INSPECTIONS: &str = "R2=examples/data/worn_bush.csv";

fn inspected(words: &[&str]) -> Answer {
    let columns = ["--inspections", INSPECTIONS, "--wear", "wear"];
    linkwear(&[&["identify", BUSH], &columns[..], words, &["--format", "json"]].concat())
}

#[test]
fn a_coefficient_of_wear_is_found_in_inspections_and_one_path_serves_all_its_values() {
    let by = ["--revolutions", "revolutions", "--free", "k_wear=1e-8..1e-6"];
    let answer = inspected(&by).json();
    let one = parameter(&answer, "k_wear");
    let [lower, upper] = ["lower", "upper"].map(|end| number(&one["interval95"][end]));
    assert!(lower < 2e-7 && 2e-7 < upper && upper - lower < 1e-8, "{one}");
    let clocks = &answer["clocks"][0];
    assert_eq!(clocks["joint"], "R2");
    // The physics' clock is faster than linear: wear opens the clearance, which narrows the contact.
    assert!(number(&clocks["interval95"]["lower"]) > 1.0, "{clocks}");
    assert!(number(&clocks["aic_difference"]) > 2.0, "{clocks}");
    // Where alpha and beta differ the mean path of a life is faster than physics by their quotient, and so is this one.
    let folder = Folder::new("identify-rates");
    let text = std::fs::read_to_string(BUSH).expect("a file of this repository");
    assert!(!text.contains("alpha ="), "{text}");
    let text = text.replace("threshold = ", "alpha = \"3 1/um\"\nbeta = \"2 1/um\"\nthreshold = ");
    let file = folder.write("rates.toml", &text);
    let columns = ["--inspections", INSPECTIONS, "--wear", "wear", "--format", "json"];
    let slower = linkwear(&[&["identify", &file], &columns[..], &by].concat()).json();
    let ratio = number(&parameter(&slower, "k_wear")["estimate"]) / number(&one["estimate"]);
    // Within a cycle, a hundredth of the path, the clearance opens as by physics.
    assert!((ratio * 1.5 - 1.0).abs() < 1e-2, "{ratio}");
    // Hardness divides what the coefficient multiplies.
    let both =
        [&by[..], &["--free", "hardness=100 MPa..500 MPa", "--gauge", "2 um", "--starts", "1"]].concat();
    let answer = inspected(&both).json();
    for name in ["k_wear", "hardness"] {
        assert_eq!(parameter(&answer, name)["state"], "not_identified");
    }
    let product = &answer["combinations"][0];
    let ratio = number(&product["parts"]["hardness"]) / number(&product["parts"]["k_wear"]);
    assert!((ratio + 1.0).abs() < 1e-3, "{product}");
}

#[test]
fn wrong_inspections_are_answered_with_what_to_write() {
    let free = ["--free", "k_wear=1e-8..1e-6"];
    for (words, code) in [
        (&["--revolutions", "turns"][..], "C0011"),
        (&["--time", "revolutions"], "C0011"),
        (&[], "C0001"),
        (&["--revolutions", "revolutions", "--gauge", "2 s"], "C0001"),
        (&["--revolutions", "revolutions", "--gauge", "-2 um"], "C0001"),
        (&["--revolutions", "revolutions", "--noise", "R1.drive=1 N m"], "C0001"),
    ] {
        assert_eq!(inspected(&[&free[..], words].concat()).errors()[0]["code"], code, "{words:?}");
    }
    let folder = Folder::new("identify-inspections");
    for text in [
        "n,wear [um]\n100,0\n200,0\n300,-1\n",
        "n,wear [um]\n-100,1\n200,2\n300,3\n",
        "n,wear [um]\n1,1\n1,2\n2,3\n",
    ] {
        let file = format!("R2={}", folder.write("log.csv", text));
        let words = [
            "identify",
            BUSH,
            free[0],
            free[1],
            "--inspections",
            &file,
            "--revolutions",
            "n",
            "--wear",
            "wear",
        ];
        let answer = linkwear(&[&words[..], &["--format", "json"]].concat());
        assert_eq!(answer.errors()[0]["code"], "C0011", "{text}");
    }
}

#[test]
fn a_curve_without_noise_gives_its_parameters_back_also_from_a_later_turn_on() {
    let folder = Folder::new("identify-exact");
    let out = folder.path("run.csv");
    let truth = ["--set", "c_rocker=0.05 N m s/rad"];
    let run = [&["simulate", DRIVE, "--turns", "2", "--samples", "81", "--out", &out][..], &truth].concat();
    assert_eq!(linkwear(&run).code, 0);
    let whole = identify(&["--free", DAMPER, "--measured", &out, "--of", "R1.drive,R3.Fx"]).json();
    // The second turn alone, its times from 0 on and not even: every row but every third.
    let text = folder.read("run.csv");
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let at = head.iter().position(|title| *title == "R1.drive [N m]").expect("the drive");
    let mut later = "t [ms],R1.drive [N m]\n".to_owned();
    for (row, line) in lines.enumerate().filter(|(row, _)| *row >= 40 && row % 3 != 0) {
        let cells: Vec<&str> = line.split(',').collect();
        let t: f64 = cells[0].parse().expect("a time");
        later.push_str(&format!("{},{}\n", 1e3 * (t - 0.5) + 1e-12 * row as f64, cells[at]));
    }
    let later = folder.write("later.csv", &later);
    let late = identify(&["--free", DAMPER, "--measured", &later, "--settle", "1"]).json();
    for answer in [whole, late] {
        let found = number(&parameter(&answer, "c_rocker")["estimate"]);
        // Runs are right to 1e-9 of each value; the damper does a tenth of the torque.
        assert!((found / 0.05 - 1.0).abs() < 1e-6, "{found}");
    }
}

#[test]
fn time_tells_revolutions_where_all_last_alike() {
    let folder = Folder::new("identify-time");
    let read = std::fs::read_to_string("examples/data/worn_bush.csv").expect("inspections");
    let mut hours = "t [h],wear [um]\n".to_owned();
    for line in read.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit())) {
        let (n, wear) = line.split_once(',').expect("two cells");
        // A revolution takes 0.2 s.
        hours.push_str(&format!("{},{wear}\n", n.parse::<f64>().expect("a number") * 0.2 / 3600.0));
    }
    let file = format!("R2={}", folder.write("hours.csv", &hours));
    let words = ["identify", BUSH, "--free", "k_wear=1e-8..1e-6", "--wear", "wear", "--format", "json"];
    let by_time = linkwear(&[&words[..], &["--inspections", &file, "--time", "t"]].concat()).json();
    let by_count = inspected(&["--free", "k_wear=1e-8..1e-6", "--revolutions", "revolutions"]).json();
    let found = [by_time, by_count].map(|answer| number(&parameter(&answer, "k_wear")["estimate"]));
    // A search rests within a thousandth of an error, which is 4e-3 of the value.
    assert!((found[0] / found[1] - 1.0).abs() < 1e-5, "{found:?}");
}
