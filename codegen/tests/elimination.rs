//! Rows first and the saddle point are two ways to one solution: accelerations, multipliers and drives agree at closed
//! states.

mod forward;

use std::path::Path;

use forward::{forward_operations, solved};
use linkwear_codegen::compile::{Compiled, Options, compile};
use linkwear_codegen::model::Closure;
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{Evaluator, State, assemble};

/// A file of the workspace, with some of its text exchanged.
struct Case(&'static str, &'static [[&'static str; 2]]);

const ROUND: &str = r#"coupler = { rod = ["A", "B"], radius = "r""#;
const RECTANGLE: &str = r#"coupler = { box = ["A", "B"], width = ["8 mm", "12 mm"], width_axis = [0, 1, 0]"#;

fn compiled(Case(path, edits): &Case, closure: Closure, saddle: bool) -> Compiled {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
    let mut text = std::fs::read_to_string(file).expect("a file");
    for [old, new] in *edits {
        assert!(text.contains(old), "{path}: {old}");
        text = text.replace(old, new);
    }
    of_text(path, text, closure, saddle)
}

fn of_text(path: &str, text: String, closure: Closure, saddle: bool) -> Compiled {
    let source = SourceFile { name: path.to_owned(), text };
    let options = Options { closure: Some(closure), saddle, ..Options::default() };
    compile(&source, &options).unwrap_or_else(|errors| panic!("{errors}"))
}

#[test]
fn both_ways_agree_and_rows_first_is_never_dearer() {
    let cases = [
        Case("mechanisms/four_bar.toml", &[]),
        Case("mechanisms/six_bar.toml", &[]),
        Case("mechanisms/slider_crank.toml", &[]),
        Case("mechanisms/spatial_slider_crank.toml", &[]),
        Case("mechanisms/bennett.toml", &[]),
        Case("mechanisms/rssr_rigid.toml", &[]),
        Case("mechanisms/rssr_flexible.toml", &[]),
        Case("mechanisms/rssr_flexible.toml", &[[ROUND, RECTANGLE]]),
        Case("mechanisms/rssr_flexible.toml", &[["modes = 6", "modes = 1"]]),
        Case("mechanisms/rssr.toml", &[]),
        Case("mechanisms/rssr.toml", &[[ROUND, RECTANGLE], ["modes = 6", "modes = 3"]]),
        Case("mechanisms/rssr_ball_wear.toml", &[]),
        // Without drivers.
        Case("mechanisms/andrews.toml", &[]),
        Case("mechanisms/bricard.toml", &[]),
        Case("mechanisms/n_four_bar_2.toml", &[]),
        // Without a driver, with modes that move joints and modes that move none.
        Case("codegen/tests/data/joints_flexible.toml", &[]),
    ];
    for case in &cases {
        let name = case.0;
        for closure in [Closure::Joint, Closure::Log] {
            let [rows_first, saddle] = [false, true].map(|saddle| compiled(case, closure, saddle));
            assert!(forward_operations(&rows_first) <= forward_operations(&saddle), "{name} {closure:?}");
            let states = agree((&rows_first, &saddle), &format!("{name} {:?} {closure:?}", case.1));
            assert!(states >= 3, "{name} {closure:?}: {states} states");
        }
    }
}

/// Loops that meet at one body: above its base and below it.
#[test]
fn both_ways_agree_where_many_loops_meet_at_one_body() {
    let below = |legs: &[&str], turned: &str, ball: &str| {
        let legs: String = legs.iter().map(|leg| format!("{leg} = {{ q1 = \"{turned}\" }}\n")).collect();
        format!("\n[assembly]\n{legs}{ball}\n")
    };
    let of_delta = below(
        &["U1a", "U1b", "U2a", "U2b", "U3a", "U3b"],
        "104 deg",
        r#"S1a = ["0 deg", "-104 deg", "0 deg"]"#,
    );
    let of_stewart =
        below(&["U1", "U2", "U3", "U4", "U5", "U6"], "133 deg", r#"S1 = ["-36 deg", "128 deg", "0 deg"]"#);
    // Directions that are rounded leave no entry of a row zero.
    let cases = [
        ("tests/data/delta.toml", &of_delta, false),
        ("tests/data/stewart.toml", &of_stewart, false),
        ("tests/data/stewart.toml", &of_stewart, true),
    ];
    for (path, other, is_rounded) in cases {
        let text = compiled(&Case(path, &[]), Closure::Joint, false).source.text;
        let text = if is_rounded { rounded(&text) } else { text };
        let heights = ["", other].map(|guess| {
            let text = format!("{text}{guess}");
            let both = [false, true].map(|saddle| of_text(path, text.clone(), Closure::Joint, saddle));
            let [rows_first, saddle] = &both;
            assert!(4 * forward_operations(rows_first) < 3 * forward_operations(saddle), "{path}");
            let states = agree((rows_first, saddle), &format!("{path} {guess}"));
            assert!(states >= 3, "{path} {guess}: {states} states");
            height(rows_first)
        });
        assert!(heights[0] * heights[1] < 0.0, "{path}: {heights:?}");
    }
}

/// With six digits behind the point.
fn rounded(text: &str) -> String {
    let is_digit = |letter: char| letter.is_ascii_digit() || letter == '.';
    let short = |number: &str| match number.parse::<f64>() {
        Ok(value) if number.len() > 9 => format!("{value:.6}"),
        _ => number.to_owned(),
    };
    let mut digits = String::new();
    let mut rounded = String::new();
    for letter in text.chars() {
        if is_digit(letter) {
            digits.push(letter);
        } else {
            rounded += &short(&std::mem::take(&mut digits));
            rounded.push(letter);
        }
    }
    rounded
}

/// Of the body that all loops meet at, at the start.
fn height(compiled: &Compiled) -> f64 {
    let system = compiled.interpreter();
    let parameters = compiled.parameters();
    let state = assemble(&system, compiled.description(), &parameters, 0.0).expect("a start");
    let mut evaluator = Evaluator::new(&system, compiled.description(), &parameters).expect("parameters");
    let channels = evaluator.observe(0.0, &state.q, &state.v).to_vec();
    let names = compiled.description().channels.iter();
    let at = names.map(|channel| &*channel.name).position(|name| name == "C.z").expect("a column");
    channels[at]
}

/// From one start the loops are closed for the drivers' place at several times, as far as Newton comes. Out: how many states.
fn agree((rows_first, saddle): (&Compiled, &Compiled), name: &str) -> usize {
    let system = rows_first.interpreter();
    let times = (0..12).map(|i| 0.01 * f64::from(i));
    let closed = |t: f64| assemble(&system, rows_first.description(), &rows_first.parameters(), t).ok();
    let states: Vec<(f64, State)> = times.filter_map(|t| Some((t, closed(t)?))).collect();
    for (t, state) in &states {
        let [ours, theirs] = [rows_first, saddle].map(|compiled| solved(compiled, *t, state));
        for (a, b) in ours.iter().zip(&theirs) {
            let size = b.iter().fold(1e-6, |size: f64, x| size.max(x.abs()));
            let error = a.iter().zip(b).fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs()));
            // The saddle point squares the condition of the loops, some 1e2, on roundings of 1e-16.
            assert!(error <= 1e-10 * size, "{name} at {t} s: {error:e} of {size:e}");
        }
    }
    states.len()
}
