//! Modal data files: what is written reads back, and what is wrong is refused with its place.

use super::*;

fn sample(second_order: bool) -> ModalData {
    let mut input = rod(Theory::Timoshenko, Hold::Pinned(None), 4);
    input.second_order = second_order;
    let beam = Beam::new(&input).expect("a rod");
    beam.modal_data(&[("start", 0.0), ("middle", 0.2), ("end", LENGTH)]).expect("on the rod")
}

fn refused(change: impl Fn(&mut ModalData)) -> DataError {
    let mut data = sample(true);
    change(&mut data);
    data.check().expect_err("refused")
}

fn unread(from: &str, to: &str) -> FileError {
    let text = sample(false).to_toml().expect("sound data");
    assert!(text.contains(from), "{text}");
    ModalData::from_toml(&text.replacen(from, to, 1)).expect_err("refused")
}

#[test]
fn what_is_written_reads_back_to_the_same_bits() {
    for second_order in [false, true] {
        let data = sample(second_order);
        let text = data.to_toml().expect("sound data");
        let read = ModalData::from_toml(&text).expect("its own file");
        let bits = |data: &ModalData| serde_json::to_string(data).expect("numbers");
        assert_eq!(bits(&read), bits(&data));
        assert_eq!(read.to_toml().expect("sound data"), text);
    }
}

#[test]
fn a_rigid_body_is_a_file_too() {
    let data = data(&rod(Theory::Timoshenko, Hold::Pinned(None), 0));
    let text = data.to_toml().expect("sound data");
    assert_eq!(ModalData::from_toml(&text), Ok(data));
}

#[test]
fn headers_must_be_the_known_ones() {
    assert!(matches!(unread("SI", "mm"), FileError::Header { key: "units", .. }));
    assert!(matches!(unread("version = 1", "version = 2"), FileError::Header { key: "version", .. }));
    assert!(matches!(unread("order = 1", "order = 3"), FileError::Order { found: 3 }));
}

#[test]
fn unknown_keys_are_refused() {
    assert!(matches!(unread("first_moment", "first_momentum"), FileError::Syntax { .. }));
    assert!(matches!(unread("gamma", "gama"), FileError::Syntax { .. }));
}

#[test]
fn pairs_name_known_modes_once() {
    let unknown = unread(r#"modes = ["y1", "y1"]"#, r#"modes = ["y1", "y9"]"#);
    assert_eq!(unknown, FileError::UnknownMode { place: "coupling".to_owned(), name: "y9".to_owned() });
    let twice = unread(r#"modes = ["z1", "z1"]"#, r#"modes = ["z1", "y1"]"#);
    assert!(matches!(twice, FileError::PairTwice { .. }), "{twice}");
}

#[test]
fn numbers_that_belong_to_no_body_are_refused() {
    let positive = |place: &str| DataError::NotPositive { place: place.to_owned(), definite: true };
    assert_eq!(refused(|data| data.stiffness[0][0] = -1.0), positive("stiffness"));
    assert_eq!(refused(|data| data.mass_matrix[1][1] = 0.0), positive("mass_matrix"));
    assert_eq!(refused(|data| data.second_moment[2][2] = -1e-9), positive("second_moment"));
    assert!(matches!(refused(|data| data.mass = 0.0), DataError::NotPositive { definite: false, .. }));
    let negative = refused(|data| data.modes[1].frequency = -1.0);
    assert!(matches!(negative, DataError::Negative { .. }), "{negative}");
    assert!(matches!(refused(|data| data.damping[0][1] = 1.0), DataError::NotSymmetric { .. }));
    assert!(matches!(refused(|data| data.coupling[0][1][1][2] = 0.5), DataError::NotSymmetric { .. }));
    assert!(matches!(refused(|data| data.gamma[0][1] = f64::NAN), DataError::NotFinite { .. }));
    assert_eq!(refused(|data| data.gamma[0][1] *= 2.0), DataError::NegativeMass);
    assert!(matches!(refused(|data| data.nodes[1].name = "end".to_owned()), DataError::Twice { .. }));
    assert!(matches!(refused(|data| data.nodes[1].displacement2 = None), DataError::Order { .. }));
    let short = refused(|data| data.nodes[2].rotation.truncate(3));
    assert_eq!(short, DataError::Length { place: "rotation of node end".to_owned(), found: 3, expected: 4 });
}

#[test]
fn lists_are_as_long_as_they_must_be() {
    for (from, to) in [
        ("first_moment = [", "first_moment = [0.0, "),
        ("second_moment = [[", "second_moment = [[0.0, "),
        (r#"modes = ["z1", "z1"]"#, r#"modes = ["z1", "z1", "y1"]"#),
        ("gamma = [", "gamma = [0.0, "),
        ("position = [", "position = [0.0, "),
        ("displacement = [[", "displacement = [[0.0, "),
    ] {
        let error = unread(from, to).to_string();
        assert!(error.contains("are needed"), "{from}: {error}");
    }
}

#[test]
fn the_documented_example_is_a_file() {
    let documented = include_str!("../../../../docs/modal-data.md");
    let example = documented.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next());
    let data = ModalData::from_toml(example.expect("an example")).expect("sound data");
    assert_eq!(data.node("tip").map(|node| node.displacement.len()), Some(2));
    assert_eq!(data.coupling[1][0][2][1], 2.0);
}

#[test]
fn couplings_of_no_body_are_refused() {
    let scaled = |data: &mut ModalData, k: usize, factor: f64| {
        data.coupling[k][k].iter_mut().flatten().for_each(|entry| *entry *= factor);
    };
    for (factor, missing) in [(0.0, true), (0.5, false)] {
        let DataError::Products { modes, missing: found } = refused(|data| scaled(data, 0, factor)) else {
            panic!("another fault")
        };
        assert_eq!((modes.len(), found), (1, missing));
    }
    // Two shapes whose product is larger than both.
    let together = refused(|data| {
        let size = 2.0 * data.mass_matrix[0][0].max(data.mass_matrix[1][1]);
        (data.coupling[0][1][1][1], data.coupling[1][0][1][1]) = (size, size);
    });
    assert!(matches!(together, DataError::Products { modes, .. } if modes.len() > 1));
}

#[test]
fn masses_of_modes_are_held_against_their_couplings() {
    let mut data = sample(false);
    assert_eq!(data.mass_beside_products(), None);
    data.coupling[0][0].iter_mut().flatten().for_each(|entry| *entry *= 1.02);
    assert_eq!(data.check(), Ok(()));
    let (modes, [mass, product]) = data.mass_beside_products().expect("they differ");
    assert_eq!((modes, mass), ([0, 0], data.mass_matrix[0][0]));
    // The mass is the trace but for the quadrature of a mesh.
    assert!((product / mass - 1.02).abs() < 1e-9, "{product} {mass}");
}
