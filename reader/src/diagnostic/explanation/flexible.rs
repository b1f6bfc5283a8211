//! Explanations of warnings about flexible links and modal data.

use super::example::{Explanation, File};
use crate::diagnostic::Code;

pub const FLEXIBLE: &[Explanation] = &[
    Explanation {
        code: Code::HeldAsFree,
        file: File::Swing,
        text: "A weld, a guide, a drive, or a pin across which the weight bends the link, keeps a section from turning, and \
               the shapes of the link leave it free to. Many modes are needed then for the moment there: a cantilever with \
               two pinned modes in each plane sags three quarters of what it should. Without `held` such an end is clamped.",
        wrong: r#"[bodies]
bar = { rod = ["O", "A"], radius = "10 mm", density = "7850 kg/m^3", flexible = { modes = 4, young = "210 GPa", held = "pinned" } }

[joints]
hinge = { prismatic = ["ground", "bar"], at = "O", axis = [0, 1, 0] }"#,
        right: r#"[bodies]
bar = { rod = ["O", "A"], radius = "10 mm", density = "7850 kg/m^3", flexible = { modes = 4, young = "210 GPa" } }

[joints]
hinge = { prismatic = ["ground", "bar"], at = "O", axis = [0, 1, 0] }"#,
    },
    Explanation {
        code: Code::FastForOrder1,
        file: File::Swing,
        text: "A link whose shapes are linear (`order = 1`) does not know that it is pulled straight by turning: it seems softer than it \
               is, by the square of its turns per second over its first frequency. It bends by 10 % too much from a third of that \
               frequency on, and without bounds above it. `order = 2` knows.",
        wrong: r#"[bodies]
bar = { rod = ["O", "A"], radius = "10 mm", density = "7850 kg/m^3", flexible = { modes = 4, young = "210 GPa" } }

[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], drive = "2*pi*9.5 Hz*t" }"#,
        right: r#"[bodies]
bar = { rod = ["O", "A"], radius = "10 mm", density = "7850 kg/m^3", flexible = { modes = 4, young = "210 GPa", order = 2 } }

[joints]
hinge = { revolute = ["ground", "bar"], at = "O", axis = [0, 0, 1], drive = "2*pi*9.5 Hz*t" }"#,
    },
    Explanation {
        code: Code::ModalMass,
        file: File::Swing,
        text: "The mass of two modes is the trace of their coupling, the integral of the product of their shapes. Both stand in modal data, and \
               these contradict each other by more than lumped masses do: one of them was left out, scaled or written in other axes. \
               `mass_matrix` counts in the accelerations of the modes, `coupling` in everything else.",
        wrong: r#"[bodies]
bar = { rod = ["O", "A"], radius = "9 mm", mass = "2 kg", flexible = { data = "rod_of_other_mass.toml", origin = "O" } }"#,
        right: r#"[bodies]
bar = { rod = ["O", "A"], radius = "9 mm", mass = "2 kg", flexible = { data = "rod_of_two_masses.toml", origin = "O" } }"#,
    },
];
