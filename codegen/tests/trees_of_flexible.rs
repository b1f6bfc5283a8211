//! Where loops with flexible bodies are cut: a tree in which sections turn freely is taken where it makes the equations shorter and
//! nothing asks for the coordinates of the other; both move alike.

mod simulated;

use linkwear_codegen::compile::{Options, compile};
use linkwear_runtime::{Integrator, Settings, Span};
use simulated::{compiled, run_with, source};

/// A crank and a rod that bend, a piston in a guide that lies askew, so that nothing stays in a plane.
fn engine(crank_pin: &str, piston_pin: &str, rest: &str) -> String {
    format!(
        r#"
gravity = ["3 m/s^2", "-9.81 m/s^2", "5 m/s^2"]
[points]
O = [0, 0, 0]
A = ["100 mm", 0, 0]
P = ["400 mm", 0, 0]
[bodies]
crank = {{ rod = ["O", "A"], radius = "5 mm", density = "7850 kg/m^3", flexible = {{ modes = 2, young = "210 GPa", poisson = 0.3, damping = 0.01 }} }}
rod = {{ rod = ["A", "P"], radius = "5 mm", density = "7850 kg/m^3", flexible = {{ modes = 4, young = "210 GPa", poisson = 0.3, damping = 0.01 }} }}
piston = {{ mass = "0.3 kg", centre = "P", inertia = ["1.2e-4 kg m^2", "1e-4 kg m^2", "1e-4 kg m^2"] }}
[joints]
bearing = {{ revolute = ["ground", "crank"], at = "O", axis = [0, 1, 5], drive = "2*pi*10*t/(1 s)" }}
crank_pin = {{ spherical = ["crank", "rod"], at = "A"{crank_pin} }}
piston_pin = {{ universal = ["piston", "rod"], at = "P", axes = [[0, 0, 1], [0, 1, 0]]{piston_pin} }}
guide = {{ prismatic = ["ground", "piston"], at = "P", axis = [4, 0, 3] }}
{rest}
"#
    )
}

fn cuts(text: &str) -> Vec<String> {
    let compiled = compiled(text);
    compiled.topology.cuts.iter().map(|id| compiled.mechanism.joint(*id).name.clone()).collect()
}

#[test]
fn a_rod_that_bends_is_carried_by_its_ball() {
    assert_eq!(cuts(&engine("", "", "")), ["piston_pin"]);
    // Rigid links keep the tree with few rows.
    let rigid = Options { rigid: true, ..Options::default() };
    let rigid = compile(&source(&engine("", "", "")), &rigid).expect("a mechanism");
    assert_eq!(rigid.mechanism.joint(rigid.topology.cuts[0]).name, "crank_pin");
}

#[test]
fn what_the_file_asks_for_stays_in_the_tree() {
    assert_eq!(cuts(&engine(", cut = true", "", "")), ["crank_pin"]);
    assert_eq!(cuts(&engine("", ", damping = { q1 = \"0.1 N m s/rad\" }", "")), ["crank_pin"]);
    let mentioned =
        "[forces]\nbrake = { torque = \"rod\", components = [0, 0, \"1 N m*sin(piston_pin.q1)\"] }";
    assert_eq!(cuts(&engine("", "", mentioned)), ["crank_pin"]);
    assert_eq!(cuts(&engine("", "", "[assembly]\npiston_pin = { q1 = \"1 deg\" }")), ["crank_pin"]);
}

#[test]
fn the_tree_stays_where_the_start_would_be_another() {
    let chosen = engine("", "", "");
    // Away from where it is drawn loops close by guesses of the tree's coordinates.
    let ahead = chosen.replace("drive = \"2*pi", "drive = \"0.2+2*pi");
    assert_eq!(cuts(&ahead), ["crank_pin"]);
    // The piston may turn in its guide: how fast it begins to, the driver does not say.
    let kinds = [
        (
            "spherical = [\"crank\", \"rod\"], at = \"A\"",
            "universal = [\"crank\", \"rod\"], at = \"A\", axes = [[0, 0, 1], [0, 1, 0]]",
        ),
        (
            "universal = [\"piston\", \"rod\"], at = \"P\", axes = [[0, 0, 1], [0, 1, 0]]",
            "spherical = [\"piston\", \"rod\"], at = \"P\"",
        ),
        ("prismatic", "cylindrical"),
    ];
    let turned = kinds.iter().fold(chosen, |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    });
    let driven = cuts(&turned);
    let at_rest = cuts(&turned.replace(", drive = \"2*pi*10*t/(1 s)\"", ""));
    assert_eq!([driven, at_rest], [["piston_pin"], ["crank_pin"]]);
}

#[test]
fn another_tree_moves_alike_in_fewer_operations() {
    let [chosen, other] = ["", ", cut = true"].map(|cut| engine(cut, "", ""));
    let total =
        |text: &str| -> u64 { compiled(text).operations().iter().map(|one| one.operations.total).sum() };
    let (least, most) = (total(&chosen), total(&other));
    assert!(10 * least < 9 * most, "{least} for {most}");

    let integrator = Integrator::Dopri5 { tolerance: 1e-11, max_step: None };
    let settings = Settings::new(integrator, Span::Turns(0.25), 20);
    let [chosen, other] = [chosen, other].map(|text| run_with(&text, &settings));
    let mut compared = 0;
    for channel in &other.channels {
        let name = &*channel.name;
        // Multipliers belong to the cut; a quaternion and its negative are one orientation.
        let of_tree = name.contains("lambda") || name.starts_with("crank_pin.q");
        let (Ok(one), Ok(two), false) = (chosen.column(name), other.column(name), of_tree) else { continue };
        let largest = two.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        let apart = one.iter().zip(two).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        // Steps at 1e-11 of each value, over a quarter of a turn with modes of 225 Hz to 2 kHz; what is zero rounds to 1e-12.
        assert!(apart <= 1e-7 * largest + 1e-12, "{name}: {apart} of {largest}");
        compared += 1;
    }
    assert!(compared > 80, "{compared} columns");
}
