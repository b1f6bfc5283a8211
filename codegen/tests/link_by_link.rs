//! Articulated bodies are one more way to the forward dynamics: accelerations, multipliers and drives are those of elimination at
//! closed states.

mod forward;

use std::path::Path;

use forward::{forward_operations, solved};
use linkwear_codegen::compile::{Compiled, Options, compile};
use linkwear_codegen::model::Closure;
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{State, assemble};

fn compiled(name: &str, text: &str, closure: Closure, link_by_link: bool) -> Compiled {
    let source = SourceFile { name: name.to_owned(), text: text.to_owned() };
    let closure = Some(closure);
    let options = Options { closure, saddle: !link_by_link, link_by_link, ..Options::default() };
    compile(&source, &options).unwrap_or_else(|errors| panic!("{errors}"))
}

/// Cells of crossed bars on one another; driven or left to its weight.
fn scissor(cells: usize, driven: bool) -> String {
    let drive = if driven { r#", drive = "0.2 rad*sin(3 rad/s*t + 1 rad)""# } else { "" };
    format!(
        r#"
spec = 1
name = "scissor"
gravity = [0, "-9.81 m/s^2", 0]

[parameters]
N = {cells}

[points]
L0 = [0, 0, 0]
R0 = ["0.3 m", 0, 0]
L1 = [0, "0.4 m", 0]
R1 = ["0.3 m", "0.4 m", 0]
C1 = ["0.15 m", "0.2 m", 0]

[bodies]
slide = {{ mass = "1 kg", centre = "R0", inertia = ["1 g m^2", "1 g m^2", "1 g m^2"] }}
a1 = {{ rod = ["L0", "R1"], radius = "10 mm", density = "7850 kg/m^3" }}
b1 = {{ rod = ["R0", "L1"], radius = "10 mm", density = "7850 kg/m^3" }}

[joints]
foot = {{ revolute = ["ground", "a1"], at = "L0", axis = [0, 0, 1], damping = "0.5 N m s/rad"{drive} }}
guide = {{ prismatic = ["ground", "slide"], at = "R0", axis = [1, 0, 0] }}
pin = {{ revolute = ["slide", "b1"], at = "R0", axis = [0, 0, 1] }}
M1 = {{ revolute = ["a1", "b1"], at = "C1", axis = [0, 0, 1] }}

[repeat.cell]
count = "N - 1"
first = 2

[repeat.cell.points]
"L{{i}}" = [0, "{{i}}*0.4 m", 0]
"R{{i}}" = ["0.3 m", "{{i}}*0.4 m", 0]
"C{{i}}" = ["0.15 m", "{{2*i - 1}}*0.2 m", 0]

[repeat.cell.bodies]
"a{{i}}" = {{ rod = ["L{{i-1}}", "R{{i}}"], radius = "10 mm", density = "7850 kg/m^3" }}
"b{{i}}" = {{ rod = ["R{{i-1}}", "L{{i}}"], radius = "10 mm", density = "7850 kg/m^3" }}

[repeat.cell.joints]
"M{{i}}" = {{ revolute = ["a{{i}}", "b{{i}}"], at = "C{{i}}", axis = [0, 0, 1] }}
"P{{i}}" = {{ revolute = ["a{{i-1}}", "b{{i}}"], at = "R{{i-1}}", axis = [0, 0, 1] }}
"Q{{i}}" = {{ revolute = ["b{{i-1}}", "a{{i}}"], at = "L{{i-1}}", axis = [0, 0, 1] }}
"#
    )
}

/// Compares both at states that close the loops for the drivers' place at several times, as far as Newton comes.
fn compare(name: &str, text: &str, closure: Closure) {
    let [ours, theirs] = [true, false].map(|by_links| compiled(name, text, closure, by_links));
    let system = ours.interpreter();
    let times = (0..12).map(|i| 0.01 * f64::from(i));
    let states: Vec<(f64, State)> = times
        .filter_map(|t| Some((t, assemble(&system, ours.description(), &ours.parameters(), t).ok()?)))
        .collect();
    assert!(states.len() >= 3, "{name} {closure:?}: {} states", states.len());
    for (t, state) in states {
        let [ours, theirs] = [&ours, &theirs].map(|compiled| solved(compiled, t, &state));
        for (a, b) in ours.iter().zip(&theirs) {
            // What is zero is the rest of terms of the order of one.
            let size = b.iter().fold(1e-4, |size: f64, x| size.max(x.abs()));
            let error = a.iter().zip(b).fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs()));
            assert!(error <= 1e-10 * size, "{name} {closure:?} at {t} s: {error:e} of {size:e}");
        }
    }
}

#[test]
fn links_one_by_one_have_the_solution_of_elimination() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let files = [
        "mechanisms/four_bar.toml",
        "mechanisms/six_bar.toml",
        "mechanisms/slider_crank.toml",
        "mechanisms/spatial_slider_crank.toml",
        "mechanisms/bennett.toml",
        "mechanisms/rssr_rigid.toml",
        "mechanisms/andrews.toml",
        "mechanisms/bricard.toml",
        "mechanisms/n_four_bar_2.toml",
        "mechanisms/n_four_bar_40.toml",
        "mechanisms/slider_crank_clearance.toml",
        // Every kind of joint in every role.
        "codegen/tests/data/bushing.toml",
        "codegen/tests/data/joints_cut.toml",
        "codegen/tests/data/joints_cut_reversed.toml",
        "codegen/tests/data/joints_driven.toml",
        "codegen/tests/data/joints_inline.toml",
        "codegen/tests/data/joints_open.toml",
        "codegen/tests/data/joints_tree.toml",
        "codegen/tests/data/joints_tree_reversed.toml",
    ];
    for file in files {
        let text = std::fs::read_to_string(root.join(file)).expect("a file");
        for closure in [Closure::Joint, Closure::Log] {
            compare(file, &text, closure);
        }
    }
}

#[test]
fn a_long_scissor_has_the_solution_of_elimination() {
    for driven in [false, true] {
        compare("scissor", &scissor(20, driven), Closure::Joint);
    }
}

#[test]
fn operations_of_a_scissor_grow_as_its_cells() {
    for driven in [false, true] {
        let count = |cells: usize| {
            let source = SourceFile { name: "scissor".to_owned(), text: scissor(cells, driven) };
            let compiled = compile(&source, &Options::default()).unwrap_or_else(|errors| panic!("{errors}"));
            forward_operations(&compiled)
        };
        let counts = [count(24), count(96)];
        let exponent = (counts[1] as f64 / counts[0] as f64).ln() / 4.0_f64.ln();
        // Once they came to millions.
        assert!(exponent < 1.1 && counts[1] < 50_000, "driven {driven}: {counts:?}");
    }
}
