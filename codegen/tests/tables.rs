//! Functions given by rows, run in forces and drives: between the rows, at them and outside.

use std::fs;

use linkwear_codegen::compile::{Compiled, Options, compile};
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{Entry, Integrator, Run, Settings, Span, System, Watch, simulate};

fn text(tables: &str, joint: &str) -> String {
    format!(
        r#"spec = 1
name = "block"
gravity = [0, 0, 0]
[tables]
{tables}
[points]
O = [0, 0, 0]
A = ["0.1 m", 0, 0]
[bodies]
body = {{ rod = ["O", "A"], radius = "10 mm", mass = "2 kg" }}
[joints]
rail = {{ prismatic = ["ground", "body"], at = "O", axis = [1, 0, 0], {joint} }}
"#
    )
}

fn compiled(name: &str, text: String) -> Compiled {
    let source = SourceFile { name: name.into(), text };
    compile(&source, &Options::default()).unwrap_or_else(|errors| panic!("{errors}"))
}

fn refused(tables: &str, joint: &str) -> String {
    let source = SourceFile { name: "block.toml".into(), text: text(tables, joint) };
    match compile(&source, &Options::default()) {
        Ok(_) => panic!("taken: {joint}"),
        Err(errors) => errors.to_string(),
    }
}

fn run(compiled: &Compiled, span: f64) -> Run {
    let integrator = Integrator::Dopri5 { tolerance: 1e-10, max_step: None };
    let settings = Settings { span: Span::Time(span), samples: 101, integrator, ..Settings::default() };
    simulate(&compiled.interpreter(), compiled.description(), &compiled.parameters(), &settings, Watch::NONE)
        .unwrap()
}

const PUSH: &str =
    r#"push = { argument = ["0 s", "1 s", "3 s"], value = ["0 N", "4 N", "0 N"], interpolation = "linear""#;

#[test]
fn a_linear_load_moves_a_block_as_its_integral_says() {
    let own = compiled("block.toml", text(&format!("{PUSH} }}"), r#"force = "push(t)""#));
    let run = run(&own, 3.0);
    assert!(run.stopped.is_none());
    for (t, v) in run.times.iter().zip(run.column("rail.v").unwrap()) {
        // 2 kg: the integral of 2 t up to 1 s, of 3 - t from then on.
        let exact = if *t < 1.0 { t * t } else { 1.0 + 3.0 * (t - 1.0) - 0.5 * (t * t - 1.0) };
        // The tolerance, for steps that pass the corner.
        assert!((v - exact).abs() < 1e-8, "{t}: {v} {exact}");
    }
}

#[test]
fn outside_its_rows_a_table_ends_a_run_holds_or_goes_on() {
    let with = |outside: &str| {
        compiled("block.toml", text(&format!("{PUSH}, outside = \"{outside}\" }}"), r#"force = "push(t)""#))
    };
    let ended = run(&with("refuse"), 4.0).stopped.expect("nothing is known there").to_string();
    assert!(ended.contains("not"), "{ended}");
    let at = |compiled: &Compiled, t: f64| {
        let system = compiled.interpreter();
        let sizes = System::<f64>::sizes(&system);
        let mut output = vec![0.0; sizes.output(Entry::ForwardDynamics)];
        let mut workspace = vec![0.0; sizes.workspace];
        system.evaluate(Entry::ForwardDynamics, &[t, 0.0, 0.0], &mut output, &mut workspace);
        2.0 * output[0]
    };
    assert!(at(&with("refuse"), 3.5).is_nan() && at(&with("refuse"), -0.5).is_nan());
    assert_eq!([-0.5, 0.5, 1.0, 2.5, 3.5].map(|t| at(&with("hold"), t)), [0.0, 2.0, 4.0, 1.0, 0.0]);
    assert_eq!([-2.0, 3.5, 5.0].map(|t| at(&with("periodic"), t)), [4.0, 2.0, 2.0]);
}

#[test]
fn a_periodic_spline_drives_with_continuous_accelerations() {
    let table = r#"lift = { argument = ["0 s", "0.25 s", "0.5 s", "0.75 s", "1 s"], value = ["0 mm", "10 mm", "0 mm", "-10 mm", "0 mm"], interpolation = "spline", outside = "periodic" }"#;
    let own = compiled("block.toml", text(table, r#"drive = "lift(t)""#));
    let run = run(&own, 4.0);
    assert!(run.stopped.is_none());
    let columns = ["rail.q", "rail.v", "rail.a"].map(|name| run.column(name).unwrap());
    // The periodic spline through 0, h, 0, -h has slopes 3 h/(2 d) and -3 h/(2 d) where it is zero, none at its tops.
    for (k, t) in run.times.iter().enumerate() {
        let s = (t.rem_euclid(0.5)) / 0.25;
        let sign = if t.rem_euclid(1.0) < 0.5 { 1.0 } else { -1.0 };
        let u = if s > 1.0 { 2.0 - s } else { s };
        let exact = sign * 0.01 * (1.5 * u - 0.5 * u * u * u);
        // Roundings of the time in its rounds.
        assert!((columns[0][k] - exact).abs() < 1e-15, "{t}: {} {exact}", columns[0][k]);
        let curved = -sign * 0.01 * 3.0 * u / (0.25 * 0.25);
        assert!((columns[2][k] - curved).abs() < 1e-11, "{t}: {} {curved}", columns[2][k]);
    }
    assert!((columns[1][0] - 0.01 * 1.5 / 0.25).abs() < 1e-15);
}

#[test]
fn a_file_of_rows_gives_the_bits_of_the_same_rows_written_out() {
    let folder = std::env::temp_dir().join(format!("linkwear-rows-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let rows = "# measured\nway [mm], force [N]\n0, 0\n5, 120\n\"8\", 300\n";
    fs::write(folder.join("rows.csv"), rows).unwrap();
    let name = folder.join("block.toml").to_string_lossy().into_owned();
    let inline = r#"law = { argument = ["0 mm", "5 mm", "8 mm"], value = ["0 N", "120 N", "300 N"], outside = "hold" }"#;
    let [own, other] = [r#"law = { data = "rows.csv", outside = "hold" }"#, inline]
        .map(|table| compiled(&name, text(table, r#"force = "-law(rail.q)""#)));
    let tables = |compiled: &Compiled| format!("{:?}", compiled.mechanism.joints[0].passive);
    assert!(tables(&own).contains("knots: [0.0, 0.005, 0.008]"));
    let knots =
        |text: String| text.split("knots").nth(1).map(|rest| rest.split("span").next().unwrap().to_owned());
    assert_eq!(knots(tables(&own)), knots(tables(&other)));
    // The file is one of those that a build watches and a result is known by.
    assert_eq!(own.mechanism.attached.len(), 1);
    fs::write(folder.join("rows.csv"), "way [mm], force [N]\n0, secret\n").unwrap();
    let source =
        SourceFile { name, text: text(r#"law = { data = "rows.csv" }"#, r#"force = "-law(rail.q)""#) };
    let told = compile(&source, &Options::default()).map(|_| ()).unwrap_err().to_string();
    fs::remove_dir_all(folder).unwrap();
    assert!(told.contains("line 2 has a cell that is no number") && !told.contains("secret"), "{told}");
}

#[test]
fn what_a_table_cannot_do_is_refused() {
    let law = r#"law = { argument = ["0 m", "1 m"], value = ["0 N", "1 N"] }"#;
    for (joint, code) in [
        (r#"force = "law(t)""#, "E0303"),
        (r#"force = "law(rail.q, 1)""#, "E0305"),
        (r#"force = "lw(rail.q)""#, "E0305"),
        (r#"force = "law(rail.q)*1 m""#, "E0303"),
    ] {
        let told = refused(law, joint);
        assert!(told.contains(code), "{joint}: {told}");
    }
    let straight =
        r#"lift = { argument = ["0 s", "1 s"], value = ["0 m", "1 m"], interpolation = "linear" }"#;
    assert!(refused(straight, r#"drive = "lift(t)""#).contains("E0310"));
    let rows: Vec<String> = (0..300).map(|k| format!("\"{k} m\"")).collect();
    let long = format!("law = {{ argument = [{0}], value = [{0}] }}", rows.join(", "));
    assert!(refused(&long, r#"force = "1 N*law(rail.q)/(1 m)""#).contains("E0112"));
    let named = r#"sin = { argument = ["0 m", "1 m"], value = ["0 N", "1 N"] }"#;
    assert!(refused(named, r#"force = "1 N""#).contains("E0202"));
    let outside = r#"law = { data = "../../etc/hostname" }"#;
    assert!(refused(outside, r#"force = "law(rail.q)""#).contains("E0312"));
}

#[test]
fn a_table_that_begins_after_the_start_is_refused_with_the_cure() {
    let late = r#"law = { argument = ["1 s", "2 s"], value = ["0 N", "5 N"] }"#;
    let answer = refused(late, r#"force = "law(t)""#);
    assert!(answer.contains("E0308") && answer.contains("outside = \"hold\""), "{answer}");
}
