//! What triangles enclose, against closed forms; files that are no meshes.

use std::f64::consts::PI;

use super::super::mass::{Mass, Shape};
use super::super::place::{Matrix, Place, rotation};
use super::super::solid::Solid;
use super::super::stl::{Triangle, triangles};

/// A binary STL file.
pub fn binary(header: &[u8], mesh: &[Triangle]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend((mesh.len() as u32).to_le_bytes());
    for triangle in mesh {
        bytes.extend([0; 12]);
        triangle.iter().flatten().for_each(|x| bytes.extend((*x as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn text(mesh: &[Triangle]) -> String {
    let mut text = "solid of a test\n".to_owned();
    for triangle in mesh {
        text.push_str("facet normal 0 0 1\nouter loop\n");
        triangle.iter().for_each(|[x, y, z]| text.push_str(&format!("vertex {x} {y} {z}\n")));
        text.push_str("endloop\nendfacet\n");
    }
    text + "endsolid of a test\n"
}

/// A box from the origin.
pub fn block(size: [f64; 3]) -> Vec<Triangle> {
    let at = |corner: usize| std::array::from_fn(|i| if corner >> i & 1 == 1 { size[i] } else { 0.0 });
    let faces: [[usize; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).map(|face| face.map(at)).collect()
}

/// A surface around an axis: rings of `sides` corners, their radius and height by number, with caps to a point.
fn turned(sides: usize, profile: &[[f64; 2]]) -> Vec<Triangle> {
    let at = |ring: usize, side: usize| {
        let [radius, z] = profile[ring];
        let angle = 2.0 * PI * (side % sides) as f64 / sides as f64;
        [radius * angle.cos(), radius * angle.sin(), z]
    };
    let mut mesh = Vec::new();
    for side in 0..sides {
        for ring in 1..profile.len() {
            let (a, b) = (at(ring - 1, side), at(ring - 1, side + 1));
            let (c, d) = (at(ring, side + 1), at(ring, side));
            mesh.extend([[a, b, c], [a, c, d]].into_iter().filter(|[p, q, r]| p != q && q != r && r != p));
        }
    }
    mesh
}

fn moved(mesh: &[Triangle], place: &Place) -> Vec<Triangle> {
    mesh.iter().map(|triangle| triangle.map(|corner| place.point(corner))).collect()
}

fn assert_near(found: &Mass, expected: &Mass, share: f64) {
    let flat = |m: &Matrix| m.iter().flatten().copied().collect::<Vec<f64>>();
    let size = flat(&expected.inertia).into_iter().fold(0.0, f64::max);
    assert!((found.mass / expected.mass - 1.0).abs() < share, "{found:?} {expected:?}");
    for i in 0..3 {
        assert!((found.centre[i] - expected.centre[i]).abs() < share, "{found:?} {expected:?}");
    }
    for (a, b) in flat(&found.inertia).into_iter().zip(flat(&expected.inertia)) {
        assert!((a - b).abs() < share * size, "{found:?} {expected:?}");
    }
}

#[test]
fn a_box_far_off_and_turned_is_that_of_its_formula() {
    let size = [0.3, 0.2, 0.1];
    let half = size.map(|x| 0.5 * x);
    let middle = Place { origin: half, ..Place::default() };
    let place = Place::turned([3.0, -2.0, 5.0], rotation([2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0], 1.1));
    let expected = Shape::Box { half }.of_mass(6.0).seen_from(&middle).seen_from(&place);
    let solid = Solid::enclosed(&moved(&block(size), &place)).expect("closed");
    // Corners rounded at a distance of 6 m, lengths of 0.1 m.
    assert_near(&solid.of_density(1000.0), &expected, 1e-13);
    assert_near(&solid.of_mass(6.0), &expected, 1e-13);
    assert!(!solid.is_inside_out);
}

#[test]
fn a_tetrahedron_is_that_of_its_formula() {
    let (o, a, b, c) = ([0.0; 3], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 4.0]);
    let mut mesh = vec![[o, b, a], [o, a, c], [o, c, b], [a, b, c]];
    // V = abc/6; about the corner the moments of second order are V a^2/10 and V ab/20, the centre is at a quarter.
    let v = 4.0;
    let moment = |i: usize, j: usize| {
        let d = [2.0, 3.0, 4.0];
        v * d[i] * d[j] * (if i == j { 1.0 / 10.0 } else { 1.0 / 20.0 } - 1.0 / 16.0)
    };
    let trace: f64 = (0..3).map(|i| moment(i, i)).sum();
    let inertia =
        std::array::from_fn(|i| std::array::from_fn(|j| if i == j { trace } else { 0.0 } - moment(i, j)));
    let expected = Mass { mass: v, centre: [0.5, 0.75, 1.0], inertia };
    assert_near(&Solid::enclosed(&mesh).expect("closed").of_density(1.0), &expected, 1e-14);
    mesh.iter_mut().for_each(|triangle| triangle.swap(0, 1));
    let inside_out = Solid::enclosed(&mesh).expect("closed");
    assert!(inside_out.is_inside_out);
    assert_near(&inside_out.of_density(1.0), &expected, 1e-14);
}

#[test]
fn round_solids_come_near_to_their_formulas_as_their_sides_do() {
    let arc = |rings: usize, half: f64, radius: f64| -> Vec<[f64; 2]> {
        let angle = |ring: usize| PI * ring as f64 / rings as f64;
        let at = |ring: usize| {
            let sine = if ring.is_multiple_of(rings) { 0.0 } else { angle(ring).sin() };
            let z = -radius * angle(ring).cos();
            [radius * sine, z + half * if 2 * ring < rings { -1.0 } else { 1.0 }]
        };
        (0..=rings).map(at).collect()
    };
    let (radius, half) = (0.05, 0.08);
    let cylinder = [[0.0, -half], [radius, -half], [radius, half], [0.0, half]];
    for (shape, profile, share) in [
        (Shape::Cylinder { radius, half }, cylinder.to_vec(), 2.0),
        (Shape::Sphere { radius }, arc(201, 0.0, radius), 4.0),
        (Shape::Capsule { radius, half }, arc(201, half, radius), 4.0),
    ] {
        let expected = shape.of_mass(shape.volume());
        let solid = Solid::enclosed(&turned(200, &profile)).expect("closed");
        // A polygon of n sides has less than its circle by (2 pi/n)^2/6 of the area, twice that of the moment.
        let missing = share * (2.0 * PI / 200.0_f64).powi(2) / 6.0;
        assert_near(&solid.of_density(1.0), &expected, 1.5 * missing);
    }
    let ellipsoid = Shape::Ellipsoid { half: [radius; 3] };
    assert_near(&ellipsoid.of_mass(2.0), &Shape::Sphere { radius }.of_mass(2.0), 1e-15);
}

/// A box that faces inwards, in a place.
fn hole(size: [f64; 3], origin: [f64; 3]) -> Vec<Triangle> {
    let mut mesh = moved(&block(size), &Place { origin, ..Place::default() });
    mesh.iter_mut().for_each(|triangle| triangle.swap(0, 1));
    mesh
}

#[test]
fn a_surface_turned_inwards_is_a_hole_within_another_only() {
    let whole = block([2.0, 2.0, 2.0]);
    let volume = |parts: &[&[Triangle]]| Solid::enclosed(&parts.concat()).map(|solid| solid.volume);
    let within = hole([0.5, 0.5, 0.5], [0.3, 0.4, 0.5]);
    // On a face of the whole, on that of another hole, and a solid in a hole.
    let (on_face, beside) =
        (hole([0.5, 0.5, 0.5], [0.3, 0.4, 0.0]), hole([0.5, 0.5, 0.4], [0.8, 0.45, 0.55]));
    let island = moved(&block([0.1, 0.1, 0.1]), &Place { origin: [0.5, 0.6, 0.7], ..Place::default() });
    for (parts, expected) in [
        (vec![&whole[..], &within], 8.0 - 0.125),
        (vec![&within, &whole], 8.0 - 0.125),
        (vec![&whole, &on_face], 8.0 - 0.125),
        (vec![&whole, &within, &beside], 8.0 - 0.125 - 0.1),
        (vec![&whole, &within, &island], 8.0 - 0.125 + 0.001),
    ] {
        let found = volume(&parts).expect("holes within");
        // Sums of some products of numbers below 8.
        assert!((found - expected).abs() < 1e-14 * 8.0, "{found}, not {expected}");
    }
    let aside = hole([0.5, 0.5, 0.5], [5.0, 0.0, 0.0]);
    let nested = hole([0.1, 0.1, 0.1], [0.5, 0.6, 0.7]);
    let flush = hole([0.5, 0.5, 0.5], [0.3, 0.4, 2.0]);
    for parts in
        [vec![&whole[..], &aside], vec![&aside, &whole], vec![&whole, &flush], vec![&whole, &within, &nested]]
    {
        let why = volume(&parts).expect_err("a hole in nothing");
        assert!(why.contains("a hole in nothing"), "{why}");
    }
}

#[test]
fn surfaces_that_enclose_nothing_are_told() {
    let mut open = block([1.0, 1.0, 1.0]);
    open.pop();
    let mut turned = block([1.0, 1.0, 1.0]);
    turned[3].swap(0, 1);
    let flat = block([1.0, 1.0, 0.0]);
    for (mesh, told) in [
        (open, "it is not closed: 3 of 18 edges"),
        (turned, "do not all face outwards: along 3 of 18 edges"),
        (flat, "encloses no volume"),
        (block([1e-120, 1e-120, 1e-120]), "beyond what can be computed"),
    ] {
        let why = Solid::enclosed(&mesh).expect_err("no solid");
        assert!(why.contains(told), "{told}: {why}");
    }
}

#[test]
fn text_and_binary_say_the_same_whatever_their_header() {
    let mesh = block([1.0, 2.0, 0.5]);
    let written = text(&mesh);
    let twice = format!("{written}{}", written.replace("vertex 0", "vertex -0"));
    for (bytes, many) in [
        (binary(b"made by a test", &mesh), 1),
        (binary(b"solid made by a test", &mesh), 1),
        ([binary(b"with a line end", &mesh), b"\n".to_vec()].concat(), 1),
        (written.clone().into_bytes(), 1),
        (written.replace("solid of a test", "solid").into_bytes(), 1),
        (format!("\n {}", written.to_uppercase()).into_bytes(), 1),
        (written.replace('\n', "\r\n").into_bytes(), 1),
        (twice.into_bytes(), 2),
    ] {
        let found = triangles(&bytes).expect("a mesh");
        let expected = vec![mesh.clone(); many].concat();
        assert_eq!(found, expected);
    }
}

#[test]
fn files_that_are_no_meshes_are_told() {
    let mesh = block([1.0, 2.0, 0.5]);
    let whole = binary(b"", &mesh);
    let cut = whole[..whole.len() - 30].to_vec();
    for (bytes, told) in [
        (Vec::new(), "too short"),
        (cut, "for a binary file of 12 triangles it has 654 bytes in place of 684"),
        (binary(b"", &[]), "no triangles"),
        (b"solid\nendsolid".to_vec(), "no triangles"),
        (text(&mesh).replace("vertex 1", "vertex x").into_bytes(), "invalid float"),
        (text(&mesh).replace("vertex 1", "vertex 1e999").into_bytes(), "expected finite"),
        (binary(b"", &[[[f64::NAN; 3]; 3]]), "not at finite coordinates"),
        (b"ply\nformat ascii 1.0\n".to_vec(), "too short"),
    ] {
        let why = triangles(&bytes).expect_err("no mesh");
        assert!(why.contains(told), "{told}: {why}");
    }
    for at in 0..2000 {
        for file in [whole.clone(), text(&mesh).into_bytes()] {
            let mut changed = file.clone();
            let (to, from) = ((at * 7919) % file.len(), (at * 104_729) % file.len());
            changed[to] = changed[from] ^ (at as u8);
            if let Ok(mesh) = triangles(&changed) {
                let _ = Solid::enclosed(&mesh);
            }
            let _ = triangles(&changed[..to]);
        }
    }
}
