//! The shipped mechanisms: they resolve without warnings, and loops are cut where a person would cut them.

use linkwear_codegen::input::Reach;
use linkwear_codegen::model::topology::spanning_tree;
use linkwear_codegen::model::{Carrier, Mechanism, Overrides, Topology, resolve};
use linkwear_codegen::source::SourceFile;
use linkwear_codegen::spec;

fn source(name: &str) -> SourceFile {
    let path = format!("{}/../mechanisms/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    SourceFile { name: format!("mechanisms/{name}.toml"), text: std::fs::read_to_string(path).unwrap() }
}

fn read(name: &str) -> (Mechanism, Topology) {
    read_with(name, &Overrides::default())
}

fn read_with(name: &str, overrides: &Overrides) -> (Mechanism, Topology) {
    let source = source(name);
    let spec = spec::parse(&source).unwrap_or_else(|errors| panic!("{errors}"));
    let (mechanism, warnings) =
        resolve(&spec, overrides, Reach::Below).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(warnings, [], "{name}");
    assert_eq!(mechanism.name, name);
    let topology = spanning_tree(&mechanism).unwrap_or_else(|errors| panic!("{}", errors.located(&source)));
    (mechanism, topology)
}

/// Tree joints as `inboard joint> outboard` and the names of the cuts.
fn shape(mechanism: &Mechanism, topology: &Topology) -> (Vec<String>, Vec<String>) {
    let step = |step: &linkwear_codegen::model::TreeJoint| {
        let arrow = if step.reversed { "<" } else { ">" };
        let joint = &mechanism.joint(step.joint).name;
        let inboard = mechanism.carrier_name(step.inboard);
        format!("{inboard} {joint}{arrow} {}", mechanism.carrier_name(Carrier::Body(step.outboard)))
    };
    let cuts = topology.cuts.iter().map(|id| mechanism.joint(*id).name.clone()).collect();
    (topology.tree.iter().map(step).collect(), cuts)
}

#[test]
fn rssr_is_cut_at_the_ball_that_the_file_leaves_open() {
    let (mechanism, topology) = read("rssr_rigid");
    let (tree, cuts) = shape(&mechanism, &topology);
    assert_eq!(tree, ["ground R1> crank", "ground R4> rocker", "crank S2> coupler"]);
    assert_eq!(cuts, ["S3"]);
}

#[test]
fn rssr_carries_the_numbers_of_the_case_study() {
    let (mechanism, _) = read("rssr_rigid");
    let values = mechanism.parameter_values();
    let parameter = |name: &str| mechanism.parameters.iter().find(|p| p.name == name).unwrap();
    assert_eq!(parameter("L2").value, 0.42);
    assert_eq!(parameter("L2").dimension.si_unit(), "m");
    assert!(parameter("speed").tunable && !parameter("speed").assumed);
    assert!(parameter("c_rocker").assumed);
    let b = mechanism.points.iter().find(|point| point.name == "B").unwrap();
    assert_eq!(mechanism.carrier_name(b.carrier), "coupler");
    let rocker = Carrier::Body(linkwear_codegen::id::BodyId::new(2));
    assert_eq!(b.position_for(rocker).clone().map(|x| x.value(&values).unwrap()), [0.35 + 0.26, 0.05, -0.3]);
    // 2 pi times 2 Hz times 0.125 s is a quarter of a turn, to the last bit or so.
    let law = &mechanism.joints[0].drives[0].law;
    assert!((law.value_at_time(&values, 0.125).unwrap() - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert_eq!(mechanism.gravity.clone().map(|g| g.value(&values).unwrap()), [0.0, 0.0, -9.81]);
    let start = &mechanism.starts[0];
    assert!(!start.held);
    assert_eq!(start.position.as_ref().unwrap().value(&values), Some(-48.0 * std::f64::consts::PI / 180.0));
}

#[test]
fn pendulum_has_no_loop() {
    let (mechanism, topology) = read("pendulum");
    assert_eq!(shape(&mechanism, &topology), (vec!["ground hinge> rod".to_owned()], vec![]));
}

#[test]
fn four_bar_is_cut_at_the_joint_that_the_file_leaves_open() {
    let (mechanism, topology) = read("four_bar");
    let (tree, cuts) = shape(&mechanism, &topology);
    assert_eq!(tree, ["ground R1> crank", "ground R4> rocker", "crank R2> coupler"]);
    assert_eq!(cuts, ["R3"]);
}

#[test]
fn slider_crank_is_cut_at_the_ball() {
    let (mechanism, topology) = read("slider_crank");
    let (tree, cuts) = shape(&mechanism, &topology);
    assert_eq!(tree, ["ground crank_bearing> crank", "ground guide> piston", "piston piston_pin> rod"]);
    assert_eq!(cuts, ["crank_pin"]);
}

#[test]
fn overrides_replace_values_and_what_follows_from_them() {
    let overrides = Overrides::parse(["L1=0.13 m", "speed=600 rpm"]).unwrap();
    let (mechanism, _) = read_with("rssr_rigid", &overrides);
    let values = mechanism.parameter_values();
    assert_eq!(values[0], 0.13);
    let tip = &mechanism.points[1].position_for(Carrier::Ground)[0];
    assert_eq!(tip.value(&values), Some(0.13));
    let speed = mechanism.parameters.iter().find(|p| p.name == "speed").unwrap();
    assert_eq!(speed.value, 10.0, "rpm is a frequency as Hz is");
}

/// The whole front end of an RSSR file stays far below what a person or a build notices.
#[test]
fn front_end_takes_under_five_milliseconds() {
    let source = source("rssr_rigid");
    let fastest = (0..20)
        .map(|_| {
            let start = std::time::Instant::now();
            let spec = spec::parse(&source).unwrap();
            let (mechanism, _) = resolve(&spec, &Overrides::default(), Reach::Below).unwrap();
            spanning_tree(&mechanism).unwrap();
            start.elapsed()
        })
        .min()
        .unwrap();
    // Measured 0.1 ms; the fastest of many runs, so that a busy machine does not fail it.
    assert!(fastest.as_secs_f64() < 5e-3, "{fastest:?}");
}
