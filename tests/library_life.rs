//! Lives from Rust, by `linkwear::life`: what the command line would refuse, the library refuses too.

use linkwear::life::{JointFit, LifeStudy};
use linkwear::mechanism::Mechanism;
use linkwear_gamma::life::Estimate;
use linkwear_gamma::process::{Gamma, Process, Wiener};

fn refusal(estimate: Estimate, joint: &str) -> String {
    let mechanism = Mechanism::shipped("rssr").expect("a shipped mechanism");
    let fit = JointFit { joint: joint.to_owned(), from: "test".to_owned(), estimate };
    let study = LifeStudy { fits: vec![fit], ..LifeStudy::new(&mechanism) };
    study.run().expect_err("no life").to_string()
}

fn exact(process: &'static dyn Process, exponent: Option<f64>) -> Estimate {
    Estimate::new(process, [10.0, 12.0], exponent).expect("positive parameters")
}

#[test]
fn fits_that_no_life_can_be_drawn_from_are_refused() {
    let message = refusal(exact(&Wiener, None), "R1");
    assert!(message.contains("`R1` is no plain Gamma process"), "{message}");
    let message = refusal(exact(&Gamma, Some(0.7)), "R1");
    assert!(message.contains("`R1` is no plain Gamma process"), "{message}");
    let message = refusal(exact(&Gamma, None), "R4");
    assert!(message.contains("`R4` is no joint that wears; there are: R1"), "{message}");
}
