//! Missions: lives by segments against lives without, against revolutions that alternate, and table against full coupling.

use std::num::NonZero;
use std::path::Path;

use linkwear::backend::Backend;
use linkwear::life::{Cause, Coupling, LifeResult, LifeStudy, MissionChoice, Trajectories};
use linkwear::mechanism::Mechanism;
use linkwear_codegen::{Options, SourceFile};
use linkwear_runtime::{Integrator, SINGULAR_PIVOT, TurnRunner, Watch};

/// The case study with these missions; a lower threshold is reached within a few cycles.
fn mechanism(missions: &str, threshold: f64) -> Mechanism {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("mechanisms/rssr.toml");
    let text = std::fs::read_to_string(file).expect("a shipped file") + missions;
    let source = SourceFile { name: "rssr.toml".to_owned(), text };
    let mut mechanism = Mechanism::compile(&source, &Options::default(), Backend::Auto).expect("it compiles");
    mechanism.description.contacts.to_mut()[0].wear.as_mut().expect("R1 wears").threshold = threshold;
    mechanism
}

fn study(mechanism: &Mechanism, coupling: Coupling) -> LifeStudy<'_> {
    let count = if coupling == Coupling::Table { 50 } else { 3 };
    LifeStudy {
        coupling: Some(coupling),
        trajectories: Trajectories::Count(count),
        ..LifeStudy::new(mechanism)
    }
}

fn mean(mechanism: &Mechanism, coupling: Coupling) -> LifeResult {
    let study = LifeStudy { trajectories: Trajectories::MeanPath, ..study(mechanism, coupling) };
    study.run().expect("a life")
}

const TWO: &str = "
[missions.shift.segments]
slow = { duration = \"20 h\", set = { speed = \"2 Hz\" } }
fast = { duration = \"10 h\", set = { speed = \"2.5 Hz\" }, wear = 1.5 }
";
const TWO_REVERSED: &str = "
[missions.shift.segments]
fast = { duration = \"10 h\", set = { speed = \"2.5 Hz\" }, wear = 1.5 }
slow = { duration = \"20 h\", set = { speed = \"2 Hz\" } }
";

#[test]
fn a_mission_of_one_segment_is_the_life_without_missions() {
    let one = mechanism("\n[missions.shift.segments]\nall = { share = 1 }\n", 8e-6);
    let timed = mechanism("\n[missions.shift.segments]\nall = { duration = \"2 h\" }\n", 8e-6);
    for coupling in [Coupling::Table, Coupling::Full] {
        let without = LifeStudy { mission: MissionChoice::None, ..study(&one, coupling) };
        let without = without.run().expect("a life");
        for mechanism in [&one, &timed] {
            let by_mission = study(mechanism, coupling).run().expect("a life");
            let mission = by_mission.mission.clone().expect("a mission");
            assert_eq!((mission.segments.len(), &mission.segments[0].wear[..]), (1, &[1.0][..]));
            assert_eq!(LifeResult { mission: None, ..by_mission }, without, "{coupling:?}");
        }
    }
}

#[test]
fn a_segment_is_the_mechanism_with_its_values_set() {
    let set = mechanism(
        "\n[missions.shift.segments]\nall = { share = 1, set = { speed = \"2.5 Hz\" }, wear = 1.5 }\n",
        8e-6,
    );
    let by_mission = mean(&set, Coupling::Table);
    let mut changed = mechanism("", 8e-6);
    let speed = changed.description.parameters.iter().position(|one| one.name == "speed").expect("a speed");
    changed.parameters[speed] = 2.5;
    changed.description.contacts.to_mut()[0].wear.as_mut().expect("R1 wears").coefficient *= 1.5;
    assert_eq!(LifeResult { mission: None, ..by_mission }, mean(&changed, Coupling::Table));
}

/// W [m] after whole missions: revolutions of one setting, then of the other, Archard's wear added by hand.
fn alternated(mechanism: &Mechanism, segments: &[(f64, f64, f64)], missions: usize) -> f64 {
    let description = &mechanism.description;
    let speed = description.parameters.iter().position(|one| one.name == "speed").expect("a speed");
    let contact = description.contacts[0].clone();
    let gamma = contact.wear.expect("R1 wears").feedback;
    let system = mechanism.system();
    let integrator = Integrator::Rk43 { tolerance: 1e-6, max_step: None };
    let runner = |hertz: f64| {
        let mut parameters = mechanism.parameters.clone();
        parameters[speed] = hertz;
        TurnRunner::new(&*system, description, &parameters, integrator, SINGULAR_PIVOT).expect("it turns")
    };
    let mut runners: Vec<TurnRunner<'_>> = segments.iter().map(|(hertz, ..)| runner(*hertz)).collect();
    let mut wear = 0.0;
    for _ in 0..missions {
        for (runner, (hertz, seconds, factor)) in runners.iter_mut().zip(segments) {
            let mut depth = |wear: f64| {
                runner.set_worn(0, gamma * wear, None).expect("a clearance");
                runner.turns(3, Watch::NONE).expect("turns")[2].joints[0].depth
            };
            // The midpoint of the block: over the life its error is 4e-4, four times as much in blocks twice as long.
            let revolutions = factor * hertz * seconds;
            let half = 0.5 * revolutions * depth(wear);
            wear += revolutions * depth(wear + half);
        }
    }
    wear
}

#[test]
fn segments_wear_as_revolutions_that_alternate() {
    const MISSIONS: usize = 10;
    // The clearance grows fourfold: 10 missions of this many times 30 h.
    let times = 40.0;
    let hour = 3600.0 * times;
    let plain = mechanism("", 8e-6);
    let (slow, fast) = ((2.0, 20.0 * hour, 1.0), (2.5, 10.0 * hour, 1.5));
    let wear = alternated(&plain, &[slow, fast], MISSIONS);
    let reversed = alternated(&plain, &[fast, slow], MISSIONS);
    assert!(wear > 1e-6, "nothing to compare: {wear} m");
    // Which comes first changes the life by less than an eighth of the logarithm by which the ratio of both rates changes, in
    // missions (docs/missions.md): a thousandth of ten of them.
    assert!((reversed / wear - 1.0).abs() < 1e-3, "{wear} m, reversed {reversed} m");
    // The mean path has worn so much after as many missions: by the blocks to 4e-4, by its own steps to 1e-4, by the order.
    for (text, coupling) in [(TWO, Coupling::Full), (TWO, Coupling::Table), (TWO_REVERSED, Coupling::Table)] {
        let life = mean(&mechanism(text, wear), coupling);
        let missions = life.missions().expect("durations") / times;
        assert!((missions / MISSIONS as f64 - 1.0).abs() < 1e-3, "{missions} missions, {coupling:?}");
    }
}

#[test]
fn the_table_meets_the_dynamics_within_its_error() {
    let two = mechanism(TWO, 20e-6);
    let (table, full) = (mean(&two, Coupling::Table), mean(&two, Coupling::Full));
    let apart = (table.end.cycles / full.end.cycles - 1.0).abs();
    // The dynamics at every step are off by their own steps, 1e-4.
    let error = table.table_error().expect("a table") + 1e-4;
    assert!(apart < error, "{apart:.1e} apart, the table says {error:.1e}");
    let shares = |life: &LifeResult| -> Vec<f64> {
        life.mission.as_ref().expect("a mission").segments.iter().map(|segment| segment.wear[0]).collect()
    };
    let (by_table, by_dynamics) = (shares(&table), shares(&full));
    assert!((by_table.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    for (table, full) in by_table.iter().zip(&by_dynamics) {
        assert!((table - full).abs() < 1e-3, "{by_table:?} {by_dynamics:?}");
    }
}

#[test]
fn a_segment_alone_is_told_without_being_lived() {
    let two = mechanism(TWO, 20e-6);
    let told = mean(&two, Coupling::Table).mission.expect("a mission").segments;
    for (segment, text) in told.iter().zip([
        "\n[missions.one.segments]\nslow = { share = 1, set = { speed = \"2 Hz\" } }\n",
        "\n[missions.one.segments]\nfast = { share = 1, set = { speed = \"2.5 Hz\" }, wear = 1.5 }\n",
    ]) {
        let lived = mean(&mechanism(text, 20e-6), Coupling::Table).end.cycles;
        let alone = segment.alone.expect("one joint, the same path").cycles;
        // One joint: the same points of the same table, each segment going on from its own state.
        assert!((alone / lived - 1.0).abs() < 1e-9, "{}: {alone} told, {lived} lived", segment.name);
    }
}

#[test]
fn random_lives_of_a_mission_are_the_same_on_any_threads() {
    let two = mechanism(TWO, 8e-6);
    for coupling in [Coupling::Table, Coupling::Full] {
        let lives = |threads| {
            let study = LifeStudy { threads: NonZero::new(threads), ..study(&two, coupling) };
            study.run().expect("lives")
        };
        assert_eq!(lives(1), lives(3), "{coupling:?}");
    }
}

#[test]
fn a_mission_is_chosen_by_name_or_not_at_all() {
    let two = mechanism(
        "\n[missions.day.segments]\nall = { share = 1 }\n[missions.night.segments]\nall = { share = 1 }\n",
        8e-6,
    );
    let failed = |mission| {
        let study = LifeStudy { mission, ..study(&two, Coupling::Table) };
        *study.run().expect_err("no life").cause
    };
    let known = ["day", "night"].map(str::to_owned);
    let several = failed(MissionChoice::Only);
    assert!(matches!(&several, Cause::SeveralMissions { known: names } if names[..] == known), "{several}");
    let unknown = failed(MissionChoice::Named("noon".to_owned()));
    assert!(
        matches!(&unknown, Cause::UnknownMission { known: names, .. } if names[..] == known),
        "{unknown}"
    );
    let named = LifeStudy {
        mission: MissionChoice::Named("night".to_owned()),
        trajectories: Trajectories::MeanPath,
        ..study(&two, Coupling::Table)
    };
    assert_eq!(named.run().expect("a life").mission.expect("a mission").name, "night");
}

#[test]
fn a_machine_that_fails_within_its_first_mission_is_refused() {
    let long = TWO.replace("20 h", "200000000 h");
    let error = study(&mechanism(&long, 8e-6), Coupling::Table).run().expect_err("no life").cause;
    assert!(matches!(*error, Cause::MissionOutlastsLife { missions } if missions < 1.0), "{error}");
}
