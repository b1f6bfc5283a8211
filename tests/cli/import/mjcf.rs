//! MJCF against MuJoCo 4.0.0: `data/mjcf/mujoco_numbers.py` writes its numbers, and says what they are.

use std::collections::BTreeMap;

use super::{driven, imported};
use crate::command::{Folder, linkwear};

const NUMBERS: &str = include_str!("../../data/mjcf/mujoco.csv");
const ARM: &str = "tests/data/mjcf/arm.xml";
const HUMANOID: &str = "tests/data/humanoid/humanoid.xml";
const PRESS: &str = "examples/data/press/press.xml";

/// Rows of MuJoCo's numbers: a name, then numbers.
fn rows(what: &str) -> Vec<(String, Vec<f64>)> {
    let rows = NUMBERS.lines().filter_map(|line| line.strip_prefix(what)?.strip_prefix(','));
    let found: Vec<_> = rows
        .map(|row| {
            let (name, numbers) = row.split_once(',').expect("a name");
            (name.to_owned(), numbers.split(',').map(|cell| cell.parse().expect("a number")).collect())
        })
        .collect();
    assert!(!found.is_empty(), "{what}");
    found
}

/// What MuJoCo says and what was found, beside the largest that MuJoCo says. Rounding of chains of 8 and 22 bodies, whose accelerations
/// come from mass matrices of condition 1e5: 1.1e-14 was found, of the inertia of a mesh that is moved, turned and scaled 9e-12.
fn assert_near(what: &str, pairs: &[(String, f64, f64)]) {
    let largest = pairs.iter().fold(0.0, |largest: f64, (_, expected, _)| largest.max(expected.abs()));
    let most = pairs.iter().map(|(_, expected, found)| (expected - found).abs()).fold(0.0, f64::max);
    println!("{what}: {most:e} of {largest}");
    for (name, expected, found) in pairs {
        let difference = (expected - found).abs() / largest;
        assert!(difference < 1e-10, "{what}, {name}: {found} {expected}, {difference:e} of {largest}");
    }
}

#[test]
fn masses_of_shapes_and_meshes_are_those_of_mujoco() {
    let folder = Folder::new("import-mjcf-masses");
    for (what, file) in [("arm", ARM), ("press", PRESS)] {
        let (text, _) = imported(&folder, file);
        let file: toml::Table = text.parse().expect("TOML");
        let si = |value: &toml::Value| match value {
            toml::Value::String(text) => text.split(' ').next().expect("a number").parse().expect("a number"),
            value => value.as_integer().expect("0") as f64,
        };
        for (name, expected) in rows(&format!("{what} mass")) {
            let Some(body) = file["bodies"].get(&name) else {
                assert_eq!(name, "pedestal", "it alone is of the ground");
                continue;
            };
            let list = |key: &str| body[key].as_array().expect("a list").iter().map(si).collect::<Vec<f64>>();
            let found = [vec![si(&body["mass"])], list("centre"), list("inertia")].concat();
            assert_eq!(found.len(), expected.len());
            for (range, unit) in [(0..1, "kg"), (1..4, "m"), (4..10, "kg m^2")] {
                let pairs: Vec<_> =
                    range.map(|at| (format!("{at} {unit}"), expected[at], found[at])).collect();
                assert_near(&name, &pairs);
            }
        }
    }
}

#[test]
fn the_drives_of_an_arm_are_those_of_mujoco() {
    let folder = Folder::new("import-mjcf-arm");
    let (text, told) = imported(&folder, ARM);
    assert_eq!((&told["bodies"], &told["joints"]), (&8.into(), &8.into()), "{told}");
    for state in 0..5 {
        let expected = rows(&format!("arm inverse {state}"));
        let drives: Vec<(&str, String)> = expected
            .iter()
            .map(|(name, numbers)| {
                let unit = if ["lift", "grip"].contains(&name.as_str()) { "m" } else { "rad" };
                let [q, v, a] = numbers[..3] else { panic!("three numbers of {name}") };
                let half = 0.5 * a;
                (&**name, format!("{q:?} {unit} + ({v:?} {unit}/s)*t + ({half:?} {unit}/s^2)*t^2"))
            })
            .collect();
        let found = driven(&folder, &text, &drives, &["--time", "0.0001", "--samples", "2"]);
        let pairs = expected
            .iter()
            .map(|(name, numbers)| (name.clone(), numbers[3], found[0][&format!("{name}.drive")]));
        assert_near(&format!("state {state}"), &pairs.collect::<Vec<_>>());
    }
}

/// Several joints in a body, armatures, springs, a free root: accelerations of all 21 joints.
#[test]
fn the_accelerations_of_a_humanoid_are_those_of_mujoco() {
    let folder = Folder::new("import-mjcf-humanoid");
    let (text, told) = imported(&folder, HUMANOID);
    // 13 bodies that move against each other, 9 between joints of one of them.
    assert_eq!((&told["bodies"], &told["joints"]), (&22.into(), &22.into()), "{told}");
    for state in 0..3 {
        let expected = rows(&format!("humanoid forward {state}"));
        let mut with_start = format!("{text}\n[initial]\n");
        for (name, numbers) in &expected {
            if name == "root" {
                let units = ["rad", "m", "rad/s", "m/s"];
                let keys = (0..12).map(|at| {
                    let (letter, number) = if at < 6 { ('q', at + 1) } else { ('v', at - 5) };
                    format!("{letter}{number} = \"{:?} {}\"", numbers[at], units[at / 3])
                });
                with_start.push_str(&format!("root = {{ {} }}\n", keys.collect::<Vec<_>>().join(", ")));
            } else {
                with_start.push_str(&format!(
                    "{name} = {{ q = \"{:?} rad\", v = \"{:?} rad/s\" }}\n",
                    numbers[0], numbers[1]
                ));
            }
        }
        let found = driven(&folder, &with_start, &[], &["--time", "0.00001", "--samples", "2"]);
        let joints = expected.iter().filter(|(name, _)| name != "root");
        let pairs = joints.map(|(name, numbers)| (name.clone(), numbers[2], found[0][&format!("{name}.a")]));
        assert_near(&format!("state {state}"), &pairs.collect::<Vec<_>>());
    }
}

#[test]
fn a_closed_press_starts_as_mujocos_matrices_say() {
    let folder = Folder::new("import-mjcf-press");
    let (text, told) = imported(&folder, PRESS);
    assert_eq!((&told["bodies"], &told["joints"]), (&5.into(), &6.into()), "{told}");
    let file = folder.write("press.toml", &text);
    let checked = linkwear(&["check", &file, "--format", "json"]).json();
    // Crank and plumb: the ram and the lever follow.
    assert_eq!(checked["mobility"], 4, "{checked}");
    let found: Vec<BTreeMap<String, f64>> =
        driven(&folder, &text, &[], &["--time", "0.00001", "--samples", "2"]);
    let pairs = rows("press rest");
    let pairs = pairs.iter().map(|(name, number)| (name.clone(), number[0], found[0][&format!("{name}.a")]));
    assert_near("at rest", &pairs.collect::<Vec<_>>());
}
