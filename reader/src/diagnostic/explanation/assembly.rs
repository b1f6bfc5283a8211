//! E06: assembly and rank.

use super::example::{Explanation, File};
use crate::diagnostic::Code;

pub const ASSEMBLY: &[Explanation] = &[
    Explanation {
        code: Code::LoopDoesNotClose,
        file: File::FourBar,
        text: "A loop that cannot be closed from the given start: a link is too short to reach, the driver starts \
               where the linkage cannot be, or a crooked axis or too few digits let it open along its motion. The \
               message says by how much, and in which direction.",
        wrong: r#"[points]
C = { coupler = ["150 mm", 0, 0], rocker = ["350 mm", 0, 0] }"#,
        right: r#"[points]
C = { coupler = ["300 mm", "200 mm", 0], rocker = ["300 mm", "250 mm", 0] }"#,
    },
    Explanation {
        code: Code::Locked,
        file: File::Swing,
        text: "Three bars that are pinned to a triangle are a frame. Take a joint away, or put one in that \
               gives way. Links that are stretched to their limit cannot move either: lengthen one.",
        wrong: r#"[points]
D = [0, "1 m", 0]

[bodies]
stay = { rod = ["D", "A"], radius = "10 mm", density = "7850 kg/m^3" }

[joints]
elbow = { revolute = ["bar", "stay"], at = "A", axis = [0, 0, 1] }
wall = { revolute = ["ground", "stay"], at = "D", axis = [0, 0, 1] }"#,
        right: r#"[points]
D = [0, "1 m", 0]

[bodies]
stay = { rod = ["D", "A"], radius = "10 mm", density = "7850 kg/m^3" }

[joints]
elbow = { revolute = ["bar", "stay"], at = "A", axis = [0, 0, 1] }"#,
    },
    Explanation {
        code: Code::DriverOnDependentCoordinate,
        file: File::FourBar,
        text: "A driver on a coordinate that the loops hold, or that only has play to drive: it would have to bend \
               the links. Drive a joint that can move.",
        wrong: r#"[points]
E = [0, "-100 mm", 0]
H = ["100 mm", "-100 mm", 0]

[bodies]
left = { rod = ["E", "H"], radius = "6 mm", density = "steel" }
right = { rod = ["O", "H"], radius = "6 mm", density = "steel" }

[joints]
T1 = { revolute = ["ground", "left"], at = "E", axis = [0, 0, 1], drive = "1 rad/s*t" }
T2 = { revolute = ["left", "right"], at = "H", axis = [0, 0, 1] }
T3 = { revolute = ["ground", "right"], at = "O", axis = [0, 0, 1] }"#,
        right: r#"[points]
E = [0, "-100 mm", 0]
H = ["100 mm", "-100 mm", 0]

[bodies]
left = { rod = ["E", "H"], radius = "6 mm", density = "steel" }

[joints]
T1 = { revolute = ["ground", "left"], at = "E", axis = [0, 0, 1], drive = "1 rad/s*t" }"#,
    },
    Explanation {
        code: Code::DriversInConflict,
        file: File::FourBar,
        text: "Drivers that the loops couple: each of them alone says how the mechanism moves, together they \
               contradict each other. Keep as many drivers as there are freedoms; `check` says how many.",
        wrong: r#"[joints]
R4 = { revolute = ["ground", "rocker"], at = "D", axis = [0, 0, 1], drive = "20 deg*sin(2*pi*1 Hz*t)" }"#,
        right: r#"[joints]
R4 = { revolute = ["ground", "rocker"], at = "D", axis = [0, 0, 1] }"#,
    },
    Explanation {
        code: Code::StartImpossible,
        file: File::FourBar,
        text: "Start values in `[initial]` are met exactly, and these cannot be met together with the loops and the \
               drivers. Give as many as there are freedoms left; a mere guess goes into `[assembly]`.",
        wrong: r#"[initial]
R4 = "-20 deg""#,
        right: r#"[assembly]
R4 = "10 deg""#,
    },
    Explanation {
        code: Code::StartNotFinite,
        file: File::FourBar,
        text: "A prescribed motion, a start value or a residual is not finite at t = 0. The root of the time, for \
               instance, sets out with infinite speed. Let a motion begin smoothly.",
        wrong: r#"[joints]
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "sqrt(t/(1 s))" }"#,
        right: r#"[joints]
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "t^2/(1 s^2)" }"#,
    },
    Explanation {
        code: Code::MasslessFreedom,
        file: File::Swing,
        text: "A freedom that moves no mass: its acceleration would be infinite. A point mass on a ball joint can \
               spin without inertia. Give the body an inertia, or take the freedom away.",
        wrong: r#"[bodies]
bob = { mass = "1 kg", centre = "A" }

[joints]
ball = { spherical = ["bar", "bob"], at = "A" }"#,
        right: r#"[bodies]
bob = { mass = "1 kg", centre = "A", inertia = ["1e-3 kg m^2", "1e-3 kg m^2", "1e-3 kg m^2"] }

[joints]
ball = { spherical = ["bar", "bob"], at = "A" }"#,
    },
    Explanation {
        code: Code::SingularStart,
        file: File::FourBar,
        text: "A start in a singular position: links in line that could go on in two ways, or a driver at its dead \
               point. Start a degree beside it.",
        wrong: r#"[points]
A = ["100 mm", 0, 0]
C = ["400 mm", 0, 0]
D = ["300 mm", 0, 0]"#,
        right: r#"[points]
A = ["70.710678 mm", "70.710678 mm", 0]
C = ["370.710678 mm", "70.710678 mm", 0]
D = ["300 mm", 0, 0]

[joints]
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "20 deg*sin(2*pi*1 Hz*t)" }"#,
    },
];
