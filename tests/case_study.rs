//! The case study in its quick form: the same bits every time, near the independent code, nothing about this machine.
#![cfg(feature = "case-study")]

mod command;

use std::sync::OnceLock;

use command::{Folder, linkwear};
use linkwear::case_study::{Options, Study, html, markdown, pictures, run};

const OPTIONS: Options = Options { quick: true, seed: 7 };

fn study_on(threads: usize) -> Study {
    run(OPTIONS, threads, &|_| {}, &|| false).unwrap_or_else(|error| panic!("{error}"))
}

/// One study for all tests.
fn study() -> &'static Study {
    static STUDY: OnceLock<Study> = OnceLock::new();
    STUDY.get_or_init(|| study_on(2))
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
        // Coarse tables, and bins half as wide see higher peaks.
        assert!((finest.maximum / snapshot.maximum - 1.0).abs() < 0.15);
    }
}

#[test]
fn a_study_has_the_same_bits_on_any_number_of_threads_and_on_paper() {
    let again = study_on(1);
    assert_eq!(&again, study());
    let drawn = pictures(study()).expect("pictures");
    for (one, other) in drawn.iter().zip(&pictures(&again).expect("pictures")) {
        assert_eq!((one.name, &one.svg, &one.png), (other.name, &other.svg, &other.png));
    }
    assert_eq!(markdown(study()), markdown(&again));
    let page = html(study(), &drawn);
    for absent in ["<script", "src=", "href=", "url("] {
        assert!(!page.contains(absent), "{absent}");
    }
    assert_eq!(page.matches("<svg").count(), drawn.len());
}

#[test]
fn the_command_writes_whole_files_into_a_fresh_folder_only() {
    let folder = Folder::new("case-study");
    let out = folder.path("study");
    let answer = linkwear(&["case-study", "--quick", "--seed", "7", "--out", &out, "--format", "json"]);
    let results = answer.json();
    assert_eq!(results, serde_json::to_value(study()).expect("plain data"));
    assert_eq!(
        results,
        serde_json::from_str::<serde_json::Value>(&folder.read("study/results.json")).expect("JSON")
    );
    let text = folder.read("study/results.json");
    for absent in ["wall", "elapsed", "millis", "/tmp", env!("CARGO_MANIFEST_DIR")] {
        assert!(!text.contains(absent), "{absent}");
    }
    let mut expected =
        vec!["case-study.html".to_owned(), "case-study.md".to_owned(), "results.json".to_owned()];
    for picture in pictures(study()).expect("pictures") {
        expected.extend([format!("{}.png", picture.name), format!("{}.svg", picture.name)]);
    }
    expected.sort();
    let mut names: Vec<String> = std::fs::read_dir(&out)
        .expect("the folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert_eq!(names, expected);

    let refused = linkwear(&["case-study", "--quick", "--out", &out, "--format", "json"]);
    assert_eq!(refused.code, 1);
    assert_eq!(refused.errors()[0]["code"], "C0004");
}
