//! Units that differ, from the command line: `fit --random-effects`, `predict --unit`, `life --fit`.

use crate::command::{Folder, linkwear};
use serde_json::Value;

const LASERS: [&str; 8] =
    ["fit", "examples/data/gaas_lasers.csv", "--unit", "unit", "--wear", "percent", "--exposure", "khours"];

#[track_caller]
fn close(found: &Value, expected: f64, tolerance: f64) {
    let found = found.as_f64().expect("a number");
    assert!((found / expected - 1.0).abs() <= tolerance, "{found} for {expected}");
}

fn fit(more: &[&str]) -> Value {
    linkwear(&[&LASERS[..], &["--random-effects", "--format", "json"], more].concat()).json()
}

#[test]
fn lasers_have_rates_of_their_own() {
    let found = fit(&["--compare"]);
    // Independent optimisers, to the digits that they gave.
    close(&found["log_likelihood"], 93.738_929, 6e-9);
    close(&found["random"]["shape"], 28.8786, 2e-6);
    close(&found["random"]["rate"], 1.453_31, 4e-6);
    close(&found["random"]["mean"], 19.871, 2e-5);
    close(&found["beta"], 19.871, 2e-5);
    close(&found["random"]["cv"], 1.0 / 28.8786_f64.sqrt(), 2e-6);
    assert_eq!(found["boundary"], false);
    close(&found["lr_test"]["statistic"], 2.0 * (93.738_929 - 69.609_358_92), 1e-8);
    assert!(found["lr_test"]["p"].as_f64().expect("a number") < 1e-10);
    close(&found["aic"], 6.0 - 2.0 * 93.738_929, 1e-8);
    // Of units alike, as those beside it.
    close(&found["comparison"][0]["log_likelihood"], 69.609_358_92, 1e-9);
    close(&found["comparison"][0]["aic"], 4.0 - 2.0 * 69.609_358_92, 1e-9);
    let rows = found["compare"].as_array().expect("rows");
    for (process, random, expected) in [
        ("gamma", false, 69.609_358_92),
        ("gamma", true, 93.738_929),
        ("inverse-gaussian", true, 95.326_768),
        ("wiener", true, 69.188_413_7),
    ] {
        let row = rows.iter().find(|row| row["process"] == process && row["random"] == random);
        close(&row.expect("a row")["log_likelihood"], expected, 1e-8);
    }
    assert_eq!(rows.len(), 6);
}

#[test]
fn lives_of_which_some_never_end_are_told_as_far_as_they_go() {
    let folder = Folder::new("never");
    // Drifts of 0.15 to 2.3, a steady scatter about each.
    let mut rows = "unit,t,w\n".to_owned();
    for (unit, drift) in [0.15, 0.5, 0.8, 1.0, 1.2, 1.5, 1.9, 2.3].into_iter().enumerate() {
        let mut wear = 0.0;
        rows.push_str(&format!("{unit},0,0\n"));
        for k in 1..=6_usize {
            wear += drift + 0.1 * ((7 * k + 3 * unit) % 11) as f64 - 0.5;
            rows.push_str(&format!("{unit},{k},{wear}\n"));
        }
    }
    let (data, out) = (folder.write("wear.csv", &rows), folder.path("fit.json"));
    let columns = ["fit", &data, "--unit", "unit", "--wear", "w", "--exposure", "t", "--process", "wiener"];
    linkwear(&[&columns[..], &["--random-effects", "--out", &out, "--format", "json"]].concat()).json();
    let asked =
        |p: &str| linkwear(&["predict", &out, "--threshold", "12", "--quantile", p, "--format", "json"]);
    let told = asked("1%").json();
    assert!(told["asked_quantiles"][0]["time"].is_number(), "{told}");
    assert!(told["interval95"]["lower"].is_number() && told["interval95"]["upper"].is_null(), "{told}");
    let last = told["reliability"].as_array().and_then(|course| course.last()).expect("a course");
    assert!(last["time"].is_number() && last["reliability"].is_number(), "{last}");
    assert!(told["warnings"].to_string().contains("ever fails"), "{told}");
    let text = linkwear(&["predict", &out, "--threshold", "12"]).out;
    assert!(text.contains("no upper end"), "{text}");
    let refused = asked("99.9%").errors()[0].clone();
    assert!(refused["message"].as_str().is_some_and(|text| text.contains("no time is known")), "{refused}");
}

#[test]
fn units_alike_are_an_answer_and_one_unit_is_refused() {
    let folder = Folder::new("units-alike");
    let rows: String = (0..5)
        .flat_map(|unit| {
            // The same increments in another order.
            let wears = [0.8, 1.3, 0.6, 1.1, 1.5, 0.7];
            let mut level = 0.0;
            (0..6).map(move |at| {
                level += wears[(at + unit) % 6];
                format!("{unit},{},{level:.1}\n", at + 1)
            })
        })
        .collect();
    let file = folder.write("alike.csv", &format!("unit,t,w\n{rows}"));
    let columns = ["--unit", "unit", "--wear", "w", "--exposure", "t", "--from-zero", "--random-effects"];
    let out = folder.path("fit.json");
    let arguments = [&["fit", &file], &columns[..], &["--format", "json", "--out", &out]].concat();
    let found = linkwear(&arguments).json();
    assert_eq!((&found["boundary"], &found["random"]["cv"]), (&true.into(), &0.0.into()));
    assert_eq!(found["lr_test"]["p"], 1.0);
    // A plain process, then, of every unit.
    let predicted =
        linkwear(&["predict", &out, "--threshold", "20", "--unit", "3", "--format", "json"]).json();
    assert_eq!(predicted["current"], 6.0);
    let one = folder.write("one.csv", "unit,t,w\n1,1,1\n1,2,2.5\n1,3,3\n1,4,4.7\n1,5,5\n1,6,6.3\n");
    let refused = linkwear(&[&["fit", &one], &columns[..], &["--format", "json"]].concat());
    assert_eq!(refused.code, 1);
}

#[test]
fn units_differ_as_much_by_rounded_readings() {
    let folder = Folder::new("units-rounded");
    let text = std::fs::read_to_string("examples/data/gaas_lasers.csv").expect("shipped");
    let row = |line: &str| {
        let Some((start, percent)) = line.rsplit_once(',') else { return line.to_owned() };
        percent.parse::<f64>().map_or(line.to_owned(), |percent| format!("{start},{percent:.1}"))
    };
    let rows: Vec<String> = text.lines().map(row).collect();
    let file = folder.write("rounded.csv", &rows.join("\n"));
    let out = folder.path("fit.json");
    let columns = ["--unit", "unit", "--wear", "percent", "--exposure", "khours", "--random-effects"];
    let options = ["--resolution", "0.1", "--compare", "--format", "json", "--out", &out];
    let found = linkwear(&[&["fit", &file], &columns[..], &options[..]].concat()).json();
    let exact = fit(&[]);
    // Rounding adds a twentieth to the variance of an increment.
    close(&found["random"]["cv"], exact["random"]["cv"].as_f64().expect("a number"), 0.05);
    assert_eq!((&found["boundary"], &found["resolution"]), (&false.into(), &0.1.into()));
    // The Gamma process alone takes readings as rounded: with units alike and with units that differ.
    let rows = found["compare"].as_array().expect("rows");
    assert_eq!(rows.iter().filter(|row| row["random"] == true).count(), 1, "{rows:?}");
    // A laser by its readings: as by exact ones, within what a step of the gauge is of 15 %.
    let told = |file: &str| {
        linkwear(&["predict", file, "--threshold", "15", "--unit", "10", "--format", "json"]).json()
    };
    let exact_out = folder.path("exact.json");
    fit(&["--out", &exact_out]);
    close(&told(&out)["mean"], told(&exact_out)["mean"].as_f64().expect("a number"), 0.05);
}

#[test]
fn a_unit_is_told_by_its_own_readings() {
    let folder = Folder::new("units-predict");
    let out = folder.path("fit.json");
    fit(&["--out", &out]);
    let ask = |more: &[&str]| {
        linkwear(&[&["predict", &out, "--threshold", "15", "--format", "json"], more].concat())
    };
    let (any, fast) = (ask(&[]).json(), ask(&["--unit", "10"]).json());
    // Laser 10 was last read with 12.21 % at 4000 hours. By the law of its rate after that its mean life is closed:
    // (beta left + 1/2) / alpha, beta the mean of Gamma(28.8786 + 4 alpha, 1.45331 + 12.21).
    close(&fast["current"], 12.21, 0.0);
    let alpha = 39.0309;
    let beta = (28.8786 + 4.0 * alpha) / (1.453_31 + 12.21);
    close(&fast["mean"], (beta * (15.0 - 12.21) + 0.5) / alpha, 1e-5);
    close(&any["mean"], (19.871 * 15.0 + 0.5) / alpha, 1e-5);
    // E T² from E beta² = mean² (1 + cv²), var(T | beta) of shape a rate of 1: beta left / alpha² and more of order 1 / alpha².
    let (width, plain) = (&any["interval95"], &fast["interval95"]);
    let length =
        |ends: &Value| ends["upper"].as_f64().expect("a number") - ends["lower"].as_f64().expect("a number");
    assert!(length(width) > 4.0 * length(plain));
    assert_eq!(any["interval95"]["kind"], "predictive");
    // The same reading by hand is the same unit.
    let by_hand = ask(&["--current", "12.21", "--at", "4"]).json();
    close(&by_hand["mean"], fast["mean"].as_f64().expect("a number"), 1e-12);
    for (wrong, code) in [
        (&["--unit", "99"][..], 1),
        (&["--unit", "10", "--current", "13"], 2),
        (&["--unit", "10", "--current", "11", "--at", "5"], 1),
    ] {
        let refused = ask(wrong);
        assert_eq!(refused.code, code, "{wrong:?}");
        assert!(!refused.errors()[0]["help"].as_str().expect("a text").is_empty());
    }
    // Readings of a laser that is not among the data.
    let log = folder.write("log.csv", "t,w\n0,0\n1,3.1\n2,6.2\n3,9.0\n");
    let inspected = ask(&["--inspections", &log, "--time", "t", "--wear", "w"]).json();
    let same = ask(&["--current", "9", "--at", "3"]).json();
    // The readings move the parameters of the population as well, but little beside 240 increments.
    close(&inspected["mean"], same["mean"].as_f64().expect("a number"), 0.02);
    let gauge =
        ask(&["--inspections", &log, "--time", "t", "--wear", "w", "--gauge", "0.2", "--particles", "10000"])
            .json();
    // An error of 0.2 leaves the rate open by 0.2 of 9 more, and the wear by 0.2 of 6.
    close(&gauge["mean"], same["mean"].as_f64().expect("a number"), 0.06);
}

#[test]
fn a_joint_keeps_its_rate_and_threads_change_no_bit() {
    let folder = Folder::new("units-life");
    let random = r#"{ "process": "gamma", "alpha": 13.65, "beta": 13.65, "over_lambda": true, "random": { "cv": 0.2 } }"#;
    let file = folder.write("fit.json", random);
    let live = |threads: &str| {
        linkwear(&[
            "life",
            "mechanisms/rssr.toml",
            "--trajectories",
            "400",
            "--threads",
            threads,
            "--fit",
            &file,
            "--format",
            "json",
        ])
        .json()
    };
    let (one, two) = (live("1"), live("2"));
    assert_eq!(
        (&one["mean"], &one["std"], &one["quantiles"]),
        (&two["mean"], &two["std"], &two["quantiles"])
    );
    // Lives of one rate vary by 3.1 %; a rate that varies by 20 % is nearly all. Three standard errors of 400.
    close(&one["cov"], 0.2, 3.0 * 0.036);
}

#[test]
fn lasers_that_entered_below_a_limit_may_differ_as_much_as_all() {
    let entered = "examples/data/gaas_lasers_entered.csv";
    let fit = |more: &[&str]| {
        let columns = ["--unit", "unit", "--wear", "percent", "--exposure", "khours"];
        let options = ["--random-effects", "--format", "json"];
        linkwear(&[&["fit", entered], &columns[..], &options, more].concat()).json()
    };
    let high = |found: &Value| found["profile_intervals"]["cv"][1].as_f64().expect("a number");
    let (bare, counted) = (fit(&[]), fit(&["--entered-below", "2"]));
    // All fifteen have 0.18608512.
    assert!(high(&bare) < 0.186 && high(&counted) > 0.186, "{} {}", high(&bare), high(&counted));
    let entries = counted["increments"]["known"].as_array().expect("words");
    assert_eq!(entries.iter().filter(|word| *word == "entered").count(), 11);
    assert!(bare["increments"].get("known").is_none());
}

#[test]
fn a_log_of_service_gives_the_fit_of_the_lasers() {
    let folder = Folder::new("serviced");
    let out = folder.path("fit.json");
    let serviced = "examples/data/gaas_lasers_serviced.csv";
    let columns = ["--unit", "unit", "--wear", "percent", "--exposure", "khours", "--random-effects"];
    let more = ["--reset", "service", "--format", "json", "--out", &out];
    let found = linkwear(&[&["fit", serviced], &columns[..], &more].concat()).json();
    // Nine increments of 240 are lost: within half of the standard errors, 3.6 and 2.1.
    close(&found["alpha"], 39.030_86, 0.05);
    close(&found["beta"], 19.870_91, 0.05);
    // Laser 6 left the range: what it wears is not known, and so not told.
    let refused = linkwear(&["predict", &out, "--threshold", "15", "--unit", "6", "--format", "json"]);
    assert_eq!(refused.code, 1);
    let told = linkwear(&["predict", &out, "--threshold", "15", "--unit", "1", "--format", "json"]).json();
    assert!(told["current"].as_f64().expect("a number") < 15.0);
}

#[test]
fn a_part_that_was_replaced_has_no_remaining_life_but_what_took_its_place() {
    let folder = Folder::new("replaced");
    let wears = [1.0, 2.2, 0.7, 1.6, 2.9, 0.4];
    let rows: String = (0..6)
        .flat_map(|unit| {
            let mut level = 0.0;
            let rows: Vec<String> = (0..6)
                .map(|at| {
                    level += wears[(at * (unit + 1) + unit) % 6] * (1.0 + 0.3 * unit as f64);
                    // The first is replaced on the way, the second at the end, the third is worked on.
                    let done = match (unit, at) {
                        (0, 2) => "replaced",
                        (1, 5) => "replaced=0.5",
                        (2, 5) => "reground=0.25",
                        _ => "",
                    };
                    let row = format!("u{unit},{},{level:.2},{done}\n", at + 1);
                    level = if done == "replaced" { 0.0 } else { level };
                    row
                })
                .collect();
            rows
        })
        .collect();
    let file = folder.write("log.csv", &format!("unit,t,w,service\n{rows}"));
    let out = folder.path("fit.json");
    let columns = ["--unit", "unit", "--wear", "w", "--exposure", "t", "--from-zero", "--random-effects"];
    let fit = linkwear(&[&["fit", &file], &columns[..], &["--reset", "service", "--out", &out]].concat());
    assert_eq!(fit.code, 0, "{}", fit.err);
    let predict =
        |unit: &str| linkwear(&["predict", &out, "--threshold", "30", "--unit", unit, "--format", "json"]);
    for (unit, cure) in [("u0", "--unit u0#2"), ("u1", "--current LEVEL")] {
        let told = predict(unit);
        assert!(told.code == 1 && told.out.contains(cure) && told.out.contains("replaced"), "{}", told.out);
    }
    assert_eq!(predict("u2").json()["current"], 0.25);
    assert!(predict("u0#2").json()["current"].as_f64().is_some_and(|wear| wear > 0.25));
}
