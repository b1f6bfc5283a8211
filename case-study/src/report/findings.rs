//! What the study found, in words that depend on its numbers. In: [`Study`]. Out: blocks and sentences.
//! Never computes results.

use super::block::Block;
use super::number::{fixed, percent, signed};
use crate::{AreaGrowth, Lives, Orderings, Prediction, Protocol, Study, TABLE_2, UnderProtocol};

/// Part of the data sets in which a claim holds.
type Share = fn(&Orderings) -> f64;

/// What the paper says about its three models.
const CLAIMS: [(&str, Share); 5] = [
    ("the proposed model has the smallest error", |orderings| orderings.proposed_is_nearest),
    ("the proposed model has the smallest scatter", |orderings| orderings.proposed_is_narrowest),
    ("both baselines predict too long a life", |orderings| orderings.baselines_over_predict),
    ("baseline 1 predicts the longest life", |orderings| orderings.rigid_is_longest),
    ("all of these at once", |orderings| orderings.all),
];

/// Places in [`crate::MODELS`].
const PROPOSED: usize = 0;
const RIGID: usize = 1;
const NO_FEEDBACK: usize = 2;

pub(super) fn blocks(study: &Study) -> Vec<Block> {
    vec![
        Block::Heading(2, "Findings".to_owned()),
        Block::List(sentences(study)),
        orderings(study),
        areas(study),
    ]
}

/// The findings, one by one.
pub(super) fn sentences(study: &Study) -> Vec<String> {
    let mut found: Vec<String> = CLAIMS.iter().map(|(claim, of)| claimed(study, claim, *of)).collect();
    found.push(nearest_to_the_paper(study));
    found.push(by_definition("Proposed, fitted on all cycles", study, proposed));
    found.push(by_definition("Baseline 2, no feedback", study, no_feedback) + NO_FEEDBACK_WHY);
    found.push(by_definition("Baseline 1, rigid coupler", study, rigid) + &rigid_why(study));
    found.push(cancellation(study));
    found.push(vibration(study));
    found.push(area(study));
    found
}

/// In how many cases a claim of the paper holds.
fn claimed(study: &Study, claim: &str, of: Share) -> String {
    let cases: Vec<(String, f64)> = study
        .lives
        .iter()
        .flat_map(|lives| {
            lives.protocols.iter().map(move |under| (case(lives, under.protocol), of(&under.orderings)))
        })
        .collect();
    let holds = cases.iter().filter(|(_, part)| *part > 0.5).count();
    let best = cases.iter().max_by(|a, b| a.1.total_cmp(&b.1));
    let worst = cases.iter().min_by(|a, b| a.1.total_cmp(&b.1));
    let (Some(best), Some(worst)) = (best, worst) else { return String::new() };
    format!(
        "The paper: {claim}. Here this holds in most data sets in {holds} of {} cases; most often ({} of the data sets) \
         with {}, least often ({}) with {}.",
        cases.len(),
        percent(best.1),
        best.0,
        percent(worst.1),
        worst.0,
    )
}

/// The case whose three errors are nearest to those of the paper's Table 2.
fn nearest_to_the_paper(study: &Study) -> String {
    let distance = |under: &UnderProtocol| -> f64 {
        let pairs = under.predictions.iter().zip(TABLE_2);
        pairs.map(|(found, printed)| (found.error - printed.error).powi(2)).sum()
    };
    let cases = study.lives.iter().flat_map(|lives| lives.protocols.iter().map(move |under| (lives, under)));
    let nearest = cases.min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
    let Some((lives, under)) = nearest else { return String::new() };
    let models = under.predictions.iter().zip(TABLE_2).map(|(found, printed)| {
        format!("{} {} (paper: {} %)", found.model, result(Some(found)), signed(100.0 * printed.error, 2))
    });
    format!(
        "Nearest to the errors of the paper's Table 2, of all cases, comes {}: {}.",
        case(lives, under.protocol),
        models.collect::<Vec<_>>().join(", ")
    )
}

fn case(lives: &Lives, protocol: Protocol) -> String {
    format!("W the {}, gamma {}, {}", lives.wear, lives.gamma, protocol.name())
}

fn of(lives: &Lives, protocol: Protocol, model: usize) -> Option<&Prediction> {
    lives.under(protocol).and_then(|under: &UnderProtocol| under.predictions.get(model))
}

/// "+3.1 ± 0.7 % (COV 3.3 %)".
fn result(prediction: Option<&Prediction>) -> String {
    prediction.map_or_else(String::new, |prediction| {
        format!(
            "{} ± {} % (COV {} %)",
            signed(100.0 * prediction.error, 2),
            fixed(100.0 * prediction.error_scatter, 2),
            fixed(100.0 * prediction.lives.cov, 2)
        )
    })
}

/// How an error compares with its scatter over data sets.
fn weight(prediction: Option<&Prediction>) -> &'static str {
    let part = prediction.map_or(0.0, |prediction| prediction.error.abs() / prediction.error_scatter);
    match part {
        part if part > 3.0 => "far beyond the scatter",
        part if part > 1.0 => "more than the scatter",
        _ => "within the scatter",
    }
}

/// One result after the other, each with its definition of wear.
fn by_definition(what: &str, study: &Study, says: fn(&Lives) -> String) -> String {
    let all = study
        .lives
        .iter()
        .map(|lives| format!("W the {}, gamma {}: {}", lives.wear, lives.gamma, says(lives)));
    format!("{what}. {}.", all.collect::<Vec<_>>().join("; "))
}

fn proposed(lives: &Lives) -> String {
    let found = of(lives, Protocol::All, PROPOSED);
    format!("error {}, {}", result(found), weight(found))
}

/// Why its errors are what they are.
const NO_FEEDBACK_WHY: &str = " A model without feedback cannot know that the wear of a cycle changes: it takes the \
                               rate of the cycles that it has seen for the rate of all, so that its error depends on \
                               the window, and it reads the change as scatter.";

fn no_feedback(lives: &Lives) -> String {
    let (early, all) = (of(lives, Protocol::First20, NO_FEEDBACK), of(lives, Protocol::All, NO_FEEDBACK));
    let growth = lives.ratio.get(NO_FEEDBACK).map_or(1.0, |ratio| ratio.0 / ratio.1);
    format!(
        "error {} fitted on the first 20 cycles, {} on all, where the wear of a cycle changes by {} % over the life",
        result(early),
        result(all),
        signed(100.0 * (growth - 1.0), 0),
    )
}

fn rigid(lives: &Lives) -> String {
    let (early, all) = (of(lives, Protocol::First20, RIGID), of(lives, Protocol::All, RIGID));
    let (first, last) = lives.ratio.get(RIGID).copied().unwrap_or((1.0, 1.0));
    format!(
        "error {} fitted on the first 20 cycles, {}, {} on all; its dLambda is {} times that of the truth at the start \
         and {} times at the end",
        result(early),
        weight(early),
        result(all),
        fixed(first, 3),
        fixed(last, 3),
    )
}

/// What the rigid coupler does to wear, by definition of wear.
fn rigid_why(study: &Study) -> String {
    let fitted = [Protocol::All, Protocol::First20, Protocol::First10];
    let apart = |lives: &Lives| {
        let difference = |protocol: &Protocol| {
            Some((of(lives, *protocol, RIGID)?.error - of(lives, *protocol, PROPOSED)?.error).abs())
        };
        fitted.iter().filter_map(difference).fold(0.0, f64::max)
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
    let shared = study.lives.iter().filter_map(|lives| {
        let errors = (of(lives, Protocol::Shared, RIGID)?.error, of(lives, Protocol::All, RIGID)?.error);
        Some(format!(
            "{} % and {} % (W the {}, gamma {})",
            signed(100.0 * errors.0, 1),
            signed(100.0 * errors.1, 1),
            lives.wear,
            lives.gamma
        ))
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
         elastic coupler damps it, a rigid one keeps it: at the clearance of the worn joint the largest force is {} N \
         rigid and {} N flexible, and the rigid motion is chaotic. Still the wear integral S differs by {} % only at \
         the start and by {} % at the end. That vibration, not a redistribution of the load, is what flexibility changes \
         at this speed: the mean force of the flexible linkage is within {:.2} % of that of an ideal joint.",
        fixed(rigid.peak_force_last, 0),
        fixed(flexible.peak_force_last, 0),
        signed(100.0 * (rigid.wear_integral_first / flexible.wear_integral_first - 1.0), 1),
        signed(100.0 * (rigid.wear_integral_last / flexible.wear_integral_last - 1.0), 1),
        100.0 * (study.forces.flexible.mean / study.forces.ideal.mean - 1.0).abs(),
    )
}

/// What the model of the area does.
fn area(study: &Study) -> String {
    let growth = |area: &AreaGrowth| {
        format!(
            "c^{} by the {} area (rigid over flexible {} % unworn, {} % worn)",
            fixed(area.flexible, 3),
            area.area,
            signed(100.0 * (area.ratio_first - 1.0), 1),
            signed(100.0 * (area.ratio_last - 1.0), 1),
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
    let mut rows = Vec::new();
    for lives in &study.lives {
        for under in &lives.protocols {
            let mut row =
                vec![lives.wear.to_owned(), lives.gamma.to_string(), under.protocol.name().to_owned()];
            row.extend(CLAIMS.iter().map(|(_, of)| percent(of(&under.orderings))));
            rows.push(row);
        }
    }
    Block::table(
        "The orderings of the paper, in so many of the data sets",
        &[
            "W",
            "gamma",
            "fitted on",
            "proposed nearest",
            "proposed narrowest",
            "baselines too long",
            "baseline 1 longest",
            "all",
        ],
        rows,
    )
}

fn areas(study: &Study) -> Block {
    let row = |area: &AreaGrowth| {
        vec![
            area.area.to_owned(),
            fixed(area.flexible, 4),
            fixed(area.rigid, 4),
            fixed(area.ratio_first, 4),
            fixed(area.ratio_last, 4),
        ]
    };
    Block::table(
        "Growth of the depth of a revolution with the clearance, dLambda ~ c^n, by model of the contact area; gamma 1",
        &["area", "n, flexible", "n, rigid", "rigid/flexible, unworn", "worn"],
        study.areas.iter().map(row).collect(),
    )
}
