//! Four-bars whose links come in line, for tests of singular positions.
#![allow(dead_code, reason = "every test takes what it needs")]

use linkwear_codegen::compile::{Compiled, Options, compile};
use linkwear_codegen::source::SourceFile;

/// A planar four-bar of these corners on the ground, from O over A and B to D, with what its crank and its rocker do.
pub fn four_bar(
    corners: [[f64; 2]; 3],
    crank: &str,
    rocker: &str,
    more: &str,
) -> Result<Compiled, &'static str> {
    compiled(four_bar_text(corners, crank, rocker, more))
}

/// The same as a file.
pub fn four_bar_text(corners: [[f64; 2]; 3], crank: &str, rocker: &str, more: &str) -> String {
    let [a, b, d] = corners.map(|[x, y]| format!("[\"{x:?} m\", \"{y:?} m\", 0]"));
    format!(
        "spec = 1\nname = \"bars\"\ngravity = [0, \"-9.81 m/s^2\", 0]\n[points]\nO = [0, 0, 0]\nA = {a}\nB = {b}\nD = {d}\n[bodies]\n\
         crank = {{ rod = [\"O\", \"A\"], radius = \"8 mm\", mass = \"1 kg\" }}\n\
         coupler = {{ rod = [\"A\", \"B\"], radius = \"8 mm\", mass = \"2 kg\" }}\n\
         rocker = {{ rod = [\"D\", \"B\"], radius = \"8 mm\", mass = \"1.5 kg\" }}\n[joints]\n\
         R1 = {{ revolute = [\"ground\", \"crank\"], at = \"O\", axis = [0, 0, 1]{crank} }}\n\
         R2 = {{ revolute = [\"crank\", \"coupler\"], at = \"A\", axis = [0, 0, 1] }}\n\
         R3 = {{ revolute = [\"coupler\", \"rocker\"], at = \"B\", axis = [0, 0, 1] }}\n\
         R4 = {{ revolute = [\"ground\", \"rocker\"], at = \"D\", axis = [0, 0, 1]{rocker} }}\n{more}"
    )
}

/// Compiles a file, or says the code of its first fault.
pub fn compiled(text: String) -> Result<Compiled, &'static str> {
    let source = SourceFile { name: "bars.toml".to_owned(), text };
    compile(&source, &Options::default()).map_err(|errors| errors.list()[0].code.as_str())
}

/// Corners of linkages whose links come in line, with the crank at an angle.
pub fn foldable(angle: f64) -> [(&'static str, [[f64; 2]; 3]); 4] {
    let (sine, cosine) = angle.sin_cos();
    let parallel = |length: f64, base: f64| {
        let a = [length * cosine, length * sine];
        [a, [a[0] + base, a[1]], [base, 0.0]]
    };
    // Where circles around crank and ground pin meet, on the far side.
    let meeting = |length: f64, base: f64, coupler: f64, rocker: f64| {
        let a = [length * cosine, length * sine];
        let (x, y) = (a[0] - base, a[1]);
        let distance = x.hypot(y);
        let along = (rocker * rocker - coupler * coupler + distance * distance) / (2.0 * distance);
        let across = (rocker * rocker - along * along).max(0.0).sqrt();
        let b = [base + (x * along - y * across) / distance, (y * along + x * across) / distance];
        [a, b, [base, 0.0]]
    };
    [
        ("parallelogram", parallel(0.1, 0.3)),
        ("rhombus", parallel(0.2, 0.2)),
        ("kite", meeting(0.1, 0.1, 0.3, 0.3)),
        ("change points", meeting(0.1, 0.3, 0.25, 0.15)),
    ]
}
