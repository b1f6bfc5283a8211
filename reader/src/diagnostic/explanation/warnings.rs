//! Warnings.

use super::example::{Explanation, File};
use crate::diagnostic::Code;

pub const WARNINGS: &[Explanation] = &[
    Explanation {
        code: Code::NoGravity,
        file: File::Swing,
        text: "The file does not mention gravity, so there is none. In a plane that lies flat, or for bare \
               kinematics, that is right: say it by zeros.",
        wrong: "# gravity = [0, 0, 0]",
        right: "gravity = [0, 0, 0]",
    },
    Explanation {
        code: Code::LooksLikeDegrees,
        file: File::Swing,
        text: "A bare number that is read as radians and is far more than a turn. Write the unit.",
        wrong: r#"[initial]
hinge = -48"#,
        right: r#"[initial]
hinge = "-48 deg""#,
    },
    Explanation {
        code: Code::UnitShadowsName,
        file: File::Swing,
        text: "A unit behind a number is also a name in this file. The unit wins; a bracket or a `*` makes it the \
               name.",
        wrong: r#"[parameters]
s = "0.2 s"
length = "1 s*5 m/s""#,
        right: r#"[parameters]
duration = "0.2 s"
length = "1 s*5 m/s""#,
    },
    Explanation {
        code: Code::UnusedParameter,
        file: File::Swing,
        text: "A parameter that nothing uses: perhaps another one is meant where it should stand.",
        wrong: r#"[parameters]
radius = "10 mm""#,
        right: r#"[parameters]
radius = "10 mm"

[bodies]
bar = { rod = ["O", "A"], radius = "radius", density = "7850 kg/m^3" }"#,
    },
    Explanation {
        code: Code::SpringWithoutDirection,
        file: File::Swing,
        text: "A spring whose ends lie on one another at the reference pose pulls in no direction there. Give it \
               two places, or take a bushing.",
        wrong: r#"[points]
E = { at = ["1 m", 0, 0], on = "ground" }

[forces]
coil = { spring = ["ground", "bar"], at = ["E", "A"], stiffness = "1 N/m", length = 0 }

[initial]
hinge = "-30 deg""#,
        right: r#"[points]
E = { at = ["1 m", "0.5 m", 0], on = "ground" }

[forces]
coil = { spring = ["ground", "bar"], at = ["E", "A"], stiffness = "1 N/m", length = 0 }

[initial]
hinge = "-30 deg""#,
    },
    Explanation {
        code: Code::FrequencyAsSpeed,
        file: File::Swing,
        text: "A frequency in Hz or rpm where an angular speed is needed. They are turns per unit of time: an \
               angular speed has 2 pi in it.",
        wrong: r#"[initial]
hinge = { q = 0, v = "60 rpm" }"#,
        right: r#"[initial]
hinge = { q = 0, v = "2*pi*60 rpm" }"#,
    },
    Explanation {
        code: Code::RigidPart,
        file: File::FourBar,
        text: "Joints that never move although others do: a part of the mechanism is a frame, at least in the \
               position it starts in.",
        wrong: r#"[points]
E = [0, "-100 mm", 0]
H = ["100 mm", "-100 mm", 0]

[bodies]
left = { rod = ["E", "H"], radius = "6 mm", density = "steel" }
right = { rod = ["O", "H"], radius = "6 mm", density = "steel" }

[joints]
T1 = { revolute = ["ground", "left"], at = "E", axis = [0, 0, 1] }
T2 = { revolute = ["left", "right"], at = "H", axis = [0, 0, 1] }
T3 = { revolute = ["ground", "right"], at = "O", axis = [0, 0, 1] }"#,
        right: r#"[points]
E = [0, "-100 mm", 0]
H = ["100 mm", "-100 mm", 0]

[bodies]
left = { rod = ["E", "H"], radius = "6 mm", density = "steel" }

[joints]
T1 = { fixed = ["ground", "left"], at = "E" }"#,
    },
    Explanation {
        code: Code::NearResonance,
        file: File::Swing,
        text: "A harmonic of a drive lies near a frequency of a flexible body: small errors of either change the \
               vibration much. Change the speed or the section, or allow the warning if it is meant.",
        wrong: r#"[points]
A = ["0.42 m", 0, 0]

[bodies]
bar = { rod = ["O", "A"], radius = "6 mm", density = "7850 kg/m^3", flexible = { modes = 2, young = "210 GPa" } }

[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], drive = "2*pi*10 Hz*t" }"#,
        right: r#"[points]
A = ["0.42 m", 0, 0]

[bodies]
bar = { rod = ["O", "A"], radius = "6 mm", density = "7850 kg/m^3", flexible = { modes = 2, young = "210 GPa" } }

[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], drive = "2*pi*9 Hz*t" }"#,
    },
    Explanation {
        code: Code::ContactNearMode,
        file: File::Swing,
        text: "The journal of a joint with clearance, pressed by the load at rest, vibrates near a frequency of a \
               flexible body, so that contact and link excite each other. Another stiffness, mass or clearance \
               moves it.",
        wrong: r#"[points]
A = ["0.42 m", 0, 0]

[bodies]
bar = { rod = ["O", "A"], radius = "6 mm", density = "7850 kg/m^3", flexible = { modes = 2, young = "210 GPa", held = "pinned" } }

[clearance.hinge]
radial = "10 um"
journal_radius = "10 mm"
length = "20 mm"
modulus = "115 GPa"
restitution = 0.9"#,
        right: r#"[points]
A = ["0.42 m", 0, 0]

[bodies]
bar = { rod = ["O", "A"], radius = "9 mm", density = "7850 kg/m^3", flexible = { modes = 2, young = "210 GPa", held = "pinned" } }

[clearance.hinge]
radial = "10 um"
journal_radius = "10 mm"
length = "20 mm"
modulus = "115 GPa"
restitution = 0.9"#,
    },
    Explanation {
        code: Code::MovesByClearance,
        file: File::FourBar,
        text: "A linkage that moves only thanks to its clearances: with ideal joints it would be locked, or its \
               drivers would contradict each other. Forces then depend on the clearances alone.",
        wrong: r#"[points]
A = [0, "100 mm", 0]
C = ["300 mm", "100 mm", 0]
E = ["150 mm", 0, 0]
H = ["150 mm", "100.05 mm", 0]

[bodies]
third = { rod = ["E", "H"], radius = "6 mm", density = "steel" }

[joints]
R5 = { revolute = ["ground", "third"], at = "E", axis = [0, 0, 1] }
R6 = { revolute = ["coupler", "third"], at = "H", axis = [0, 0, 1] }
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "20 deg*sin(2*pi*1 Hz*t)" }

[clearance.R6]
radial = "0.1 mm"
journal_radius = "5 mm"
length = "10 mm"
modulus = "100 GPa"
restitution = 0.9"#,
        right: r#"[points]
A = [0, "100 mm", 0]
C = ["300 mm", "100 mm", 0]

[joints]
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "20 deg*sin(2*pi*1 Hz*t)" }"#,
    },
];

pub const PLAUSIBILITY: &[Explanation] = &[
    Explanation {
        code: Code::TurnsAsAngle,
        file: File::Press,
        text: "A rate in Hz or rpm becomes an angle without 2 pi, so that a turn takes 6.28 times as long as the \
               number says.",
        wrong: r#"[joints]
shaft = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "speed*t" }"#,
        right: r#"[joints]
shaft = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "2*pi*speed*t" }"#,
    },
    Explanation {
        code: Code::SizesApart,
        file: File::Press,
        text: "A body far longer, shorter or thicker than the others: often m for mm.",
        wrong: r#"[bodies]
rod = { rod = ["A", "P"], radius = "8 m", density = "7850 kg/m^3" }"#,
        right: r#"[bodies]
rod = { rod = ["A", "P"], radius = "8 mm", density = "7850 kg/m^3" }"#,
    },
    Explanation {
        code: Code::OddMaterial,
        file: File::Press,
        text: "A density, modulus, hardness, wear coefficient, coefficient of friction or damping ratio that no material has: often MPa for GPa, or \
               g/cm^3 without its unit. `docs/choosing-values.md` has usual values with their sources.",
        wrong: r#"[wear.pin]
hardness = "3.5 kPa""#,
        right: r#"[wear.pin]
hardness = "3.5 GPa""#,
    },
    Explanation {
        code: Code::OddBearing,
        file: File::Press,
        text: "A radial clearance above a tenth of the journal's radius, or a wear threshold above a quarter of it: \
               contact laws and Archard's law are not meant for that.",
        wrong: r#"[clearance.pin]
radial = "2.5 mm""#,
        right: r#"[clearance.pin]
radial = "25 um""#,
    },
    Explanation {
        code: Code::LooseBody,
        file: File::Press,
        text: "A driven mechanism has a freedom that no driver, spring, damper, force or start value takes care of: \
               perhaps a joint is missing. If a body is really to swing freely, allow the warning.",
        wrong: r#"[points]
E = ["240 mm", 0, 0]

[bodies]
flap = { rod = ["P", "E"], radius = "8 mm", density = "7850 kg/m^3" }

[joints]
hook = { revolute = ["ram", "flap"], at = "P", axis = [0, 0, 1] }"#,
        right: r#"[points]
E = ["240 mm", 0, 0]

[bodies]
flap = { rod = ["P", "E"], radius = "8 mm", density = "7850 kg/m^3" }

[joints]
hook = { fixed = ["ram", "flap"], at = "P" }"#,
    },
    Explanation {
        code: Code::NoFullTurn,
        file: File::Press,
        text: "Drivers that the loops do not let go on: a crank longer than its rod cannot turn once round, a \
               stroke can be longer than a linkage reaches. The message says when and where the motion ends, or where laws jump so \
               that it could not be followed.",
        wrong: r#"[points]
A = ["130 mm", 0, 0]
P = ["200 mm", 0, 0]"#,
        right: r#"[points]
A = ["40 mm", 0, 0]
P = ["200 mm", 0, 0]"#,
    },
    Explanation {
        code: Code::PassesSingular,
        file: File::FourBar,
        text: "A driven motion passes a singular position of its loops, where it could go on in two ways: a \
               parallelogram that lies down flat may turn over. A run goes on smoothly; a real linkage may not.",
        wrong: r#"[points]
A = [0, "100 mm", 0]
C = ["300 mm", "100 mm", 0]
D = ["300 mm", 0, 0]"#,
        right: r#"[points]
A = [0, "100 mm", 0]
C = ["300 mm", "100 mm", 0]
D = ["300 mm", 0, 0]

[joints]
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "20 deg*sin(2*pi*1 Hz*t)" }"#,
    },
    Explanation {
        code: Code::AngleJumps,
        file: File::FourBar,
        text: "A force uses the angle of a joint that closes a loop, which is known only up to whole turns, and \
               that angle passes half a turn on the way: the force would jump. Open the loop at another joint.",
        wrong: r#"[points]
C = ["200 mm", "282.8427 mm", 0]

[joints]
R2 = { revolute = ["crank", "coupler"], at = "A", axis = [0, 0, 1], spring = { stiffness = "2 N m/rad" }, cut = true }"#,
        right: r#"[points]
C = ["200 mm", "282.8427 mm", 0]

[joints]
R2 = { revolute = ["crank", "coupler"], at = "A", axis = [0, 0, 1], spring = { stiffness = "2 N m/rad" } }
R3 = { revolute = ["coupler", "rocker"], at = "C", axis = [0, 0, 1], cut = true }"#,
    },
    Explanation {
        code: Code::MassesApart,
        file: File::Swing,
        text: "A body far heavier than the others, or a gravity that nothing has: often a wrong power of ten.",
        wrong: r#"gravity = [0, "-9.81e9 m/s^2", 0]"#,
        right: r#"gravity = [0, "-9.81 m/s^2", 0]"#,
    },
    Explanation {
        code: Code::UnplacedPoint,
        file: File::Swing,
        text: "A point that nothing says which body carries: it rests. `on` says where it belongs.",
        wrong: r#"[points]
tip = ["1.2 m", 0, 0]"#,
        right: r#"[points]
tip = { at = ["1.2 m", 0, 0], on = "bar" }"#,
    },
    Explanation {
        code: Code::FrictionNotUnique,
        file: File::Swing,
        text: "Dry friction follows the force in its joint, and redundant constraints leave that force undetermined: two hinges on \
               one axis share a load in any proportion. One joint with `length` between its bearings stands for both. In a plane \
               mechanism forces out of its plane are left unsaid: they are zero without loads there.",
        wrong: r#"[points]
P = [0, 0, "0.5 m"]

[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], dry_friction = { coefficient = 0.1, radius = "10 mm" } }
second = { revolute = ["ground", "bar"], at = "P", axis = [0, 0, 1] }"#,
        right: r#"[points]
P = [0, 0, "0.25 m"]

[joints]
hinge = { revolute = ["ground", "bar"], at = "P", axis = [0, 0, 1], dry_friction = { coefficient = 0.1, radius = "10 mm", length = "0.5 m" } }"#,
    },
    Explanation {
        code: Code::HeldElsewhere,
        file: File::Swing,
        text: "A spring, a force or another element holds a point on a body that does not have it, where others do: points that \
               are swapped, or a wrong name. The element acts where the point is drawn, on the body that it names. Where that is \
               meant, `on` says so.",
        wrong: r#"[points]
P = { at = ["1 m", "-0.5 m", 0], on = "ground" }

[forces]
coil = { spring = ["ground", "bar"], at = ["A", "P"], stiffness = "2 kN/m", length = "500 mm" }"#,
        right: r#"[points]
P = { at = ["1 m", "-0.5 m", 0], on = "ground" }

[forces]
coil = { spring = ["ground", "bar"], at = ["P", "A"], stiffness = "2 kN/m", length = "500 mm" }"#,
    },
    Explanation {
        code: Code::TooFast,
        file: File::Swing,
        text: "A drive or a start value turns a body so fast that its end moves with more than 4 km/s, or slides with more \
               than 20 km/s. The strongest fibres burst at 2 km/s: a unit or an exponent is wrong.",
        wrong: r#"[initial]
hinge = { v = "2*pi*6e9 rpm" }"#,
        right: r#"[initial]
hinge = { v = "2*pi*600 rpm" }"#,
    },
    Explanation {
        code: Code::UnequalCycles,
        file: File::Press,
        text: "A life goes cycle by cycle, all joints together. Where a cycle stands for a million revolutions at one joint and \
               for one at another, the other has hardly worn when the first fails, and the life has no hours. The key is \
               written once for each joint; without it a cycle is one revolution.",
        wrong: r#"[wear.pin]
revolutions_per_cycle = 1e6

[clearance.wrist]
radial = "25 um"
journal_radius = "12 mm"
length = "20 mm"
modulus = "115 GPa"

[wear.wrist]
coefficient = 1e-8
hardness = "3.5 GPa"
threshold = "80 um""#,
        right: r#"[wear.pin]
revolutions_per_cycle = 1e6

[clearance.wrist]
radial = "25 um"
journal_radius = "12 mm"
length = "20 mm"
modulus = "115 GPa"

[wear.wrist]
coefficient = 1e-8
hardness = "3.5 GPa"
threshold = "80 um"
revolutions_per_cycle = 1e6"#,
    },
    Explanation {
        code: Code::NegativeStiffness,
        file: File::Swing,
        text: "A spring with a stiffness below zero pushes away from where it is unloaded, the more the further. A mechanism that \
               snaps over can be drawn so, and `allow` in [check] then says that it is meant; else a sign is wrong, and the \
               motion runs away. All other stiffnesses are at least zero (E0403).",
        wrong: r#"[points]
P = { at = ["1 m", "-0.5 m", 0], on = "ground" }

[forces]
coil = { spring = ["ground", "bar"], at = ["P", "A"], stiffness = "-2 kN/m", length = "500 mm" }"#,
        right: r#"[points]
P = { at = ["1 m", "-0.5 m", 0], on = "ground" }

[forces]
coil = { spring = ["ground", "bar"], at = ["P", "A"], stiffness = "2 kN/m", length = "500 mm" }"#,
    },
];
