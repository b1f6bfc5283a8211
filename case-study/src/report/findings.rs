//! What the study found, in words that depend on its numbers. In: [`Study`]. Out: blocks and sentences.
//! Never computes results.

use super::block::Block;
use super::number::{fixed, percent, signed, signed_percent};
use crate::{AreaGrowth, Lives, Orderings, Prediction, Protocol, Study, TABLE_2, UnderProtocol};

/// Part of the data sets in which a claim holds.
type Share = fn(&Orderings) -> f64;

/// What the paper says about its three models: as a sentence, as the title of a column.
const CLAIMS: [(&str, &str, Share); 5] = [
    ("the proposed model has the smallest error", "proposed nearest", |found| found.proposed_is_nearest),
    ("the proposed model has the smallest scatter", "proposed narrowest", |found| {
        found.proposed_is_narrowest
    }),
    ("both baselines predict too long a life", "baselines too long", |found| found.baselines_over_predict),
    ("baseline 1 predicts the longest life", "baseline 1 longest", |found| found.rigid_is_longest),
    ("all of these at once", "all", |found| found.all),
];

/// Places in [`crate::MODELS`].
const PROPOSED: usize = 0;
const RIGID: usize = 1;
const NO_FEEDBACK: usize = 2;

pub(super) fn blocks(study: &Study) -> Vec<Block> {
    vec![Block::Heading(2, "Findings"), Block::List(sentences(study)), orderings(study), areas(study)]
}

/// The findings, one by one.
fn sentences(study: &Study) -> Vec<String> {
    let mut found: Vec<String> = CLAIMS.iter().map(|(claim, _, of)| claimed(study, claim, *of)).collect();
    found.extend([
        nearest_to_the_paper(study),
        by_definition("Proposed, fitted on all cycles", study, proposed),
        by_definition("Baseline 2, no feedback", study, no_feedback) + NO_FEEDBACK_WHY,
        by_definition("Baseline 1, rigid coupler", study, rigid) + &rigid_why(study),
        cancellation(study),
        vibration(study),
        area(study),
    ]);
    found
}

/// Every definition of wear under every protocol.
fn cases(study: &Study) -> impl Iterator<Item = (&Lives, &UnderProtocol)> {
    study.lives.iter().flat_map(|lives| lives.protocols.iter().map(move |under| (lives, under)))
}

fn case((lives, under): (&Lives, &UnderProtocol)) -> String {
    format!("{}, {}", definition(lives), under.protocol.name())
}

fn definition(lives: &Lives) -> String {
    format!("W the {}, gamma {}", lives.wear, lives.gamma)
}

/// In how many cases a claim of the paper holds.
fn claimed(study: &Study, claim: &str, of: Share) -> String {
    let shares: Vec<_> = cases(study).map(|at| (at, of(&at.1.orderings))).collect();
    let holds = shares.iter().filter(|(_, part)| *part > 0.5).count();
    let best = shares.iter().max_by(|a, b| a.1.total_cmp(&b.1));
    let worst = shares.iter().min_by(|a, b| a.1.total_cmp(&b.1));
    let (Some(best), Some(worst)) = (best, worst) else { return String::new() };
    format!(
        "The paper: {claim}. Here this holds in most data sets in {holds} of {} cases; most often ({} of the data sets) \
         with {}, least often ({}) with {}.",
        shares.len(),
        percent(best.1),
        case(best.0),
        percent(worst.1),
        case(worst.0),
    )
}

/// The case whose three errors are nearest to those of the paper's Table 2.
fn nearest_to_the_paper(study: &Study) -> String {
    let distance = |under: &UnderProtocol| -> f64 {
        let pairs = under.predictions.iter().zip(TABLE_2);
        pairs.map(|(found, printed)| (found.error - printed.error).powi(2)).sum()
    };
    let nearest = cases(study).min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
    let Some(nearest) = nearest else { return String::new() };
    let models = nearest.1.predictions.iter().zip(TABLE_2).map(|(found, printed)| {
        format!("{} {} (paper: {})", found.model, result(found), signed_percent(printed.error, 2))
    });
    format!(
        "Nearest to the errors of the paper's Table 2, of all cases, comes {}: {}.",
        case(nearest),
        models.collect::<Vec<_>>().join(", ")
    )
}

/// "+3.1 ± 0.7 % (COV 3.3 %)".
fn result(found: &Prediction) -> String {
    let (scatter, cov) = (100.0 * found.error_scatter, 100.0 * found.lives.cov);
    format!("{} ± {scatter:.2} % (COV {cov:.2} %)", signed(100.0 * found.error, 2))
}

/// How an error compares with its scatter over data sets.
fn weight(found: &Prediction) -> &'static str {
    match found.error.abs() / found.error_scatter {
        part if part > 3.0 => "far beyond the scatter",
        part if part > 1.0 => "more than the scatter",
        _ => "within the scatter",
    }
}

/// One result after the other, each with its definition of wear.
fn by_definition(what: &str, study: &Study, says: fn(&Lives) -> String) -> String {
    let all: Vec<String> =
        study.lives.iter().map(|lives| format!("{}: {}", definition(lives), says(lives))).collect();
    format!("{what}. {}.", all.join("; "))
}

fn proposed(lives: &Lives) -> String {
    let found = &lives.under(Protocol::All)[PROPOSED];
    format!("error {}, {}", result(found), weight(found))
}

/// Why its errors are what they are.
const NO_FEEDBACK_WHY: &str = " A model without feedback cannot know that the wear of a cycle changes: it takes the \
                               rate of the cycles that it has seen for the rate of all, so that its error depends on \
                               the window, and it reads the change as scatter.";

fn no_feedback(lives: &Lives) -> String {
    let [early, all] = [Protocol::First20, Protocol::All].map(|fitted| &lives.under(fitted)[NO_FEEDBACK]);
    let (first, last) = lives.ratio[NO_FEEDBACK];
    format!(
        "error {} fitted on the first 20 cycles, {} on all, where the wear of a cycle changes by {} over the life",
        result(early),
        result(all),
        signed_percent(first / last - 1.0, 0),
    )
}

fn rigid(lives: &Lives) -> String {
    let [early, all] = [Protocol::First20, Protocol::All].map(|fitted| &lives.under(fitted)[RIGID]);
    let (first, last) = lives.ratio[RIGID];
    format!(
        "error {} fitted on the first 20 cycles, {}, {} on all; its dLambda is {first:.3} times that of the truth at the \
         start and {last:.3} times at the end",
        result(early),
        weight(early),
        result(all),
    )
}

/// What the rigid coupler does to wear, by definition of wear.
fn rigid_why(study: &Study) -> String {
    let apart = |lives: &Lives| {
        let fitted = [Protocol::All, Protocol::First20, Protocol::First10].map(|fitted| lives.under(fitted));
        fitted
            .map(|models| (models[RIGID].error - models[PROPOSED].error).abs())
            .into_iter()
            .fold(0.0, f64::max)
    };
    let largest =
        |wear: &str| study.lives.iter().filter(|lives| lives.wear == wear).map(apart).fold(0.0, f64::max);
    format!(
        " With W the depth, which depends on the work of friction and the area alone, its mean life differs from the \
         proposed model's by {:.2} % at most after any fit: life cannot tell the two apart. With W the largest depth \
         they differ by up to {:.1} %: the chattering journal spreads its wear over a wider arc, and how much wider \
         changes with the clearance, which no constant factor makes good.",
        100.0 * largest("depth"),
        100.0 * largest("largest depth"),
    )
}

/// Why constant factors do not matter.
fn cancellation(study: &Study) -> String {
    let shared = study.lives.iter().map(|lives| {
        let error = |protocol| signed_percent(lives.under(protocol)[RIGID].error, 1);
        format!("{} and {} ({})", error(Protocol::Shared), error(Protocol::All), definition(lives))
    });
    format!(
        "Cancellation: the fit gives beta = alpha sum dLambda/sum dW, so a constant factor between the dLambda of two \
         models changes alpha and nothing else. Only a change of the ratio along the life is left. Errors of baseline 1 \
         with the parameters of the truth, and fitted on all cycles: {}.",
        shared.collect::<Vec<_>>().join(", ")
    )
}

/// What flexibility does to the dynamics.
fn vibration(study: &Study) -> String {
    let last = |model: &str| study.tables.iter().rfind(|table| table.model == model);
    let (Some(rigid), Some(flexible)) = (last("rigid"), last("flexible")) else { return String::new() };
    format!(
        "Damping: the journal swings in its bearing as a pendulum under the load, which Coulomb sliding hardly damps. The \
         elastic coupler damps it, a rigid one keeps it: at the clearance of the worn joint the largest force is {:.0} N \
         rigid and {:.0} N flexible, and the rigid motion is chaotic. Still the wear integral S differs by {} only at \
         the start and by {} at the end. That vibration, not a redistribution of the load, is what flexibility changes \
         at this speed: the mean force of the flexible linkage is within {:.2} % of that of an ideal joint.",
        rigid.peak_force_last,
        flexible.peak_force_last,
        signed_percent(rigid.wear_integral_first / flexible.wear_integral_first - 1.0, 1),
        signed_percent(rigid.wear_integral_last / flexible.wear_integral_last - 1.0, 1),
        100.0 * (study.forces.flexible.mean / study.forces.ideal.mean - 1.0).abs(),
    )
}

/// What the model of the area does.
fn area(study: &Study) -> String {
    let growth = |area: &AreaGrowth| {
        format!(
            "c^{:.3} by the {} area (rigid over flexible {} unworn, {} worn)",
            area.flexible,
            area.area,
            signed_percent(area.ratio_first - 1.0, 1),
            signed_percent(area.ratio_last - 1.0, 1),
        )
    };
    let all: Vec<String> = study.areas.iter().map(growth).collect();
    format!(
        "Area model: the paper leaves the contact area open, and it decides how strong the feedback is. The depth of a \
         revolution grows as {}.",
        all.join(", ")
    )
}

fn orderings(study: &Study) -> Block {
    let holds =
        |claim: usize, (_, under): &(&Lives, &UnderProtocol)| percent(CLAIMS[claim].2(&under.orderings));
    Block::table(
        "The orderings of the paper, in so many of the data sets",
        cases(study),
        &[
            ("W", &|(lives, _)| lives.wear.to_owned()),
            ("gamma", &|(lives, _)| lives.gamma.to_string()),
            ("fitted on", &|(_, under)| under.protocol.name().to_owned()),
            (CLAIMS[0].1, &|case| holds(0, case)),
            (CLAIMS[1].1, &|case| holds(1, case)),
            (CLAIMS[2].1, &|case| holds(2, case)),
            (CLAIMS[3].1, &|case| holds(3, case)),
            (CLAIMS[4].1, &|case| holds(4, case)),
        ],
    )
}

fn areas(study: &Study) -> Block {
    Block::table(
        "Growth of the depth of a revolution with the clearance, dLambda ~ c^n, by model of the contact area; gamma 1",
        &study.areas,
        &[
            ("area", &|area| area.area.to_owned()),
            ("n, flexible", &|area| fixed(area.flexible, 4)),
            ("n, rigid", &|area| fixed(area.rigid, 4)),
            ("rigid/flexible, unworn", &|area| fixed(area.ratio_first, 4)),
            ("worn", &|area| fixed(area.ratio_last, 4)),
        ],
    )
}
