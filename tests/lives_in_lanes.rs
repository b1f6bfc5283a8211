//! Random lives with full coupling: the same bits in lanes as alone, on any number of threads, in any shards.

use std::num::NonZero;
use std::path::Path;

use linkwear::backend::Backend;
use linkwear::life::{Coupling, LifeStudy, Shard, Trajectories};
use linkwear::mechanism::Mechanism;
use linkwear_codegen::{Options, SourceFile};

fn mechanism(backend: Backend) -> Mechanism {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("mechanisms/rssr.toml");
    let text = std::fs::read_to_string(file).expect("a shipped file");
    let source = SourceFile { name: "rssr.toml".to_owned(), text };
    let mut mechanism = Mechanism::compile(&source, &Options::default(), backend).expect("it compiles");
    // A few cycles are enough to part lives that differ by a bit.
    let wear = mechanism.description.contacts.to_mut()[0].wear.as_mut().expect("R1 wears");
    wear.threshold = 8e-6;
    mechanism
}

/// Lives in cycles, by their bits.
fn lives(mechanism: &Mechanism, threads: usize, count: u64, shard: Option<Shard>) -> Vec<u64> {
    let study = LifeStudy {
        coupling: Some(Coupling::Full),
        trajectories: Trajectories::Count(count),
        shard,
        threads: NonZero::new(threads),
        ..LifeStudy::new(mechanism)
    };
    study.run().expect("lives").lives.iter().map(|end| end.cycles.to_bits()).collect()
}

#[test]
fn the_mean_path_is_the_same_in_lanes_and_alone() {
    let path = |backend| {
        let mechanism = mechanism(backend);
        let study = LifeStudy {
            coupling: Some(Coupling::Full),
            trajectories: Trajectories::MeanPath,
            ..LifeStudy::new(&mechanism)
        };
        let life = study.run().expect("a life");
        (life.end, life.measurements, life.cycles, life.turn_errors, life.warnings)
    };
    let native = path(Backend::Native);
    assert!(native.1 >= 9, "{} measurements", native.1);
    assert_eq!(path(Backend::Compiled), native);
}

#[test]
fn lives_are_the_same_alone_side_by_side_and_in_shards() {
    let native = mechanism(Backend::Native);
    let all = lives(&native, 1, 11, None);
    assert_eq!(all.len(), 11);
    assert_eq!(lives(&native, 2, 11, None), all, "two threads");
    let shards = (1..=3).flat_map(|index| lives(&native, 2, 11, Shard::new(index, 3).ok()));
    assert_eq!(shards.collect::<Vec<_>>(), all, "shards");
    // Compiled code has no lanes: one life after the other.
    assert_eq!(lives(&mechanism(Backend::Compiled), 1, 3, None), all[..3], "alone");
}
