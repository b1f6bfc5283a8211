//! Robots against what their elements mean, and files that are none.

use linkwear_codegen::{Options, SourceFile, compile};

use super::*;

mod meshes;
mod mjcf;

const ARM: &str = include_str!("../../examples/data/arm.urdf");

/// One link on a joint, and what else stands within the joint.
fn one(kind: &str, link: &str, joint: &str) -> String {
    let sides = r#"<parent link="a"/><child link="b"/>"#;
    format!(
        "<robot name=\"one\">\n<link name=\"a\"/>\n<link name=\"b\">{link}</link>\n<joint name=\"j\" type=\"{kind}\">{sides}{joint}</joint>\n</robot>\n"
    )
}

const MASS: &str = r#"<inertial><mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.1"/></inertial>"#;

fn compiled(text: &str) -> linkwear_codegen::Compiled {
    let source = SourceFile { name: "made.toml".to_owned(), text: text.to_owned() };
    compile(&source, &Options::default()).unwrap_or_else(|errors| panic!("{errors}\n{text}"))
}

#[test]
fn joints_of_every_type_are_mechanisms() {
    for (kind, made) in [
        ("revolute", "revolute = [\"ground\", \"b\"]"),
        ("continuous", "revolute = [\"ground\", \"b\"]"),
        ("prismatic", "prismatic = [\"ground\", \"b\"]"),
        ("planar", "planar = [\"ground\", \"b\"]"),
        ("floating", "free = [\"ground\", \"b\"]"),
    ] {
        let found = from_urdf(&one(kind, MASS, ""), Base::Fixed).expect("a robot");
        assert!(found.text.contains(made), "{kind}: {}", found.text);
        assert_eq!((found.bodies, found.joints), (1, 1));
        compiled(&found.text);
    }
}

#[test]
fn the_shipped_arm_compiles_held_and_floating() {
    let held = from_urdf(ARM, Base::Fixed).expect("a robot");
    assert_eq!((held.bodies, held.joints), (7, 7));
    compiled(&held.text);
    let floating = from_urdf(ARM, Base::Floating).expect("a robot");
    assert_eq!((floating.bodies, floating.joints), (8, 8));
    assert!(floating.text.contains("free = [\"ground\", \"world\"]"), "{}", floating.text);
    compiled(&floating.text);
    // Advice is by the names of the file that is made.
    let hyphen = one("revolute", MASS, "<dynamics friction=\"0.2\"/>").replace("name=\"j\"", "name=\"j-1\"");
    let found = from_urdf(&hyphen, Base::Fixed).expect("a robot");
    assert!(found.text.contains("j_1 = {"), "{}", found.text);
    assert!(found.left_out.iter().any(|line| line.contains("tanh(j_1.v/")), "{:?}", found.left_out);
    for what in ["friction of shoulder_pan", "<visual>, 9 times", "fixed joints, 3", "limits of 7", "gravity"]
    {
        assert!(held.left_out.iter().any(|line| line.contains(what)), "{what}: {:?}", held.left_out);
    }
}

#[test]
fn what_joints_of_several_coordinates_lose_is_told() {
    let more = "<dynamics damping=\"0.5\" friction=\"0.2\"/><limit effort=\"7\" velocity=\"2\"/>\
                <safety_controller k_velocity=\"1\"/><calibration rising=\"0\"/>";
    for kind in ["planar", "floating"] {
        let found = from_urdf(&one(kind, MASS, more), Base::Fixed).expect("a robot");
        for what in
            ["damping 0.5", "friction 0.2", "effort 7", "velocity 2", "<safety_controller>", "<calibration>"]
        {
            assert!(
                found.left_out.iter().any(|line| line.contains(what)),
                "{kind} {what}: {:?}",
                found.left_out
            );
        }
    }
}

/// Two halves of a bar fixed to each other are the bar.
#[test]
fn links_that_are_fixed_to_each_other_are_one_body() {
    let half = |name: &str, mass: f64| {
        // A thin bar of 1 m along x, from the origin of its link.
        let turn = mass / 12.0;
        format!(
            "<link name=\"{name}\"><inertial><origin xyz=\"0.5 0 0\"/><mass value=\"{mass}\"/><inertia ixx=\"1e-6\" iyy=\"{turn}\" izz=\"{turn}\"/></inertial></link>\n"
        )
    };
    let text = format!(
        "<robot name=\"bar\"><link name=\"world\"/>{}{}<joint name=\"j\" type=\"continuous\"><parent link=\"world\"/><child link=\"near\"/><axis xyz=\"0 0 1\"/></joint>\n\
         <joint name=\"f\" type=\"fixed\"><parent link=\"near\"/><child link=\"far\"/><origin xyz=\"1 0 0\"/></joint></robot>",
        half("near", 3.0),
        half("far", 3.0)
    );
    let found = from_urdf(&text, Base::Fixed).expect("a robot");
    // 6 kg, 2 m: m l^2 / 12 = 2.
    assert!(found.text.contains("mass = \"6 kg\", centre = [\"1.0 m\", 0, 0]"), "{}", found.text);
    assert!(found.text.contains("\"2.0 kg m^2\", \"2.0 kg m^2\""), "{}", found.text);
}

/// Three links on two joints, the second of which follows the first.
fn pair(kinds: [&str; 2], mimic: &str) -> String {
    let joint = |name: &str, kind: &str, parent: &str, child: &str, inside: &str| {
        format!(
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>{inside}</joint>\n"
        )
    };
    format!(
        "<robot name=\"pair\">\n<link name=\"a\"/>\n<link name=\"b\">{MASS}</link>\n<link name=\"c\">{MASS}</link>\n{}{}</robot>\n",
        joint("lead", kinds[0], "a", "b", ""),
        joint("follow", kinds[1], "b", "c", mimic)
    )
}

#[test]
fn a_joint_that_mimics_another_is_a_relation() {
    let mimic = r#"<mimic joint="lead" multiplier="2.5" offset="0.125"/>"#;
    for (kinds, factor, offset) in [
        (["revolute", "continuous"], "-2.5", "0.125 rad"),
        (["prismatic", "prismatic"], "-2.5", "0.125 m"),
        (["revolute", "prismatic"], "\"-2.5 m\"", "0.125 m"),
        (["prismatic", "revolute"], "\"-2.5 1/m\"", "0.125 rad"),
    ] {
        let found = from_urdf(&pair(kinds, mimic), Base::Fixed).expect("a robot");
        let made = format!(
            "follow_follows = {{ relation = {{ follow = 1, lead = {factor} }}, offset = \"{offset}\" }}"
        );
        assert!(found.text.contains(&made), "{}", found.text);
        // One freedom is left of two, and the loops close with the offset.
        let compiled = compiled(&found.text);
        assert_eq!(compiled.mechanism.couplings.len(), 1);
        assert_eq!(compiled.analysis.mobility, 1, "{kinds:?}");
    }
    let told = |found: &Imported| found.left_out.iter().any(|line| line.contains("moves alone"));
    for (kinds, mimic) in [
        (["floating", "revolute"], mimic),
        (["revolute", "planar"], mimic),
        (["fixed", "revolute"], mimic),
        (["revolute", "revolute"], r#"<mimic joint="lead" multiplier="0"/>"#),
    ] {
        let found = from_urdf(&pair(kinds, mimic), Base::Fixed).expect("a robot");
        assert!(told(&found) && !found.text.contains("[couplings]"), "{:?}", found.left_out);
        compiled(&found.text);
    }
    for (mimic, message) in [
        (r#"<mimic joint="other"/>"#, "`other`, which is not in the file"),
        (r#"<mimic joint="follow"/>"#, "mimics itself"),
        (r#"<mimic joint="lead" multiplier="x"/>"#, "\"x\""),
        ("<mimic/>", "no `joint`"),
    ] {
        let error =
            from_urdf(&pair(["revolute", "revolute"], mimic), Base::Fixed).expect_err("no such mimic");
        assert!(error.message.contains(message) && error.line == 6, "{message}: {error:?}");
    }
}

#[test]
fn files_that_are_no_robots_are_refused_with_line_and_cure() {
    let deep = "<a>".repeat(100_000);
    let loops = "<robot name=\"r\"><link name=\"a\"/>\n<link name=\"b\"/><link name=\"c\"/><joint name=\"j\" type=\"fixed\"><parent link=\"b\"/><child link=\"c\"/></joint>\
                 <joint name=\"k\" type=\"fixed\"><parent link=\"c\"/><child link=\"b\"/></joint></robot>";
    let cases: Vec<(String, &str, usize)> = vec![
        (String::new(), "no XML", 1),
        ("<robot>\n<link></robot>".to_owned(), "no XML", 2),
        (deep, "no XML", 1),
        ("<sdf/>".to_owned(), "not of <robot> or <mujoco>", 1),
        (format!("{}{}", "<a>".repeat(1000), "</a>".repeat(1000)), "more than 300 deep", 1),
        ("<robot/>".to_owned(), "no links", 1),
        (loops.to_owned(), "circle", 1),
        ("<robot name=\"r\">\n<link/></robot>".to_owned(), "no `name`", 2),
        (one("hinge", MASS, ""), "type \"hinge\"", 4),
        (one("revolute", "", "") + " ", "left", 0),
        (one("revolute", &MASS.replace("\"2\"", "\"-2\""), ""), "mass of link `b` is -2", 3),
        (one("revolute", &MASS.replace("\"2\"", "\"nan\""), ""), "\"nan\"", 3),
        (one("revolute", &MASS.replace("\"2\"", "\"0\""), ""), "inertia and no mass", 3),
        (one("revolute", MASS, "<axis xyz=\"0 0 0\"/>"), "0 0 0", 4),
        (one("revolute", MASS, "<axis xyz=\"0 1\"/>"), "is \"0 1\"", 4),
        (one("revolute", MASS, "<dynamics damping=\"-1\"/>"), "damping", 4),
        (one("revolute", MASS, "").replace("child link=\"b\"", "child link=\"c\""), "not in the file", 4),
        ("<!DOCTYPE r [<!ENTITY a \"b\">]><robot/>".to_owned(), "no XML", 1),
    ];
    for (text, told, line) in cases {
        match from_urdf(&text, Base::Fixed) {
            // A link without mass that carries nothing: no fault, and told.
            Ok(found) => assert!(line == 0 && found.bodies == 0, "{text}"),
            Err(error) => {
                assert!(error.message.contains(told) && error.line == line, "{told}: {error:?}");
                assert!(!error.cure.is_empty());
            }
        }
    }
    let carries = ARM.replace("<mass value=\"2.33\"/>", "<mass value=\"0\"/>");
    let error = from_urdf(&carries, Base::Fixed).expect_err("no mass");
    assert!(error.message.contains("forearm"), "{error:?}");
}

#[test]
fn robots_have_so_many_links_in_either_format_and_no_more() {
    // A chain of hinges without masses: all of it is left out, from its end on.
    let chain = |links: usize| {
        let link = |at: usize| format!("<link name=\"l{at}\"/>\n");
        let joint = |at: usize| {
            let sides = format!("<parent link=\"l{}\"/><child link=\"l{at}\"/>", at - 1);
            format!("<joint name=\"j{at}\" type=\"continuous\">{sides}</joint>\n")
        };
        let links: String = (0..links).map(link).chain((1..links).map(joint)).collect();
        format!("<robot name=\"r\">\n{links}</robot>\n")
    };
    let found = from_urdf(&chain(2000), Base::Fixed).expect("a robot");
    assert_eq!((found.bodies, found.left_out.len()), (0, 2000));
    let error = from_urdf(&chain(2001), Base::Fixed).expect_err("one too many");
    assert!(error.message.contains("more than 2000 links") && error.line == 2002, "{error:?}");
}

/// A letter of a file in another place, the file cut there, a word in the place of a word: by a step that meets all parts.
fn mutants(text: &str) -> impl Iterator<Item = [String; 3]> + '_ {
    const WORDS: [&str; 9] =
        ["", "0", "-1", "1e400", "nan", "1e-300 1e300 -1e300", "world", "\u{e9}", "true"];
    let words: Vec<(usize, &str)> = text.match_indices('"').collect();
    (0..600).map(move |at| {
        let bytes = text.as_bytes();
        let mut changed = bytes.to_vec();
        let (to, from) = ((at * 7919) % bytes.len(), (at * 104_729) % bytes.len());
        changed[to] = bytes[from];
        let quoted = 2 * ((at * 7919) % (words.len() / 2));
        let (start, end) = (words[quoted].0 + 1, words[quoted + 1].0);
        let replaced = format!("{}{}{}", &text[..start], WORDS[at % WORDS.len()], &text[end..]);
        let cut = text[..text.floor_char_boundary(to)].to_owned();
        [String::from_utf8_lossy(&changed).into_owned(), cut, replaced]
    })
}

/// An answer, or a fault with its place and cure; what is written is TOML.
fn answered(text: &str, base: Base, files: &dyn Files) {
    for density in [None, Some(1000.0)] {
        match from_robot(text, base, density, files) {
            Ok(found) => {
                let made = found.text.parse::<toml::Table>();
                assert!(made.is_ok(), "{made:?}\n{}\n{text}", found.text);
            }
            Err(error) => {
                assert!(error.line > 0 && !error.message.is_empty() && !error.cure.is_empty(), "{error:?}");
            }
        }
    }
}

#[test]
fn cut_and_mutated_files_are_answered() {
    for mutant in mutants(ARM) {
        mutant.iter().for_each(|text| answered(text, Base::Fixed, &NoFiles));
        answered(&mutant[1], Base::Floating, &NoFiles);
    }
}

#[test]
fn all_faults_of_links_and_joints_are_told_at_once() {
    let text = "<robot name=\"b\">\n<link name=\"base\"/>\n\
        <link name=\"a\"><inertial><mass value=\"-2\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial></link>\n<link name=\"c\"/>\n\
        <joint name=\"j\" type=\"revolute\"><parent link=\"base\"/><child link=\"a\"/><axis xyz=\"0 0 0\"/></joint>\n\
        <joint name=\"k\" type=\"ball\"><parent link=\"a\"/><child link=\"c\"/></joint>\n\
        <joint name=\"l\" type=\"fixed\"><parent link=\"a\"/><child link=\"zzz\"/></joint>\n</robot>";
    let first = from_urdf(text, Base::Fixed).expect_err("faults");
    let all: Vec<(usize, &str)> =
        std::iter::once(&first).chain(&first.others).map(|fault| (fault.line, &*fault.message)).collect();
    let [mass, axis, kind, link] = all[..] else { panic!("{all:?}") };
    assert!(mass.0 == 3 && mass.1.contains("mass"), "{mass:?}");
    assert!(axis.0 == 5 && axis.1.contains("axis of joint `j`"), "{axis:?}");
    assert!(kind.0 == 6 && kind.1.contains("ball"), "{kind:?}");
    assert!(link.0 == 7 && link.1.contains("`zzz`"), "{link:?}");
}
