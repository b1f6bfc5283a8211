//! Wear kept by bearing angle and fed back to the gap there: the case study's journal makes room for itself.

use std::f64::consts::PI;

use linkwear::mechanisms::rssr;
use linkwear_runtime::life::{LifeOutcome, LifeSettings, LifeState, MeanIncrement, WearStep, run_life};
use linkwear_runtime::wear::{Grid, Measure, Profile};
use linkwear_runtime::{DynamicsSource, RevolutionSettings, Watch};

/// Of which one wears a micrometre off the deepest place of the unworn bearing.
const REVOLUTIONS: f64 = 4e7;
const CYCLES: u64 = 4;
/// Clearance of the case study [m].
const CLEARANCE: f64 = 10e-6;

/// The bearing after every cycle.
fn worn() -> Vec<Profile> {
    let mut description = rssr::description().clone();
    let wear = description.contacts.to_mut()[0].wear.as_mut().expect("R1 wears");
    (wear.profile, wear.measure, wear.revolutions_per_cycle) = (true, Some(Measure::Maximum), REVOLUTIONS);
    let parameters: Vec<f64> = description.parameters.iter().map(|parameter| parameter.default).collect();
    let (system, settle) =
        (rssr::Mechanism::default(), RevolutionSettings { settle: Some(2), ..RevolutionSettings::default() });
    let mut fine = DynamicsSource::new(&system, &description, &parameters, settle).expect("a start");
    let mut settings = LifeSettings::new(fine.joints().expect("numbers in range"));
    settings.step = WearStep::Cycle;
    let mut state = LifeState::new(&settings, 0).expect("settings");
    let live = |cycle| {
        settings.most_cycles = cycle;
        let outcome = run_life(&settings, &mut fine, &MeanIncrement, &mut state, Watch::NONE);
        assert!(matches!(outcome, Ok(LifeOutcome::CycleLimit)), "{outcome:?}");
        state.joints[0].profile.clone().expect("a profile")
    };
    (1..=CYCLES).map(live).collect()
}

#[test]
fn a_journal_wears_the_edges_away_until_it_fits() {
    let worn = worn();
    let (first, last) = (&worn[0], &worn[worn.len() - 1]);
    println!("{:?}", worn.iter().map(|profile| (profile.mean(), profile.maximum())).collect::<Vec<_>>());
    // The same work of friction wears off the same volume wherever it goes; chatter in a worn bearing adds some per cent.
    let linear = first.mean() * worn.len() as f64;
    assert!((last.mean() / linear - 1.0).abs() < 0.1, "{:e} {linear:e}", last.mean());
    // The deepest place grows ever slower, because wear spreads: the feedback has the other sign than that of a
    // clearance that opens all round.
    let grown: Vec<f64> = worn.windows(2).map(|pair| pair[1].maximum() - pair[0].maximum()).collect();
    assert!(grown[0] < 0.9 * first.maximum() && grown[2] < 0.9 * grown[0], "{grown:?}");
    // The journal touches all that is worn somewhere on its way around, but for smoothing (5e-8 m times the
    // logarithm of how many bins share a corner) and pieces of wear (1e-8 m). A groove would be a micrometre deeper.
    let grid = Grid::new(last.depths().len());
    let unit = |angle: f64| [angle.cos(), angle.sin()];
    let around: Vec<[f64; 2]> = (0..720)
        .map(|step| unit(f64::from(step) * PI / 360.0))
        .map(|direction| (direction, grid.distance(last, CLEARANCE, direction, 0.0)))
        .map(|(direction, distance)| direction.map(|component| distance * component))
        .collect();
    for (bin, depth) in last.depths().iter().enumerate().filter(|(_, depth)| **depth > 0.5e-6) {
        let normal = unit(last.middle(bin));
        let farthest = around.iter().map(|at| at[0] * normal[0] + at[1] * normal[1]).fold(0.0, f64::max);
        assert!((farthest - CLEARANCE - depth).abs() < 2e-7, "{bin}: {farthest:e} {depth:e}");
    }
    // It wears where the load presses, at -157.5 and -7.5 deg.
    let deepest = (0..last.depths().len()).max_by(|a, b| last.depths()[*a].total_cmp(&last.depths()[*b]));
    let angle = last.middle(deepest.expect("bins")) * 180.0 / PI;
    assert!((angle + 157.5).abs() < 8.0 || (angle + 7.5).abs() < 8.0, "{angle}");
}
