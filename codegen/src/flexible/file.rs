//! The modal data file: [`ModalData`] as TOML text, with units and a version. `docs/modal-data.md` documents every key.
//!
//! Symmetric tables of blocks are lists of pairs of modes; pairs that are not listed are 0.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::check::DataError;
use super::data::{ModalData, Mode, Node, SecondOrder, Strain, transposed};
use super::exact::{Exact, whole_list};

type Vector = [f64; 3];
type Matrix = [[f64; 3]; 3];

/// First line of every file.
const FORMAT: &str = "linkwear modal data";
/// The one version there is.
const VERSION: u32 = 1;
/// The one system of units there is.
const UNITS: &str = "SI";

/// Why a text is no modal data.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum FileError {
    /// No TOML, an unknown or missing key, or a value of the wrong kind.
    #[error("line {line}, column {column}: {message}")]
    Syntax {
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// What is wrong; nothing of the line but what is wrong in it.
        message: String,
    },
    /// The key `format`, `version` or `units` says something else.
    #[error("{key} must be {expected}, not {found}")]
    Header {
        /// The key.
        key: &'static str,
        /// What it says.
        found: String,
        /// What it must say.
        expected: String,
    },
    /// A pair of modes names a mode that the file does not have.
    #[error("{place} names the mode {name}, which is not listed")]
    UnknownMode {
        /// The list of pairs.
        place: String,
        /// The name.
        name: String,
    },
    /// A pair of modes is given twice, perhaps the other way round.
    #[error("{place} gives the pair {first}, {second} twice")]
    PairTwice {
        /// The list of pairs.
        place: String,
        /// First mode of the second mention.
        first: String,
        /// Its second mode.
        second: String,
    },
    /// `order` is neither 1 nor 2, or `second_order` is given with order 1.
    #[error("order must be 1, or 2 with second_order, not {found}")]
    Order {
        /// The order given.
        found: u32,
    },
    /// The numbers cannot belong to a body.
    #[error(transparent)]
    Data(#[from] DataError),
}

impl FileError {
    fn syntax(text: &str, error: &toml::de::Error) -> Self {
        let before = &text[..error.span().map_or(0, |span| text.floor_char_boundary(span.start))];
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|letter| *letter != '\n').count() + 1;
        Self::Syntax { line, column, message: error.message().to_owned() }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    format: String,
    version: u32,
    units: String,
    order: u32,
    mass: f64,
    #[serde(deserialize_with = "whole_list")]
    first_moment: Vector,
    #[serde(deserialize_with = "whole_list")]
    second_moment: Matrix,
    mass_matrix: Vec<Vec<f64>>,
    stiffness: Vec<Vec<f64>>,
    damping: Vec<Vec<f64>>,
    #[serde(default)]
    mode: Vec<FileMode>,
    #[serde(default)]
    coupling: Vec<Pair<Matrix>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    second_order: Vec<PairSecond>,
    #[serde(default)]
    node: Vec<FileNode>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileMode {
    name: String,
    frequency: f64,
    #[serde(deserialize_with = "whole_list")]
    gamma: Vector,
    #[serde(deserialize_with = "whole_list")]
    moment: Matrix,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, bound(deserialize = "T: Exact<'de>"))]
struct Pair<T> {
    #[serde(deserialize_with = "whole_list")]
    modes: [String; 2],
    #[serde(deserialize_with = "whole_list")]
    value: T,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PairSecond {
    #[serde(deserialize_with = "whole_list")]
    modes: [String; 2],
    #[serde(deserialize_with = "whole_list")]
    gamma: Vector,
    #[serde(deserialize_with = "whole_list")]
    moment: Matrix,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileNode {
    name: String,
    #[serde(deserialize_with = "whole_list")]
    position: Vector,
    #[serde(deserialize_with = "whole_list")]
    displacement: Vec<Vector>,
    #[serde(deserialize_with = "whole_list")]
    rotation: Vec<Vector>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    displacement2: Vec<Pair<Vector>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    strain: Option<Strain>,
}

impl ModalData {
    /// Reads a modal data file.
    ///
    /// # Errors
    /// Text that is no such file, or numbers that cannot belong to a body.
    pub fn from_toml(text: &str) -> Result<Self, FileError> {
        let file: File = toml::from_str(text).map_err(|error| FileError::syntax(text, &error))?;
        let header = [
            ("format", file.format.clone(), FORMAT.to_owned()),
            ("version", file.version.to_string(), VERSION.to_string()),
            ("units", file.units.clone(), UNITS.to_owned()),
        ];
        for (key, found, expected) in header {
            if found != expected {
                return Err(FileError::Header { key, found, expected });
            }
        }
        let data = file.into_data()?;
        data.check()?;
        Ok(data)
    }

    /// Writes a modal data file that reads back to the same bits.
    ///
    /// # Errors
    /// Data that [`ModalData::check`] refuses.
    pub fn to_toml(&self) -> Result<String, DataError> {
        self.check()?;
        #[expect(
            clippy::expect_used,
            reason = "TOML has all that checked data are: finite numbers, texts, lists"
        )]
        let text = toml::to_string(&File::from_data(self)).expect("checked data can be written");
        Ok(text)
    }
}

impl File {
    fn into_data(self) -> Result<ModalData, FileError> {
        let names: Vec<String> = self.mode.iter().map(|mode| mode.name.clone()).collect();
        if !(self.order == 2 || (self.order == 1 && self.second_order.is_empty())) {
            return Err(FileError::Order { found: self.order });
        }
        let blocks = self.coupling.into_iter().map(|pair| (pair.modes, pair.value)).collect();
        let coupling = table("coupling", &names, blocks, transposed)?;
        let gamma = self.second_order.iter().map(|pair| (pair.modes.clone(), pair.gamma)).collect();
        let moment = self.second_order.iter().map(|pair| (pair.modes.clone(), pair.moment)).collect();
        let second_order = SecondOrder {
            gamma: table("second_order", &names, gamma, |value| *value)?,
            moment: table("second_order", &names, moment, |value| *value)?,
        };
        let nodes = self.node.into_iter().map(|node| node.into_node(&names, self.order));
        Ok(ModalData {
            mass: self.mass,
            first_moment: self.first_moment,
            second_moment: self.second_moment,
            gamma: self.mode.iter().map(|mode| mode.gamma).collect(),
            moment: self.mode.iter().map(|mode| mode.moment).collect(),
            coupling,
            mass_matrix: self.mass_matrix,
            stiffness: self.stiffness,
            damping: self.damping,
            second_order: (self.order == 2).then_some(second_order),
            nodes: nodes.collect::<Result<_, _>>()?,
            modes: self
                .mode
                .into_iter()
                .map(|mode| Mode { name: mode.name, frequency: mode.frequency })
                .collect(),
        })
    }

    fn from_data(data: &ModalData) -> Self {
        let names: Vec<&str> = data.modes.iter().map(|mode| mode.name.as_str()).collect();
        let modes = data.modes.iter().zip(&data.gamma).zip(&data.moment);
        let second = data.second_order.iter().flat_map(|second| {
            pairs(&names).filter_map(|(k, l, modes)| {
                let (gamma, moment) = (second.gamma[k][l], second.moment[k][l]);
                let zero = gamma.iter().chain(moment.iter().flatten()).all(|each| *each == 0.0);
                (!zero).then_some(PairSecond { modes, gamma, moment })
            })
        });
        let coupling = pairs(&names).map(|(k, l, modes)| Pair { modes, value: data.coupling[k][l] });
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            units: UNITS.to_owned(),
            order: if data.second_order.is_some() { 2 } else { 1 },
            mass: data.mass,
            first_moment: data.first_moment,
            second_moment: data.second_moment,
            mass_matrix: data.mass_matrix.clone(),
            stiffness: data.stiffness.clone(),
            damping: data.damping.clone(),
            mode: modes
                .map(|((mode, gamma), moment)| FileMode {
                    name: mode.name.clone(),
                    frequency: mode.frequency,
                    gamma: *gamma,
                    moment: *moment,
                })
                .collect(),
            coupling: coupling.filter(|pair| pair.value != [[0.0; 3]; 3]).collect(),
            second_order: second.collect(),
            node: data.nodes.iter().map(|node| FileNode::from_node(node, &names)).collect(),
        }
    }
}

impl FileNode {
    fn into_node(self, names: &[String], order: u32) -> Result<Node, FileError> {
        let place = format!("displacement2 of node {}", self.name);
        let given = !self.displacement2.is_empty();
        let blocks = self.displacement2.into_iter().map(|pair| (pair.modes, pair.value)).collect();
        let second = table(&place, names, blocks, |value| *value)?;
        Ok(Node {
            name: self.name,
            position: self.position,
            displacement: self.displacement,
            rotation: self.rotation,
            // With order 1 a given table stays, for the check to refuse.
            displacement2: (order == 2 || given).then_some(second),
            strain: self.strain,
        })
    }

    fn from_node(node: &Node, names: &[&str]) -> Self {
        let second = node
            .displacement2
            .iter()
            .flat_map(|second| pairs(names).map(|(k, l, modes)| Pair { modes, value: second[k][l] }));
        Self {
            name: node.name.clone(),
            position: node.position,
            displacement: node.displacement.clone(),
            rotation: node.rotation.clone(),
            displacement2: second.filter(|pair| pair.value != [0.0; 3]).collect(),
            strain: node.strain.clone(),
        }
    }
}

/// All pairs k <= l with their names.
fn pairs(names: &[&str]) -> impl Iterator<Item = (usize, usize, [String; 2])> {
    (0..names.len())
        .flat_map(move |k| (k..names.len()).map(move |l| (k, l, [names[k].to_owned(), names[l].to_owned()])))
}

/// The table of listed pairs; the entry (l, k) is the mirrored entry (k, l), and what is not listed is 0.
fn table<T: Copy + Default>(
    place: &str,
    names: &[String],
    listed: Vec<([String; 2], T)>,
    mirror: fn(&T) -> T,
) -> Result<Vec<Vec<T>>, FileError> {
    let n = names.len();
    let mut found: Vec<Vec<Option<T>>> = vec![vec![None; n]; n];
    for (modes, value) in listed {
        let index = |name: &String| {
            let unknown = || FileError::UnknownMode { place: place.to_owned(), name: name.clone() };
            names.iter().position(|each| each == name).ok_or_else(unknown)
        };
        let (k, l) = (index(&modes[0])?, index(&modes[1])?);
        if found[k][l].is_some() {
            let [first, second] = modes;
            return Err(FileError::PairTwice { place: place.to_owned(), first, second });
        }
        found[l][k] = Some(mirror(&value));
        found[k][l] = Some(value);
    }
    let rows = found.into_iter().map(|row| row.into_iter().map(Option::unwrap_or_default).collect());
    Ok(rows.collect())
}
