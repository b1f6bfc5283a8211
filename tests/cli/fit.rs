//! `fit`: Gamma processes of measured wear from the command line.

use std::fs;
use std::path::PathBuf;

use crate::command::{Folder, linkwear};
use crate::truth::reached;
use linkwear_gamma::special::ln_gamma;
use serde_json::Value;

const HEAVY: &str = "examples/data/sliding_wear_100g.csv";
const COLUMNS: [&str; 6] = ["--unit", "unit", "--wear", "wear_um", "--exposure", "cycles"];

fn fit(file: &str, more: &[&str]) -> Value {
    linkwear(&[&["fit", file], &COLUMNS[..], more, &["--format", "json"]].concat()).json()
}

#[track_caller]
fn close(found: &Value, expected: f64, tolerance: f64) {
    let found = found.as_f64().expect("a number");
    assert!((found / expected - 1.0).abs() <= tolerance, "{found} for {expected}");
}

/// A data file that this process alone uses.
fn written(name: &str, text: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("linkwear-fit-{}-{name}.csv", std::process::id()));
    fs::write(&path, text).expect("a temporary file");
    path
}

/// The one error of data that cannot be fitted.
fn refused(name: &str, rows: &str, more: &[&str]) -> Value {
    let path = written(name, &format!("unit,cycles,wear_um\n{rows}"));
    let file = path.display().to_string();
    let answer = linkwear(&[&["fit", &file], &COLUMNS[..], more, &["--format", "json"]].concat());
    fs::remove_file(path).expect("the file");
    assert_eq!(answer.code, 1);
    let error = answer.errors()[0].clone();
    assert_eq!(error["file"], file.as_str());
    assert_eq!(error["code"], "C0011");
    assert!(!error["help"].as_str().expect("a text").is_empty());
    error
}

#[test]
fn sliding_wear_has_its_exponent() {
    let found = fit(HEAVY, &["--from-zero", "--power-law", "--compare"]);
    // Roots of the likelihood equations by mpmath; the text of JSON is exact.
    let roots = [
        ("exponent", 0.206_019_983_598_03, 1e-10),
        ("alpha", 27.458_294_614_152, 1e-10),
        ("beta", 2.594_459_464_416_3, 1e-10),
        ("log_likelihood", -51.281_265_004_615, 1e-12),
    ];
    for (key, expected, bound) in roots {
        let error = (found[key].as_f64().expect("a number") / expected - 1.0).abs();
        reached("sliding wear, 100 g, Gamma process", &format!("{key}, relative"), error, bound);
    }
    close(&found["aic"], 2.0 * 3.0 + 2.0 * 51.281_265_004_615, 1e-12);
    assert_eq!(found["n"], 32);
    assert_eq!(found["covariance"].as_array().expect("a matrix").len(), 3);
    assert!(found["se_alpha"].is_number() && found["se_beta"].is_number());
    assert_eq!(found["comparison"][1]["process"], "Wiener");
    close(&fit(HEAVY, &["--power-law"])["log_likelihood"], -44.166_706_950_88, 1e-12);
}

#[test]
fn the_two_shrinking_scars_of_the_whole_set_are_named() {
    let file = "gamma/tests/data/sliding_wear.csv";
    let answer = linkwear(&[&["fit", file], &COLUMNS[..], &["--format", "json"]].concat());
    assert_eq!(answer.code, 1);
    let error = answer.errors()[0].clone();
    let message = error["message"].as_str().expect("a text");
    assert!(message.contains("unit 104") && message.contains("unit 105"), "{message}");
    assert!(message.starts_with("2 increment(s)") && error["line"].is_number(), "{error}");
}

#[test]
fn groups_are_fitted_alone_and_together() {
    let file = "gamma/tests/data/gaas_lasers.csv";
    let text = fs::read_to_string(file).expect("the table");
    let grouped = text.lines().map(|line| match line.split(',').next() {
        Some("unit") => format!("{line},half\n"),
        Some(unit) if line.starts_with('#') || unit.is_empty() => format!("{line}\n"),
        Some(unit) => format!("{line},{}\n", if unit.len() > 1 { "late" } else { "early" }),
        None => String::new(),
    });
    let path = written("groups", &grouped.collect::<String>());
    let shown = path.display().to_string();
    let columns =
        ["fit", &shown, "--unit", "unit", "--wear", "current_increase_percent", "--exposure", "hours"];
    let found = linkwear(&[&columns[..], &["--groups", "half", "--format", "json"]].concat()).json();
    fs::remove_file(path).expect("the file");
    // Published per 1000 hours, 28.75350606.
    for (key, expected) in [("alpha", 28.753_506_06e-3), ("beta", 14.114_459_33)] {
        let error = (found[key].as_f64().expect("a number") / expected - 1.0).abs();
        reached("GaAs lasers, Gamma process", &format!("{key}, relative"), error, 1e-8);
    }
    assert_eq!(found["groups"].as_array().expect("a list").len(), 2);
    assert_eq!(found["group_test"]["degrees"], 2);
}

/// Specimens numbered anew in each batch, in another unit of wear.
fn batches(scale: f64, from: f64) -> String {
    let mut rows = "unit,t,w,batch\n".to_owned();
    for batch in ["A", "B"] {
        for unit in 0..4_u32 {
            let mut wear = 0.0;
            for k in 0..6_u32 {
                // Increments of 0.5 to 2.5 in a fixed disorder, other ones in each batch.
                let step = f64::from((7 * k + 3 * unit + if batch == "A" { 0 } else { 4 }) % 11);
                wear += if k == 0 { 0.0 } else { scale * (0.5 + 0.2 * step) };
                rows.push_str(&format!("{unit},{},{wear},{batch}\n", from + f64::from(k)));
            }
        }
    }
    rows
}

const BATCHES: [&str; 10] =
    ["--unit", "unit", "--wear", "w", "--exposure", "t", "--groups", "batch", "--format", "json"];

#[test]
fn units_numbered_anew_in_each_group_are_units_of_their_own() {
    let found = |name: &str, rows: &str| {
        let path = written(name, rows);
        let shown = path.display().to_string();
        let answer = linkwear(&[&["fit", &shown], &BATCHES[..]].concat()).json();
        fs::remove_file(path).expect("the file");
        answer
    };
    let count = |fit: &Value| fit["increments"]["from"].as_array().expect("a list").len();
    for from in [0.0, 1.0] {
        let [plain, scaled] = [1.0, 1000.0].map(|scale| found("batches", &batches(scale, from)));
        for groups in [&plain, &scaled] {
            let parts = groups["groups"].as_array().expect("a list");
            assert_eq!(parts.iter().map(count).collect::<Vec<_>>(), [20, 20]);
            assert_eq!(count(groups), 40);
        }
        let [statistic, other] =
            [&plain, &scaled].map(|found| found["group_test"]["statistic"].as_f64().expect("a number"));
        // Likelihoods of some tens: the maxima are met to 1e-9.
        assert!(statistic > 0.0 && (statistic - other).abs() < 1e-6, "{statistic} {other}");
        let warning = plain["warnings"].to_string();
        assert!(warning.contains("unit 0 (and 3 more) is in several groups"), "{warning}");
    }
}

#[test]
fn a_unit_that_goes_on_in_another_group_does_not_begin_at_zero_again() {
    let rows =
        "unit,t,w,batch\na,1,1,A\na,2,2.5,A\na,3,3.1,A\na,4,5,A\nb,1,1,B\na,5,5.5,B\na,6,6.5,B\na,7,9,B\n";
    let path = written("goes-on", rows);
    let shown = path.display().to_string();
    let answer = linkwear(&[&["fit", &shown], &BATCHES[..], &["--from-zero"]].concat());
    let error = answer.errors()[0].clone();
    assert_eq!(error["line"], 7, "{error}");
    assert!(error["message"].as_str().is_some_and(|words| words.contains("goes on in group B")), "{error}");
    // Other units of the same names, read at the same exposures, begin at 0 each.
    let rows: String = batches(1.0, 1.0).replace(",0,A", ",0.4,A").replace(",0,B", ",0.3,B");
    fs::write(&path, rows).expect("a file");
    let found = linkwear(&[&["fit", &shown], &BATCHES[..], &["--from-zero"]].concat()).json();
    assert_eq!(found["increments"]["from"].as_array().map(Vec::len), Some(48));
    fs::remove_file(path).expect("the file");
}

#[test]
fn bad_data_are_named_with_line_and_cure() {
    let cases = [
        ("unsorted", "a,2,1\na,1,2\n", 3, "goes back"),
        ("twice", "a,2,1\na,2,2\n", 3, "twice"),
        ("single", "a,1,1\n", 2, "one reading"),
        ("increment", "a,1,1\na,2,2\n", 3, "1 increment"),
        ("constant", "a,1,1\na,2,1\na,3,1\n", 2, "constant"),
        ("nan", "a,1,1\na,2,NaN\n", 3, "not a finite number"),
        ("units", "a,1,1\na,2 h,2\n", 3, "a number with a unit"),
        ("short", "a,1,1\na,2\n", 3, "no CSV table"),
    ];
    for (name, rows, line, words) in cases {
        let error = refused(name, rows, &[]);
        assert_eq!(error["line"], line, "{error}");
        assert!(error["message"].as_str().expect("a text").contains(words), "{error}");
    }
}

/// All at once, column by column: a file of a thousand lines is not mended a line a run.
#[test]
fn all_wrong_cells_of_a_file_are_told_at_once() {
    let path = written("cells", "unit,cycles,wear_um\na,1,x\n,2,2\na,3 h,\na,4,4\n");
    let file = path.display().to_string();
    let answer = linkwear(&[&["fit", &file], &COLUMNS[..], &["--format", "json"]].concat());
    fs::remove_file(path).expect("the file");
    let errors = answer.errors();
    let mut lines: Vec<u64> = errors.iter().filter_map(|error| error["line"].as_u64()).collect();
    lines.sort_unstable();
    assert_eq!(lines, [2, 3, 4, 4], "{errors:?}");
    let broken = written("rows", "unit,cycles,wear_um\na,1\na,2,2\na,3,3,3\n");
    let file = broken.display().to_string();
    let answer = linkwear(&[&["fit", &file], &COLUMNS[..]].concat());
    fs::remove_file(broken).expect("the file");
    assert!(answer.err.contains("line 2:") && answer.err.contains("line 4:"), "{}", answer.err);
    // What is wrong in every line is not told a hundred times.
    let rows: String = (1..=100).map(|cycle| format!("a,{cycle},?\n")).collect();
    let many = written("many", &format!("unit,cycles,wear_um\n{rows}"));
    let file = many.display().to_string();
    let answer = linkwear(&[&["fit", &file], &COLUMNS[..]].concat());
    fs::remove_file(many).expect("the file");
    assert_eq!(answer.err.matches("error[C0011]").count(), 20);
    assert!(answer.err.contains("and 80 more"), "{}", answer.err);
}

#[test]
fn a_misspelt_column_is_suggested() {
    let answer = linkwear(&["fit", HEAVY, "--unit", "unit", "--wear", "wear_mu", "--exposure", "cycles"]);
    assert_eq!(answer.code, 1);
    assert!(answer.err.contains("did you mean `wear_um`?"), "{}", answer.err);
}

#[test]
fn the_bootstrap_repeats_its_bits_and_the_fit_is_written_whole() {
    let out = std::env::temp_dir().join(format!("linkwear-fit-{}-out.json", std::process::id()));
    let shown = out.display().to_string();
    let more = ["--power-law", "--bootstrap", "50", "--seed", "3", "--out", &shown];
    let first = fit(HEAVY, &more);
    assert_eq!(first, fit(HEAVY, &more));
    let written: Value = serde_json::from_str(&fs::read_to_string(&out).expect("the fit")).expect("JSON");
    fs::remove_file(out).expect("the file");
    for key in ["alpha", "beta", "exponent", "covariance", "n", "wear_unit", "exposure_unit"] {
        assert_eq!(written[key], first[key], "{key}");
    }
}

#[test]
fn one_unit_is_refused_until_it_is_accepted() {
    let rows = "a,1,1\na,2,2.5\na,3,3.1\na,4,5\n";
    let error = refused("one", rows, &[]);
    assert_eq!(error["line"], 2);
    let message = error["message"].as_str().expect("a text");
    assert!(message.contains("rows 2 to 5") && message.contains("one unit, a"), "{message}");
    assert!(error["help"].as_str().expect("a text").contains("--one-unit"), "{error}");

    let path = written("accepted", &format!("unit,cycles,wear_um\n{rows}"));
    let file = path.display().to_string();
    let found = fit(&file, &["--one-unit"]);
    let text = linkwear(&[&["fit", &file], &COLUMNS[..], &["--one-unit"]].concat());
    fs::remove_file(path).expect("the file");
    assert!(found["warnings"][0].as_str().expect("a text").contains("one unit only"), "{found}");
    assert!(text.code == 0 && text.out.contains("warning: one unit only"), "{}", text.out);
    assert_eq!(fit(HEAVY, &["--power-law"])["warnings"], Value::Array(Vec::new()));
}

#[test]
fn a_fit_that_its_own_test_rejects_is_called_bad_with_what_to_try() {
    let found = fit(HEAVY, &["--from-zero"]);
    close(&found["goodness"]["anderson_darling"], 14.8, 0.01);
    assert!(found["goodness"]["p_anderson_darling"].as_f64().expect("a number") < 1e-10);
    assert_eq!(found["goodness"]["p_values_by"], "asymptotic");
    let warning = found["warnings"][0].as_str().expect("a text");
    assert!(warning.contains("reject this fit") && warning.contains("--power-law"), "{warning}");
    let text = linkwear(&[&["fit", HEAVY], &COLUMNS[..], &["--from-zero"]].concat());
    assert!(text.code == 0 && text.out.contains("warning: the data reject this fit"), "{}", text.out);
    let drawn = fit(HEAVY, &["--from-zero", "--bootstrap", "200"]);
    assert_eq!(drawn["goodness"]["p_values_by"], "bootstrap");
    assert!(drawn["warnings"][0].as_str().expect("a text").contains("reject"), "{drawn}");
}

/// Log-likelihood of an increment of wear of this shape.
fn term(shape: f64, beta: f64, wear: f64) -> f64 {
    shape * beta.ln() - ln_gamma(shape) + (shape - 1.0) * wear.ln() - beta * wear
}

/// The printed log-likelihood is that of the estimate, and no step in a parameter leads higher.
#[track_caller]
fn a_maximum(found: &Value, estimate: &[f64], log_likelihood: &dyn Fn(&[f64]) -> f64) {
    let here = log_likelihood(estimate);
    // Some thirty to ninety terms of size 10, each good to 1e-14 of itself.
    close(&found["log_likelihood"], here, 1e-11);
    for at in 0..estimate.len() {
        for step in [-1e-4, 1e-4] {
            let mut moved = estimate.to_vec();
            moved[at] *= 1.0 + step;
            // Curvatures of some tens and more make a fall of 1e-7, well above rounding.
            assert!(log_likelihood(&moved) < here - 1e-10, "parameter {at}, step {step}");
        }
    }
}

#[test]
fn a_covariate_multiplies_lambda_as_a_power() {
    let folder = Folder::new("fit-covariate");
    let whole = fs::read_to_string("gamma/tests/data/sliding_wear.csv").expect("the table");
    // Without the two readings that fall.
    let kept: Vec<&str> =
        whole.lines().filter(|line| !line.ends_with(",4.012") && !line.ends_with(",12.869")).collect();
    assert_eq!(kept.len() + 2, whole.lines().count());
    let file = folder.write("loads.csv", &kept.join("\n"));
    let found = fit(&file, &["--power-law", "--covariate", "load_g"]);
    let number = |value: &Value| value.as_f64().expect("a number");
    let power = &found["covariates"][0];
    assert_eq!(power["name"], "load_g");
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for line in kept.iter().filter(|line| line.starts_with('1')) {
        rows.push(line.split(',').map(|cell| cell.parse().expect("a number")).collect());
    }
    let log_likelihood = |phi: &[f64]| -> f64 {
        let increments = rows.windows(2).filter(|pair| pair[0][0] == pair[1][0]);
        let share = |pair: &[Vec<f64>]| {
            let (from, to) = (&pair[0], &pair[1]);
            let lambda = (to[2].powf(phi[2]) - from[2].powf(phi[2])) * to[1].powf(phi[3]);
            term(phi[0] * lambda, phi[1], to[3] - from[3])
        };
        increments.map(share).sum()
    };
    let estimate = [&found["alpha"], &found["beta"], &found["exponent"], &power["coefficient"]].map(number);
    a_maximum(&found, &estimate, &log_likelihood);
    assert_eq!(found["covariance"].as_array().expect("a matrix").len(), 4);
    // Heavier is faster, and surely so.
    assert!(estimate[3] > 5.0 * number(&found["standard_errors"][3]));
}

#[test]
fn readings_are_rounded_to_the_step_of_the_gauge() {
    let folder = Folder::new("fit-resolution");
    let units = [[0.5, 0.0, 1.0, 0.5, 0.5], [1.0, 0.5, 0.0, 0.0, 0.5], [0.5, 1.5, 0.5, 0.0, 1.0]];
    let mut text = "unit,cycles,wear_um\n".to_owned();
    for (unit, increments) in units.iter().enumerate() {
        let mut wear = 0.0;
        text.push_str(&format!("{unit},0,0\n"));
        for (at, increment) in increments.iter().enumerate() {
            wear += increment;
            text.push_str(&format!("{unit},{},{wear}\n", at + 1));
        }
    }
    let file = folder.write("steps.csv", &text);
    let found = fit(&file, &["--resolution", "0.5"]);
    // Mean wear per cycle: rounding moves the last reading of a unit by a quarter of a micrometre, of 8 in all.
    let pace = found["alpha"].as_f64().expect("a number") / found["beta"].as_f64().expect("a number");
    let total: f64 = units.iter().flatten().sum();
    assert!((pace - total / 15.0).abs() < 0.05, "{pace}");
    // The others do not know the step, and say so wherever their criteria stand.
    let options = ["--resolution", "0.5", "--compare"];
    let compared = fit(&file, &options);
    for (list, at) in [("comparison", 0), ("compare", 0)] {
        let is_exact = |row: &Value| row["exact_readings"] == true;
        let rows = compared[list].as_array().expect("rows");
        assert!(!is_exact(&rows[at]) && rows.iter().filter(|row| is_exact(row)).count() == 2, "{rows:?}");
    }
    let shown = linkwear(&[&["fit", &file], &COLUMNS[..], &options].concat()).out;
    assert!(
        shown.contains("Wiener (exact readings)") && shown.contains("do not know --resolution"),
        "{shown}"
    );
    // With an error before rounding readings may fall, and less of their scatter is wear's.
    let falling = folder.write("falling.csv", &text.replace("1,4,1.5\n", "1,4,1\n"));
    let refused = linkwear(&[&["fit", &falling], &COLUMNS[..], &["--resolution", "0.5"]].concat());
    assert!(refused.code == 1 && refused.err.contains("its error too"), "{}", refused.err);
    let erring = fit(&falling, &["--resolution", "0.5", "--gauge", "0.2"]);
    assert!(erring["alpha"].as_f64() > found["alpha"].as_f64(), "{} {}", erring["alpha"], found["alpha"]);
    assert_eq!((&erring["gauge"], &found["gauge"]), (&0.2.into(), &Value::Null));
    let alone = linkwear(&[&["fit", &file], &COLUMNS[..], &["--gauge", "0.2"]].concat());
    assert!(alone.code == 2 && alone.err.contains("--resolution"), "{}", alone.err);
    // Options that do not go together, whatever the data are: these were told as mistakes of the file.
    for (more, words) in [
        (["--process", "wiener"], ["only the Gamma process", "leave --process or --resolution out"]),
        (["--gauge", "51"], ["than a hundred times its resolution", "a --resolution of a tenth of --gauge"]),
    ] {
        let wrong = linkwear(&[&["fit", &file], &COLUMNS[..], &["--resolution", "0.5"], &more[..]].concat());
        assert!(wrong.code == 2 && wrong.err.contains("C0001"), "{more:?}: {}", wrong.err);
        assert!(words.iter().all(|words| wrong.err.contains(words)), "{more:?}: {}", wrong.err);
    }
    let off =
        linkwear(&[&["fit", &file], &COLUMNS[..], &["--resolution", "0.3", "--format", "json"]].concat());
    let error = off.errors()[0].clone();
    assert!(off.code == 1 && error["message"].as_str().expect("a text").contains("no multiple"), "{error}");
    assert!(error["line"].is_number(), "{error}");
    let answer = linkwear(&[&["fit", &file], &COLUMNS[..], &["--format", "json"]].concat());
    let error = answer.errors()[0].clone();
    assert!(error["message"].as_str().expect("a text").starts_with("4 increment(s)"), "{error}");
    assert!(error["help"].as_str().expect("a text").contains("resolution"), "{error}");
}

#[test]
fn only_differences_of_lambda_count_and_no_row_is_made_up() {
    let folder = Folder::new("fit-lambda-table");
    let rows = "unit,cycles,wear_um\na,0,0\na,1,1.3\na,2,1.9\na,5,5.5\nb,0,0\nb,1,0.8\nb,4,4.1\nb,5,4.9\n";
    let file = folder.write("wear.csv", rows);
    let table = |name: &str, rows: &str| folder.write(name, &format!("cycles,lambda\n{rows}"));
    let by = |table: &str, more: &[&str]| {
        linkwear(&[&["fit", &file], &COLUMNS[..], &["--lambda", table, "--format", "json"], more].concat())
    };
    let plain = by(&table("plain.csv", "0,0\n5,5\n"), &[]).json();
    for other in ["0,10\n5,15\n", "-5,-3\n0,2\n5,7\n"] {
        let found = by(&table("other.csv", other), &[]).json();
        for key in ["alpha", "beta", "log_likelihood", "increments"] {
            assert_eq!(found[key], plain[key], "{key}");
        }
    }
    let late = table("late.csv", "1,4\n5,8\n");
    for (more, words) in [(&[][..], "outside of"), (&["--from-zero"], "Lambda of new parts")] {
        let error = by(&late, more).errors()[0].clone();
        assert!(error["message"].as_str().is_some_and(|text| text.contains(words)), "{error}");
    }
    // Without the readings before its begin nothing is missing.
    let worn = folder.write("worn.csv", &rows.replace("a,0,0\n", "").replace("b,0,0\n", ""));
    let columns = [&["fit", &worn], &COLUMNS[..], &["--format", "json"]].concat();
    let [by_late, by_plain] = [&late, &folder.path("plain.csv")]
        .map(|table| linkwear(&[&columns[..], &["--lambda", table]].concat()).json());
    for key in ["alpha", "beta", "log_likelihood"] {
        assert_eq!(by_late[key], by_plain[key], "{key}");
    }
}

/// Each joint of a life has a Lambda of its own: that of the joint that fails first is no other's.
#[test]
fn of_a_life_of_several_joints_the_one_that_is_fitted_is_named() {
    let folder = Folder::new("fit-lambda-joints");
    let cycle =
        r#"{ "joints": [{ "joint": "R2", "dLambda_m": 1e-6 }, { "joint": "R3.end1", "dLambda_m": 4e-6 }] }"#;
    let life = format!(r#"{{ "failed_joint": "R3.end1", "cycles": [{}] }}"#, [cycle; 20].join(", "));
    let life = folder.write("life.json", &life);
    let rows = "a,0,0\na,6,7\na,20,19\nb,0,0\nb,9,8\nb,20,23\n";
    let file = folder.write("wear.csv", &format!("unit,cycles,wear_um\n{rows}"));
    let table = folder.write("lambda.csv", "cycles,lambda_um\n0,0\n20,20\n");
    let of = |lambda: &str| fit(&file, &["--lambda", lambda]);
    let [own, other] = ["R2", "R3.end1"].map(|joint| of(&format!("{joint}={life}")));
    let by_table = of(&table);
    for key in ["alpha", "beta", "log_likelihood"] {
        let number = |fit: &Value| fit[key].as_f64().expect("a number");
        // Lambda of R2 is the table's but for rounding of its sum.
        assert!((number(&own) / number(&by_table) - 1.0).abs() < 1e-9, "{key}");
        // The same wear over four times the Lambda: a quarter of alpha, and all else alike.
        let expected = number(&own) * if key == "alpha" { 0.25 } else { 1.0 };
        assert!((number(&other) / expected - 1.0).abs() < 1e-9, "{key}");
    }
    for (lambda, message) in [
        (life.clone(), "has the Lambda of 2 joints"),
        (format!("R4={life}"), "no joint `R4` wears in"),
        (format!("R2={table}"), "is a table"),
    ] {
        let answer =
            linkwear(&[&["fit", &file], &COLUMNS[..], &["--lambda", &lambda, "--format", "json"]].concat());
        let error = answer.errors()[0].clone();
        assert!(error["message"].as_str().expect("a text").contains(message), "{error}");
        let names_them = error["help"].as_str().expect("a text").contains("R2, R3.end1");
        assert_eq!(names_them, message != "is a table", "{error}");
    }
}

#[test]
fn lambda_comes_from_a_life_from_a_table_or_from_a_column_alike() {
    let folder = Folder::new("fit-lambda");
    // Coarse steps: only the way of the numbers is looked at.
    let hurry = ["--rigid", "--mean", "--step", "5e-5", "--settle", "1", "--format", "json"];
    let answer = linkwear(&[&["life", "mechanisms/rssr.toml"], &hurry[..]].concat());
    let life = folder.write("life.json", &answer.out);
    let mut lambda = vec![0.0];
    for cycle in answer.json()["cycles"].as_array().expect("a list") {
        let step = cycle["joints"][0]["dLambda_m"].as_f64().expect("a number");
        lambda.push(lambda[lambda.len() - 1] + 1e6 * step);
    }
    let (mut data, mut total) = ("unit,cycles,wear_um,lambda_um\n".to_owned(), 0.0);
    for (unit, pace) in [0.9, 1.0, 1.15].into_iter().enumerate() {
        for (cycle, scatter) in [(0, 0.0), (6, 1.05), (12, 0.97), (18, 1.01)] {
            let wear = pace * scatter * lambda[cycle];
            total += if cycle == 18 { wear } else { 0.0 };
            data.push_str(&format!("{unit},{cycle},{wear},{}\n", lambda[cycle]));
        }
    }
    let file = folder.write("wear.csv", &data);
    let rows: String = lambda.iter().enumerate().map(|(at, value)| format!("{at},{value}\n")).collect();
    let table = folder.write("lambda.csv", &format!("cycles,lambda_um\n{rows}"));
    let by_life = fit(&file, &["--lambda", &life]);
    // alpha / beta is the mean pace; roots are found to 1e-12.
    let ratio = by_life["alpha"].as_f64().expect("a number") / by_life["beta"].as_f64().expect("a number");
    assert!((ratio / (total / (3.0 * lambda[18])) - 1.0).abs() < 1e-10, "{ratio}");
    assert_eq!(by_life["over_lambda"], true);
    assert!(by_life["exposure_unit"].as_str().expect("a text").contains("life.json"));
    let columns = ["fit", &file, "--unit", "unit", "--wear", "wear_um", "--lambda", "lambda_um"];
    for other in
        [fit(&file, &["--lambda", &table]), linkwear(&[&columns[..], &["--format", "json"]].concat()).json()]
    {
        for key in ["alpha", "beta", "log_likelihood"] {
            assert_eq!(other[key], by_life[key], "{key}");
        }
    }
    assert_eq!(fit(&file, &[])["over_lambda"], false);

    // The fit goes back into the life: wear is a little faster than Archard's law says, so life is shorter.
    let out = folder.path("fit.json");
    fit(&file, &["--lambda", &life, "--out", &out]);
    let more = [
        "--rigid",
        "--step",
        "5e-5",
        "--settle",
        "1",
        "--trajectories",
        "20",
        "--fit",
        &out,
        "--format",
        "json",
    ];
    let lived = linkwear(&[&["life", "mechanisms/rssr.toml"], &more[..]].concat()).json();
    close(&lived["parameters"][0]["alpha_per_um"], by_life["alpha"].as_f64().expect("a number"), 1e-12);
    let path = |life: &Value| life["mean_path"]["cycles"].as_f64().expect("a number");
    assert!(ratio > 1.0 && path(&lived) < path(&answer.json()), "{ratio}");
    assert!(lived["error_budget"]["half_widths_95"]["parameters"].as_f64().expect("a number") > 0.0);

    let late = folder.write("late.csv", "unit,cycles,wear_um\na,0,0\na,100,9\nb,0,0\nb,3,9\n");
    let answer =
        linkwear(&[&["fit", &late], &COLUMNS[..], &["--lambda", &life, "--format", "json"]].concat());
    let error = answer.errors()[0].clone();
    assert!(error["message"].as_str().expect("a text").contains("exposure 100 is outside"), "{error}");
    assert_eq!(error["line"], 3);
}
