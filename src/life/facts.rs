//! What a life's result is told with and that no random life changes. In: a study. Out: [`LifeFacts`]. Never knows what
//! became of it.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::study::{Coupling, LifeStudy};
use crate::provenance::Provenance;
use crate::wear_measure::{WearMeasure, wear_measures};

/// Facts of a study, the same in all its shards.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct LifeFacts {
    /// The mechanism.
    pub name: String,
    /// What ran its equations. Back ends agree in every bit.
    pub backend: String,
    /// Seed of the random lives.
    pub seed: u64,
    /// Lives up to which each is kept and told.
    pub listed: u64,
    /// Coefficient of variation of the wear-rate factor that all joints of a life share.
    pub shared_factor: Option<f64>,
    /// Measure of wear of each joint that wears.
    pub wear_measures: Vec<WearMeasure>,
    /// What the result is of.
    pub provenance: Provenance,
    /// The mechanism's file and those that it names: names, texts.
    #[serde(default)]
    pub sources: Vec<(String, String)>,
    /// Remarks on the mechanism's file, as machines read them.
    pub warnings: Vec<Value>,
}

impl LifeFacts {
    /// Of a study, lived with this coupling.
    pub fn new(study: &LifeStudy<'_>, coupling: Coupling) -> Self {
        let mechanism = study.mechanism;
        let warnings = mechanism.warnings.entries();
        Self {
            name: mechanism.description.name.to_string(),
            backend: mechanism.backend().to_owned(),
            seed: study.seed,
            listed: study.listed,
            shared_factor: study.shared_factor,
            provenance: study.provenance(coupling),
            sources: mechanism.sources(),
            wear_measures: wear_measures(&mechanism.description),
            warnings: warnings.iter().map(|entry| serde_json::json!(entry)).collect(),
        }
    }
}
