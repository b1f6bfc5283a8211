//! The command line itself: exit codes, help, usage errors, and nothing but JSON on stdout.

use crate::command::{Answer, linkwear};
use serde_json::Value;

#[test]
fn help_of_every_subcommand_has_an_example() {
    for name in [
        "check",
        "cost",
        "equations",
        "generate",
        "simulate",
        "life",
        "merge",
        "study",
        "identify",
        "sensitivity",
        "fit",
        "plan",
        "predict",
        "import",
        "new",
        "fmu",
        "diff",
        "explain",
        "schema",
        "completions",
        "man",
    ] {
        let answer = linkwear(&[name, "--help"]);
        assert_eq!(answer.code, 0);
        assert!(answer.out.contains(&format!("linkwear {name}")), "{}", answer.out);
    }
}

#[test]
fn help_lists_only_what_there_is() {
    let help = linkwear(&["--help"]).out;
    for absent in ["jit", "optimise"] {
        assert!(!help.lines().any(|line| line.trim_start().starts_with(absent)), "{absent}");
    }
}

#[test]
fn the_case_study_is_a_program_of_its_own_and_the_answer_says_which() {
    let line = "cargo run --release -p linkwear-case-study -- --quick --out study --format json";
    let answer = linkwear(&["case-study", "--quick", "--out", "study", "--format", "json"]);
    assert_eq!(answer.code, 2);
    assert_eq!(answer.errors()[0]["help"], line);
    let answer = linkwear(&["case-study", "--help"]);
    assert_eq!(answer.code, 2);
    assert!(answer.err.contains("cargo run --release -p linkwear-case-study -- --help"), "{}", answer.err);
}

#[test]
fn a_negative_number_is_told_what_is_wrong_with_it() {
    for (words, cause) in [
        (&["predict", "fit.json", "--threshold", "-1"][..], "a positive number is needed"),
        (&["predict", "fit.json", "--threshold", "1", "--rate", "-2.5e3"], "a positive number is needed"),
        (
            &["plan", "fit.json", "--threshold", "-1", "--preventive", "1", "--failure", "9"],
            "positive number",
        ),
        (&["simulate", "four_bar", "--step", "-0.0001"], "a positive number is needed"),
        // These were told as mistakes of the file that was read.
        (&["predict", "fit.json", "--threshold", "10", "--current", "-5"], "a number from 0 on is needed"),
        (
            &["predict", "fit.json", "--threshold", "10", "--current", "5", "--at", "-1"],
            "a number from 0 on is needed",
        ),
        (
            &["fit", "a.csv", "--unit", "u", "--wear", "w", "--exposure", "t", "--entered-below", "-1"],
            "a positive number is needed",
        ),
    ] {
        let answer = linkwear(words);
        assert!(answer.code == 2 && answer.err.contains(cause), "{words:?}: {}", answer.err);
        assert!(!answer.err.contains("unexpected argument"), "{}", answer.err);
    }
}

#[test]
fn wrong_usage_exits_with_2_and_says_so_in_json_too() {
    let cases: &[&[&str]] = &[
        &["simulate"],
        &["nonsense"],
        &["check", "mechanisms/pendulum.toml", "--set", "damping"],
        &["simulate", "mechanisms/pendulum.toml", "--time", "-1"],
        &["simulate", "mechanisms/pendulum.toml", "--time", "1", "--turns", "1"],
        &["simulate", "mechanisms/pendulum.toml", "--samples", "1"],
        &["simulate", "mechanisms/pendulum.toml", "--step", "1e-3", "--tol", "1e-9"],
        &["simulate", "mechanisms/pendulum.toml", "--step", "1e-3", "--integrator", "dopri5"],
        &["simulate", "mechanisms/pendulum.toml", "--tol", "1e-3", "--integrator", "rk4"],
        &["simulate", "mechanisms/pendulum.toml", "--turns", "1"],
        &["simulate", "mechanisms/pendulum.toml", "--tol", "0"],
        &["simulate", "mechanisms/pendulum.toml", "--tol", "1"],
        &["life", "mechanisms/rssr.toml", "--tol", "1e-30"],
        &["generate", "mechanisms/pendulum.toml", "--check"],
        &["life", "mechanisms/rssr.toml", "--shared-factor", "0"],
        &["life", "mechanisms/rssr.toml", "--shared-factor", "0.2", "--mean"],
        &["predict", "fit.json", "--threshold", "10", "--covariate", "load"],
        &["simulate", "mechanisms/pendulum.toml", "--backend", "jit"],
        &["new", "no-name"],
    ];
    for case in cases {
        let answer = linkwear(case);
        assert_eq!((answer.code, answer.out.as_str()), (2, ""), "{case:?}: {}", answer.err);
        assert!(!answer.err.is_empty(), "{case:?}");

        let answer = linkwear(&[case, &["--format", "json"][..]].concat());
        assert_eq!(answer.code, 2, "{case:?}");
        assert_eq!(answer.errors()[0]["code"], "C0001", "{case:?}");
        let text = |key: &str| answer.errors()[0][key].as_str().expect("a text").to_owned();
        let (message, help) = (text("message"), text("help"));
        assert!(!help.is_empty() && !help.contains("error:"), "{case:?}: {help}");
        assert!(!help.contains(&message), "{case:?}: {message}: {help}");
    }
    // What an option's value lacks is a cause, what to write instead a cure.
    let answer =
        linkwear(&["study", "x.toml", "--of", "steps", "--vary", "a=1;2; 3..x:2", "--format", "json"]);
    let error = &answer.errors()[0];
    let text = |key: &str| error[key].as_str().expect("a text");
    assert!(text("message").ends_with("the end `1;2; 3` of a range is no number with a unit"), "{error}");
    assert!(text("help").starts_with("write NAME=A..B:N, as"), "{error}");
    let answer = linkwear(&["simulate", "x.toml", "--turn", "1", "--format", "json"]);
    let error = &answer.errors()[0];
    assert_eq!(error["message"], "unexpected argument '--turn' found");
    assert!(
        error["help"].as_str().is_some_and(|help| help.starts_with("tip: a similar argument")),
        "{error}"
    );
}

#[test]
fn an_error_object_has_the_six_fields_scripts_read() {
    let answer = linkwear(&["check", "no_such_file.toml", "--format", "json"]);
    assert_eq!(answer.code, 1);
    let errors = answer.errors();
    let names: Vec<&String> = errors[0].as_object().expect("an object").keys().collect();
    assert_eq!(names, ["code", "file", "line", "column", "message", "help"]);
    assert_eq!(errors[0]["code"], "C0002");
    assert_eq!(errors[0]["file"], "no_such_file.toml");
}

#[test]
fn a_broken_file_is_an_error_of_the_input_with_its_place() {
    let folder = crate::command::Folder::new("broken");
    let file = folder.write("broken.toml", "spec = 1\nname = = \"x\"\n");
    for name in ["check", "cost", "equations", "generate", "simulate"] {
        let answer = linkwear(&[name, &file]);
        assert_eq!((answer.code, answer.out.as_str()), (1, ""), "{name}");
        assert!(answer.err.contains("broken.toml"), "{}", answer.err);
        let error = linkwear(&[name, &file, "--format", "json"]).errors()[0].clone();
        assert_eq!(error["line"], 2, "{name}");
        assert!(error["column"].as_u64() > Some(1), "{name}");
    }
}

#[test]
fn a_closed_pipe_is_no_error() {
    let mut child = crate::command::start(&["generate", "mechanisms/rssr_rigid.toml"]);
    drop(child.stdout.take());
    let answer = Answer::of(child.wait_with_output().expect("an end"));
    assert_eq!((answer.code, answer.err.as_str()), (0, ""));
}

#[test]
fn the_schema_is_the_one_of_the_docs() {
    let shipped = std::fs::read_to_string("docs/linkwear.schema.json").expect("the shipped schema");
    let current = linkwear(&["schema"]);
    assert_eq!(current.code, 0, "{}", current.err);
    assert_eq!(current.out, shipped);
    assert!(serde_json::from_str::<Value>(&shipped).expect("JSON")["properties"]["joints"].is_object());
}

#[test]
fn packagers_get_completions_and_a_manual() {
    let script = linkwear(&["completions", "bash"]);
    assert!(script.code == 0 && script.out.contains("simulate"));
    let page = linkwear(&["man"]);
    assert!(page.code == 0 && page.out.contains(".TH linkwear"));
    let page = linkwear(&["man", "life"]);
    assert!(
        page.code == 0 && page.out.contains(".TH linkwear-life") && page.out.contains("\\-\\-trajectories")
    );
    let unknown = linkwear(&["man", "lief"]);
    assert!(unknown.code == 2 && unknown.err.contains("did you mean `life`?"), "{}", unknown.err);
}

#[test]
fn pages_of_the_manual_name_only_pages_that_exist() {
    let folder = crate::command::Folder::new("man");
    let told = folder.linkwear(&["man", "--out", "man1", "--format", "json"]).json();
    let files: Vec<&str> =
        told["files"].as_array().expect("a list").iter().filter_map(Value::as_str).collect();
    assert!(files.contains(&"man1/linkwear.1") && files.contains(&"man1/linkwear-simulate.1"), "{files:?}");
    let mut links = 0;
    for file in &files {
        let page = folder.read(file);
        assert!(page.contains(".SH NAME") && page.contains(".SH SYNOPSIS"), "{file}");
        for link in
            page.split("(1)").map(|before| before.rsplit(char::is_whitespace).next().unwrap_or_default())
        {
            let name = link.replace('\\', "");
            if name.starts_with("linkwear-") {
                links += 1;
                assert!(files.contains(&format!("man1/{name}.1").as_str()), "{file}: {name}(1)");
            }
        }
    }
    assert_eq!(links, files.len() - 1, "linkwear(1) names every other page");
    // Again over what is there, as a packager does.
    assert_eq!(folder.linkwear(&["man", "--out", "man1"]).code, 0);
}

#[cfg(feature = "page")]
#[test]
fn a_picture_of_another_format_is_refused_before_the_work() {
    let folder = crate::command::Folder::new("ending");
    let gif = folder.path("a.GIF");
    for arguments in [
        &["draw", "mechanisms/pendulum.toml", "-o", &gif][..],
        &["simulate", "mechanisms/pendulum.toml", "--plot", &gif],
    ] {
        let answer = linkwear(arguments);
        assert_eq!((answer.code, folder.names().len()), (2, 0), "{}", answer.err);
        assert!(
            answer.err.contains("not as `.gif`") && answer.err.contains(".svg or .png"),
            "{}",
            answer.err
        );
    }
}

/// A rod whose drive follows an input that nothing moves has no turns: it is drawn where it is.
#[cfg(feature = "page")]
#[test]
fn a_driver_that_rests_is_drawn() {
    let folder = crate::command::Folder::new("rests");
    let file = folder.write(
        "rests.toml",
        "spec = 1\nname = \"rests\"\ngravity = [0, 0, 0]\n[inputs]\ncommand = \"30 deg\"\n\
         [points]\nO = [\"0 m\", \"0 m\", \"0 m\"]\nA = [\"1 m\", \"0 m\", \"0 m\"]\n\
         [bodies]\narm = { rod = [\"O\", \"A\"], radius = \"1 cm\", density = \"7850 kg/m^3\" }\n\
         [joints]\nR = { revolute = [\"ground\", \"arm\"], at = \"O\", axis = [0, 0, 1], drive = \"command\" }\n",
    );
    let picture = folder.path("rests.svg");
    let answer = linkwear(&["draw", &file, "-o", &picture]);
    assert_eq!(answer.code, 0, "{}", answer.err);
    assert!(answer.err.contains("does not get round"), "{}", answer.err);
    assert!(folder.read("rests.svg").contains("</svg>"));
    // Who says how many turns is told that there are none.
    assert_eq!(linkwear(&["draw", &file, "--turns", "1", "-o", &folder.path("b.svg")]).code, 1);
}

#[test]
fn what_is_no_number_or_none_at_all_is_told_by_its_name() {
    let folder = crate::command::Folder::new("no-number");
    let tiny = linkwear(&["life", "mechanisms/rssr.toml", "--tol", "1e-30"]);
    assert!(tiny.err.contains("1e-30") && tiny.err.contains("between 1e-14 and 0.1"), "{}", tiny.err);
    let text = std::fs::read_to_string("mechanisms/rssr.toml").expect("a shipped file");
    let with = |factor: &str| {
        let coefficient = "coefficient = \"k_wear\"";
        assert!(text.contains(coefficient));
        let changed = text.replace(coefficient, &format!("{coefficient}\ncoefficient_factor = {factor}"));
        linkwear(&["life", &folder.write("factor.toml", &changed), "--mean", "--coupling", "full"])
    };
    // What is zero whatever happens is told at its place; that a load, a speed or an input makes it so, by the life.
    let never = with("0");
    assert!(
        never.code == 1 && never.err.contains("E0403") && never.err.contains("coefficient_factor = 0"),
        "{}",
        never.err
    );
    let none = with("\"0*sliding_speed/(1 m/s)\"");
    assert!(none.code == 1 && none.err.contains("a wear coefficient of zero"), "{}", none.err);
    let no_number = with("\"sqrt(1 - sliding_speed/(0.01 m/s))\"");
    assert!(
        no_number.code == 1 && no_number.err.contains("`wear of R1` is not a finite number"),
        "{}",
        no_number.err
    );
    let empty = folder.write("empty.csv", "t [s],R1.drive [N m]\n");
    let arguments = [
        "identify",
        "examples/data/rocker_drive.toml",
        "--free",
        "c_rocker=0.005..0.5 N m s/rad",
        "--measured",
        &empty,
    ];
    let nothing = linkwear(&arguments);
    assert!(nothing.code == 1 && nothing.err.contains("there are no readings"), "{}", nothing.err);
}

/// The cure of what cannot be read is that of its cause, not a path that is right.
#[test]
fn what_cannot_be_read_has_the_cure_of_its_cause() {
    let folder = crate::command::Folder::new("usage-unread");
    let large = folder.write("large.toml", &"# a comment\n".repeat(400_000));
    for (file, cure) in [(&*large, "[repeat]"), ("-", "/dev/stdin"), ("none.toml", "check the path")] {
        let error = linkwear(&["check", file, "--format", "json"]).errors()[0].clone();
        assert_eq!(error["code"], "C0002", "{error}");
        assert!(error["help"].as_str().is_some_and(|help| help.contains(cure)), "{error}");
    }
}
