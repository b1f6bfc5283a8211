//! What the equations of motion need of a flexible body, as plain numbers.
//!
//! A point of the body is, in its floating frame, `r = rbar + Σ q_k φ_k(rbar) + ½ Σ q_k q_l χ_kl(rbar)`; the last sum
//! only with [`SecondOrder`]. Integrals run over the mass of the body. The unit of a modal coordinate q_k is free: [q]
//! below. Mass-normalised modes have [q] = m kg^½.

use serde::{Deserialize, Serialize};

/// Everything the equations of motion need of a flexible body, in its floating frame, with n modes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModalData {
    /// Mass m [kg].
    pub mass: f64,
    /// First moment s0 = ∫ rbar dm [kg m].
    pub first_moment: [f64; 3],
    /// Second moment P0 = ∫ rbar rbarᵀ dm [kg m²], symmetric. The inertia about the origin is tr(P0) 1 - P0.
    pub second_moment: [[f64; 3]; 3],
    /// The modes, in the order of every list below; length n.
    pub modes: Vec<Mode>,
    /// Γ_k = ∫ φ_k dm [kg m/q]; length n.
    pub gamma: Vec<[f64; 3]>,
    /// C_k = ∫ rbar φ_kᵀ dm [kg m²/q], row: component of rbar, column: component of φ_k; length n.
    pub moment: Vec<[[f64; 3]; 3]>,
    /// N_kl = ∫ φ_k φ_lᵀ dm [kg m²/q²], n by n blocks with N_lk = N_klᵀ.
    pub coupling: Vec<Vec<[[f64; 3]; 3]>>,
    /// M_ff [kg m²/q²], n by n, symmetric positive definite; tr N_kl for a consistent body.
    pub mass_matrix: Vec<Vec<f64>>,
    /// K_ff [N m/q²], n by n, symmetric.
    pub stiffness: Vec<Vec<f64>>,
    /// D_ff [N m s/q²], n by n, symmetric.
    pub damping: Vec<Vec<f64>>,
    /// The quadratic part of the displacement field; without it the field is linear in q.
    pub second_order: Option<SecondOrder>,
    /// Points where joints attach or where something is read.
    pub nodes: Vec<Node>,
}

/// One mode by name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mode {
    /// Name, for example `y1`: first bending mode along y. Beams also have `z` (bending), `x` (axial), `t` (torsion).
    pub name: String,
    /// Natural frequency [Hz]; 0 where the shape is no eigenmode.
    pub frequency: f64,
}

/// Integrals of the quadratic displacement field ½ Σ q_k q_l χ_kl(rbar); symmetric in k and l.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SecondOrder {
    /// ∫ χ_kl dm [kg m/q²], n by n.
    pub gamma: Vec<Vec<[f64; 3]>>,
    /// ∫ rbar χ_klᵀ dm [kg m²/q²], n by n; row: component of rbar, column: component of χ_kl.
    pub moment: Vec<Vec<[[f64; 3]; 3]>>,
}

/// A point of the body that something attaches to or looks at.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Node {
    /// Name, unique in the body.
    pub name: String,
    /// Undeformed place rbar in the floating frame [m].
    pub position: [f64; 3],
    /// φ_k here [m/q]; length n.
    pub displacement: Vec<[f64; 3]>,
    /// ψ_k here [rad/q], the small-rotation vector of the cross-section; length n.
    pub rotation: Vec<[f64; 3]>,
    /// χ_kl here [m/q²], n by n; present exactly when the body has [`SecondOrder`].
    pub displacement2: Option<Vec<Vec<[f64; 3]>>>,
    /// What bending stress needs; only where the cross-section is known.
    pub strain: Option<Strain>,
}

/// Axial normal strain over one cross-section of a beam.
///
/// At a fibre (y, z) of the section: `strain = Σ q_k (extension_k + z curvature_y_k - y curvature_z_k)`, and
/// `stress = youngs_modulus * strain`, positive in tension.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Strain {
    /// Strain of the axis, u_k' [1/q]; length n.
    pub extension: Vec<f64>,
    /// Curvature about y, θy_k' [1/(m q)]; length n.
    pub curvature_y: Vec<f64>,
    /// Curvature about z, θz_k' [1/(m q)]; length n.
    pub curvature_z: Vec<f64>,
    /// Young's modulus E [Pa].
    pub youngs_modulus: f64,
    /// Where the outermost fibres are.
    pub outline: Outline,
}

/// Outline of a cross-section: where its largest bending stress can be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Outline {
    /// A circle: largest stress `E (|extension| + radius sqrt(curvature_y² + curvature_z²))`.
    Round {
        /// Outer radius [m].
        radius: f64,
    },
    /// Corners at (±y, ±z): largest stress `E (|extension| + z |curvature_y| + y |curvature_z|)`.
    Box {
        /// Distance of the outermost fibre along y [m].
        y: f64,
        /// Distance of the outermost fibre along z [m].
        z: f64,
    },
}

impl ModalData {
    /// Number of modes n.
    pub fn mode_count(&self) -> usize {
        self.modes.len()
    }

    /// The node of a name.
    pub fn node(&self, name: &str) -> Option<&Node> {
        self.nodes.iter().find(|node| node.name == name)
    }
}

impl Strain {
    /// Largest axial stress over the section [Pa] at modal coordinates `q`, as a magnitude.
    pub fn largest_stress(&self, q: &[f64]) -> f64 {
        let sum = |list: &[f64]| -> f64 { list.iter().zip(q).map(|(each, q)| each * q).sum() };
        let (extension, about_y, about_z) =
            (sum(&self.extension), sum(&self.curvature_y), sum(&self.curvature_z));
        let bending = match self.outline {
            Outline::Round { radius } => radius * about_y.hypot(about_z),
            Outline::Box { y, z } => z * about_y.abs() + y * about_z.abs(),
        };
        self.youngs_modulus * (extension.abs() + bending)
    }
}

impl ModalData {
    /// The same body without modes.
    pub fn frozen(&self) -> Self {
        let still =
            |node: &Node| Node { name: node.name.clone(), position: node.position, ..Node::default() };
        Self {
            mass: self.mass,
            first_moment: self.first_moment,
            second_moment: self.second_moment,
            nodes: self.nodes.iter().map(still).collect(),
            ..Self::default()
        }
    }

    /// How long the body is: the diagonal of the box around its nodes [m].
    pub fn length(&self) -> f64 {
        let extent = |axis: usize| {
            let places = self.nodes.iter().map(|node| node.position[axis]);
            let (low, high) =
                places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
            (high - low).max(0.0)
        };
        (0..3).map(|axis| extent(axis).powi(2)).sum::<f64>().sqrt()
    }

    /// Unit of the modal coordinates, as far as it is known.
    pub fn modal_unit(&self) -> &'static str {
        let unit = |k: usize, l: usize| f64::from(u8::from(k == l));
        let normalised = (0..self.modes.len())
            .all(|k| (0..self.modes.len()).all(|l| self.mass_matrix[k][l] == unit(k, l)));
        if normalised { "kg^0.5 m" } else { "1" }
    }
}

pub(super) fn transposed(block: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| block[j][i]))
}
