//! Energy of mechanisms with several flexible links, held in every way: what goes in and out of strain, motion and weight
//! must balance, or a term is missing somewhere.

mod support;

use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{Integrator, Settings, Span};
use support::{compile_source, run_with};

fn drift(name: &str, text: &str, time: f64) -> f64 {
    let source = SourceFile { name: format!("{name}.toml"), text: text.into() };
    let compiled = compile_source(&source, &[], None);
    let integrator = Integrator::Dopri5 { tolerance: 1e-10, max_step: None };
    let run = run_with(&compiled, &Settings::new(integrator, Span::Time(time), 3));
    let numbers = &run.run.statistics;
    (numbers.energy_error_J / numbers.energy_throughput_J).abs()
}

/// Four revolutes, three flexible links, two of them in the tree against their joint's direction, mixed orders.
#[test]
fn planar_four_bar_of_flexible_links_keeps_its_energy() {
    let text = r#"
spec = 1
name = "fb"
gravity = ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]
[points]
O = ["0 m","0 m","0 m"]
A = ["0 m","0.1 m","0 m"]
B = ["0.4 m","0.3 m","0 m"]
C = ["0.4 m","0 m","0 m"]
[bodies]
crank = { rod = ["O","A"], radius = "4 mm", density = "7850 kg/m^3", flexible = { modes = 2, young = "210 GPa" } }
coupler = { rod = ["B","A"], radius = "4 mm", density = "7850 kg/m^3", flexible = { modes = 4, young = "210 GPa" } }
rocker = { rod = ["C","B"], radius = "4 mm", density = "7850 kg/m^3", flexible = { modes = 4, young = "210 GPa", order = 2 } }
[joints]
J1 = { revolute = ["ground","crank"], at = "O", axis = [0,0,1] }
J2 = { revolute = ["coupler","crank"], at = "A", axis = [0,0,1] }
J3 = { revolute = ["coupler","rocker"], at = "B", axis = [0,0,1] }
J4 = { revolute = ["ground","rocker"], at = "C", axis = [0,0,1] }
[initial]
J1 = { v = "20 rad/s" }
"#;
    let drift = drift("four_flexible_bars", text, 0.05);
    assert!(drift < 1e-9, "{drift:e} of the throughput");
}

/// A stepped link with a concentrated mass, axial and torsional modes, springs to it, and further links on its slopes.
#[test]
fn open_chain_with_every_kind_of_mode_keeps_its_energy() {
    let text = r#"
spec = 1
name = "arm"
gravity = ["1 m/s^2", "-9.81 m/s^2", "2 m/s^2"]
[points]
O = ["0 m","0 m","0 m"]
M = ["0.2 m","0 m","0 m"]
A = ["0.5 m","0 m","0 m"]
B = ["0.9 m","0.1 m","0.1 m"]
[bodies]
one = { rod = ["O","A"], radius = "4 mm", density = "7850 kg/m^3", flexible = { modes = 4, young = "210 GPa", held = "clamped", axial = 1, torsion = 1, steps = [{ to = "0.2 m", radius = "6 mm" }], masses = [{ at = "0.3 m", mass = "0.2 kg" }] } }
two = { box = ["A","B"], width = ["5 mm","8 mm"], width_axis = [0, 0.7, -0.7], density = "2700 kg/m^3", flexible = { modes = 3, young = "70 GPa", order = 2 } }
tip = { mass = "0.1 kg", centre = "B", inertia = ["1e-5 kg m^2","2e-5 kg m^2","2e-5 kg m^2"] }
mid = { mass = "0.05 kg", centre = "M", inertia = ["1e-5 kg m^2","1e-5 kg m^2","1e-5 kg m^2"] }
[joints]
J1 = { universal = ["ground","one"], at = "O", axes = [[0,0,1],[0,1,0]] }
J2 = { revolute = ["one","two"], at = "A", axis = [1,1,0] }
J3 = { cylindrical = ["two","tip"], at = "B", axis = [1,0,1] }
J5 = { prismatic = ["one","mid"], at = "M", axis = [0,1,0.3], spring = { stiffness = "2000 N/m" } }
[forces]
s = { spring = ["ground","one"], at = ["B0","M"], stiffness = "500 N/m", length = "0.1 m" }
[points.B0]
at = ["0.2 m","0.3 m","0.1 m"]
on = "ground"
[initial]
J1 = { v1 = "3 rad/s", v2 = "2 rad/s" }
J3 = { v1 = "5 rad/s", v2 = "0.1 m/s" }
one = { eta = [0.001, 0.002, 0, 0, 0, 0], eta_v = [0,0,0.1,0,0,0] }
"#;
    let drift = drift("arm", text, 0.03);
    assert!(drift < 1e-9, "{drift:e} of the throughput");
}

/// Three attachments: Craig-Bampton shapes.
#[test]
fn beam_with_a_rotor_in_its_middle_keeps_its_energy() {
    let text = r#"
spec = 1
name = "craig"
gravity = ["0 m/s^2", "0 m/s^2", "-9.81 m/s^2"]
[points]
O = ["0 m","0 m","0 m"]
M = ["0.3 m","0 m","0 m"]
A = ["0.6 m","0 m","0 m"]
G = ["0.3 m","0 m","0.2 m"]
[bodies]
beam = { rod = ["O","A"], radius = "4 mm", density = "7850 kg/m^3", flexible = { modes = 4, young = "210 GPa" } }
mass = { rod = ["M","G"], radius = "8 mm", density = "7850 kg/m^3" }
end = { mass = "0.3 kg", centre = "A", inertia = ["1e-4 kg m^2","1e-4 kg m^2","1e-4 kg m^2"] }
[joints]
J1 = { spherical = ["ground","beam"], at = "O" }
J2 = { revolute = ["beam","mass"], at = "M", axis = [1,0,0] }
J3 = { fixed = ["beam","end"], at = "A" }
[initial]
J2 = { v = "10 rad/s" }
"#;
    let drift = drift("rotor", text, 0.2);
    assert!(drift < 1e-9, "{drift:e} of the throughput");
}
