//! E03: quantities and formulas.

use super::example::{Explanation, File};
use crate::diagnostic::Code;

pub const QUANTITIES: &[Explanation] = &[
    Explanation {
        code: Code::FormulaSyntax,
        file: File::Swing,
        text: "A formula that cannot be read. Products need their `*`, exponents are whole numbers, decimals have a \
               point.",
        wrong: r#"[points]
A = ["2 length", 0, 0]"#,
        right: r#"[points]
A = ["2*length", 0, 0]"#,
    },
    Explanation {
        code: Code::UnknownUnit,
        file: File::Swing,
        text: "A unit that is not known. Units are SI with prefixes, and `t`, `min`, `h`, `deg`, `rpm`, `%`, `HB`, \
               `HV`; products of units have a blank or `*` between them.",
        wrong: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], damping = "2 Nm s/rad" }"#,
        right: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], damping = "2 N m s/rad" }"#,
    },
    Explanation {
        code: Code::UnitMismatch,
        file: File::Swing,
        text: "A quantity of another dimension than the key takes, or a formula that adds lengths to times. Every \
               formula is checked before anything is computed.",
        wrong: r#"gravity = [0, "-9.81 m/s", 0]"#,
        right: r#"gravity = [0, "-9.81 m/s^2", 0]"#,
    },
    Explanation {
        code: Code::MissingUnit,
        file: File::Swing,
        text: "A bare number where a unit is needed. Is 6 a radius in metres or in millimetres? Only zero goes \
               without.",
        wrong: r#"[bodies]
bar = { rod = ["O", "A"], radius = 10, density = "7850 kg/m^3" }"#,
        right: r#"[bodies]
bar = { rod = ["O", "A"], radius = "10 mm", density = "7850 kg/m^3" }"#,
    },
    Explanation {
        code: Code::UnknownFunction,
        file: File::Swing,
        text: "A function that is not known, or that has another number of arguments. `docs/formulas.md` lists \
               them all.",
        wrong: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], force = "-1 N m*sgn(hinge.v)" }"#,
        right: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], force = "-1 N m*tanh(hinge.v/(0.01 rad/s))" }"#,
    },
    Explanation {
        code: Code::NotAllowedHere,
        file: File::Swing,
        text: "Time, a coordinate or a point where only parameters may occur. Geometry and masses are fixed; drives \
               may follow time, forces everything. `docs/spec-reference.md` has a table of what may be used where.",
        wrong: r#"[points]
A = ["1 m + 0.1 m/s*t", 0, 0]"#,
        right: r#"[points]
A = ["1 m", 0, 0]"#,
    },
    Explanation {
        code: Code::TunableNotAllowed,
        file: File::Swing,
        text: "A tunable parameter where the value decides what code is generated: axes, screws, flexible links, \
               wear. Take `tunable` away; `--set` changes it all the same, by generating anew.",
        wrong: r#"[parameters]
tilt = { value = "3 deg", tunable = true }

[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = ["sin(tilt)", 0, 1] }"#,
        right: r#"[parameters]
tilt = "3 deg"

[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = ["sin(tilt)", 0, 1] }"#,
    },
    Explanation {
        code: Code::NotFinite,
        file: File::Swing,
        text: "A value that is infinite or not a number: a division by zero, the root of a negative number, a size \
               beyond all numbers.",
        wrong: r#"[parameters]
length = "1 m/(2 - 2)""#,
        right: r#"[parameters]
length = "1 m/(2 - 1)""#,
    },
    Explanation {
        code: Code::UnknownMember,
        file: File::Swing,
        text: "A member that this joint or point does not have. Joints with one coordinate have `.q` and `.v`, \
               those with several `.q1`, `.v1` and so on; points have `.x .y .z` and `.vx .vy .vz`.",
        wrong: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], force = "-1 N m*sin(hinge.q2)" }"#,
        right: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], force = "-1 N m*sin(hinge.q)" }"#,
    },
    Explanation {
        code: Code::NotSmooth,
        file: File::Swing,
        text: "A drive whose position or speed would jump: the force for that is infinite. A drive needs a second \
               derivative, which may jump itself. Motion laws and smooth forms have one; `if`, `step`, `sign`, `floor` \
               and `mod` of the time jump, `abs`, `min`, `max` and `clamp` of it have a kink. Of parameters alone \
               all of them may stand in a drive.",
        wrong: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], drive = "30 deg*min(t/(1 s), 1)" }"#,
        right: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], drive = "30 deg*cycloidal(t/(1 s))" }"#,
    },
    Explanation {
        code: Code::BadArgument,
        file: File::Swing,
        text: "An argument that shapes a function and cannot be so: the width of a smooth form must be above zero, \
               the ramp of a trapezoid at most half of the phase, the period of a motion law at least the whole \
               phase. Such arguments are fixed when code is generated.",
        wrong: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], drive = "30 deg*trapezoid(t/(1 s), 0.7)" }"#,
        right: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], drive = "30 deg*trapezoid(t/(1 s), 0.25)" }"#,
    },
    Explanation {
        code: Code::BadTable,
        file: File::Swing,
        text: "A table that is no function: arguments that do not rise, fewer than two rows, columns of different lengths, \
               a period that does not end with the value that it begins with; or a CSV file that cannot be read.",
        wrong: r#"[tables]
brake = { argument = ["0 rad/s", "2 rad/s", "1 rad/s"], value = ["0 N m", "3 N m", "4 N m"] }"#,
        right: r#"[tables]
brake = { argument = ["0 rad/s", "1 rad/s", "2 rad/s"], value = ["0 N m", "3 N m", "4 N m"] }"#,
    },
];
