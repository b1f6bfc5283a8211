//! E02: names.

use super::example::{Explanation, File};
use crate::diagnostic::Code;

pub const NAMES: &[Explanation] = &[
    Explanation {
        code: Code::BadName,
        file: File::Swing,
        text: "A name with other characters than letters, digits and `_`, or that does not begin with a letter. \
               Names go into formulas, columns and generated code, where anything else would mean something else.",
        wrong: r#"name = "my swing""#,
        right: r#"name = "my_swing""#,
    },
    Explanation {
        code: Code::ReservedName,
        file: File::Swing,
        text: "A name that means something already: `t` is the time, `pi` the number, `ground` the fixed frame, \
               `energy` a group of output columns.",
        wrong: r#"[parameters]
t = "1 s""#,
        right: r#"[parameters]
period = "1 s""#,
    },
    Explanation {
        code: Code::DuplicateName,
        file: File::Swing,
        text: "Two things with one name. Parameters, inputs, points, bodies, joints and forces share one set of \
               names, since formulas and columns use them side by side.",
        wrong: r#"[parameters]
bar = "3 mm""#,
        right: r#"[parameters]
thickness = "3 mm""#,
    },
    Explanation {
        code: Code::UnknownName,
        file: File::Swing,
        text: "A name that nothing in the file has. The nearest one there is stands in the message.",
        wrong: r#"[points]
A = ["lenght", 0, 0]"#,
        right: r#"[points]
A = ["length", 0, 0]"#,
    },
    Explanation {
        code: Code::WrongKindOfName,
        file: File::Swing,
        text: "A name of another kind of thing: a joint where a body is needed, a parameter where a point is \
               needed.",
        wrong: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "bar", axis = [0, 0, 1] }"#,
        right: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1] }"#,
    },
    Explanation {
        code: Code::UnknownOverride,
        file: File::Swing,
        text: "`--set` of a parameter that the file does not have.",
        wrong: "--set lenght=2m",
        right: "--set length=2m",
    },
    Explanation {
        code: Code::ParameterCycle,
        file: File::Swing,
        text: "Parameters that are defined by each other have no value. Give one of them a number.",
        wrong: r#"[parameters]
width = "2*height"
height = "width/2""#,
        right: r#"[parameters]
width = "2*height"
height = "5 mm""#,
    },
    Explanation {
        code: Code::RepeatCollision,
        file: File::Swing,
        text: "Cells of a `[repeat]` group that make the same thing twice, because a name in it lacks the index in \
               braces.",
        wrong: r#"[repeat.place]
count = 2
points = { H = { at = [0, 0, 0], on = "bar" } }"#,
        right: r#"[repeat.place]
count = 2
points = { "H{i}" = { at = [0, 0, 0], on = "bar" } }"#,
    },
];
