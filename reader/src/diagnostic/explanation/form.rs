//! E01: the form of a file.

use super::example::{Explanation, File};
use crate::diagnostic::Code;

pub const FORM: &[Explanation] = &[
    Explanation {
        code: Code::NotToml,
        file: File::Swing,
        text: "The file is not TOML, the format of its lines. Strings, quantities and formulas stand in quotes, \
               lists in square brackets with commas, and a table or a key stands only once. Bare numbers and `true` \
               or `false` go without quotes.",
        wrong: r#"[points]
A = [1 m, 0, 0]"#,
        right: r#"[points]
A = ["1 m", 0, 0]"#,
    },
    Explanation {
        code: Code::SpecVersion,
        file: File::Swing,
        text: "`spec` says for which version of the format the file was written, so that a later program never \
               reads it as something else. This program reads version 1.",
        wrong: "spec = 2",
        right: "spec = 1",
    },
    Explanation {
        code: Code::MissingKey,
        file: File::Swing,
        text: "A key or table is missing that has no default: a guess would change the result silently. The message \
               says which.",
        wrong: r#"[bodies]
bar = { rod = ["O", "A"], density = "7850 kg/m^3" }"#,
        right: r#"[bodies]
bar = { rod = ["O", "A"], radius = "10 mm", density = "7850 kg/m^3" }"#,
    },
    Explanation {
        code: Code::UnknownKey,
        file: File::Swing,
        text: "A key that means nothing here, most often a slip of the pen. If it were skipped, the default would \
               count in its place and nobody would see it. `docs/spec-reference.md` lists every key.",
        wrong: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], dampng = "1 N m s/rad" }"#,
        right: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], damping = "1 N m s/rad" }"#,
    },
    Explanation {
        code: Code::WrongType,
        file: File::Swing,
        text: "A value of another type than the key takes: a word where a list is needed, a list where a number is \
               needed.",
        wrong: r#"gravity = "down""#,
        right: r#"gravity = [0, "-9.81 m/s^2", 0]"#,
    },
    Explanation {
        code: Code::WrongCount,
        file: File::Swing,
        text: "A list with too many or too few entries. Positions, axes and gravity have three, in the order x, y, \
               z of the ground; joints name two bodies, parent first; rods two points.",
        wrong: r#"[points]
A = ["1 m", 0]"#,
        right: r#"[points]
A = ["1 m", 0, 0]"#,
    },
    Explanation {
        code: Code::ConflictingKeys,
        file: File::Swing,
        text: "Keys that say the same thing twice, or that belong to different kinds. Mass follows from density and \
               size, so both together could disagree.",
        wrong: r#"[bodies]
bar = { rod = ["O", "A"], radius = "10 mm", density = "7850 kg/m^3", mass = "2 kg" }"#,
        right: r#"[bodies]
bar = { rod = ["O", "A"], radius = "10 mm", mass = "2 kg" }"#,
    },
    Explanation {
        code: Code::NoKind,
        file: File::Swing,
        text: "Nothing says what kind of body, joint or force this is. The kind is a key of its own: `rod = [..]`, \
               `revolute = [..]`, `spring = [..]`.",
        wrong: r#"[joints]
hinge = { at = "O", axis = [0, 0, 1] }"#,
        right: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1] }"#,
    },
    Explanation {
        code: Code::BadChoice,
        file: File::Swing,
        text: "A word that is not one of those the key takes. The message lists them.",
        wrong: r#"closure = "logs""#,
        right: r#"closure = "log""#,
    },
    Explanation {
        code: Code::BadRepeat,
        file: File::Swing,
        text: "A `[repeat]` group that cannot be expanded: its count is no whole number, or a brace holds something \
               else than the index and whole numbers.",
        wrong: r#"[repeat.place]
count = 2.5
points = { "H{i}" = { at = [0, 0, 0], on = "bar" } }"#,
        right: r#"[repeat.place]
count = 2
points = { "H{i}" = { at = [0, 0, 0], on = "bar" } }"#,
    },
    Explanation {
        code: Code::EmptyMechanism,
        file: File::Swing,
        text: "A mechanism without bodies: nothing has mass, nothing can be computed.",
        wrong: r#"spec = 1
name = "swing"
gravity = [0, "-9.81 m/s^2", 0]

[bodies]"#,
        right: r#"spec = 1
name = "swing"
gravity = [0, "-9.81 m/s^2", 0]

[points]
O = [0, 0, 0]
A = ["1 m", 0, 0]

[bodies]
bar = { rod = ["O", "A"], radius = "10 mm", density = "7850 kg/m^3" }

[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1] }"#,
    },
    Explanation {
        code: Code::TooLarge,
        file: File::Swing,
        text: "More of something than can be compiled within a minute and 2 GiB on any machine. \
               `docs/spec-reference.md` has the table of limits.",
        wrong: r#"[repeat.place]
count = 5000
points = { "H{i}" = { at = [0, 0, 0], on = "bar" } }"#,
        right: r#"[repeat.place]
count = 50
points = { "H{i}" = { at = [0, 0, 0], on = "bar" } }"#,
    },
    Explanation {
        code: Code::BadInclude,
        file: File::Swing,
        text: "A file that cannot be a part of this one: it cannot be read, lies outside the folder of the file that includes it, \
               includes itself, or is moved or turned although something in it is written along the axes of its own drawing.",
        wrong: r#"[include]
left = { file = "no_such_leg.toml", origin = ["1 m", 0, 0] }"#,
        right: r#"[include]
# left = { file = "no_such_leg.toml", origin = ["1 m", 0, 0] }"#,
    },
];
