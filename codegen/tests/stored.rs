//! Programs of mechanisms as bytes.

use linkwear_codegen::{Options, SourceFile, compile};
use linkwear_tape::Program;
use linkwear_tape::stored::Damage;

fn program(name: &str) -> Program {
    let path = format!("{}/../mechanisms/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("a mechanism");
    let compiled = compile(&SourceFile { name: path, text }, &Options::default()).expect("no errors");
    let program = Program::new(compiled.description().clone(), compiled.tapes().to_vec());
    let program = program.expect("what is compiled fits");
    assert_eq!(program.sizes(), compiled.sizes());
    program
}

#[test]
fn a_mechanism_comes_back_from_its_bytes() {
    for name in ["pendulum", "slider_crank_clearance", "rssr_ball_wear", "rssr"] {
        let program = program(name);
        assert_eq!(Program::from_bytes(&program.to_bytes()).as_ref(), Ok(&program), "{name}");
    }
}

#[test]
fn a_tape_that_does_not_fit_the_description_is_told() {
    let program = program("pendulum");
    let mut tapes = program.tapes().to_vec();
    tapes.swap(0, 7);
    let wrong = Program::new(program.description().clone(), tapes);
    let told = "tape `prescribed`: it does not fit the description";
    assert_eq!(wrong, Err(Damage::Value { what: told.to_owned() }));
    let few = Program::new(program.description().clone(), program.tapes()[..4].to_vec());
    assert!(few.is_err());
}
