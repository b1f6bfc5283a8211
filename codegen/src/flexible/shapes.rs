//! Mode shapes of a beam under its hold, each family and each bending plane on its own.
//! In: mesh and hold. Out: mass-normalised shapes with fixed signs in a fixed order, and what was left out.

use std::f64::consts::PI;
use std::thread::available_parallelism;

use linkwear_tape::side_by_side;
use nalgebra::{DMatrix, DVector};

use super::beam::{Attachment, BeamInput};
use super::eigen::{Eigenmode, lowest, mass_orthonormal, orthonormal, product};
use super::element::Rigidity;
use super::error::BeamError;
use super::line::{Curve, Line};
use super::mesh::{Family, Mesh};

/// One mode of a beam.
#[derive(Clone, Debug)]
pub struct Shape {
    /// The motion it belongs to.
    pub family: Family,
    /// Number in its family, from 1.
    pub number: usize,
    /// omega² [rad²/s²].
    pub square: f64,
    /// Motion of the family's line; mass-normalised.
    pub curve: Curve,
}

/// First frequencies that were left out [Hz]; what a warning about truncation needs.
///
/// Chord frames without axial or torsional modes: of the beam held at both ends of the chord, because the frame alone
/// does not say how the neighbours hold it (a beam free at both ends has the same).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truncated {
    /// Bending along y; with Craig-Bampton, the first fixed-interface frequency left out.
    pub y: f64,
    /// Bending along z; likewise.
    pub z: f64,
    /// Axial.
    pub axial: f64,
    /// Torsional.
    pub torsion: f64,
}

/// Shapes in the order of the modal coordinates, and what was left out.
pub fn shapes(input: &BeamInput, mesh: &Mesh) -> Result<(Vec<Shape>, Truncated), BeamError> {
    let tasks = [
        Task::plane(input, mesh, Family::Y)?,
        Task::bar(input, mesh, Family::Axial, input.modes.axial)?,
        Task::bar(input, mesh, Family::Torsion, input.modes.torsion)?,
    ];
    let cores = available_parallelism().map_or(1, usize::from);
    let solved: [Option<Solved>; 3] =
        side_by_side(&tasks, cores, Task::solved).try_into().unwrap_or_default();
    let [bending, axial, torsion] = solved;
    let [of_y, of_axial, of_torsion] = tasks;
    let along_y = Plane::new(of_y, bending)?;
    let of_z = Task::plane(input, mesh, Family::Z)?;
    let along_z = along_y.turned(&of_z).map_or_else(|| Plane::new(of_z.clone(), of_z.solved()), Ok)?;
    let planes = [along_y, along_z];
    let (y, z) = share(input.modes.bending, &planes[0].modes, &planes[1].modes);
    let mut kept = merge(planes[0].keep(y)?, planes[1].keep(z)?);
    let (axial_modes, axial) = bar_modes(mesh, of_axial, axial, input.modes.axial)?;
    let (torsion_modes, torsion) = bar_modes(mesh, of_torsion, torsion, input.modes.torsion)?;
    kept.extend(axial_modes);
    kept.extend(torsion_modes);
    let left_out = [planes[0].modes[y].square, planes[1].modes[z].square, axial, torsion];
    let [y, z, axial, torsion] = left_out.map(|square| square.sqrt() / (2.0 * PI));
    Ok((kept, Truncated { y, z, axial, torsion }))
}

/// Frequencies this close count as equal: those of equal planes have equal bits, those of sections equal but for how
/// they were written differ by rounding.
const EQUAL: f64 = 1e-9;

/// How many of the `count` lowest modes lie in each plane; of equal ones, y comes first.
fn share(count: usize, along_y: &[Eigenmode], along_z: &[Eigenmode]) -> (usize, usize) {
    let (mut y, mut z) = (0, 0);
    while y + z < count {
        if comes_first(along_y[y].square, along_z[z].square) { y += 1 } else { z += 1 }
    }
    (y, z)
}

fn comes_first(y: f64, z: f64) -> bool {
    y <= z * (1.0 + EQUAL)
}

/// Both planes, lowest first.
fn merge(along_y: Vec<Shape>, along_z: Vec<Shape>) -> Vec<Shape> {
    let (mut y, mut z) = (along_y.into_iter().peekable(), along_z.into_iter().peekable());
    let mut all = vec![];
    loop {
        let from_y = match (y.peek(), z.peek()) {
            (Some(y), Some(z)) => comes_first(y.square, z.square),
            (Some(_), None) => true,
            (None, Some(_)) => false,
            (None, None) => return all,
        };
        all.extend(if from_y { y.next() } else { z.next() });
    }
}

/// Eigenmodes to be found: they depend on no other family, and take most of the time.
#[derive(Clone)]
struct Task<'a> {
    family: Family,
    mesh: &'a Mesh,
    /// Orthonormal rows that the modes are held in.
    held: Vec<DVector<f64>>,
    count: usize,
}

/// A mass matrix and its eigenmodes.
type Solved = (DMatrix<f64>, Vec<Eigenmode>);

impl<'a> Task<'a> {
    /// Of a bending plane, with all interfaces held.
    fn plane(input: &BeamInput, mesh: &'a Mesh, family: Family) -> Result<Self, BeamError> {
        let line = mesh.line(family);
        let attachments = input.attachments();
        let mut rows = vec![];
        for (index, Attachment { x, rotation }) in attachments.iter().enumerate() {
            let station = mesh.station(*x);
            let chord = index == 0 || index + 1 == attachments.len();
            if !chord {
                rows.push(line.station(station, 0).clone());
            }
            if rotation[usize::from(family == Family::Z)] {
                rows.push(line.station(station, 1).clone());
            }
        }
        let held = orthonormal(&rows).ok_or(BeamError::Extreme)?;
        // One more than can be kept is left out and named.
        Ok(Self { family, mesh, held, count: input.modes.bending + 1 })
    }

    /// Of a bar family.
    fn bar(input: &BeamInput, mesh: &'a Mesh, family: Family, count: usize) -> Result<Self, BeamError> {
        let line = mesh.line(family);
        // The anchor holds one place. What pulls at the far one stretches the bar as one static shape does,
        // which many eigenmodes of the free end would only approach: it comes first, then modes with both ends held.
        let far: Vec<DVector<f64>> =
            input.far().map(|x| line.station(mesh.station(x), 0).clone()).into_iter().collect();
        let held = orthonormal(&far).ok_or(BeamError::Extreme)?;
        let fixed = if held.is_empty() { count } else { count.saturating_sub(1) };
        Ok(Self { family, mesh, held, count: fixed + 1 })
    }

    /// `None`: rounding buried them.
    fn solved(&self) -> Option<Solved> {
        let mass = self.mesh.line(self.family).mass();
        let modes = lowest(&mass, &self.held, self.count)?;
        Some((mass, modes))
    }
}

/// One bending plane with its eigenmodes (with Craig-Bampton: of fixed interfaces).
struct Plane<'a> {
    family: Family,
    mesh: &'a Mesh,
    mass: DMatrix<f64>,
    /// Orthonormal rows that span the interface motions: held in the fixed-interface modes, and in energy the static shapes.
    interface: Vec<DVector<f64>>,
    modes: Vec<Eigenmode>,
}

impl<'a> Plane<'a> {
    fn new(Task { family, mesh, held, .. }: Task<'a>, solved: Option<Solved>) -> Result<Self, BeamError> {
        let (mass, modes) = solved.ok_or(BeamError::Extreme)?;
        Ok(Self { family, mesh, mass, interface: held, modes })
    }

    /// Another plane, if it is equal to the bit, as that of a round section is.
    fn turned(&self, other: &Task<'a>) -> Option<Self> {
        let is_equal =
            self.interface == other.held && self.mesh.line(self.family) == other.mesh.line(other.family);
        is_equal.then(|| Self {
            family: other.family,
            mesh: self.mesh,
            mass: self.mass.clone(),
            interface: self.interface.clone(),
            modes: self.modes.clone(),
        })
    }

    /// The first `count` modes; with interfaces, the eigenmodes of what they and the static shapes span.
    fn keep(&self, count: usize) -> Result<Vec<Shape>, BeamError> {
        let mut modes = self.modes[..count].to_vec();
        if !self.interface.is_empty() {
            modes = craig_bampton(&self.mass, &self.interface, &modes).ok_or(BeamError::Extreme)?;
        }
        Ok(named(self.mesh, self.family, modes))
    }
}

/// The static shape of an interface motion has the least energy of all with that motion; where the energy is the length
/// of the unknowns, static shapes span what the rows of the interface span.
fn craig_bampton(
    mass: &DMatrix<f64>,
    interface: &[DVector<f64>],
    fixed: &[Eigenmode],
) -> Option<Vec<Eigenmode>> {
    let fixed = fixed.iter().map(|mode| mode.shape.normalize());
    let basis: Vec<DVector<f64>> = interface.iter().cloned().chain(fixed).collect();
    let n = basis.len();
    let reduced = DMatrix::from_fn(n, n, |i, j| product(&basis[i.max(j)], mass, &basis[i.min(j)]));
    let mut modes: Vec<Eigenmode> = vec![];
    for mode in lowest(&reduced, &[], n)? {
        let mut shape = DVector::zeros(mass.nrows());
        for (factor, each) in mode.shape.iter().zip(&basis) {
            shape.axpy(*factor, each, 1.0);
        }
        modes.push(mass_orthonormal(shape, mass, &modes)?);
    }
    Some(modes)
}

/// Kept modes of a bar family, and the square of the first frequency left out.
fn bar_modes(
    mesh: &Mesh,
    Task { family, held: far, count: one_more, .. }: Task<'_>,
    solved: Option<Solved>,
    count: usize,
) -> Result<(Vec<Shape>, f64), BeamError> {
    let (mass, mut modes) = solved.ok_or(BeamError::Extreme)?;
    let fixed = one_more - 1;
    let truncated = modes[fixed].square;
    modes.truncate(fixed);
    if count > 0 && !far.is_empty() {
        modes = craig_bampton(&mass, &far, &modes).ok_or(BeamError::Extreme)?;
    }
    Ok((named(mesh, family, modes), truncated))
}

fn named(mesh: &Mesh, family: Family, modes: Vec<Eigenmode>) -> Vec<Shape> {
    let line = mesh.line(family);
    let shapes = modes.into_iter().enumerate().map(|(index, mode)| Shape {
        family,
        number: index + 1,
        square: mode.square,
        curve: upright(line, mesh.length(), mode.shape),
    });
    shapes.collect()
}

/// The shape with the sign fixed: the first of deflection at x = 0, slope there, deflection at the far end that is not
/// small is positive.
fn upright(line: &Line, length: f64, shape: DVector<f64>) -> Curve {
    let curve = line.curve(shape);
    let last = line.elements.len() - 1;
    let (near, far) = (line.field(0, -1.0, &curve), line.field(last, 1.0, &curve));
    let slope = match line.elements[0].rigidity {
        Rigidity::Bending { .. } => near.slope(),
        Rigidity::Bar(_) => near.strain,
    };
    let signs = [near.value, slope * length, far.value];
    let middles = (0..=last).map(|element| line.field(element, 0.0, &curve).value.abs());
    let size = middles.fold(near.value.abs().max(far.value.abs()), f64::max);
    // Far above rounding and far below what any mode has at one of these.
    let first = signs.into_iter().find(|each| each.abs() > 1e-3 * size);
    if first.is_some_and(|each| each < 0.0) { line.curve(-curve.unknowns) } else { curve }
}
