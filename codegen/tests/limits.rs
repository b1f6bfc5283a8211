//! Files that are too large are refused with the limit they break, before they fill the memory.

use std::fmt::Write as _;

use linkwear_codegen::{Options, SourceFile, compile};

/// An open chain of rods on ball joints.
fn chain(links: usize) -> SourceFile {
    let mut text = String::from("spec = 1\nname = \"chain\"\n[points]\n");
    for i in 0..=links {
        let _ = writeln!(text, "P{i} = [\"{i}*0.1*(1 m)\", \"0 m\", \"{i}*0.02*(1 m)\"]");
    }
    text += "[bodies]\n";
    for i in 1..=links {
        let before = i - 1;
        let _ = writeln!(
            text,
            "b{i} = {{ rod = [\"P{before}\", \"P{i}\"], radius = \"5 mm\", density = \"7850 kg/m^3\" }}"
        );
    }
    text += "[joints]\n";
    for i in 1..=links {
        let (before, parent) = (i - 1, if i == 1 { "ground".to_owned() } else { format!("b{}", i - 1) });
        let _ = writeln!(text, "J{i} = {{ spherical = [\"{parent}\", \"b{i}\"], at = \"P{before}\" }}");
    }
    SourceFile { name: "chain.toml".into(), text }
}

fn refusal(source: &SourceFile) -> String {
    refusal_with(source, &Options::default())
}

fn refusal_with(source: &SourceFile, options: &Options) -> String {
    compile(source, options).map(|_| ()).expect_err("too large").to_string()
}

#[test]
fn a_chain_whose_equations_would_fill_the_memory_is_refused() {
    // With the mass matrix and its elimination, which are left out where nobody asks for them.
    let whole = Options { whole_equations: true, saddle: true, ..Options::default() };
    let message = refusal_with(&chain(80), &whole);
    assert!(message.contains("E0112") && message.contains("symbolic expressions"), "{message}");
}

#[test]
fn a_long_chain_without_its_mass_matrix_is_not() {
    let compiled = compile(&chain(60), &Options::default()).unwrap_or_else(|errors| panic!("{errors}"));
    let counts = compiled.operations();
    let equations = counts.iter().find(|count| count.name == "equations_of_motion").expect("it is there");
    assert!(equations.operations.total < 100_000, "{}", equations.operations.total);
}

#[test]
fn zeros_in_the_place_of_a_mass_matrix_are_told_wherever_equations_are_read() {
    let left_out =
        |links| compile(&chain(links), &Options::default()).unwrap_or_else(|errors| panic!("{errors}"));
    let [short, long] = [2, 60].map(left_out);
    assert_eq!([short.mass_is_left_out(), long.mass_is_left_out()], [false, true]);
    let text = |compiled: &linkwear_codegen::Compiled| {
        let only = ["mass".to_owned()];
        compiled.equations_text(&only, linkwear_codegen::render::TextFormat::Text)
    };
    assert!(text(&short).contains("mass[1] = "), "{}", text(&short));
    assert!(text(&long).contains("No masses") && !text(&long).contains("mass["), "{}", text(&long));
    // Who calls the function by its usual name finds none.
    let crate_of = |compiled: &linkwear_codegen::Compiled| {
        let files = compiled.c_crate();
        files.into_iter().map(|(_, text)| text).collect::<String>()
    };
    for (compiled, is_told) in [(&short, false), (&long, true)] {
        let (rust, c) = (compiled.rust_source(), compiled.c_files("chain.h"));
        let says = |text: &str, word: &str| assert_eq!(text.contains(word), is_told, "{word}");
        says(&rust, "pub const MASS_IS_LEFT_OUT: bool = true;");
        says(&rust, "pub fn equations_of_motion_without_mass<");
        says(&c.header, "void chain_equations_of_motion_without_mass(");
        says(&c.source, "void chain_equations_of_motion_without_mass(");
        assert_ne!(rust.contains("pub fn equations_of_motion<"), is_told);
        assert_ne!(c.header.contains("void chain_equations_of_motion("), is_told);
        for text in [&rust, &c.header, &c.source] {
            says(text, "zeros stand in its place");
        }
        let library = crate_of(compiled);
        says(&library, "CHAIN_MASS_LEFT_OUT = 6");
        says(&library, "return Err(MASS_LEFT_OUT);");
        assert!(!library.contains("OF_MASS"));
    }
}

#[test]
fn more_bodies_than_the_limit_are_refused() {
    let message = refusal(&chain(401));
    assert!(message.contains("401 bodies"), "{message}");
}

#[test]
fn of_many_faults_the_first_hundred_are_shown_and_their_number_said() {
    let mut source = chain(20);
    for i in 0..300 {
        let _ = write!(source.text, "\n[forces.f{i}]\nnothing = 1\n");
    }
    let message = refusal(&source);
    let shown = message.matches("error[").count() + message.matches("warning[").count();
    assert_eq!(shown, 100, "{message}");
    assert!(message.contains("faults in all"), "{message}");
}

/// Ten thousand faults, each within a thing of its own: what is found in one table is found in one reading. By a reading for each
/// fault this takes hours.
#[test]
fn a_fault_in_each_of_many_things_is_told_of_all() {
    let mut source = chain(20);
    for i in 0..10_000 {
        let _ = write!(
            source.text,
            "\n[joints.more{i}]\nrevolute = [\"ground\", \"b{i}\"]\nat = [\"0 m\", \"0 m\", \"0 m\"]\n"
        );
    }
    let message = refusal(&source);
    assert!(message.contains("faults in all"), "{message}");
    assert!(message.contains("found a list where a text is needed"), "{message}");
}
