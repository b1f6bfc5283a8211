//! MJCF against what its elements mean, and files that are none. `tests/cli/import/mjcf.rs` has MuJoCo's numbers.

use std::io;

use super::super::*;
use super::meshes::{binary, block};
use super::{answered, compiled, mutants};

/// Files in memory.
struct Memory(Vec<(&'static str, Vec<u8>)>);

impl Files for Memory {
    fn bytes(&self, name: &str) -> io::Result<Vec<u8>> {
        let found = self.0.iter().find(|(own, _)| *own == name);
        found.map(|(_, bytes)| bytes.clone()).ok_or_else(|| io::ErrorKind::NotFound.into())
    }
}

fn read(text: &str) -> Imported {
    from_robot(text, Base::Fixed, None, &NoFiles).unwrap_or_else(|error| panic!("{error:?}\n{text}"))
}

fn model(world: &str, rest: &str) -> String {
    format!("<mujoco model=\"m\">\n{rest}\n<worldbody>\n{world}\n</worldbody>\n</mujoco>\n")
}

const BALL: &str = "<geom size=\"0.1\"/>";

#[test]
fn joints_of_every_type_are_mechanisms() {
    for (joint, made) in [
        ("<joint/>", "revolute = [\"ground\", \"body_1\"], at = \"joint_1_at\", axis = [0, 0, 1.0]"),
        (
            "<joint type=\"slide\" axis=\"1 0 0\" damping=\"2\"/>",
            "prismatic = [\"ground\", \"body_1\"], at = \"joint_1_at\", axis = [1.0, 0, 0], damping = \"2 N s/m\"",
        ),
        (
            "<joint type=\"ball\" stiffness=\"3\"/>",
            "spherical = [\"ground\", \"body_1\"], at = \"joint_1_at\", spring = { stiffness = \"3.0 N m/rad\" }",
        ),
        ("<joint type=\"free\"/>", "free = [\"ground\", \"body_1\"]"),
        ("<freejoint/>", "free = [\"ground\", \"body_1\"]"),
    ] {
        let found = read(&model(&format!("<body>{joint}{BALL}</body>"), ""));
        assert!(found.text.contains(made), "{made}: {}", found.text);
        assert_eq!((found.bodies, found.joints), (1, 1));
        compiled(&found.text);
    }
}

#[test]
fn joints_of_one_body_are_a_chain_without_mass_between() {
    let found = read(&model(
        &format!(
            "<body name=\"b\"><joint name=\"x\" axis=\"1 0 0\"/><joint name=\"y\" axis=\"0 1 0\"/><joint name=\"z\" type=\"slide\"/>{BALL}</body>"
        ),
        "",
    ));
    assert!(found.text.contains("b_behind_x = { massless = true, centre = \"x_at\" }"), "{}", found.text);
    assert!(found.text.contains("z = { prismatic = [\"b_behind_y\", \"b\"]"), "{}", found.text);
    assert_eq!(compiled(&found.text).analysis.mobility, 3);
}

#[test]
fn loops_close_by_connect_weld_and_sites() {
    let chain = "<body name=\"a\"><joint name=\"ja\" axis=\"0 1 0\"/><geom type=\"capsule\" size=\".01\" fromto=\"0 0 0 1 0 0\"/><site name=\"sa\" pos=\"1 0 0\"/>\
                 <body name=\"b\" pos=\"1 0 0\"><joint name=\"jb\" axis=\"0 1 0\"/><geom type=\"capsule\" size=\".01\" fromto=\"0 0 0 0 0 1\"/><site name=\"sb\" pos=\"0 0 1\"/></body></body>\
                 <body name=\"c\" pos=\"0 0 1.2\"><joint name=\"jc\" axis=\"0 1 0\"/><geom type=\"capsule\" size=\".01\" fromto=\"0 0 0 1 0 0\"/><site name=\"sc\" pos=\"1 0 -0.2\"/><site name=\"sd\" pos=\"1 0 0\"/></body>";
    for (equality, made, mobility) in [
        (
            "<connect name=\"k\" body1=\"b\" body2=\"c\" anchor=\"0 0 1\"/>",
            "k = { spherical = [\"b\", \"c\"], at = \"k_at\", cut = true }",
            1,
        ),
        ("<connect body1=\"b\" anchor=\"0 0 1\"/>", "connect_1 = { spherical = [\"b\", \"ground\"]", 1),
        ("<connect site1=\"sb\" site2=\"sc\"/>", "spherical = [\"b\", \"c\"]", 1),
        ("<weld body1=\"b\" body2=\"c\"/>", "weld_1 = { fixed = [\"b\", \"c\"]", 0),
        (
            "<joint joint1=\"ja\" joint2=\"jc\" polycoef=\"0.1 -2 0 0 0\"/>",
            "relation = { ja = 1, jc = 2.0 }, offset = \"0.1 rad\"",
            2,
        ),
        ("<joint joint1=\"ja\" polycoef=\"0.25\"/>", "drive = \"0.25 rad\"", 3),
    ] {
        let found = read(&model(chain, &format!("<equality>{equality}</equality>")));
        assert!(found.text.contains(made), "{made}: {}", found.text);
        assert!(found.left_out.iter().any(|line| line.contains("solref")), "{:?}", found.left_out);
        if mobility > 0 {
            assert_eq!(compiled(&found.text).analysis.mobility, mobility, "{equality}");
        }
    }
    // Sites apart: open as drawn.
    let found = read(&model(chain, "<equality><connect site1=\"sb\" site2=\"sd\"/></equality>"));
    assert!(
        found.text.contains("{ b = [\"1.0 m\", 0, \"1.0 m\"], c = [\"1.0 m\", 0, \"1.2 m\"] }"),
        "{}",
        found.text
    );
    compiled(&found.text);
    for (equality, told) in [
        ("<weld site1=\"sa\" site2=\"sd\"/>", "places apart"),
        ("<weld body1=\"a\" body2=\"c\" relpose=\"0 0 1 1 0 0 0\"/>", "places apart"),
        ("<connect body1=\"b\" anchor=\"0 0 1\" active=\"false\"/>", "not active"),
        ("<joint joint1=\"ja\" joint2=\"jb\" polycoef=\"0 1 2 0 0\"/>", "no straight line"),
        ("<tendon tendon1=\"t\"/>", "<tendon> of line 2"),
        ("<connect body1=\"world\" anchor=\"0 0 1\"/>", "holds nothing that moves"),
    ] {
        let found = read(&model(chain, &format!("<equality>{equality}</equality>")));
        assert!(found.left_out.iter().any(|line| line.contains(told)), "{told}: {:?}", found.left_out);
        compiled(&found.text);
    }
}

#[test]
fn actuators_are_laws_over_inputs() {
    let arm = format!("<body><joint name=\"j\" ref=\"0.5\"/>{BALL}</body>");
    let angle = "<compiler angle=\"radian\"/>";
    for (actuator, input, force) in [
        ("<motor name=\"m\" joint=\"j\" gear=\"50\"/>", "m = { default = 0, unit = \"N m\" }", "(50.0)*m"),
        (
            "<motor name=\"j\" joint=\"j\" ctrlrange=\"-1 2\"/>",
            "j_signal = ",
            "clamp(j_signal, -1.0 N m, 2.0 N m)",
        ),
        (
            "<position name=\"p\" joint=\"j\" kp=\"8\"/>",
            "p = { default = 0, unit = \"rad\" }",
            "((8.0 N m/rad)*p + (-8.0 N m/rad)*(j.q + 0.5 rad))",
        ),
        (
            "<velocity name=\"v\" joint=\"j\" kv=\"4\" gear=\"2\"/>",
            "v = { default = 0, unit = \"rad/s\" }",
            "(2.0)*((4.0 N m s/rad)*v + (-4.0 N m s/rad)*2.0*j.v)",
        ),
        (
            "<general name=\"g\" joint=\"j\" gainprm=\"3\" forcerange=\"-1 1\" biastype=\"affine\" biasprm=\"1 0 0\"/>",
            "g = ",
            "clamp((3.0)*g + (1.0 N m), -1.0 N m, 1.0 N m)",
        ),
    ] {
        let found = read(&model(&arm, &format!("{angle}<actuator>{actuator}</actuator>")));
        assert!(
            found.text.contains(input) && found.text.contains(&format!("force = \"{force}\"")),
            "{force}: {}",
            found.text
        );
        compiled(&found.text);
    }
    for (actuator, told) in [
        ("<motor name=\"m\" tendon=\"t\"/>", "does not act on a joint"),
        ("<muscle name=\"m\" joint=\"j\"/>", "no counterpart"),
        ("<position name=\"m\" joint=\"j\" timeconst=\"0.1\"/>", "`timeconst`"),
        ("<general name=\"m\" joint=\"j\" dyntype=\"filter\"/>", "no counterpart"),
    ] {
        let found = read(&model(&arm, &format!("{angle}<actuator>{actuator}</actuator>")));
        assert!(found.left_out.iter().any(|line| line.contains(told)), "{told}: {:?}", found.left_out);
        compiled(&found.text);
    }
}

#[test]
fn classes_give_what_an_element_does_not_say() {
    let defaults = "<default><geom size=\"0.3 0.2\" density=\"500\"/><joint damping=\"1\"/>\
                    <default class=\"a\"><joint damping=\"2\" axis=\"1 0 0\"/><default class=\"b\"><joint axis=\"0 1 0\"/></default></default></default>";
    let body = |class: &str, joint: &str| {
        format!("<body childclass=\"{class}\"><joint {joint}/><geom type=\"capsule\" size=\"0.1\"/></body>")
    };
    for (class, joint, made) in [
        ("main", "", "axis = [0, 0, 1.0], damping = \"1 N m s/rad\""),
        ("a", "", "axis = [1.0, 0, 0], damping = \"2 N m s/rad\""),
        ("b", "", "axis = [0, 1.0, 0], damping = \"2 N m s/rad\""),
        ("b", "class=\"a\" damping=\"0\"", "axis = [1.0, 0, 0] }"),
    ] {
        let found = read(&model(&body(class, joint), defaults));
        assert!(found.text.contains(made), "{made}: {}", found.text);
        // A capsule of 0.1 x 0.2: its second size is that of the class.
        let mass = 500.0 * std::f64::consts::PI * 0.01 * (4.0 / 3.0 * 0.1 + 0.4);
        let written =
            found.text.split("mass = \"").nth(1).and_then(|rest| rest.split(' ').next()).expect("a mass");
        assert!((written.parse::<f64>().expect("a number") / mass - 1.0).abs() < 1e-14, "{written} {mass}");
    }
}

#[test]
fn totals_bounds_and_groups_change_masses() {
    let bodies = "<body name=\"a\"><freejoint/><geom size=\"0.1\" mass=\"1\"/><geom size=\"0.1\" mass=\"5\" group=\"3\"/></body>\
                  <body name=\"b\" pos=\"1 0 0\"><freejoint/><geom size=\"0.1\" mass=\"2\"/></body>";
    for (compiler, a, b) in [
        ("", "a = { mass = \"6 kg\"", "b = { mass = \"2 kg\""),
        ("<compiler inertiagrouprange=\"0 2\"/>", "a = { mass = \"1 kg\"", "b = { mass = \"2 kg\""),
        ("<compiler settotalmass=\"4\"/>", "a = { mass = \"3 kg\"", "b = { mass = \"1 kg\""),
        ("<compiler boundmass=\"3\"/>", "a = { mass = \"6 kg\"", "b = { mass = \"3 kg\""),
    ] {
        let text = read(&model(bodies, compiler)).text;
        assert!(text.contains(a) && text.contains(b), "{compiler}: {text}");
    }
    let thin = "<body><freejoint/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 4\"/></body>";
    let text = read(&model(thin, "<compiler balanceinertia=\"true\"/>")).text;
    assert!(text.contains("[\"2.0 kg m^2\", \"2.0 kg m^2\", \"2.0 kg m^2\", 0, 0, 0]"), "{text}");
    let both = format!(
        "<body><freejoint/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/>{}</body>",
        "<geom size=\"0.1\" mass=\"7\"/>"
    );
    for (word, mass) in [("auto", "1 kg"), ("true", "7 kg"), ("false", "1 kg")] {
        let text = read(&model(&both, &format!("<compiler inertiafromgeom=\"{word}\"/>"))).text;
        assert!(text.contains(&format!("mass = \"{mass}\"")), "{word}: {text}");
    }
}

#[test]
fn files_that_are_no_models_are_refused_with_line_and_cure() {
    let body = |inside: &str| model(&format!("<body name=\"b\">{inside}</body>"), "");
    let cases: Vec<(String, &str, usize)> = vec![
        ("<mujoco>\n<worldbody>".to_owned(), "no XML", 1),
        ("<mujoco/>".to_owned(), "no <worldbody>", 1),
        (body("<joint/><body><joint/><geom size=\"1\"/></body>"), "`b` moves and has no mass", 4),
        (body("<joint axis=\"0 0 0\"/>"), "0 0 0", 4),
        (body("<joint type=\"screw\"/>"), "\"screw\"", 4),
        (body("<joint damping=\"-1\"/>"), "`damping`", 4),
        (body("<joint name=\"j\"/><joint name=\"j\"/>"), "two joints", 4),
        (body("<joint class=\"none\"/>"), "no class `none`", 4),
        (body("<joint range=\"0 x\"/>"), "\"0 x\"", 4),
        (body("<body name=\"b\"/>"), "two bodies", 4),
        (body("<freejoint/><geom size=\"-1\"/>"), "`size`", 4),
        (body("<freejoint/><geom size=\"1e200\"/>"), "volume", 4),
        (body("<freejoint/><geom type=\"sdf\"/>"), "\"sdf\"", 4),
        (body("<freejoint/><geom size=\"1\" mass=\"-2\"/>"), "-2", 4),
        (body("<freejoint/><geom type=\"capsule\" size=\"1\" fromto=\"1 1 1 1 1 1\"/>"), "one place", 4),
        (body("<freejoint/><geom size=\"1\" shellinertia=\"true\"/>"), "surface", 4),
        (body("<freejoint/><geom type=\"mesh\" mesh=\"none\"/>"), "no mesh `none`", 4),
        (body("<freejoint/><geom type=\"mesh\"/>"), "no `mesh`", 4),
        (body("<freejoint/><inertial pos=\"0 0 0\" mass=\"-1\"/>"), "-1 kg", 4),
        (body("<freejoint/><geom size=\"1\" quat=\"0 0 0 0\"/>"), "zero", 4),
        (body("<freejoint/><geom size=\"1\" xyaxes=\"1 0 0 1 0 0\"/>"), "length 0", 4),
        (body("<replicate count=\"3\"/>"), "<replicate>", 4),
        (model("<joint/>", ""), "stands in the world", 4),
        (model("", "<compiler coordinate=\"global\"/>"), "global", 2),
        (model("", "<compiler angle=\"turns\"/>"), "\"turns\"", 2),
        (model("", "<compiler eulerseq=\"xyq\"/>"), "eulerseq", 2),
        (model("", "<include file=\"none.xml\"/>"), "cannot be read", 2),
        (model("", "<include/>"), "no `file`", 2),
        (model("", "<equality><connect body1=\"q\" anchor=\"0 0 0\"/></equality>"), "no body `q`", 2),
        (model("", "<equality><joint joint1=\"q\"/></equality>"), "no joint `q`", 2),
        (model("", "<actuator><motor joint=\"q\"/></actuator>"), "no joint `q`", 2),
        (model("", "<default><default/></default>"), "no `class`", 2),
        (model("", "<default><default class=\"main\"/></default>"), "within itself", 2),
        (model(&"<body>".repeat(400), "") + &"</body>".repeat(400), "no XML", 5),
    ];
    for (text, told, line) in cases {
        let error = from_robot(&text, Base::Fixed, None, &NoFiles).expect_err(told);
        assert!(
            error.message.contains(told) && error.line == line && !error.cure.is_empty(),
            "{told}: {error:?}"
        );
    }
}

#[test]
fn included_files_and_meshes_are_read_once_and_never_in_circles() {
    let files = Memory(vec![
        ("a.xml", b"<mujoco><include file=\"b.xml\"/></mujoco>".to_vec()),
        ("b.xml", b"<x><default><geom density=\"2000\"/></default></x>".to_vec()),
        ("c.xml", b"<mujoco>\n<include file=\"d.xml\"/></mujoco>".to_vec()),
        ("d.xml", b"<mujoco>\n\n<include file=\"c.xml\"/></mujoco>".to_vec()),
        ("many.xml", b"<mujoco><include file=\"b.xml\"/><include file=\"b.xml\"/></mujoco>".to_vec()),
        ("bad.xml", vec![0xff, 0xfe]),
        ("meshes/cube.stl", binary(b"", &block([1.0, 1.0, 1.0]))),
    ]);
    let mesh = "<compiler meshdir=\"meshes\"/><asset><mesh file=\"cube.stl\" scale=\"0.1 0.1 0.1\"/></asset>";
    let body = "<body><freejoint/><geom type=\"mesh\" mesh=\"cube\"/></body>";
    let made = |rest: &str| from_robot(&model(body, rest), Base::Fixed, None, &files);
    let found = made(&format!("<include file=\"a.xml\"/>{mesh}")).expect("a model");
    // Corners are of seven digits.
    assert!(found.text.contains("mass = \"2.0") || found.text.contains("mass = \"1.99999"), "{}", found.text);
    made(&format!("<include file=\"many.xml\"/>{mesh}")).expect("b.xml twice is no circle");
    let spread = |word: &str| made(&mesh.replace("file=", &format!("inertia=\"{word}\" file=")));
    let told = |found: &Imported| found.left_out.iter().any(|line| line.contains("\"convex\" of 1 mesh"));
    assert!(told(&spread("convex").expect("a model")) && !told(&spread("exact").expect("a model")));
    assert!(spread("shell").expect_err("hollow").message.contains("over its surface"));
    for (rest, told, file, line) in [
        ("<include file=\"c.xml\"/>", "`c.xml` includes itself, by c.xml, d.xml", Some("d.xml"), 3),
        ("<include file=\"bad.xml\"/>", "not UTF-8", None, 2),
    ] {
        let error = made(rest).expect_err(told);
        assert!(error.message.contains(told), "{error:?}");
        assert_eq!((error.file.as_deref(), error.line), (file, line));
    }
}

#[test]
fn cut_and_mutated_models_are_answered() {
    const ARM: &str = include_str!("../../../tests/data/mjcf/arm.xml");
    const PRESS: &str = include_str!("../../../examples/data/press/press.xml");
    let files = Memory(vec![
        ("meshes/bracket.stl", include_bytes!("../../../tests/data/mjcf/meshes/bracket.stl").to_vec()),
        ("lever.stl", include_bytes!("../../../examples/data/press/lever.stl").to_vec()),
    ]);
    for text in [ARM, PRESS] {
        for mutant in mutants(text) {
            mutant.iter().for_each(|text| answered(text, Base::Fixed, &files));
        }
    }
}

#[test]
fn the_force_of_all_actuators_of_a_joint_has_its_limit() {
    let with = |joint: &str, actuators: &str| {
        let world = format!("<body><joint name=\"j\" {joint}/>{BALL}</body>");
        read(&model(&world, &format!("<actuator>{actuators}</actuator>")))
    };
    let two = "<motor name=\"a\" joint=\"j\"/><motor name=\"b\" joint=\"j\" gear=\"2\"/>";
    let range = "actuatorfrcrange=\"-3 4\"";
    let found = with(&format!("{range} armature=\"0.1\""), two);
    let sum = "-(0.1 kg m^2)*j.a + clamp(a + (2.0)*b, -3.0 N m, 4.0 N m)";
    assert!(found.text.contains(sum), "{}", found.text);
    compiled(&found.text);
    let off = with(&format!("{range} actuatorfrclimited=\"false\""), two);
    assert!(!off.text.contains("clamp"), "{}", off.text);
    // Nothing acts there that could be limited.
    let idle = with(range, "");
    assert!(idle.left_out.iter().any(|line| line.contains("actuatorfrcrange")), "{:?}", idle.left_out);
    let world = format!("<body><joint actuatorfrcrange=\"3 -3\"/>{BALL}</body>");
    assert!(from_robot(&model(&world, ""), Base::Fixed, None, &NoFiles).is_err());
}

#[test]
fn an_inertial_in_a_frame_is_refused_at_its_line() {
    let inertial = "<inertial mass=\"1\" pos=\"0 0 0\" diaginertia=\"1 1 1\"/>";
    let text = model(&format!("<body><joint/>\n<frame pos=\"5 0 0\">{inertial}</frame></body>"), "");
    let error = from_robot(&text, Base::Fixed, None, &NoFiles).expect_err("no element of a frame");
    assert!(error.message.contains("<frame>") && error.line == 5, "{error:?}");
}

#[test]
fn all_kinds_of_actuators_share_one_store_of_defaults() {
    let arm = format!("<body><joint name=\"j\"/>{BALL}</body>");
    let affine = "<general gaintype=\"fixed\" biastype=\"affine\" gainprm=\"50\" biasprm=\"2 -50 -3\"/>";
    for (defaults, actuator, force) in [
        (
            affine,
            "<position name=\"a\" joint=\"j\"/>",
            "(50.0 N m/rad)*a + (2.0 N m) + (-50.0 N m/rad)*j.q + (-3.0 N m s/rad)*j.v",
        ),
        (
            affine,
            "<general name=\"a\" joint=\"j\" biasprm=\"1\"/>",
            "(50.0 N m/rad)*a + (1.0 N m) + (-50.0 N m/rad)*j.q + (-3.0 N m s/rad)*j.v",
        ),
        (affine, "<velocity name=\"a\" joint=\"j\"/>", "(50.0 N m s/rad)*a + (-50.0 N m s/rad)*j.v"),
        (affine, "<motor name=\"a\" joint=\"j\"/>", "a"),
        (
            "<position kp=\"50\" kv=\"3\"/>",
            "<general name=\"a\" joint=\"j\"/>",
            "(50.0 N m/rad)*a + (-50.0 N m/rad)*j.q + (-3.0 N m s/rad)*j.v",
        ),
        (
            "<position kp=\"50\" kv=\"3\"/>",
            "<position name=\"a\" joint=\"j\" kp=\"7\"/>",
            "(7.0 N m/rad)*a + (-7.0 N m/rad)*j.q + (-3.0 N m s/rad)*j.v",
        ),
        (
            "<position kp=\"50\" kv=\"3\"/>",
            "<velocity name=\"a\" joint=\"j\"/>",
            "(50.0 N m s/rad)*a + (-50.0 N m s/rad)*j.v",
        ),
        ("<velocity kv=\"9\"/><motor/>", "<general name=\"a\" joint=\"j\"/>", "a"),
    ] {
        let found =
            read(&model(&arm, &format!("<default>{defaults}</default><actuator>{actuator}</actuator>")));
        let plain = found.text.replace("((", "(").replace("))", ")");
        assert!(plain.contains(force), "{defaults} {actuator}: {}", found.text);
        compiled(&found.text);
    }
    let muscle = "<default><muscle/></default><actuator><general name=\"a\" joint=\"j\"/></actuator>";
    let found = read(&model(&arm, muscle));
    assert!(found.left_out.iter().any(|line| line.contains("no counterpart")), "{:?}", found.left_out);
}

#[test]
fn what_flags_and_defaults_switch_off_does_not_act() {
    let arms = format!(
        "<body><joint name=\"j\" stiffness=\"3\" damping=\"2\"/>{BALL}</body><body pos=\"0 1 0\"><joint name=\"k\"/>{BALL}</body>"
    );
    let rest = "<equality><joint joint1=\"k\" joint2=\"j\" polycoef=\"0 2 0 0 0\"/></equality>\
                <actuator><motor name=\"m\" joint=\"j\" ctrlrange=\"-1 1\" group=\"2\"/></actuator>";
    for (extra, gone, told) in [
        ("<option><flag spring=\"disable\"/></option>", "spring =", "springs of joints"),
        ("<option><flag damper=\"disable\"/></option>", "damping =", "damping of joints"),
        ("<option><flag passive=\"disable\"/></option>", "damping =", "springs of joints"),
        ("<option><flag actuation=\"disable\"/></option>", "force =", "actuators"),
        ("<option><flag clampctrl=\"disable\"/></option>", "clamp(", "ranges of the signals"),
        ("<option actuatorgroupdisable=\"2\"/>", "force =", "group 2 is disabled"),
        ("<option><flag equality=\"disable\"/></option>", "relation =", "<equality>"),
        ("<option><flag constraint=\"disable\"/></option>", "relation =", "<equality>"),
        ("<default><equality active=\"false\"/></default>", "relation =", "not active"),
    ] {
        let plain = read(&model(&arms, rest));
        assert!(plain.text.contains(gone), "{gone}: {}", plain.text);
        let found = read(&model(&arms, &format!("{extra}{rest}")));
        assert!(!found.text.contains(gone), "{extra}: {}", found.text);
        assert!(found.left_out.iter().any(|line| line.contains(told)), "{told}: {:?}", found.left_out);
        compiled(&found.text);
    }
    // Defaults of joints are none of what couples them.
    let found =
        read(&model(&arms, &format!("<default><joint class=\"main\" damping=\"1\"/></default>{rest}")));
    assert!(found.text.contains("relation ="), "{}", found.text);
}
