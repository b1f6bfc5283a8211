//! Fig. 6 and Table 2 in words. In: [`Study`]. Out: blocks. Never knows other figures.

use super::block::Block;
use super::number::{fixed, percent, signed};
use crate::{HISTORIES, Lives, MODELS, Prediction, SHOWN, Study, TABLE_2, TRUE_LIFE};

pub(super) fn blocks(study: &Study) -> Vec<Block> {
    let mut blocks = vec![
        Block::Heading(2, "Remaining useful life (Fig. 6, Table 2)"),
        Block::Text(setting(study)),
        Block::Figure {
            name: "fig6-life",
            caption: format!(
                "Fig. 6. Probability density of life: the truth, and what three models predict from one data set of \
                 {HISTORIES} histories, fitted on their {}.",
                SHOWN.name()
            ),
        },
        the_paper(),
    ];
    blocks.extend(study.lives.iter().map(table));
    blocks.push(Block::Figure {
        name: "table2-errors",
        caption: "Errors of the predicted mean life against the truth: mean and standard deviation over the data sets. \
                  Errors with shared parameters, which are larger, stand in the tables."
            .to_owned(),
    });
    blocks.push(calibration(study));
    blocks
}

fn setting(study: &Study) -> String {
    let sets = study.lives[0].data_sets;
    format!(
        "The paper does not say what its ground truth is, to which wear the models are fitted, nor gamma. Here the \
         truth is the finest own model: flexible coupler, feedback, half the time step; the wear of every cycle is drawn \
         from a Gamma process, starting at the clearance that the wear before has opened. Its beta W_crit = 1092 is \
         backed out of the paper's coefficient of variation, and alpha = beta. Cycles are calibrated once for every \
         definition of wear, so that the mean path of the truth lives {TRUE_LIFE} cycles. All models learn from the same \
         {HISTORIES} histories, each by its own dLambda; this is repeated with {sets} data sets. Four protocols: fit on \
         all cycles until failure, on the first 20, on the first 10, and no fit at all, where all models share the \
         parameters of the truth. A life is counted with the threshold interpolated within its last cycle, and as whole \
         cycles, which is half a cycle more."
    )
}

/// The paper's own numbers.
fn the_paper() -> Block {
    Block::table(
        "Table 2 of the paper (ground truth 25.1 cycles, backed out of mean and error)",
        MODELS.iter().zip(TABLE_2),
        &[
            ("model", &|(model, _)| (**model).to_owned()),
            ("mean [cycles]", &|(_, printed)| fixed(printed.mean, 1)),
            ("std. [cycles]", &|(_, printed)| fixed(printed.std, 2)),
            ("COV [%]", &|(_, printed)| fixed(100.0 * printed.cov, 2)),
            ("error [%]", &|(_, printed)| signed(100.0 * printed.error, 2)),
        ],
    )
}

fn table(lives: &Lives) -> Block {
    let predictions = lives
        .protocols
        .iter()
        .flat_map(|under| under.predictions.iter().map(move |found| (under.protocol.name(), Some(found))));
    let numbers = |found: &Option<&Prediction>| found.map_or(lives.truth, |found| found.lives);
    // The truth has no scatter and no error.
    let with_scatter = |value: String, scatter: Option<f64>| match scatter {
        Some(scatter) => format!("{value} ± {}", fixed(100.0 * scatter, 2)),
        None => value,
    };
    Block::table(
        format!(
            "Table 2, recomputed: W is the {}, gamma = {}; means over {} data sets, ± standard deviation over them",
            lives.wear, lives.gamma, lives.data_sets
        ),
        std::iter::once(("", None)).chain(predictions),
        &[
            ("fitted on", &|(fitted_on, _)| (*fitted_on).to_owned()),
            ("model", &|(_, found)| found.map_or("truth", |found| found.model).to_owned()),
            ("mean [cycles]", &|(_, found)| fixed(numbers(found).mean, 2)),
            ("std. [cycles]", &|(_, found)| fixed(numbers(found).std, 3)),
            ("COV [%]", &|(_, found)| {
                with_scatter(fixed(100.0 * numbers(found).cov, 2), found.map(|found| found.cov_scatter))
            }),
            ("error [%]", &|(_, found)| {
                let error = found.map_or(String::new(), |found| signed(100.0 * found.error, 2));
                with_scatter(error, found.map(|found| found.error_scatter))
            }),
            ("too long in", &|(_, found)| found.map_or(String::new(), |found| percent(found.over_predicts))),
            ("whole cycles: mean", &|(_, found)| fixed(numbers(found).mean_whole, 2)),
            ("COV [%]", &|(_, found)| fixed(100.0 * numbers(found).cov_whole, 2)),
        ],
    )
}

fn calibration(study: &Study) -> Block {
    let life = |lives: &Lives, model: usize| fixed(lives.deterministic[model], 2);
    let ratio = |lives: &Lives, model: usize| {
        let (first, last) = lives.ratio[model];
        format!("{} {}", fixed(first, 4), fixed(last, 4))
    };
    Block::table(
        "Behind the lives: the calibrated cycle, the exponent n of dLambda ~ c^n along the life of the truth; and for every \
         model its deterministic life without any fit, and its dLambda over that of the truth at the start and at the end",
        &study.lives,
        &[
            ("W", &|lives| lives.wear.to_owned()),
            ("gamma", &|lives| lives.gamma.to_string()),
            ("revolutions per cycle", &|lives| format!("{:.4e}", lives.revolutions_per_cycle)),
            ("n", &|lives| fixed(lives.exponent, 3)),
            ("proposed: life", &|lives| life(lives, 0)),
            ("ratio", &|lives| ratio(lives, 0)),
            ("baseline 1: life", &|lives| life(lives, 1)),
            ("ratio", &|lives| ratio(lives, 1)),
            ("baseline 2: life", &|lives| life(lives, 2)),
            ("ratio", &|lives| ratio(lives, 2)),
        ],
    )
}
