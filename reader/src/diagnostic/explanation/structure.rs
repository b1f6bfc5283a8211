//! E05: how bodies hang together.

use super::example::{Explanation, File};
use crate::diagnostic::Code;

pub const STRUCTURE: &[Explanation] = &[
    Explanation {
        code: Code::Disconnected,
        file: File::FourBar,
        text: "Bodies that no joint connects to the ground, not even through others. A joint was forgotten, or \
               names another body. A body that really floats takes a `free` joint.",
        wrong: r#"[points]
E = ["400 mm", 0, 0]

[bodies]
flap = { rod = ["D", "E"], radius = "6 mm", density = "steel" }"#,
        right: r#"[points]
E = ["400 mm", 0, 0]

[bodies]
flap = { rod = ["D", "E"], radius = "6 mm", density = "steel" }

[joints]
R5 = { fixed = ["ground", "flap"], at = "D" }"#,
    },
    Explanation {
        code: Code::CutDisconnects,
        file: File::Swing,
        text: "A joint must be cut, because its point or axis has one position on each body or because the file \
               says so, but a body hangs on it alone. Only a joint within a loop can be cut.",
        wrong: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], cut = true }"#,
        right: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1] }"#,
    },
    Explanation {
        code: Code::DrivenLoop,
        file: File::FourBar,
        text: "Driven joints that make up a whole loop: each of them says where it is, and the loop could not \
               close. Leave at least as many joints free as the loop needs.",
        wrong: r#"[points]
C = ["300 mm", "200 mm", 0]

[joints]
R2 = { revolute = ["crank", "coupler"], at = "A", axis = [0, 0, 1], drive = "0.1*t/(1 s)" }
R3 = { revolute = ["coupler", "rocker"], at = "C", axis = [0, 0, 1], drive = "0.1*t/(1 s)" }
R4 = { revolute = ["ground", "rocker"], at = "D", axis = [0, 0, 1], drive = "0.1*t/(1 s)" }"#,
        right: r#"[points]
C = ["300 mm", "200 mm", 0]

[joints]
R2 = { revolute = ["crank", "coupler"], at = "A", axis = [0, 0, 1] }
R3 = { revolute = ["coupler", "rocker"], at = "C", axis = [0, 0, 1] }
R4 = { revolute = ["ground", "rocker"], at = "D", axis = [0, 0, 1] }"#,
    },
    Explanation {
        code: Code::DrivenCut,
        file: File::FourBar,
        text: "A driven joint must be cut. A driver prescribes a coordinate of the tree, and a cut joint has none: \
               open the loop at another of its joints.",
        wrong: r#"[points]
C = ["300 mm", "200 mm", 0]

[joints]
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "2*pi*1 Hz*t", cut = true }"#,
        right: r#"[points]
C = ["300 mm", "200 mm", 0]

[joints]
R3 = { revolute = ["coupler", "rocker"], at = "C", axis = [0, 0, 1], cut = true }"#,
    },
    Explanation {
        code: Code::StartOnCut,
        file: File::FourBar,
        text: "A start value of a joint that is cut: its angle follows from the others. Give start values to the \
               other joints of the loop.",
        wrong: r#"[assembly]
R3 = "40 deg""#,
        right: r#"[assembly]
R4 = "10 deg""#,
    },
    Explanation {
        code: Code::CoupledCut,
        file: File::FourBar,
        text: "A joint in a coupling must be cut. Across a cut an angle is known up to whole turns only, and a coupling counts \
               turns. Open the loop at a joint that is in no coupling.",
        wrong: r#"[bodies]
disc = { mass = "1 kg", centre = "O", inertia = ["1e-3 kg m^2", "1e-3 kg m^2", "1e-3 kg m^2"] }
[joints]
RD = { revolute = ["ground", "disc"], at = "O", axis = [0, 0, 1] }
[couplings]
follow = { relation = { RD = 1, R3 = 2 } }"#,
        right: r#"[bodies]
disc = { mass = "1 kg", centre = "O", inertia = ["1e-3 kg m^2", "1e-3 kg m^2", "1e-3 kg m^2"] }
[joints]
RD = { revolute = ["ground", "disc"], at = "O", axis = [0, 0, 1] }
[couplings]
follow = { relation = { RD = 1, R4 = 2 } }"#,
    },
];
