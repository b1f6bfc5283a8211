//! `diff`: two results, or two mechanism files, side by side.

use crate::command::{Folder, linkwear};
use serde_json::Value;

const RSSR: &str = "mechanisms/rssr_rigid.toml";

/// A run with a tolerance, as a table and as JSON.
fn simulated(folder: &Folder, name: &str, tolerance: &str) -> [String; 2] {
    let rows = folder.path(&format!("{name}.csv"));
    let answer = linkwear(&["simulate", RSSR, "--tol", tolerance, "--out", &rows, "--format", "json"]);
    assert_eq!(answer.code, 0, "{}", answer.err);
    [rows, folder.write(&format!("{name}.json"), &answer.out)]
}

/// What differs.
fn keys(told: &Value) -> Vec<&str> {
    let differences = told["differences"].as_array().expect("a list");
    differences.iter().filter_map(|one| one["key"].as_str()).collect()
}

#[test]
fn what_runs_are_of_comes_first_then_columns_with_the_place_of_their_largest_difference() {
    let folder = Folder::new("diff");
    let [rough, rough_json] = simulated(&folder, "rough", "1e-4");
    let [fine, fine_json] = simulated(&folder, "fine", "1e-9");
    let text = linkwear(&["diff", &rough, &fine]);
    assert!(text.code == 0 && text.out.contains("options.tolerance"), "{}{}", text.out, text.err);
    let told = linkwear(&["diff", &rough, &fine, "--format", "json"]).json();
    assert_eq!(
        (&told["kind"], &told["identical"], &told["agree"]),
        (&"a table".into(), &false.into(), &().into())
    );
    assert_eq!(told["made"][0]["key"], "options.tolerance");
    let differences = told["differences"].as_array().expect("a list");
    let sizes: Vec<f64> = differences.iter().map(|one| one["relative"].as_f64().expect("a number")).collect();
    assert!(sizes.is_sorted_by(|one, next| one >= next) && sizes[0] > 0.0, "{sizes:?}");
    // The largest difference is where it is said to be.
    let first = &differences[0];
    let cells = |file: &str| {
        let mut rows = csv::Reader::from_path(file).expect("a table");
        let at =
            rows.headers().expect("titles").iter().position(|title| first["key"] == title).expect("a column");
        let column = rows.records().map(|row| row.expect("a row")[at].parse::<f64>().expect("a number"));
        column.collect::<Vec<f64>>()
    };
    let (a, b) = (cells(&rough), cells(&fine));
    let gaps: Vec<f64> = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).collect();
    let most = gaps.iter().copied().fold(0.0, f64::max);
    assert_eq!(first["largest"], most);
    let row = gaps.iter().position(|gap| *gap == most).expect("a row");
    assert_eq!(first["place"]["key"], format!("row {}", row + 1));
    assert_eq!(first["place"]["column"], "t [s]");
    // The same in JSON; the time it took here is not compared.
    let told = linkwear(&["diff", &rough_json, &fine_json, "--format", "json"]).json();
    let keys = keys(&told);
    assert!(keys.contains(&"steps") && !keys.contains(&"wall_seconds"), "{keys:?}");
}

#[test]
fn the_exit_status_says_whether_they_agree_within_a_tolerance() {
    let folder = Folder::new("diff-tolerance");
    let [rough, _] = simulated(&folder, "rough", "1e-4");
    let [fine, _] = simulated(&folder, "fine", "1e-9");
    let code = |a: &str, b: &str, most: &str| linkwear(&["diff", a, b, "--tolerance", most]).code;
    let told = linkwear(&["diff", &rough, &fine, "--format", "json"]).json();
    let most = told["differences"][0]["relative"].as_f64().expect("a number");
    assert_eq!(code(&rough, &fine, &format!("{}", 1.001 * most)), 0);
    assert_eq!(code(&rough, &fine, &format!("{}", 0.999 * most)), 1);
    assert_eq!(code(&fine, &fine, "0"), 0);
    assert_eq!(code(&fine, &fine, "-1"), 2);
    let answer = linkwear(&["diff", &fine, &fine]);
    assert!(answer.code == 0 && answer.out.starts_with("identical: 78 columns, 201 rows"), "{}", answer.out);
}

#[test]
fn tables_are_the_same_in_every_format() {
    let folder = Folder::new("diff-formats");
    let files = [
        "a.csv",
        "a.npy",
        #[cfg(feature = "parquet")]
        "a.parquet",
    ]
    .map(|name| folder.path(name));
    for file in &files {
        assert_eq!(linkwear(&["simulate", RSSR, "--out", file]).code, 0);
    }
    for file in &files[1..] {
        let told = linkwear(&["diff", &files[0], file, "--format", "json"]).json();
        assert!(told["identical"] == true && told["made"].as_array().is_some_and(Vec::is_empty), "{told}");
    }
}

#[test]
fn lives_are_compared_by_their_folders_and_tables_with_names() {
    let folder = Folder::new("diff-lives");
    let lived = |seed: &str| {
        let out = folder.path(&format!("life{seed}"));
        let words = ["life", "mechanisms/rssr.toml", "--trajectories", "10", "--seed", seed, "--out", &out];
        assert_eq!(linkwear(&words).code, 0);
        out
    };
    let (one, other) = (lived("1"), lived("2"));
    let told = linkwear(&["diff", &one, &other, "--format", "json"]).json();
    assert_eq!((&told["kind"], &told["made"][0]["key"]), (&"a result of life".into(), &"seed".into()));
    let keys = keys(&told);
    assert!(keys.contains(&"mean") && !keys.contains(&"mean_path.cycles"), "{keys:?}");
    let rows = |life: &str| format!("{life}/lives.csv");
    let told = linkwear(&["diff", &rows(&one), &rows(&other), "--format", "json"]).json();
    assert_eq!((&told["rows"][0], &told["identical"]), (&10.into(), &false.into()));
}

#[test]
fn mechanism_files_are_compared_by_what_they_say_not_by_how() {
    let folder = Folder::new("diff-files");
    let text = std::fs::read_to_string("mechanisms/rssr.toml").expect("a file");
    let same = folder.write("same.toml", &text.replace("\"10 um\"", "\"0.01 mm\"").replace("# ", "#  "));
    let told =
        linkwear(&["diff", "mechanisms/rssr.toml", &same, "--tolerance", "1e-15", "--format", "json"]).json();
    assert_eq!(told["agree"], true, "{told}");
    let other = folder.write("other.toml", &text.replace("\"120 mm\"", "\"121 mm\""));
    let told = linkwear(&["diff", "mechanisms/rssr.toml", &other, "--format", "json"]).json();
    let differences = told["differences"].as_array().expect("a list");
    assert_eq!((differences.len(), &differences[0]["key"]), (1, &"parameters.L1".into()));
    assert!((differences[0]["largest"].as_f64().expect("a number") - 1e-3).abs() < 1e-15);
}

#[test]
fn files_that_say_another_thing_are_not_identical() {
    let folder = Folder::new("diff-apart");
    let pairs = [
        ("a = \"1 s\"", "a = \"1 m\""),
        ("a = \"10 N/m\"", "a = \"10 N m\""),
        ("a = 3", "a = \"3 kg\""),
        ("a = \"0 m\"", "a = \"0 kg\""),
        ("a = inf", "a = -inf"),
        ("a = 9007199254740993", "a = 9007199254740992"),
        ("a = 1\n[b]", "a = 1"),
        ("a = [1, []]", "a = [1]"),
        ("[[s]]\nt = 1\nv = 5\n[[s]]\nt = 1", "[[s]]\nt = 1\n[[s]]\nt = 1\nv = 5"),
        ("[[s]]\nt = 1\nv = 5\n[[s]]\nt = 1", "[[s]]\nt = 1\nv = 5\n[[s]]\nt = 1\nv = 5"),
    ];
    for (number, (a, b)) in pairs.into_iter().enumerate() {
        let files =
            [folder.write(&format!("{number}a.toml"), a), folder.write(&format!("{number}b.toml"), b)];
        for (one, other, same) in [(0, 1, false), (1, 0, false), (0, 0, true), (1, 1, true)] {
            let told = linkwear(&["diff", &files[one], &files[other], "--format", "json"]).json();
            assert_eq!(told["identical"], same, "{a} {b}: {told}");
            let code = linkwear(&["diff", &files[one], &files[other], "--tolerance", "0"]).code;
            assert_eq!(code == 0, same, "{a} {b}");
        }
    }
}

#[test]
fn columns_of_one_title_are_compared_by_their_order() {
    let folder = Folder::new("diff-titles");
    let one = folder.write("one.csv", "a,b,b\n0,1,2\n1,1,3\n");
    let other = folder.write("other.csv", "a,b,b\n0,1,2\n1,1,4\n");
    let fewer = folder.write("fewer.csv", "a,b\n0,1\n1,1\n");
    let told = |a: &str, b: &str| linkwear(&["diff", a, b, "--format", "json"]).json();
    assert_eq!(told(&one, &one)["identical"], true);
    let found = told(&one, &other);
    assert_eq!((&found["differences"][0]["a"], &found["differences"][0]["b"]), (&"3".into(), &"4".into()));
    assert_eq!(told(&one, &fewer)["only_in_a"], serde_json::json!(["b"]));
}

#[test]
fn results_of_different_kinds_are_refused_with_the_reason() {
    let folder = Folder::new("diff-kinds");
    let [rows, json] = simulated(&folder, "run", "1e-4");
    let answer = linkwear(&["diff", &rows, &json]);
    assert!(
        answer.code == 2 && answer.err.contains("is a table") && answer.err.contains("a result of simulate")
    );
    let check = linkwear(&["check", RSSR, "--format", "json"]).out;
    let answer = linkwear(&["diff", &json, &folder.write("check.json", &check)]);
    assert!(answer.code == 2 && answer.err.contains("a result of check"), "{}", answer.err);
    let nothing = folder.write("nothing.json", "{\"a\": 1}");
    let answer = linkwear(&["diff", &nothing, &json]);
    assert!(answer.code == 1 && answer.err.contains("no result of linkwear"), "{}", answer.err);
    let broken = folder.write("broken.npy", "no numbers");
    let answer = linkwear(&["diff", &broken, &rows]);
    assert!(answer.code == 1 && answer.err.contains("no table"), "{}", answer.err);
    let uneven = folder.write("uneven.csv", "t [s],q\n0,1\n# so far\n\n1\n");
    let answer = linkwear(&["diff", &uneven, &rows]);
    assert!(answer.code == 1 && answer.err.contains("line 5: 1 cells"), "{}", answer.err);
}
