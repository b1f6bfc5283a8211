//! temp
use serde::{Deserialize, Serialize};
/// d
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ModalData {
    /// d
    pub mass: f64,
    /// d
    pub first_moment: [f64; 3],
    /// d
    pub second_moment: [[f64; 3]; 3],
    /// d
    pub modes: Vec<Mode>,
    /// d
    pub gamma: Vec<[f64; 3]>,
    /// d
    pub moment: Vec<[[f64; 3]; 3]>,
    /// d
    pub coupling: Vec<Vec<[[f64; 3]; 3]>>,
    /// d
    pub mass_matrix: Vec<Vec<f64>>,
    /// d
    pub stiffness: Vec<Vec<f64>>,
    /// d
    pub damping: Vec<Vec<f64>>,
    /// d
    pub second_order: Option<SecondOrder>,
    /// d
    pub nodes: Vec<Node>,
}
/// d
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Mode {
    /// d
    pub name: String,
    /// d
    pub frequency: f64,
}
/// d
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SecondOrder {
    /// d
    pub gamma: Vec<Vec<[f64; 3]>>,
    /// d
    pub moment: Vec<Vec<[[f64; 3]; 3]>>,
}
/// d
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Node {
    /// d
    pub name: String,
    /// d
    pub position: [f64; 3],
    /// d
    pub displacement: Vec<[f64; 3]>,
    /// d
    pub rotation: Vec<[f64; 3]>,
    /// d
    pub displacement2: Option<Vec<Vec<[f64; 3]>>>,
}

impl ModalData {
    /// d
    pub fn read(path: &std::path::Path) -> Result<Self, String> {
        let text = std::fs::read_to_string(path).map_err(|e| e.to_string())?;
        toml::from_str(&text).map_err(|e| e.to_string())
    }
    /// d
    pub fn modal_unit(&self) -> &'static str {
        let identity = self.mass_matrix.iter().enumerate().all(|(i, row)| {
            row.iter().enumerate().all(|(j, x)| *x == f64::from(u8::from(i == j)))
        });
        if identity { "kg^0.5 m" } else { "1" }
    }
}
