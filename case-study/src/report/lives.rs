//! Fig. 6 and Table 2 in words. In: [`Study`]. Out: blocks. Never knows other figures.

use super::block::Block;
use super::number::{fixed, percent, signed};
use crate::{
    HISTORIES, LifeNumbers, Lives, MODELS, Prediction, SHOWN, Study, TABLE_2, TRUE_LIFE, UnderProtocol,
};

pub(super) fn blocks(study: &Study) -> Vec<Block> {
    let mut blocks = vec![
        Block::Heading(2, "Remaining useful life (Fig. 6, Table 2)".to_owned()),
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
    let sets = study.lives.first().map_or(0, |lives| lives.data_sets);
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
    let rows = MODELS.iter().zip(TABLE_2).map(|(model, printed)| {
        vec![
            (*model).to_owned(),
            fixed(printed.mean, 1),
            fixed(printed.std, 2),
            fixed(100.0 * printed.cov, 2),
            signed(100.0 * printed.error, 2),
        ]
    });
    Block::table(
        "Table 2 of the paper (ground truth 25.1 cycles, backed out of mean and error)",
        &["model", "mean [cycles]", "std. [cycles]", "COV [%]", "error [%]"],
        rows.collect(),
    )
}

fn table(lives: &Lives) -> Block {
    let mut rows = vec![truth(&lives.truth)];
    for under in &lives.protocols {
        rows.extend(under.predictions.iter().map(|prediction| row(under, prediction)));
    }
    Block::table(
        &format!(
            "Table 2, recomputed: W is the {}, gamma = {}; means over {} data sets, ± standard deviation over them",
            lives.wear, lives.gamma, lives.data_sets
        ),
        &[
            "fitted on",
            "model",
            "mean [cycles]",
            "std. [cycles]",
            "COV [%]",
            "error [%]",
            "too long in",
            "whole cycles: mean",
            "COV [%]",
        ],
        rows,
    )
}

fn truth(truth: &LifeNumbers) -> Vec<String> {
    let mut row = vec!["".to_owned(), "truth".to_owned()];
    row.extend([fixed(truth.mean, 2), fixed(truth.std, 3), fixed(100.0 * truth.cov, 2)]);
    row.extend(["".to_owned(), "".to_owned()]);
    row.extend([fixed(truth.mean_whole, 2), fixed(100.0 * truth.cov_whole, 2)]);
    row
}

fn row(under: &UnderProtocol, prediction: &Prediction) -> Vec<String> {
    let lives = &prediction.lives;
    vec![
        under.protocol.name().to_owned(),
        prediction.model.to_owned(),
        fixed(lives.mean, 2),
        fixed(lives.std, 3),
        format!("{} ± {}", fixed(100.0 * lives.cov, 2), fixed(100.0 * prediction.cov_scatter, 2)),
        format!("{} ± {}", signed(100.0 * prediction.error, 2), fixed(100.0 * prediction.error_scatter, 2)),
        percent(prediction.over_predicts),
        fixed(lives.mean_whole, 2),
        fixed(100.0 * lives.cov_whole, 2),
    ]
}

fn calibration(study: &Study) -> Block {
    let rows = study.lives.iter().map(|lives| {
        let mut row = vec![
            lives.wear.to_owned(),
            lives.gamma.to_string(),
            format!("{:.4e}", lives.revolutions_per_cycle),
            fixed(lives.exponent, 3),
        ];
        for (life, ratio) in lives.deterministic.iter().zip(&lives.ratio) {
            row.extend([fixed(*life, 2), format!("{} {}", fixed(ratio.0, 4), fixed(ratio.1, 4))]);
        }
        row
    });
    Block::table(
        "Behind the lives: the calibrated cycle, the exponent n of dLambda ~ c^n along the life of the truth; and for every \
         model its deterministic life without any fit, and its dLambda over that of the truth at the start and at the end",
        &[
            "W",
            "gamma",
            "revolutions per cycle",
            "n",
            "proposed: life",
            "ratio",
            "baseline 1: life",
            "ratio",
            "baseline 2: life",
            "ratio",
        ],
        rows.collect(),
    )
}
