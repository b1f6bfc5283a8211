//! E04: mechanics.

use super::example::{Explanation, File};
use crate::diagnostic::Code;

pub const MECHANICS: &[Explanation] = &[
    Explanation {
        code: Code::ZeroAxis,
        file: File::Swing,
        text: "An axis without a direction. Its length does not matter, but one of its numbers must not be zero.",
        wrong: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 0] }"#,
        right: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1] }"#,
    },
    Explanation {
        code: Code::ParallelAxes,
        file: File::Swing,
        text: "Two axes that are parallel but must not be: a universal joint would lose a freedom, the edge of a \
               box would have no direction across it.",
        wrong: r#"[bodies]
bar = { box = ["O", "A"], width = ["5 mm", "20 mm"], width_axis = [1, 0, 0], density = "7850 kg/m^3" }"#,
        right: r#"[bodies]
bar = { box = ["O", "A"], width = ["5 mm", "20 mm"], width_axis = [0, 0, 1], density = "7850 kg/m^3" }"#,
    },
    Explanation {
        code: Code::NotPositive,
        file: File::Swing,
        text: "A mass, radius, length, density or damping that is not positive, or a tube whose bore is as large as \
               itself.",
        wrong: r#"[bodies]
bar = { tube = ["O", "A"], radius = "10 mm", inner_radius = "12 mm", density = "7850 kg/m^3" }"#,
        right: r#"[bodies]
bar = { tube = ["O", "A"], radius = "12 mm", inner_radius = "10 mm", density = "7850 kg/m^3" }"#,
    },
    Explanation {
        code: Code::ImpossibleInertia,
        file: File::Swing,
        text: "An inertia that no body can have: each principal moment is at most the sum of the other two. Often a \
               matrix entry of the wrong sign, or moments about another point than the centre of mass.",
        wrong: r#"[bodies]
bar = { mass = "1 kg", centre = "A", inertia = ["1e-3 kg m^2", "1e-3 kg m^2", "5e-3 kg m^2"] }"#,
        right: r#"[bodies]
bar = { mass = "1 kg", centre = "A", inertia = ["1e-3 kg m^2", "1e-3 kg m^2", "2e-3 kg m^2"] }"#,
    },
    Explanation {
        code: Code::ZeroLength,
        file: File::Swing,
        text: "Two points that must be apart lie on one another: a rod without length has no direction.",
        wrong: r#"[bodies]
bar = { rod = ["O", "O"], radius = "10 mm", density = "7850 kg/m^3" }"#,
        right: r#"[bodies]
bar = { rod = ["O", "A"], radius = "10 mm", density = "7850 kg/m^3" }"#,
    },
    Explanation {
        code: Code::ZeroLead,
        file: File::Swing,
        text: "A screw joint that does not advance is a revolute joint: say so, or give the advance of a turn.",
        wrong: r#"[joints]
hinge = { screw = ["ground", "bar"], at = "O", axis = [0, 0, 1], lead = 0 }"#,
        right: r#"[joints]
hinge = { screw = ["ground", "bar"], at = "O", axis = [0, 0, 1], lead = "5 mm" }"#,
    },
    Explanation {
        code: Code::SameBody,
        file: File::Swing,
        text: "A joint or force between a body and itself holds and pushes nothing.",
        wrong: r#"[joints]
hinge = { revolute = ["bar", "bar"], at = "O", axis = [0, 0, 1] }"#,
        right: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1] }"#,
    },
    Explanation {
        code: Code::PointNotOnBody,
        file: File::FourBar,
        text: "A point that has a position for each of some bodies is used by another body, where nobody knows \
               where it is.",
        wrong: r#"[joints]
R4 = { revolute = ["ground", "rocker"], at = "C", axis = [0, 0, 1] }"#,
        right: r#"[joints]
R4 = { revolute = ["ground", "rocker"], at = "D", axis = [0, 0, 1] }"#,
    },
    Explanation {
        code: Code::NoSuchCoordinate,
        file: File::Swing,
        text: "A coordinate that this kind of joint does not have, or one value for a joint that takes one for each \
               of its coordinates by name.",
        wrong: r#"[joints]
hinge = { cylindrical = ["ground", "bar"], at = "O", axis = [0, 0, 1], damping = { q3 = "1 N s/m" } }"#,
        right: r#"[joints]
hinge = { cylindrical = ["ground", "bar"], at = "O", axis = [0, 0, 1], damping = { q2 = "1 N s/m" } }"#,
    },
    Explanation {
        code: Code::BadStart,
        file: File::FourBar,
        text: "A start value that the joint cannot take: the motion of a driven joint says already where it starts, \
               a fixed one has no coordinate, and a coordinate starts only once.",
        wrong: r#"[initial]
R1 = "30 deg""#,
        right: r#"[joints]
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 0, 1], drive = "30 deg + 2*pi*1 Hz*t" }"#,
    },
    Explanation {
        code: Code::NotPerpendicular,
        file: File::Swing,
        text: "Axes that are not at right angles but must be: principal axes of inertia, the axes of a section.",
        wrong: r#"[bodies]
bar = { mass = "1 kg", centre = "A", inertia = ["1e-3 kg m^2", "1e-3 kg m^2", "1e-3 kg m^2"], axes = [[1, 0, 0], [1, 1, 0]] }"#,
        right: r#"[bodies]
bar = { mass = "1 kg", centre = "A", inertia = ["1e-3 kg m^2", "1e-3 kg m^2", "1e-3 kg m^2"], axes = [[1, 0, 0], [0, 1, 0]] }"#,
    },
    Explanation {
        code: Code::BadModalData,
        file: File::Swing,
        text: "Modal data that cannot be read or do not fit together. The file lies in the folder of the mechanism \
               or below it; `docs/modal-data.md` has its form. Beams need no data.",
        wrong: r#"[bodies]
bar = { rod = ["O", "A"], radius = "10 mm", density = "7850 kg/m^3", flexible = { data = "nowhere.toml", origin = "O" } }"#,
        right: r#"[bodies]
bar = { rod = ["O", "A"], radius = "10 mm", density = "7850 kg/m^3", flexible = { modes = 2, young = "210 GPa" } }"#,
    },
    Explanation {
        code: Code::BadModes,
        file: File::Swing,
        text: "Modes that the link cannot have: a count that is no whole number or too large, a body without the \
               shape of a beam, a first or second order of another number.",
        wrong: r#"[bodies]
bar = { rod = ["O", "A"], radius = "10 mm", density = "7850 kg/m^3", flexible = { modes = 2.5, young = "210 GPa" } }"#,
        right: r#"[bodies]
bar = { rod = ["O", "A"], radius = "10 mm", density = "7850 kg/m^3", flexible = { modes = 2, young = "210 GPa" } }"#,
    },
    Explanation {
        code: Code::NoNodeHere,
        file: File::Swing,
        text: "A joint or force attaches to a flexible body where its modal data have no node, so nobody knows \
               how it moves there. Attach it to a node (here they are at 0, 0.5 and 1 m along the rod), or \
               have the data written with one there.",
        wrong: r#"[bodies]
bar = { rod = ["O", "A"], radius = "9 mm", mass = "2 kg", flexible = { data = "rod_of_two_masses.toml", origin = "O" } }

[parameters]
length = "1.2 m""#,
        right: r#"[bodies]
bar = { rod = ["O", "A"], radius = "9 mm", mass = "2 kg", flexible = { data = "rod_of_two_masses.toml", origin = "O" } }"#,
    },
    Explanation {
        code: Code::BadClearance,
        file: File::Press,
        text: "Clearance or wear that a joint cannot have. `radial` is the difference of two radii, so it is small \
               beside the journal's; only revolute, prismatic, cylindrical, universal and spherical joints can have \
               play, and no spherical one with a `drive` of three angles; only a journal in a bearing can tilt in it, and it has two ends to touch with; only a joint with \
               play can wear.",
        wrong: r#"[clearance.pin]
radial = "12.025 mm""#,
        right: r#"[clearance.pin]
radial = "25 um""#,
    },
    Explanation {
        code: Code::BadMission,
        file: File::Press,
        text: "A mission that a machine cannot have: no segments, shares of the operating time that do not come to 1, a \
               parameter that is fixed at generation, factors on friction or wear that are not there, a series that \
               cannot be read, or a mission where nothing wears. `docs/missions.md` has an example.",
        wrong: r#"[missions.day.segments]
press = { share = 0.5 }
idle = { share = 0.3 }"#,
        right: r#"[missions.day.segments]
press = { share = 0.5 }
idle = { share = "rest" }"#,
    },
    Explanation {
        code: Code::BadCoupling,
        file: File::Swing,
        text: "A coupling whose wheels do not fit together: tooth numbers that are not whole, axes that are not as its kind \
               needs them, a centre distance that module and teeth do not have, wheels whose axes no body carries. Signs and \
               radii follow from the drawing, so the drawing must be right. `docs/couplings.md` has every kind.",
        wrong: r#"spec = 1
name = "gears"
gravity = [0, 0, 0]

[points]
A = [0, 0, 0]
B = ["80 mm", 0, 0]

[bodies]
pinion = { mass = "0.2 kg", centre = "A", inertia = ["1e-4 kg m^2", "1e-4 kg m^2", "1e-4 kg m^2"] }
wheel = { mass = "1 kg", centre = "B", inertia = ["1e-3 kg m^2", "1e-3 kg m^2", "1e-3 kg m^2"] }

[joints]
R1 = { revolute = ["ground", "pinion"], at = "A", axis = [0, 0, 1] }
R2 = { revolute = ["ground", "wheel"], at = "B", axis = [0, 0, 1] }

[couplings]
mesh = { gears = ["pinion", "wheel"], teeth = [20, 60], module = "2.5 mm" }"#,
        right: r#"spec = 1
name = "gears"
gravity = [0, 0, 0]

[points]
A = [0, 0, 0]
B = ["80 mm", 0, 0]

[bodies]
pinion = { mass = "0.2 kg", centre = "A", inertia = ["1e-4 kg m^2", "1e-4 kg m^2", "1e-4 kg m^2"] }
wheel = { mass = "1 kg", centre = "B", inertia = ["1e-3 kg m^2", "1e-3 kg m^2", "1e-3 kg m^2"] }

[joints]
R1 = { revolute = ["ground", "pinion"], at = "A", axis = [0, 0, 1] }
R2 = { revolute = ["ground", "wheel"], at = "B", axis = [0, 0, 1] }

[couplings]
mesh = { gears = ["pinion", "wheel"], teeth = [20, 60], module = "2 mm" }"#,
    },
    Explanation {
        code: Code::BadStop,
        file: File::Swing,
        text: "An end stop that cannot be: limits that leave nothing free between them, a start beyond a limit, a restitution \
               that its law does not have, an angle of a joint that is cut. `docs/stops-and-compliance.md` has the laws.",
        wrong: r#"[stops]
bump = { joint = "hinge", lower = "30 deg", upper = "-30 deg", stiffness = "1e4 N m/rad" }"#,
        right: r#"[stops]
bump = { joint = "hinge", lower = "-30 deg", upper = "30 deg", stiffness = "1e4 N m/rad" }"#,
    },
    Explanation {
        code: Code::BadMatrix,
        file: File::Swing,
        text: "A stiffness or damping matrix of a bushing that is not symmetric, or that would give energy: an eigenvalue is \
               below zero. The order is displacements along x, y, z, then rotations about them, along the bushing's axes.",
        wrong: r#"[forces.mount]
bushing = ["ground", "bar"]
at = "O"
stiffness_matrix = [
  ["8e5 N/m", 0, 0, 0, 0, 0],
  [0, "8e5 N/m", 0, 0, 0, "9 kN"],
  [0, 0, "3e5 N/m", 0, 0, 0],
  [0, 0, 0, "20 N m/rad", 0, 0],
  [0, 0, 0, 0, "20 N m/rad", 0],
  [0, "9 kN", 0, 0, 0, "50 N m/rad"],
]"#,
        right: r#"[forces.mount]
bushing = ["ground", "bar"]
at = "O"
stiffness_matrix = [
  ["8e5 N/m", 0, 0, 0, 0, 0],
  [0, "8e5 N/m", 0, 0, 0, "2 kN"],
  [0, 0, "3e5 N/m", 0, 0, 0],
  [0, 0, 0, "20 N m/rad", 0, 0],
  [0, 0, 0, 0, "20 N m/rad", 0],
  [0, "2 kN", 0, 0, 0, "50 N m/rad"],
]"#,
    },
    Explanation {
        code: Code::BadController,
        file: File::Swing,
        text: "A controller that cannot act as it is written: limits that leave nothing between them, no time from sample to \
               sample, an integral that gives way within less than a sample, controllers that ask for each other. \
               `docs/controllers.md` has the laws.",
        wrong: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], force = "motor" }
[controllers]
motor = { measured = "hinge.q", setpoint = "30 deg", proportional = "40 N m/rad", lower = "10 N m", upper = "-10 N m", sample_time = "1 ms" }"#,
        right: r#"[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], force = "motor" }
[controllers]
motor = { measured = "hinge.q", setpoint = "30 deg", proportional = "40 N m/rad", lower = "-10 N m", upper = "10 N m", sample_time = "1 ms" }"#,
    },
];
