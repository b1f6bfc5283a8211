//! Every output is what docs/outputs.md and docs/schemas say: every subcommand on shipped files and data, its JSON by its schema, its
//! tables by the list of columns.

#[path = "../command/mod.rs"]
mod command;
mod schema;

use std::fmt::Write as _;
use std::fs;

use command::{Answer, Folder, linkwear};
use linkwear::table::{ColumnForm, tables};
use schema::faults;
use serde_json::{Value, json};

const PENDULUM: &str = "mechanisms/pendulum.toml";
const RSSR: &str = "mechanisms/rssr.toml";
/// Its bearing has clearance and touches and parts.
const CLEARANCE: &str = "mechanisms/slider_crank_clearance.toml";

fn schema(name: &str) -> Value {
    let file = fs::read_to_string(format!("docs/schemas/{name}.schema.json")).expect("a schema");
    serde_json::from_str(&file).expect("JSON")
}

fn held(name: &str, value: &Value, from: &str) {
    let found = faults(&schema(name), value);
    assert!(found.is_empty(), "{from}: by docs/schemas/{name}.schema.json\n{}", found.join("\n"));
}

/// The JSON of a subcommand, held against its schema.
fn asked(words: &[&str]) -> Value {
    let answer = linkwear(&[words, &["--format", "json"]].concat()).json();
    held(words[0], &answer, &words.join(" "));
    answer
}

fn mechanisms() -> Vec<String> {
    let files = fs::read_dir("mechanisms").expect("a folder").map(|entry| entry.expect("an entry").path());
    let files = files.filter(|path| path.extension().is_some_and(|end| end == "toml"));
    let mut files: Vec<String> = files.map(|path| path.to_str().expect("UTF-8").to_owned()).collect();
    files.sort();
    assert!(files.len() > 15, "{files:?}");
    files
}

fn columns(table: &str) -> Vec<ColumnForm> {
    let found = tables().into_iter().find(|(name, _)| *name == table);
    found.expect("a table of the list").1
}

/// Every head of a CSV file has one form of the list, and the file beside it tells the same columns.
fn held_table(folder: &Folder, file: &str, table: &str) {
    let (text, forms) = (folder.read(file), columns(table));
    let heads: Vec<&str> = text.lines().next().expect("heads").split(',').collect();
    for head in &heads {
        let known = forms.iter().filter(|form| form.has(head)).count();
        assert!(
            known == 1 || (known > 0 && table == "study --out"),
            "{file}: `{head}` has {known} forms in docs/outputs.md"
        );
    }
    let cells = |line: &str| line.split(',').count();
    assert!(text.lines().all(|line| cells(line) == heads.len()), "{file}");
    let beside: Value = serde_json::from_str(&folder.read(&format!("{file}-metadata.json"))).expect("JSON");
    held("table", &beside, file);
    let told = beside["tableSchema"]["columns"].as_array().expect("columns").iter();
    assert_eq!(
        told.map(|column| column["titles"].as_str().expect("a head")).collect::<Vec<_>>(),
        heads,
        "{file}"
    );
}

#[test]
fn a_key_too_many_or_too_few_is_found() {
    let answer = asked(&["check", PENDULUM]);
    let mut more = answer.clone();
    more["parameters"][0]["stale"] = json!(1);
    assert_eq!(faults(&schema("check"), &more), ["$.parameters[0].stale: no such key"]);
    let mut fewer = answer;
    fewer.as_object_mut().expect("an object").shift_remove("mobility");
    assert_eq!(faults(&schema("check"), &fewer), ["$: `mobility` is missing"]);
}

#[test]
fn the_program_prints_the_schemas_that_are_kept() {
    for entry in fs::read_dir("docs/schemas").expect("a folder") {
        let path = entry.expect("an entry").path();
        let name =
            path.file_name().and_then(|name| name.to_str()).expect("UTF-8").replace(".schema.json", "");
        let printed = linkwear(&["schema", &name]);
        assert_eq!((printed.code, printed.out), (0, fs::read_to_string(&path).expect("a file")), "{name}");
    }
    assert_eq!(linkwear(&["schema", "nothing"]).code, 2);
}

#[test]
fn checks_and_runs_of_all_shipped_files_are_as_told() {
    let folder = Folder::new("outputs-runs");
    for file in mechanisms() {
        asked(&["check", &file]);
        let out = folder.path("rows.csv");
        asked(&["simulate", &file, "--time", "1e-4", "--samples", "3", "--out", &out]);
        held_table(&folder, "rows.csv", "simulate --out");
    }
    let turns = asked(&["simulate", CLEARANCE, "--turns", "1", "--samples", "2"]);
    assert!(!turns["turns"].as_array().expect("a list").is_empty());
    asked(&["check", RSSR, "--closure", "log", "--set", "speed=5Hz"]);
}

/// Heads and metadata of a Parquet file are those of the CSV file; its numbers: `src/table/parquet.rs`.
#[cfg(feature = "parquet")]
#[test]
fn parquet_files_have_the_columns_that_are_told() {
    use parquet::file::reader::{FileReader as _, SerializedFileReader};
    let folder = Folder::new("outputs-parquet");
    let out = folder.path("rows.parquet");
    asked(&["simulate", RSSR, "--time", "1e-4", "--samples", "3", "--out", &out]);
    let reader = SerializedFileReader::new(fs::File::open(&out).expect("a file")).expect("Parquet");
    let about = reader.metadata().file_metadata();
    let known = about.key_value_metadata().expect("metadata").iter().find(|known| known.key == "linkwear");
    let within: Value =
        serde_json::from_str(known.and_then(|known| known.value.as_deref()).expect("a text")).expect("JSON");
    held("parquet", &within, &out);
    let forms = columns("simulate --out");
    let told = within["columns"].as_array().expect("columns");
    assert_eq!(told.len(), about.schema_descr().num_columns());
    for (column, told) in about.schema_descr().columns().iter().zip(told) {
        assert_eq!(told["titles"], column.name());
        assert_eq!(forms.iter().filter(|form| form.has(column.name())).count(), 1, "{}", column.name());
    }
}

#[test]
fn equations_and_code_are_as_told() {
    let folder = Folder::new("outputs-code");
    asked(&["equations", PENDULUM]);
    asked(&["equations", "mechanisms/four_bar.toml", "--only", "mass"]);
    asked(&["cost", PENDULUM]);
    asked(&["generate", PENDULUM]);
    asked(&["generate", PENDULUM, "--target", "c", "--out", &folder.path("pendulum")]);
    asked(&["fmu", PENDULUM, "--out", &folder.path("pendulum.fmu")]);
    #[cfg(feature = "page")]
    for words in ["report", "view", "draw"] {
        asked(&[words, PENDULUM, "--out", &folder.path(words)]);
    }
    asked(&["import", "examples/data/arm.urdf", "--out", &folder.path("arm.toml")]);
    let lever = "examples/data/press/lever.stl";
    asked(&["import", lever, "--density", "7850 kg/m^3", "--out", &folder.path("lever.toml")]);
    asked(&["completions", "bash"]);
    asked(&["man"]);
    held("new", &folder.linkwear(&["new", "fresh", "--format", "json"]).json(), "new");
}

#[test]
fn lives_and_their_files_are_as_told() {
    let folder = Folder::new("outputs-lives");
    for count in ["1", "2", "40"] {
        asked(&["life", RSSR, "--trajectories", count]);
    }
    asked(&["life", RSSR, "--mean"]);
    // Its joint chatters and would be settled for long: a page of docs waits for that.
    for mission in ["shift", "week", "measured"] {
        asked(&["life", "examples/data/four_bar_duty.toml", "--mission", mission, "--mean", "--settle", "0"]);
    }
    asked(&[
        "life",
        RSSR,
        "--trajectories",
        "20",
        "--shared-factor",
        "0.2",
        "--no-feedback",
        "--settle",
        "0",
    ]);
    let [a, b, all] = ["a", "b", "all"].map(|name| folder.path(name));
    asked(&["life", RSSR, "--trajectories", "8", "--shard", "1/2", "--out", &a]);
    asked(&["life", RSSR, "--trajectories", "8", "--shard", "2/2", "--out", &b]);
    let merged = linkwear(&["merge", &a, &b, "--out", &all, "--format", "json"]).json();
    held("life", &merged, "merge");
    let file: Value = serde_json::from_str(&folder.read("all/life.json")).expect("JSON");
    held("life", &file, "life.json");
    for table in ["cycles.csv", "lives.csv"] {
        held_table(&folder, &format!("all/{table}"), table);
    }
}

#[test]
fn studies_and_their_tables_are_as_told() {
    let folder = Folder::new("outputs-study");
    let out = folder.path("points.csv");
    let study = ["study", PENDULUM, "--vary", "length=0.5m,1m,-1m", "--time", "0.01", "--of"];
    let study = [&study[..], &["steps,energy_error_J,max.hinge.q,final.hinge.v"]].concat();
    asked(&[&study[..], &["--out", &out]].concat());
    held_table(&folder, "points.csv", "study --out");
    asked(&[&study[..], &["--shard", "1/2", "--out", &folder.path("part")]].concat());
}

/// Readings of eight units at two loads, whose increments scatter.
fn readings(folder: &Folder) -> String {
    let mut text = "unit,load,kind,hours,um,whole\n".to_owned();
    let mut state = 1_u32;
    for unit in 0..8 {
        let mut wear = 0.0;
        for hours in 1..9 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            wear += 0.4 + 2.0 * f64::from(state >> 8) / f64::from(1 << 24) * f64::from(1 + unit % 2);
            let (load, kind) = if unit % 2 == 0 { (50, "a") } else { (100, "b") };
            let _ = writeln!(text, "u{unit},{load},{kind},{},{wear:.4},{:.0}", 10 * hours, 3.0 * wear);
        }
    }
    folder.write("readings.csv", &text)
}

#[test]
fn sensitivities_are_as_told() {
    let few = [
        "sensitivity",
        "mechanisms/rssr.toml",
        "--points",
        "3",
        "--step",
        "5e-5",
        "--by",
        "k_wear,wear_rate",
    ];
    asked(&few);
    asked(&[&few[..], &["--trajectories", "20"]].concat());
}

#[test]
fn what_is_identified_is_as_told() {
    let curve = ["--measured", "examples/data/rocker_torque.csv"];
    let damper = ["identify", "examples/data/rocker_drive.toml", "--free", "c_rocker=0.005..0.5 N m s/rad"];
    asked(&[&damper[..], &curve[..]].concat());
    // One that the curve cannot tell.
    asked(
        &[&damper[..], &["--free", "m_clamp=10g..1kg", "--free", "m_load=0.1kg..2kg"], &curve[..]].concat(),
    );
    let worn =
        ["--inspections", "R2=examples/data/worn_bush.csv", "--revolutions", "revolutions", "--wear", "wear"];
    let bush = ["identify", "examples/data/worn_bush.toml", "--free", "k_wear=1e-8..1e-6", "--gauge", "2um"];
    asked(&[&bush[..], &worn[..]].concat());
}

#[test]
fn fits_and_predictions_are_as_told() {
    let folder = Folder::new("outputs-fits");
    let data = readings(&folder);
    let log = folder.write("log.csv", "hours,um\n10,1.2\n20,2.9\n30,4.1\n");
    let fit = ["fit", &data, "--unit", "unit", "--wear", "um", "--exposure", "hours", "--from-zero"];
    let file = folder.path("fit.json");
    for process in ["gamma", "inverse-gaussian", "wiener"] {
        for more in [&[][..], &["--power-law"], &["--compare"], &["--bootstrap", "40", "--groups", "kind"]] {
            asked(&[&fit[..], &["--process", process, "--out", &file], more].concat());
            held("fit-file", &serde_json::from_str(&folder.read("fit.json")).expect("JSON"), process);
        }
        let predict = ["predict", &file, "--threshold", "25"];
        asked(&predict);
        let questions = [
            "--quantile",
            "1%",
            "--reliability-at",
            "3",
            "--mission",
            "1..2",
            "--from",
            "2026-11-23",
            "--per-day",
            "1",
        ];
        let also = format!("{file}:20");
        asked(&[&predict[..], &questions[..], &["--also", &also]].concat());
        asked(&[&predict[..], &["--current", "5", "--rate", "2"]].concat());
        let inspected = ["--inspections", &log, "--time", "hours", "--wear", "um"];
        asked(&[&predict[..], &inspected[..]].concat());
        asked(&[&predict[..], &inspected[..], &["--flat-prior"]].concat());
    }
    asked(&[&fit[..], &["--out", &file, "--covariate", "load"]].concat());
    asked(&["predict", &file, "--threshold", "25", "--covariate", "load=70"]);
    let rounded = fit.map(|word| if word == "um" { "whole" } else { word });
    for gauge in [&[][..], &["--gauge", "0.5"]] {
        asked(&[&rounded[..], &["--resolution", "1"], gauge].concat());
    }
    asked(&[&fit[..], &["--out", &file]].concat());
    asked(&["predict", &file, "--threshold", "25", "--draws", "100"]);
    let gauge = ["--inspections", &log, "--time", "hours", "--wear", "um", "--gauge", "0.2"];
    asked(&[&["predict", &file, "--threshold", "25"], &gauge[..]].concat());
    let bare = folder.write("bare.json", r#"{ "alpha": 0.2, "beta": 1.5 }"#);
    asked(&["predict", &bare, "--threshold", "25"]);
    let plan = ["plan", &bare, "--threshold", "25", "--preventive", "10", "--failure", "80"];
    asked(&plan);
    let looks =
        ["--inspection", "1", "--downtime", "2", "--look-at", "20", "--parts", "3", "--horizon", "500"];
    asked(&[&plan[..], &looks[..]].concat());
}

#[test]
fn failures_are_as_told() {
    let folder = Folder::new("outputs-failures");
    let wrong = folder.write("wrong.toml", "spec = 1\nname = \"x\"\n[bodies]\na = { mass = \"1 m\" }\n");
    for words in [
        &["check", "no/such.toml"][..],
        &["check", &wrong],
        &["simulate", PENDULUM, "--turns", "x"],
        &["simulate", PENDULUM, "--out", "-"],
        &["simulate", PENDULUM, "--backend", "nothing"],
        &["life", PENDULUM],
        &["merge", &wrong, "--out", &folder.path("all")],
        &["predict", PENDULUM, "--threshold", "3"],
        &[
            "fit",
            "examples/data/sliding_wear_100g.csv",
            "--unit",
            "unit",
            "--wear",
            "nothing",
            "--exposure",
            "cycles",
        ],
    ] {
        let answer: Answer = linkwear(&[words, &["--format", "json"]].concat());
        assert_ne!(answer.code, 0, "{words:?}");
        held("errors", &serde_json::from_str(&answer.out).expect("JSON"), &words.join(" "));
    }
}
