//! A kind of force element stands in two files: as keys and a row of the table, and with its equations.

mod source;

use linkwear_codegen::spec::FORCE_KINDS;
use source::files_with;

const TABLE: &str = "reader/src/spec/force.rs";
const EQUATIONS: &str = "codegen/src/derive/elements/forces.rs";

#[test]
fn a_kind_is_named_in_the_table_and_with_its_equations_only() {
    for kind in FORCE_KINDS {
        let name = format!("\"{}\"", kind.name);
        // A joint has the keys `spring` and `force` too; and every element of the table [forces] is a force.
        let other = |line: &str| {
            let of_joints = ["\"joint\"", "(\"force\", &spec.force)"];
            let of_elements = ["\"force\", name", "Force(_) =>"];
            of_joints.iter().chain(&of_elements).any(|words| line.contains(words))
        };
        let found = files_with(|line| line.contains(&name) && !other(line) && !line.contains("made.append"));
        assert_eq!(found, [EQUATIONS, TABLE], "{name}");
    }
}

#[test]
fn no_type_or_module_is_named_after_a_kind() {
    // Joints have springs and forces of their own.
    for kind in FORCE_KINDS.iter().filter(|kind| !["spring", "force"].contains(&kind.name)) {
        let (head, tail) = kind.name.split_at(1);
        let words = [format!("mod {}", kind.name), format!("{}{tail}", head.to_uppercase())];
        let found = files_with(|line| words.iter().any(|word| line.contains(word)));
        let elsewhere = found.iter().filter(|file| ![TABLE, EQUATIONS].contains(&file.as_str()));
        assert_eq!(elsewhere.collect::<Vec<_>>(), [""; 0], "{words:?}");
    }
}
