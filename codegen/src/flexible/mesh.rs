//! How a beam is cut into elements, and its elements in each family of motion.
//! In: a checked beam. Out: elements short enough, of a degree high enough, for the modes asked for.

use std::f64::consts::PI;

use super::beam::{BeamInput, Counts, Hold, Theory, same_place};
use super::element::{Element, Rigidity};
use super::line::{Anchor, Line};
use super::section::{Material, Properties};

/// A family of motion that does not couple with the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Bending along y.
    Y,
    /// Bending along z.
    Z,
    /// Stretching along x.
    Axial,
    /// Twisting about x.
    Torsion,
}

impl Family {
    /// All of them; their order is the order of [`Mesh::lines`].
    pub const ALL: [Self; 4] = [Self::Y, Self::Z, Self::Axial, Self::Torsion];

    /// First letter of the names of its modes.
    pub fn letter(self) -> &'static str {
        match self {
            Self::Y => "y",
            Self::Z => "z",
            Self::Axial => "x",
            Self::Torsion => "t",
        }
    }
}

/// A beam cut into elements.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Places between elements, ends included [m].
    pub stations: Vec<f64>,
    /// Segment of every element.
    pub segments: Vec<usize>,
    /// The elements of each family, in the order of [`Family::ALL`].
    pub lines: Vec<Line>,
}

/// Longest element, in radians of the shortest wave to resolve.
const LONGEST: f64 = 1.5 * PI;

/// Relative error allowed to a frequency by the degree of its elements.
const DEGREE_ERROR: f64 = 1e-16;

impl Mesh {
    /// Cuts the beam.
    pub fn new(input: &BeamInput, sections: &[Properties]) -> Self {
        let properties: Vec<[Rates; 4]> = input
            .segments
            .iter()
            .zip(sections)
            .map(|(segment, section)| {
                Family::ALL.map(|family| Rates::new(family, input.theory, &segment.material, section))
            })
            .collect();
        let phases = phases(input, sections, &properties);
        let mut mesh = Self { stations: vec![0.0], segments: vec![], lines: vec![] };
        let mut elements: [Vec<Element>; 4] = [const { vec![] }; 4];
        for (start, end, segment) in spans(input) {
            let waves = phases[segment] * (end - start);
            // Rounding of a whole number is no reason for one more.
            let count = (waves / LONGEST - 1e-9).ceil().max(1.0);
            let length = (end - start) / count;
            let degree = degree(waves / count);
            for index in 0..count as usize {
                let start = start + index as f64 * length;
                mesh.segments.push(segment);
                let last = index + 1 == count as usize;
                mesh.stations.push(if last { end } else { start + length });
                for (list, rates) in elements.iter_mut().zip(&properties[segment]) {
                    let Rates { rigidity, inertia, rotary } = *rates;
                    list.push(Element { start, length, degree, rigidity, inertia, rotary });
                }
            }
        }
        let rest = Family::ALL.map(|family| (mesh.lumps(input, family), mesh.anchor(input, family)));
        let lines = elements.into_iter().zip(rest);
        mesh.lines = lines.map(|(list, (lumps, anchor))| Line::new(list, lumps, anchor)).collect();
        mesh
    }

    /// The line of a family.
    pub fn line(&self, family: Family) -> &Line {
        &self.lines[family as usize]
    }

    /// Length of the beam [m].
    pub fn length(&self) -> f64 {
        self.stations[self.stations.len() - 1]
    }

    /// The station nearest to a place.
    pub fn station(&self, x: f64) -> usize {
        let distance = |station: usize| (self.stations[station] - x).abs();
        (0..self.stations.len()).min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(0)
    }

    /// Element and s in [-1, 1] of a place; between two elements, of the one after unless `before`.
    pub fn locate(&self, x: f64, before: bool) -> (usize, f64) {
        let station = self.station(x);
        let last = self.segments.len() - 1;
        if (self.stations[station] - x).abs() <= same_place(self.length()) {
            let before = station > 0 && (before || station > last);
            return if before { (station - 1, 1.0) } else { (station, -1.0) };
        }
        let element = self.stations[1..].iter().position(|end| *end > x).unwrap_or(last);
        let (start, end) = (self.stations[element], self.stations[element + 1]);
        (element, (2.0 * (x - start) / (end - start) - 1.0).clamp(-1.0, 1.0))
    }

    fn anchor(&self, input: &BeamInput, family: Family) -> Anchor {
        let Some(origin) = input.origin().map(|x| self.station(x)) else { return Anchor::Mean };
        match (&input.hold, input.far(), family) {
            (_, _, Family::Axial | Family::Torsion) => Anchor::Point(origin),
            (Hold::Pinned(_) | Hold::CraigBampton(_), Some(far), _) => {
                Anchor::Chord(origin, self.station(far))
            }
            _ => Anchor::Section(origin),
        }
    }

    fn lumps(&self, input: &BeamInput, family: Family) -> Vec<(usize, [f64; 2])> {
        let masses = input.masses.iter();
        masses
            .map(|lump| {
                let [x, y, z] = lump.inertia;
                let inertia = match family {
                    Family::Y => [lump.mass, z],
                    Family::Z => [lump.mass, y],
                    Family::Axial => [lump.mass, 0.0],
                    Family::Torsion => [x, 0.0],
                };
                (self.station(lump.x), inertia)
            })
            .collect()
    }
}

/// Rigidity and inertia per length.
#[derive(Clone, Copy)]
struct Rates {
    rigidity: Rigidity,
    inertia: f64,
    rotary: f64,
}

impl Rates {
    fn new(family: Family, theory: Theory, material: &Material, section: &Properties) -> Self {
        let Material { youngs_modulus, poisson_ratio, density } = *material;
        let shear_modulus = youngs_modulus / (2.0 * (1.0 + poisson_ratio));
        let bend = |second: f64, axis: usize| Self {
            rigidity: Rigidity::Bending {
                bending: youngs_modulus * second,
                shear: section
                    .shear
                    .filter(|_| theory == Theory::Timoshenko)
                    .map(|kappa| kappa[axis] * shear_modulus * section.area),
            },
            inertia: density * section.area,
            rotary: if theory == Theory::EulerBernoulli { 0.0 } else { density * second },
        };
        let bar = |rigidity, inertia| Self { rigidity: Rigidity::Bar(rigidity), inertia, rotary: 0.0 };
        match family {
            Family::Y => bend(section.iz, 0),
            Family::Z => bend(section.iy, 1),
            Family::Axial => bar(youngs_modulus * section.area, density * section.area),
            Family::Torsion => bar(shear_modulus * section.torsion, density * (section.iy + section.iz)),
        }
    }

    /// Wave number over a power of the frequency that all segments share.
    fn wave(&self) -> f64 {
        match self.rigidity {
            Rigidity::Bending { bending, .. } => (self.inertia / bending).sqrt().sqrt(),
            Rigidity::Bar(rigidity) => (self.inertia / rigidity).sqrt(),
        }
    }
}

/// Wave number [rad/m] of every segment that the mesh must resolve in some family.
///
/// Mode i has about i half waves over the whole beam, spread over the segments as their wave numbers; masses only lower
/// frequencies. Two more half waves than the first dropped mode are resolved, and one for every inner attachment.
fn phases(input: &BeamInput, sections: &[Properties], properties: &[[Rates; 4]]) -> Vec<f64> {
    let Counts { bending, axial, torsion } = input.modes;
    // Both planes equal: they share the modes; otherwise all may lie in one plane.
    let equal = sections.iter().all(|section| section.iy == section.iz);
    let bending = if equal { bending.div_ceil(2) } else { bending };
    let inner = input.attachments().len().saturating_sub(2);
    let counts = [bending, bending, axial, torsion].map(|count| (count + inner + 3) as f64);
    let total = [0, 1, 2, 3].map(|family| -> f64 {
        let waves = properties.iter().map(|rates: &[Rates; 4]| rates[family].wave());
        waves.zip(&input.segments).map(|(wave, segment)| wave * segment.length).sum()
    });
    let of = |rates: &[Rates; 4]| {
        let waves = (0..4).map(|family| counts[family] * PI * rates[family].wave() / total[family]);
        waves.fold(0.0, f64::max)
    };
    properties.iter().map(of).collect()
}

/// Stretches between steps, masses and held places: start, end, segment.
fn spans(input: &BeamInput) -> Vec<(f64, f64, usize)> {
    let near = same_place(input.length());
    let masses = input.masses.iter().map(|mass| mass.x);
    let mut places: Vec<f64> = masses.chain(input.held()).collect();
    places.sort_by(f64::total_cmp);
    let mut spans = vec![];
    let mut start = 0.0;
    let mut end = 0.0;
    for (index, segment) in input.segments.iter().enumerate() {
        end += segment.length;
        for place in &places {
            if *place > start + near && *place < end - near {
                spans.push((start, *place, index));
                start = *place;
            }
        }
        spans.push((start, end, index));
        start = end;
    }
    spans
}

/// Degree that resolves `waves` radians in one element.
///
/// The best polynomial for a curvature of that wave number misses by (waves/2)^(p-1) / (2^(p-2) (p-1)!), and a frequency
/// by the square of it.
fn degree(waves: f64) -> usize {
    let mut miss = 2.0;
    for degree in 2..=24 {
        miss *= waves / 4.0 / (degree - 1) as f64;
        if degree >= 5 && miss * miss < DEGREE_ERROR {
            return degree;
        }
    }
    24
}
