//! Whatever a user writes, the front end answers with a mechanism or with diagnostics that can be printed.

use linkwear_codegen::diagnostic::Diagnostics;
use linkwear_codegen::input::Reach;
use linkwear_codegen::model::topology::spanning_tree;
use linkwear_codegen::model::{Overrides, resolve};
use linkwear_codegen::source::SourceFile;
use linkwear_codegen::spec;
use proptest::prelude::*;

/// What is put in place of a piece of a file: fragments that mean something somewhere.
const PIECES: &[&str] = &[
    "",
    "0",
    "-1",
    "nan",
    "1e308",
    "\"\"",
    "\"B\"",
    "\"ground\"",
    "\"0 mm\"",
    "\"t\"",
    "\"R1.q\"",
    "\"1/0\"",
    "\"if(t < 1 s, t, 2 s)\"",
    "\"mod(1, 0)\"",
    "\"drag(t)\"",
    "\"periodic\"",
    "\"spline\"",
    "[]",
    "{}",
    "[0, 0, 0]",
    "{ q1 = 1 }",
    "{ coupler = [0, 0, 1] }",
    "true",
    "cut = true,",
    "free",
    "planar",
    "slot",
    "inplane",
    "distance",
    "on_surface",
    "origin",
    "equation",
    "universal",
    "box",
    "\"{i}\"",
    "[repeat.x]\ncount = 2\n",
    "dry_friction = { coefficient = 0.1, radius = \"1 mm\" },",
    "\"R1.Fx*(1 m)\"",
    "\"R1.a*(1 kg m^2)\"",
    "\"crank.alpha_z*(1 kg m^2)\"",
    "\"R1.drive\"",
    "[states]\nx = { initial = \"1 N\", rate = \"-x/(1 s)\" }\n",
    "[sensors]\ns = \"2*s\"\n",
    "[stops]\nend = { joint = \"R1\", upper = \"1 rad\", stiffness = \"1 N m\" }\n",
    "[include.p]\nfile = \"p.toml\"\n",
    "cable",
    "tilt = true\n",
    "tilt = false\n",
    "ends = \"journal\"\n",
    "ends = \"bearing\"\n",
    "prismatic",
    "cylindrical",
    "length = \"0 mm\"\n",
    "hardness_ratio = 0.5\n",
    "stiffness_matrix = [[1], [2]]",
    "µ",
    "\\",
    "=",
    "\n",
];

/// Everything before equations.
fn front_end(source: &SourceFile) -> Result<(), Diagnostics> {
    let (mechanism, _) = resolve(&spec::parse(source)?, &Overrides::default(), Reach::Below)?;
    spanning_tree(&mechanism).map(drop).map_err(|errors| errors.located(source))
}

#[test]
fn a_file_without_one_of_its_tables_gives_a_mechanism_or_diagnostics() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../mechanisms");
    let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut tried = 0;
    for path in paths.filter(|path| path.extension().is_some_and(|extension| extension == "toml")) {
        let text = std::fs::read_to_string(&path).unwrap();
        // A piece runs from the head of a table to that of the next.
        let pieces: Vec<&str> = text.split("\n[").collect();
        for without in 1..pieces.len() {
            let kept = pieces.iter().enumerate().filter(|(at, _)| *at != without).map(|(_, piece)| *piece);
            let text = kept.collect::<Vec<_>>().join("\n[");
            let _ = front_end(&SourceFile { name: "cut.toml".into(), text });
            tried += 1;
        }
    }
    assert!(tried > 80, "{tried}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn a_damaged_file_gives_a_mechanism_or_diagnostics(
        file in prop::sample::select(vec!["rssr_rigid", "rssr", "four_bar", "slider_crank", "pendulum", "../examples/data/servo_crank", "../examples/data/sampled_servo", "../examples/data/drop_hammer", "../examples/data/walker", "../examples/data/loose_guide", "../examples/data/tilting_bearing"]),
        damages in prop::collection::vec((0.0..1.0, 0usize..12, prop::sample::select(PIECES)), 1..4),
    ) {
        let path = format!("{}/../mechanisms/{file}.toml", env!("CARGO_MANIFEST_DIR"));
        let mut text: Vec<char> = std::fs::read_to_string(path).unwrap().chars().collect();
        for (place, length, piece) in damages {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place in a short file")]
            let start = (place * text.len() as f64) as usize;
            let end = (start + length).min(text.len());
            text.splice(start..end, piece.chars());
        }
        let source = SourceFile { name: "damaged.toml".into(), text: text.into_iter().collect() };
        if let Err(errors) = front_end(&source) {
            prop_assert!(errors.has_errors());
            prop_assert!(!errors.to_string().is_empty());
            prop_assert_eq!(errors.entries().len(), errors.list().len());
        }
    }
}
