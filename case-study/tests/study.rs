//! The case study in its quick form: the same bits every time, near the independent code, nothing about this machine.

use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;

use linkwear_case_study::{
    Lives, Options, Picture, Prediction, Protocol, Study, TRUE_LIFE, html, markdown, pictures, run,
};
use linkwear_runtime::Watch;
use serde_json::Value;

const OPTIONS: Options = Options { quick: true, seed: 7 };

/// One study for all tests, on two threads.
fn study() -> &'static Study {
    static STUDY: OnceLock<Study> = OnceLock::new();
    STUDY.get_or_init(|| run(OPTIONS, 2, Watch::NONE).unwrap_or_else(|error| panic!("{error}")))
}

#[test]
fn the_flexible_force_is_that_of_the_independent_code() {
    let forces = &study().forces;
    // Two codes with contact vibrations of 2 kHz; measured 5.2e-5.
    assert!(forces.error < 1e-3, "{:e}", forces.error);
    // Frequencies six digits apart change little; measured 1.2e-4.
    assert!(forces.error_as_shipped < 1e-3, "{:e}", forces.error_as_shipped);
    // A chattering journal, see tests/clearance_rigid.rs.
    assert!((58.0..70.0).contains(&forces.rigid.peak), "{} N", forces.rigid.peak);
    assert!((forces.ideal.peak / forces.flexible.peak - 1.0).abs() < 1e-2);
}

#[test]
fn wear_concentrates_where_the_load_presses_and_chatter_spreads_it() {
    let around = &study().around;
    for (at, snapshot) in around.proposed.snapshots.iter().enumerate() {
        // Cycle 25.1 wears 80 µm: 10, 20 and 30 lie where a rate that grows slowly puts them.
        assert!((snapshot.maximum > 80e-6) == (at == 2), "{}", snapshot.maximum);
        // Half a bin of 5 deg from the angles of tests/reference/rssr_clearance/wear_by_angle_10um.csv, where most
        // of S lies in 200 to 205 and 350 to 355 deg.
        let angles: Vec<f64> = snapshot.peaks.iter().take(2).map(|peak| peak.angle).collect();
        assert!(angles.iter().any(|angle| (angle + 157.5).abs() < 2.5), "{angles:?}");
        assert!(angles.iter().any(|angle| (angle + 7.5).abs() < 2.5), "{angles:?}");
        let (rigid, finest) = (&around.deterministic.snapshots[at], &around.finest.snapshots[at]);
        assert!(rigid.maximum < 0.6 * snapshot.maximum);
        // The same volume to the difference of the wear integrals, 2 to 4 %.
        assert!((rigid.mean / snapshot.mean - 1.0).abs() < 0.05);
        // Tables of 5 and of 7 points.
        assert!((finest.maximum / snapshot.maximum - 1.0).abs() < 0.15);
    }
}

/// Predictions of proposed, baseline 1 and baseline 2.
fn predictions(wear: &str, gamma: f64, protocol: Protocol) -> &'static [Prediction] {
    let is_it = |lives: &&Lives| lives.wear == wear && lives.gamma == gamma;
    let lives = study().lives.iter().find(is_it).expect("a definition of wear");
    lives.under(protocol)
}

#[test]
fn lives_are_those_that_the_protocols_lead_to() {
    for lives in &study().lives {
        // 2000 lives with a deviation of 0.75 cycle: 0.017; three times that, and the half step that a mean path is
        // ahead of the mean life (theory of first passage: 1/(2 x 43.7) cycle).
        assert!((lives.truth.mean - TRUE_LIFE).abs() < 0.07, "{:?}", lives.truth);
        // Whole cycles count half a cycle more, but for the shape of the last cycle.
        assert!((lives.truth.mean_whole - lives.truth.mean - 0.5).abs() < 0.05, "{:?}", lives.truth);
    }
    // Ten data sets know an error to 0.5/sqrt(10) = 0.16 %; four times that around what 240 give, see CHANGELOG.
    for gamma in [0.1, 1.0] {
        let all = predictions("depth", gamma, Protocol::All);
        assert!(all[0].error.abs() < 0.007, "{:?}", all[0]);
        // A fit of 500 increments knows it to 3 %, 300 lives to 4 %: ten sets to 0.05 of 3.0 per cent. Three times that.
        assert!((0.0285..0.0315).contains(&all[0].lives.cov), "{:?}", all[0]);
        // Both have wear that grows with the root of the clearance: the fit takes away the constant factor left.
        assert!((all[1].error - all[0].error).abs() < 0.003, "{:?}", all[1]);
    }
    let early = &predictions("depth", 0.1, Protocol::First20)[2];
    assert!((0.02..0.04).contains(&early.error), "{early:?}");
    assert!((0.032..0.035).contains(&early.lives.cov), "{early:?}");
    // The more of the life is seen, the smaller the error of a model that takes the rate for constant.
    let ten = &predictions("depth", 0.1, Protocol::First10)[2];
    assert!(ten.error > 2.0 * early.error, "{ten:?}");
    // With shared parameters the spread of wear over the bearing is no factor to be fitted.
    let shared = &predictions("largest depth", 0.1, Protocol::Shared)[1];
    assert!(shared.error > 1.0 && shared.over_predicts == 1.0, "{shared:?}");
}

#[test]
fn orderings_are_shares_of_the_data_sets_and_hold_together() {
    for under in study().lives.iter().flat_map(|lives| &lives.protocols) {
        let found = under.orderings;
        let single = [
            found.proposed_is_nearest,
            found.proposed_is_narrowest,
            found.baselines_over_predict,
            found.rigid_is_longest,
        ];
        assert!(single.iter().all(|part| (found.all..=1.0).contains(part)), "{under:?}");
    }
    let text = markdown(study());
    for present in ["## Findings", "Cancellation:", "Damping:", "Area model:", "Table 2 of the paper"] {
        assert!(text.contains(present), "{present}");
    }
}

#[test]
fn a_page_needs_no_other_file() {
    let drawn = pictures(study()).expect("pictures");
    let page = html(study(), &drawn);
    for absent in ["<script", "src=", "href=", "url("] {
        assert!(!page.contains(absent), "{absent}");
    }
    assert_eq!(page.matches("<svg").count(), drawn.len());
}

/// Exit code and what the program prints, on one thread.
fn program(out: &Path) -> (i32, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_linkwear-case-study"));
    command.args(["--quick", "--seed", "7", "--threads", "1", "--format", "json", "--out"]).arg(out);
    let answer = command.output().expect("the program runs");
    (answer.status.code().expect("a code"), String::from_utf8(answer.stdout).expect("text"))
}

/// The program's study is another one, in another process and on another number of threads: every byte is the same.
#[test]
fn the_program_writes_the_same_bytes_on_any_number_of_threads_as_whole_files_into_a_fresh_folder_only() {
    let out = std::env::temp_dir().join(format!("linkwear-case-study-{}", std::process::id()));
    let (code, printed) = program(&out);
    assert_eq!(code, 0);
    let results = serde_json::to_value(study()).expect("plain data");
    let text = format!("{results:#}\n");
    assert_eq!(printed, text);
    for key in ["truth", "proposed", "baseline_1", "baseline_2"] {
        assert!(results["table2"][key]["mean"].is_f64(), "{key}");
    }
    assert_eq!(results["protocol"]["fitted_on"], "first20");
    for absent in ["wall", "elapsed", "millis", "/tmp", env!("CARGO_MANIFEST_DIR")] {
        assert!(!text.contains(absent), "{absent}");
    }
    let drawn = pictures(study()).expect("pictures");
    let mut expected = vec![
        ("case-study.html".to_owned(), html(study(), &drawn).into_bytes()),
        ("case-study.md".to_owned(), markdown(study()).into_bytes()),
        ("results.json".to_owned(), text.into_bytes()),
    ];
    for Picture { name, svg, png } in drawn {
        expected.extend([(format!("{name}.png"), png), (format!("{name}.svg"), svg.into_bytes())]);
    }
    expected.sort();
    let mut written: Vec<(String, Vec<u8>)> = std::fs::read_dir(&out)
        .expect("the folder")
        .map(|entry| entry.expect("an entry"))
        .map(|entry| {
            let bytes = std::fs::read(entry.path()).expect("a file");
            (entry.file_name().to_string_lossy().into_owned(), bytes)
        })
        .collect();
    written.sort();
    let names = |files: &[(String, Vec<u8>)]| files.iter().map(|file| file.0.clone()).collect::<Vec<_>>();
    assert_eq!(names(&written), names(&expected));
    for ((name, bytes), (_, expected)) in written.iter().zip(&expected) {
        assert!(bytes == expected, "{name}");
    }

    let (code, refused) = program(&out);
    let refused: Value = serde_json::from_str(&refused).expect("JSON");
    assert_eq!((code, &refused["errors"][0]["code"]), (1, &Value::from("C0004")));
    std::fs::remove_dir_all(&out).expect("the folder goes");
}
