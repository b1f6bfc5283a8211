//! Parts from STL files and meshes of robots, by the command line: where files may lie, what is refused.

use std::fs;

use crate::command::{Folder, linkwear};

/// A block of 30 x 20 x 10 from the origin, its corners moved; text.
fn block(scale: f64) -> String {
    let at = |corner: usize| {
        [30.0, 20.0, 10.0].iter().enumerate().map(move |(i, size)| {
            let x: f64 = if corner >> i & 1 == 1 { size * scale } else { 0.0 };
            x.to_string()
        })
    };
    let faces: [[usize; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let mut text = "solid block\n".to_owned();
    for [a, b, c, d] in faces {
        for triangle in [[a, b, c], [a, c, d]] {
            text.push_str("facet normal 0 0 0\n outer loop\n");
            for corner in triangle {
                text.push_str(&format!("  vertex {}\n", at(corner).collect::<Vec<_>>().join(" ")));
            }
            text.push_str(" endloop\nendfacet\n");
        }
    }
    text + "endsolid block\n"
}

fn near(found: &serde_json::Value, expected: &[f64]) {
    let found: Vec<f64> =
        found.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect();
    let largest = expected.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    for (found, expected) in found.iter().zip(expected) {
        // Whole millimetres: sums of a dozen products.
        assert!((found - expected).abs() < 1e-14 * largest, "{found} {expected}");
    }
    assert_eq!(found.len(), expected.len());
}

#[test]
fn a_part_is_weighed_in_the_unit_that_is_said_and_can_be_included() {
    let folder = Folder::new("import-part");
    let mesh = folder.write("block.stl", &block(1.0));
    let out = folder.path("block.toml");
    let told =
        linkwear(&["import", &mesh, "--density", "7850 kg/m^3", "--out", &out, "--format", "json"]).json();
    let part = &told["part"];
    let mass = 7850.0 * 6e-6;
    near(&serde_json::json!([part["mass_kg"], part["volume_m3"]]), &[mass, 6e-6]);
    near(&part["centre_m"], &[0.015, 0.010, 0.005]);
    let about = |a: f64, b: f64| mass * (a * a + b * b) / 12.0;
    near(&part["inertia_kg_m2"], &[about(0.02, 0.01), about(0.03, 0.01), about(0.03, 0.02), 0.0, 0.0, 0.0]);
    // A whole mechanism, and a part of another.
    assert_eq!(linkwear(&["check", &out]).code, 0);
    let whole = folder.write(
        "whole.toml",
        "spec = 1\nname = \"whole\"\ngravity = [0, 0, 0]\n[include.left]\nfile = \"block.toml\"\n[include.right]\nfile = \"block.toml\"\norigin = [\"1 m\", 0, 0]\n",
    );
    let checked = linkwear(&["check", &whole, "--format", "json"]).json();
    assert_eq!(checked["bodies"], 2, "{checked}");
    for (unit, scale) in [("m", 1.0), ("cm", 1e-2), ("in", 0.0254)] {
        let out = folder.path(&format!("{unit}.toml"));
        let words =
            ["import", &mesh, "--density", "1 kg/m^3", "--unit", unit, "--out", &out, "--format", "json"];
        let told = linkwear(&words).json();
        near(&serde_json::json!([told["part"]["mass_kg"]]), &[6000.0 * f64::powi(scale, 3)]);
    }
}

#[test]
fn what_is_no_part_is_refused_with_its_cure() {
    let folder = Folder::new("import-part-wrong");
    let whole = block(1.0);
    let (open, _) = whole.split_once("facet normal 0 0 0\n outer loop\n  vertex 0 0 10").expect("a face");
    let open = folder.write("open.stl", &format!("{open}endsolid\n"));
    let cut = folder.write("cut.stl", &whole[..whole.len() / 2]);
    let empty = folder.write("empty.stl", "");
    let steel = "7850 kg/m^3";
    for (mesh, density, code, told) in [
        (&open, steel, "C0011", "have a triangle on one side only"),
        (&cut, steel, "C0011", "breaks off"),
        (&empty, steel, "C0011", "too short"),
        (&folder.path("none.stl"), steel, "C0002", "cannot read"),
    ] {
        let out = folder.path("out.toml");
        let answer = linkwear(&["import", mesh, "--density", density, "--out", &out]);
        assert!(answer.code == 1 && answer.err.contains(code) && answer.err.contains(told), "{}", answer.err);
        assert!(answer.err.contains("help: ") && fs::metadata(&out).is_err());
    }
    let mesh = folder.write("block.stl", &whole);
    for (words, told) in [
        (&["--density", "7850"][..], "write a density with its unit"),
        (&["--density=-1 kg/m^3"], "write a density with its unit"),
        (&[], "a part needs a density"),
        (&["--density", "1 kg/m^3", "--unit", "ft"], "possible values: m, cm, mm, in"),
        (&["--density", "1 kg/m^3", "--floating"], "--floating is for robots"),
    ] {
        let answer = linkwear(&[&["import", &mesh, "--out", &folder.path("out.toml")], words].concat());
        assert!(answer.code == 2 && answer.err.contains(told), "{told}: {}", answer.err);
    }
}

/// A link whose mass is that of a mesh, which lies here or there.
fn urdf(mesh: &str) -> String {
    format!(
        "<robot name=\"r\"><link name=\"a\"/>\n<link name=\"b\">\n<visual><origin xyz=\"1 0 0\"/><geometry><mesh filename=\"{mesh}\" scale=\"0.001 0.001 0.002\"/></geometry></visual></link>\n\
         <joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/></joint></robot>\n"
    )
}

#[test]
fn meshes_are_read_below_the_folder_unless_more_is_allowed() {
    let folder = Folder::new("import-reach");
    fs::create_dir_all(folder.path("robot/meshes")).expect("a folder");
    folder.write("robot/meshes/block.stl", &block(1.0));
    folder.write("outside.stl", &block(1.0));
    let asked = |mesh: &str, more: &[&str]| {
        let robot = folder.write("robot/r.urdf", &urdf(mesh));
        let out = folder.path("r.toml");
        let _ = fs::remove_file(&out);
        let answer = linkwear(&[&["import", &robot, "--out", &out], more].concat());
        (answer, fs::read_to_string(&out).unwrap_or_default())
    };
    let steel = ["--density", "1000 kg/m^3"];
    for mesh in ["meshes/block.stl", "package://robot/meshes/block.stl"] {
        let (answer, text) = asked(mesh, &steel);
        assert_eq!(answer.code, 0, "{}", answer.err);
        // 30 x 20 x 20 mm of water.
        assert!(text.contains("mass = \"0.012") && text.contains("centre = [\"1.015"), "{text}");
    }
    // Without a density such a link has no mass, carries nothing, and is told.
    let (answer, _) = asked("meshes/block.stl", &[]);
    assert!(answer.code == 0 && answer.out.contains("a link without mass"), "{}{}", answer.out, answer.err);
    for mesh in ["../outside.stl", "package://robot/../outside.stl"] {
        let (answer, _) = asked(mesh, &steel);
        assert!(answer.code == 1 && answer.err.contains("outside the folder"), "{}", answer.err);
        assert!(
            answer.err.contains("r.urdf:3") && answer.err.contains("--allow-outside-data"),
            "{}",
            answer.err
        );
        let (answer, _) = asked(mesh, &[&steel[..], &["--allow-outside-data"]].concat());
        assert_eq!(answer.code, 0, "{}", answer.err);
    }
    for (mesh, told) in [
        ("meshes", "meshes are read from STL files alone"),
        ("meshes/block.dae", "meshes are read from STL files alone"),
        ("meshes/none.stl", "cannot be read"),
    ] {
        let (answer, _) = asked(mesh, &steel);
        assert!(answer.code == 1 && answer.err.contains(told), "{told}: {}", answer.err);
    }
}

#[test]
fn a_fault_in_an_included_file_is_told_there() {
    let folder = Folder::new("import-included");
    let robot = folder.write("r.xml", "<mujoco>\n<include file=\"part.xml\"/>\n<worldbody/>\n</mujoco>\n");
    folder.write(
        "part.xml",
        "<mujoco>\n<worldbody>\n<body name=\"a\" pos=\"1 2\"/>\n</worldbody>\n</mujoco>\n",
    );
    let out = folder.path("r.toml");
    let answer = linkwear(&["import", &robot, "--out", &out]);
    assert!(answer.code == 1 && answer.err.contains("part.xml:3"), "{}", answer.err);
    folder.write("part.xml", "<mujoco>\n<include file=\"part.xml\"/></mujoco>\n");
    let answer = linkwear(&["import", &robot, "--out", &out]);
    assert!(answer.code == 1 && answer.err.contains("includes itself"), "{}", answer.err);
    let answer = linkwear(&["import", &robot, "--out", &out, "--density", "1 kg/m^3"]);
    assert!(answer.code == 1 && answer.err.contains("says itself what its shapes weigh"), "{}", answer.err);
    let answer = linkwear(&["import", &robot, "--out", &out, "--floating"]);
    assert!(answer.code == 1 && answer.err.contains("says itself what moves freely"), "{}", answer.err);
}
