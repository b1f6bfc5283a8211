//! The study in words: ours beside the paper's, figure by figure. In: [`Study`]. Out: Markdown, HTML. Every sentence that
//! depends on a number is made from it. Never computes results.

mod block;
mod findings;
mod force;
mod lives;
mod number;
mod wear;

use block::Block;
use number::signed;

use super::{Lives, Picture, SHOWN, Study};

const TITLE: &str = "The case study of the RSSR linkage, recomputed";

/// The study in Markdown; figures are the SVG files of the same folder.
pub fn markdown(study: &Study) -> String {
    block::markdown(&document(study))
}

/// The study as one HTML page with its figures in it.
pub fn html(study: &Study, pictures: &[Picture]) -> String {
    let svg_of =
        |name: &str| pictures.iter().find(|known| known.name == name).map(|known| known.svg.as_str());
    block::html(TITLE, &document(study), &svg_of)
}

/// The study in a few lines, for a terminal.
pub fn summary(study: &Study) -> String {
    let (forces, around) = (&study.forces, &study.around);
    let peak = |bearing: &super::WornBearing| {
        let last = bearing.snapshots.last().and_then(|snapshot| snapshot.peaks.first());
        last.map_or_else(String::new, |peak| format!("{:+.1} deg", peak.angle))
    };
    format!(
        "Fig. 4  force of the flexible coupler against Exudyn: {:.1e} of its root mean square\n        \
         peaks {:.1} N ideal, {:.1} N flexible, {:.1} N rigid with clearance\n\
         Fig. 5  deepest wear at {} (deterministic), {} (proposed), {} (finest)",
        forces.error,
        forces.ideal.peak,
        forces.flexible.peak,
        forces.rigid.peak,
        peak(&around.deterministic),
        peak(&around.proposed),
        peak(&around.finest),
    ) + &study.lives.iter().enumerate().map(life_in_short).collect::<String>()
}

fn life_in_short((at, lives): (usize, &Lives)) -> String {
    let predicted = lives.under(SHOWN).iter().map(|found| {
        let (scatter, cov) = (100.0 * found.error_scatter, 100.0 * found.lives.cov);
        let error = signed(100.0 * found.error, 2);
        format!("\n        {:<24} {error:>6} ± {scatter:.2} %, COV {cov:.2} %", found.model)
    });
    format!(
        "\n{:<6}  error of the mean life, W the {}, gamma {}, fitted on the {}{}",
        if at == 0 { "Fig. 6" } else { "" },
        lives.wear,
        lives.gamma,
        SHOWN.name(),
        predicted.collect::<String>()
    )
}

fn document(study: &Study) -> Vec<Block> {
    let mut blocks = vec![
        Block::Heading(1, TITLE),
        Block::Text(
            "Section 5 of \"A Coupled Rigid-Flexible Dynamics and Stochastic Process Model for Wear Prediction in \
             Multi-bar Linkages\", figure by figure: what linkwear computes from mechanisms/rssr.toml beside what \
             the paper prints. Nothing was tuned towards the paper's figures."
                .to_owned(),
        ),
    ];
    if study.options.quick {
        blocks.push(Block::Text(
            "This is a quick study: few turns and coarse wear steps, good to test the tool, not to quote."
                .to_owned(),
        ));
    }
    blocks.extend(mechanism(study));
    blocks.extend(force::blocks(&study.forces));
    blocks.extend(wear::blocks(&study.around));
    blocks.extend(lives::blocks(study));
    blocks.extend(findings::blocks(study));
    blocks
}

fn mechanism(study: &Study) -> Vec<Block> {
    let assumed = study.parameters.iter().filter(|row| row.assumed).count();
    vec![
        Block::Heading(2, "Mechanism (Fig. 3, Table 1)"),
        Block::Figure {
            name: "fig3-mechanism",
            caption: "Fig. 3. The mechanism at t = 0, assembled; the crank turns about z at R1. The paper calls the \
                      spherical joints R2 and R3; they are S2 and S3 here."
                .to_owned(),
        },
        Block::table(
            "Table 1. Parameters, the paper's and ours",
            &study.parameters,
            &[
                ("parameter", &|row| row.name.clone()),
                ("symbol or place", &|row| row.symbol.clone()),
                ("paper", &|row| row.paper.clone().unwrap_or_else(|| "not given".to_owned())),
                ("here", &|row| row.ours.clone().unwrap_or_else(|| "not used".to_owned())),
                ("", &|row| if row.assumed { "assumed" } else { "" }.to_owned()),
            ],
        ),
        Block::Text(format!(
            "{assumed} values are ours because the paper is silent; the file marks them as assumed. So are, as \
             written there: the axes of R1 (z) and R4 (y), gravity along -z, solid rods of the coupler's radius for \
             crank and rocker, and which of the two ways of assembly is taken."
        )),
    ]
}
