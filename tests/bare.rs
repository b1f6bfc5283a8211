//! `examples/bare` steps without std in the bits of a run with it: what its C program prints stands in a file of the example, and here
//! `simulate` answers the same. `.ci/run` builds the example and compares the print with the file; docs/generated-code.md shows it.

use std::fs;

use linkwear::mechanisms::rssr;
use linkwear_runtime::{Integrator, Settings, Span, Watch, simulate};

#[test]
fn a_turn_without_std_has_the_bits_of_one_with_it() {
    let mechanism = rssr::Mechanism::default();
    let settings = Settings {
        span: Span::Turns(1.0),
        samples: 2,
        integrator: Integrator::Rk4 { step: 1e-5 },
        ..Settings::default()
    };
    let run = simulate(&mechanism, rssr::description(), &mechanism.parameters(), &settings, Watch::NONE);
    let run = run.expect("a run");
    assert!(run.stopped.is_none(), "{:?}", run.stopped);
    let last = |name: &str| run.column(name).expect("a column")[1];
    let expected = [last("R4.q"), last("R1.Fn"), run.turns[0][0].wear_integral];
    let printed = fs::read_to_string("examples/bare/printed.txt").expect("what the C program prints");
    // Seventeen digits tell every number from every other.
    let numbers = printed.lines().map(|line| line.rsplit(' ').nth(1).expect("a number and a unit"));
    let printed: Vec<f64> = numbers.map(|number| number.parse().expect("a number")).collect();
    assert_eq!(printed, expected);
}

#[test]
fn the_page_shows_the_example_word_for_word() {
    let page = fs::read_to_string("docs/generated-code.md").expect("the page");
    let section = page.split("\n## Without std\n").nth(1).expect("the section");
    let section = section.split("\n## ").next().expect("a section");
    for (name, language) in [
        ("Cargo.toml", "toml"),
        ("build.rs", "rust"),
        ("src/lib.rs", "rust"),
        ("main.c", "c"),
        ("printed.txt", "text"),
    ] {
        let file = fs::read_to_string(format!("examples/bare/{name}")).expect("a file of the example");
        let fence = format!("\n\n```{language}\n{file}```\n");
        assert!(section.contains(&fence), "docs/generated-code.md must have, without std:{fence}");
    }
}
