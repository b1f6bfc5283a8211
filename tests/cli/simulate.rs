//! `simulate`: what scripts read, what files appear, and which back end runs.

use crate::command::{Folder, linkwear};
use serde_json::Value;

const PENDULUM: &str = "mechanisms/pendulum.toml";
const RSSR: &str = "mechanisms/rssr_rigid.toml";

/// Whether machine code is written for this processor.
fn has_native() -> bool {
    #[cfg(target_arch = "x86_64")]
    return std::arch::is_x86_feature_detected!("avx");
    #[cfg(not(target_arch = "x86_64"))]
    return cfg!(all(target_arch = "aarch64", target_os = "linux"));
}

/// The back end that serves a shipped file here.
fn fastest() -> &'static str {
    if has_native() { "native" } else { "compiled" }
}

/// Header and rows of a CSV.
fn table(text: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut lines = text.lines();
    let header = lines.next().expect("a header").split(',').map(str::to_owned).collect();
    let cell = |cell: &str| cell.parse().unwrap_or_else(|_| panic!("`{cell}` is no number"));
    (header, lines.map(|line| line.split(',').map(cell).collect()).collect())
}

#[test]
fn the_answer_has_the_fields_scripts_read() {
    let answer = linkwear(&["simulate", RSSR, "--format", "json"]).json();
    let promised = ["steps", "evaluations", "wall_seconds", "max_loop_error_m", "energy_error_J"];
    let more = [
        "rejected",
        "projections",
        "rank_revealing_solves",
        "newton_iterations",
        "energy_throughput_J",
        "max_loop_error_rad",
    ];
    for name in promised.iter().chain(&more) {
        assert!(answer[name].is_number(), "{name}");
    }
    assert_eq!(answer["backend"], fastest());
    assert!(answer["steps"].as_u64() > Some(0));
    assert!(answer["evaluations"].as_u64() >= answer["steps"].as_u64());
    // One turn at 2 Hz; the time is reached to rounding.
    assert!((answer["time_s"].as_f64().expect("a number") - 0.5).abs() < 1e-12);
    // The loop is projected back to rounding of its lengths (0.4 m), far below what the issue asks.
    assert!(answer["max_loop_error_m"].as_f64() < Some(1e-10));
}

#[test]
fn the_implicit_method_takes_its_step_and_counts_newton() {
    let arguments = ["--integrator", "generalized-alpha", "--step", "1e-4", "--turns", "0.1"];
    let answer = linkwear(&[&["simulate", RSSR, "--format", "json"], &arguments[..]].concat()).json();
    // A tenth of a turn is 0.05 s; steps are shortened to land on the 200 samples 2.5e-4 s apart.
    assert_eq!(answer["steps"], 600);
    assert!(answer["newton_iterations"].as_u64() >= Some(600));
}

#[test]
fn rows_are_evenly_spaced_with_both_ends() {
    let folder = Folder::new("rows");
    let out = folder.path("p.csv");
    let answer = linkwear(&["simulate", PENDULUM, "--time", "0.5", "--samples", "11", "--out", &out]);
    assert_eq!(answer.code, 0, "{}", answer.err);
    let (header, rows) = table(&folder.read("p.csv"));
    assert_eq!(header[0], "t [s]");
    assert!(header.contains(&"hinge.q [rad]".to_owned()), "{header:?}");
    assert_eq!(rows.len(), 11);
    for (index, row) in rows.iter().enumerate() {
        assert_eq!(row.len(), header.len());
        // Spacing is exact but for the rounding of one product.
        assert!((row[0] - 0.05 * index as f64).abs() < 1e-15);
        assert!(row.iter().all(|value| value.is_finite()));
    }
    assert_eq!(folder.names(), ["p.csv", "p.csv-metadata.json"]);
}

#[test]
fn an_array_of_numpy_has_the_columns_and_the_numbers_of_the_csv() {
    let folder = Folder::new("npy");
    for name in ["p.csv", "p.npy"] {
        let out = folder.path(name);
        let answer = linkwear(&["simulate", PENDULUM, "--time", "0.1", "--samples", "11", "--out", &out]);
        assert_eq!(answer.code, 0, "{}", answer.err);
    }
    let (titles, rows) = table(&folder.read("p.csv"));
    let bytes = std::fs::read(folder.path("p.npy")).expect("a file");
    let length = u32::from_le_bytes(bytes[8..12].try_into().expect("four bytes")) as usize;
    let (header, values) = bytes[12..].split_at(length);
    let header = std::str::from_utf8(header).expect("UTF-8");
    assert!(titles.iter().all(|title| header.contains(&format!("('{title}', '<f8')"))), "{header}");
    assert!(header.contains("'shape': (11,)"), "{header}");
    let value = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().expect("eight bytes"));
    assert_eq!(values.chunks(8).map(value).collect::<Vec<_>>(), rows.concat());
    let help = linkwear(&["simulate", "--help"]).out;
    assert!(help.contains(".csv (text), .npy (NumPy structured array)"), "{help}");
}

/// What the file's bits are as a table: `src/table/parquet.rs`, and `tests/parquet_readers.py` by programs of other makers.
#[cfg(feature = "parquet")]
#[test]
fn a_parquet_file_has_what_is_known_about_the_table_within_and_a_csv_file_beside() {
    use serde_json::json;

    let folder = Folder::new("parquet");
    for name in ["p.csv", "p.parquet", "q.parquet"] {
        let out = folder.path(name);
        let answer = linkwear(&["simulate", PENDULUM, "--time", "0.1", "--samples", "11", "--out", &out]);
        assert_eq!(answer.code, 0, "{}", answer.err);
    }
    assert_eq!(folder.names(), ["p.csv", "p.csv-metadata.json", "p.parquet", "q.parquet"]);
    let bytes = std::fs::read(folder.path("p.parquet")).expect("a file");
    assert_eq!(bytes, std::fs::read(folder.path("q.parquet")).expect("a file"));
    assert!(bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"));
    let beside: Value = serde_json::from_str(&folder.read("p.csv-metadata.json")).expect("JSON");
    assert_eq!((&beside["@context"], &beside["url"]), (&json!("http://www.w3.org/ns/csvw"), &json!("p.csv")));
    let (titles, _) = table(&folder.read("p.csv"));
    let columns = beside["tableSchema"]["columns"].as_array().expect("columns");
    assert_eq!(
        columns.iter().map(|column| column["titles"].as_str().unwrap_or("")).collect::<Vec<_>>(),
        titles
    );
    let column = json!({ "name": "hinge.q", "titles": "hinge.q [rad]", "datatype": "double", "schema:unitText": "rad" });
    assert!(columns.contains(&column), "{columns:?}");
    let answer =
        linkwear(&["simulate", PENDULUM, "--time", "0.1", "--samples", "11", "--format", "json"]).json();
    assert_eq!(
        (&beside["notes"][0]["format"], &beside["notes"][0]["provenance"]),
        (&answer["format"], &answer["provenance"])
    );
    // The same is in the other file, found as text: it is not compressed.
    let within = json!({ "format": 1, "columns": columns, "provenance": answer["provenance"] }).to_string();
    assert!(bytes.windows(within.len()).any(|window| window == within.as_bytes()));
}

#[test]
fn one_turn_turns_the_crank_once() {
    let folder = Folder::new("turn");
    let out = folder.path("rssr.csv");
    assert_eq!(linkwear(&["simulate", RSSR, "--out", &out]).code, 0);
    let (header, rows) = table(&folder.read("rssr.csv"));
    let crank = header.iter().position(|name| name == "R1.q [rad]").expect("the crank's angle");
    assert_eq!(rows.len(), 201);
    let turned = rows[200][crank] - rows[0][crank];
    // The driver is 4 pi t: two roundings at size 2 pi.
    assert!((turned - std::f64::consts::TAU).abs() < 1e-14, "{turned}");
}

#[test]
fn a_tunable_parameter_keeps_the_compiled_back_end_and_acts() {
    let at = |speed: &str| {
        linkwear(&["simulate", RSSR, "--set", speed, "--backend", "compiled", "--format", "json"]).json()
    };
    let (slow, fast) = (at("speed=2 Hz"), at("speed=4 Hz"));
    assert_eq!(fast["backend"], "compiled");
    let ratio = slow["time_s"].as_f64().expect("s") / fast["time_s"].as_f64().expect("s");
    assert!((ratio - 2.0).abs() < 1e-12, "a turn takes half as long: {ratio}");
}

#[test]
fn another_text_or_a_folded_parameter_runs_as_machine_code_written_now() {
    let folder = Folder::new("other");
    let text = std::fs::read_to_string(RSSR).expect("a file");
    let other = folder.write("rssr_rigid.toml", &format!("{text}\n# changed\n"));
    let backend = |arguments: &[&str]| {
        let all = [&["simulate"], arguments, &["--turns", "0.1", "--format", "json"]].concat();
        linkwear(&all).json()["backend"].clone()
    };
    // Processors without it interpret.
    let written_now = if has_native() { "native" } else { "interpreter" };
    assert_eq!(backend(&[&other]), written_now);
    assert_eq!(backend(&[RSSR, "--set", "L1=121 mm"]), written_now);
    assert_eq!(backend(&[RSSR, "--closure", "log"]), written_now);
    // Nothing of these differs from what was compiled in, which may be asked for; machine code is faster.
    assert_eq!(backend(&[RSSR, "--closure", "joint", "--backend", "compiled"]), "compiled");
    assert_eq!(backend(&[RSSR, "--closure", "joint"]), fastest());
    assert_eq!(backend(&[RSSR]), fastest());
    assert_eq!(backend(&[RSSR, "--backend", "interpreter"]), "interpreter");
}

#[test]
fn back_ends_write_the_same_bytes() {
    let folder = Folder::new("same");
    let backends = ["compiled", "interpreter"].into_iter().chain(has_native().then_some("native"));
    for backend in backends.clone() {
        let out = folder.path(&format!("{backend}.csv"));
        let answer = linkwear(&["simulate", RSSR, "--turns", "0.2", "--backend", backend, "--out", &out]);
        assert_eq!(answer.code, 0, "{}", answer.err);
    }
    for backend in backends {
        assert!(folder.read("compiled.csv") == folder.read(&format!("{backend}.csv")), "{backend}");
    }
}

#[test]
fn a_back_end_that_cannot_is_refused_with_a_way_out() {
    let folder = Folder::new("refuse");
    let other =
        folder.write("mine.toml", &std::fs::read_to_string(PENDULUM).expect("a file").replace('#', "##"));
    let answer = linkwear(&["simulate", &other, "--backend", "compiled"]);
    assert_eq!(answer.code, 1);
    assert!(answer.err.contains("C0007") && answer.err.contains("help: "), "{}", answer.err);
}

#[test]
fn a_failed_run_leaves_no_file() {
    let folder = Folder::new("failed");
    let out = folder.path("rows.csv");
    for arguments in [
        &["simulate", PENDULUM, "--out", &out, "--set", "no_such_parameter=1"][..],
        &["simulate", RSSR, "--out", &out, "--backend", "compiled", "--closure", "log"],
    ] {
        assert_eq!(linkwear(arguments).code, 1);
    }
    assert!(folder.names().is_empty());
    let nowhere = folder.path("missing/rows.csv");
    let answer = linkwear(&["simulate", PENDULUM, "--out", &nowhere]);
    assert_eq!(answer.code, 1);
    assert!(answer.err.contains("C0003"), "{}", answer.err);
}

#[cfg(unix)]
#[test]
fn an_interrupt_keeps_what_was_computed() {
    use std::io::{BufRead, BufReader, Read};
    let folder = Folder::new("interrupt");
    let out = folder.write("rows.csv", "<!-- linkwear 0.0.0 -->\ncomplete rows of an earlier run");
    // Long enough that it cannot end before the signal comes.
    let mut child = crate::command::start(&[
        "simulate",
        PENDULUM,
        "--time",
        "1e7",
        "--samples",
        "2000000",
        "--out",
        &out,
    ]);
    // A line of its progress: however slow the machine is, there are rows.
    let mut told = BufReader::new(child.stderr.take().expect("a pipe"));
    let mut line = String::new();
    while !line.contains('%') {
        line.clear();
        assert!(told.read_line(&mut line).expect("text") > 0, "it ended");
    }
    let killed = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(killed.expect("kill runs").success());
    let mut err = String::new();
    told.read_to_string(&mut err).expect("text");
    assert_eq!(crate::command::Answer::of(child.wait_with_output().expect("an end")).code, 1);
    assert!(err.contains("C0009"), "{err}");
    assert_eq!(folder.read("rows.csv"), "<!-- linkwear 0.0.0 -->\ncomplete rows of an earlier run");
    let (header, rows) = table(&folder.read("rows.partial.csv"));
    assert!(!rows.is_empty() && rows.iter().all(|row| row.len() == header.len()));
    assert_eq!(folder.names(), ["rows.csv", "rows.partial.csv", "rows.partial.csv-metadata.json"]);
}

#[test]
fn peaks_are_those_of_the_steps_however_many_rows_there_are() {
    for (file, length) in
        [(RSSR, ["--turns", "1"]), ("mechanisms/slider_crank_clearance.toml", ["--turns", "1"])]
    {
        let answer = |samples: &str| {
            let all = [&["simulate", file, "--samples", samples, "--format", "json"], &length[..]].concat();
            linkwear(&all).json()
        };
        let few = answer("2");
        let forces = |answer: &Value| -> Vec<(f64, f64)> {
            let peaks = answer["peaks"].as_array().expect("a list").iter();
            let both =
                |peak: &Value| ["force_N", "force_time_s"].map(|key| peak[key].as_f64().expect("a number"));
            peaks.map(both).map(|[force, time]| (force, time)).collect()
        };
        let expected = forces(&few);
        assert!(expected.iter().any(|(force, time)| *force > 1.0 && *time > 0.0), "{expected:?}");
        for samples in ["201", "20001"] {
            // Steps do not know the rows: nothing but rounding of states put onto the constraints once more.
            for ((force, time), (known, at)) in forces(&answer(samples)).into_iter().zip(&expected) {
                assert!(
                    (force - known).abs() <= 1e-6 * known && (time - at).abs() < 1e-6,
                    "{force} {known} {time} {at}"
                );
            }
        }
    }
}

#[test]
fn the_peak_at_a_pin_is_that_of_the_turn() {
    let answer =
        linkwear(&["simulate", "mechanisms/slider_crank_clearance.toml", "--turns", "1", "--format", "json"])
            .json();
    let turn = answer["turns"][0].clone();
    let peak = answer["peaks"].as_array().expect("a list").iter().find(|peak| peak["joint"] == turn["joint"]);
    let (peak, turn) = (&peak.expect("the pin")["force_N"], &turn["peak_normal_force_N"]);
    let [peak, turn] = [peak, turn].map(|value| value.as_f64().expect("a number"));
    // Friction adds to the normal force, by its square: at most a part in a hundred at a coefficient of 0.1.
    assert!(peak >= turn * (1.0 - 1e-9) && peak < 1.02 * turn, "{peak} {turn}");
}

#[test]
fn a_person_sees_curves_and_peak_loads() {
    let answer = linkwear(&["simulate", RSSR]);
    assert_eq!(answer.code, 0, "{}", answer.err);
    for part in ["1 turn (0.5000 s)", fastest(), "R1.drive [N m]", "loop error", "peak load at", "S3"] {
        assert!(answer.out.contains(part), "{part} in\n{}", answer.out);
    }
}

#[test]
fn a_dead_point_is_named_and_the_rows_before_it_are_kept() {
    let folder = Folder::new("dead_point");
    let shipped = std::fs::read_to_string("mechanisms/four_bar.toml").expect("it is there");
    let file = shipped
        .replace(", drive = \"2*pi*speed*t\"", "")
        .replace("damping = \"0.05 N m s/rad\"", "drive = \"97 deg + 1 rad/s*t\"")
        .replace("R4 = \"97 deg\"", "R1 = \"-1 deg\"");
    folder.write("four_bar.toml", &file);
    let out = folder.path("rows.csv");
    let run =
        ["simulate", "four_bar.toml", "--time", "2", "--samples", "201", "--out", &out, "--format", "json"];
    let [error] = &folder.linkwear(&run).errors()[..] else { panic!("one error") };
    let (message, help) =
        (error["message"].as_str().expect("a text"), error["help"].as_str().expect("a text"));
    // Crank and coupler folded are 200 mm long: cos = 0.75 at D, and the rocker stands at 180 - 41.41 deg.
    assert!(message.contains("driver of `R4` is at its dead point, 138.59"), "{message}");
    assert!(error["code"] == "C0008" && help.contains("rows.partial.csv"), "{error}");
    // Every 10 ms until (138.59 - 97) deg at 1 rad/s: 0.7259 s.
    let (_, rows) = table(&folder.read("rows.partial.csv"));
    assert_eq!(rows.len(), 73);
    assert_eq!(folder.linkwear(&run[..8]).code, 1);
}
