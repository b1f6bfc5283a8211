//! Lives from Rust, by `linkwear::life`: what the command line would refuse, the library refuses too.

use std::num::NonZero;

use linkwear::life::{CountedEnds, JointFit, LifeStudy, Trajectories, UnfitForLife};
use linkwear::mechanism::Mechanism;
use linkwear_gamma::FitFile;
use linkwear_gamma::life::CountedLives;
use linkwear_runtime::{Integrator, RevolutionSettings};

fn joint_fit(joint: &str, text: &str) -> Result<JointFit, UnfitForLife> {
    JointFit::new(joint, "test", &FitFile::parse(text).expect("a fit"))
}

const PLAIN: &str = r#"{ "alpha": 10, "beta": 12, "over_lambda": true }"#;

#[test]
fn a_fit_that_no_life_can_be_drawn_from_is_none_of_a_joint() {
    let refused = |text: &str| joint_fit("R1", text).expect_err("no fit for a life");
    let wiener = refused(r#"{ "process": "wiener", "drift": 10, "spread": 12 }"#);
    assert!(matches!(wiener, UnfitForLife::Process(process) if process.name() == "wiener"), "{wiener}");
    let exponent = r#"{ "alpha": 10, "beta": 12, "exponent": 0.7 }"#;
    assert_eq!(refused(exponent), UnfitForLife::Exponent);
    let covariates = r#"{ "alpha": 10, "beta": 12, "covariates": [{ "name": "load", "coefficient": 1 }] }"#;
    assert_eq!(refused(covariates), UnfitForLife::Covariates);
    assert_eq!(refused(r#"{ "alpha": 10, "beta": 12, "over_lambda": false }"#), UnfitForLife::Exposure);
    let units = refused(r#"{ "alpha": 10, "beta": 10e3 }"#);
    assert_eq!(units.to_string(), "by this fit wear grows 1.000e-3 times as fast as Lambda");
    let covariance = r#"{ "alpha": 10, "beta": 12, "covariance": [[1]] }"#;
    assert!(matches!(refused(covariance), UnfitForLife::File(_)));
    assert!(joint_fit("R1", PLAIN).is_ok());
}

#[test]
fn what_is_wrong_with_a_fit_has_its_line_and_a_cure() {
    let fit = FitFile::parse("{ \"alpha\": 10,\n\"beta\": 12,\n\"exponent\": 0.7 }").expect("a fit");
    let error = JointFit::new("R1", "test", &fit).expect_err("an exponent").located(&fit);
    assert_eq!(error.line, Some(3));
    assert!(error.cure.contains("--lambda life.json"), "{}", error.cure);
}

#[test]
fn fits_belong_to_joints_that_wear_one_to_each() {
    let mechanism = Mechanism::shipped("rssr").expect("a shipped mechanism");
    let refusal = |joints: &[&str]| {
        let fits = joints.iter().map(|joint| joint_fit(joint, PLAIN).expect("a fit")).collect();
        let study = LifeStudy { fits, ..LifeStudy::new(&mechanism) };
        study.run().expect_err("no life").to_string()
    };
    assert_eq!(refusal(&["R4"]), "`R4` is no joint that wears; there are: R1");
    assert_eq!(refusal(&["R1", "R1"]), "joint `R1` has two fits");
}

#[test]
fn more_lives_than_are_listed_are_counted_to_the_same_statistics() {
    let mechanism = Mechanism::shipped("rssr").expect("a shipped mechanism");
    let study = |listed, threads| LifeStudy {
        // Turns that have not settled: what they wear does not matter here.
        revolutions: RevolutionSettings {
            integrator: Integrator::Rk4 { step: 1e-4 },
            settle: Some(0),
            average: 1,
        },
        trajectories: Trajectories::Count(3000),
        listed,
        threads: NonZero::new(threads),
        ..LifeStudy::new(&mechanism)
    };
    let each = study(3000, 2).run().expect("lives");
    let counted = study(1000, 2).run().expect("lives");
    assert!(each.counted.is_none() && counted.lives.is_empty());
    assert_eq!((each.lives.len(), counted.random_lives()), (3000, 3000));
    // Any threads, and any parts in any order, are the same to the last bit.
    let alone = study(700, 1).run().expect("lives");
    assert_eq!(alone.counted, counted.counted);
    let mut merged = CountedEnds::default();
    for part in each.lives.chunks(1234).rev() {
        let mut ends = CountedEnds::default();
        part.iter().for_each(|end| ends.add(end).expect("a life"));
        merged.merge(&ends);
    }
    assert_eq!(Some(merged), counted.counted);
    assert_eq!(each.mean_whole_cycles(), counted.mean_whole_cycles());
    assert_eq!(each.failed_first(), counted.failed_first());
    // Sums of 3000 numbers round.
    assert!((each.mean() / counted.mean() - 1.0).abs() < 1e-13);
    let [each, counted] = [each, counted].map(|life| life.statistics().expect("lives"));
    for p in [0.1, 0.5, 0.9] {
        let [each, counted] = [&each, &counted].map(|lives| lives.quantile(p).expect("a part").value);
        assert!((each / counted - 1.0).abs() <= CountedLives::ERROR, "{p}: {each} {counted}");
    }
}
