//! Fig. 4 in words. In: [`Forces`]. Out: blocks. Never knows other figures.

use super::block::Block;
use super::number::fixed;
use crate::Forces;

pub(super) fn blocks(forces: &Forces) -> Vec<Block> {
    let curves = [
        ("ideal joint", &forces.ideal),
        ("clearance, rigid coupler", &forces.rigid),
        ("clearance, flexible coupler", &forces.flexible),
        ("Exudyn, from its rows 1 ms apart", &forces.reference),
    ];
    vec![
        Block::Heading(2, "Joint contact force (Fig. 4)"),
        Block::Figure {
            name: "fig4-force",
            caption: "Fig. 4. Contact force at R1 over one turn at 2 Hz, after settling. The turn begins with the crank \
                      along x."
                .to_owned(),
        },
        Block::table(
            "Fig. 4 in numbers: one turn",
            curves,
            &[
                ("model", &|(name, _)| (*name).to_owned()),
                ("mean [N]", &|(_, curve)| fixed(curve.mean, 3)),
                ("peak [N]", &|(_, curve)| fixed(curve.peak, 2)),
                ("at [s]", &|(_, curve)| fixed(curve.peak_time, 4)),
                ("crank [deg]", &|(_, curve)| fixed(360.0 * curve.peak_time / forces.period, 0)),
                ("wear integral S [J]", &|(_, curve)| fixed(curve.wear_integral, 5)),
                ("losses of contact", &|(_, curve)| curve.contact_losses.to_string()),
            ],
        ),
        Block::Text(agreement(forces)),
        Block::Text(against_the_paper(forces)),
    ]
}

fn agreement(forces: &Forces) -> String {
    let chatter = forces.rigid.peak / forces.flexible.peak - 1.0;
    format!(
        "With the coupler frequencies of the Exudyn model (138.042, 550.64, 1233.27 Hz) the force of the flexible \
         mechanism differs from Exudyn's by {:.1e} of its root mean square; with the frequencies of the file, by \
         {:.1e}. The rigid coupler's turn is one of a chaotic motion: its journal chatters (peak {:+.0} % of the \
         flexible one's), and only statistics over many turns mean something. The elastic coupler damps that \
         vibration; it leaves the load itself as it is (the mean differs from the ideal joint's by {:.2} %).",
        forces.error,
        forces.error_as_shipped,
        100.0 * chatter,
        100.0 * (forces.flexible.mean / forces.ideal.mean - 1.0).abs(),
    )
}

/// The paper's words: "rapid decay initially, followed by significant amplification near the end configuration".
fn against_the_paper(forces: &Forces) -> String {
    let shape = &forces.shape;
    let decays = shape.first >= shape.early_peak && shape.middle < 0.5 * shape.first;
    let grows = shape.late_peak > 1.5 * shape.middle;
    let verdict = match (decays, grows) {
        (true, true) => "Both parts of the description hold here.",
        (true, false) => "The decay is found here, the amplification at the end is not.",
        (false, true) => "The amplification at the end is found here, the decay at the start is not.",
        (false, false) => "Neither is found in a turn that begins with the crank along x.",
    };
    format!(
        "The paper describes its curve as \"rapid decay initially, followed by significant amplification near the \
         end configuration\" and prints no numbers with it. Here the force is {:.1} N at the start, rises to {:.1} N \
         in the first tenth of the turn, has a mean of {:.1} N between the first tenth and the last fifth, reaches \
         {:.1} N in the last fifth and ends with {:.1} N. {verdict} The paper does not say with which position of \
         the crank its cycle begins, nor where its fixed joints are; our largest force acts at a crank angle of {:.0} deg. A \
         cycle that is counted from just after it would begin with a decay and end with a rise.",
        shape.first,
        shape.early_peak,
        shape.middle,
        shape.late_peak,
        shape.last,
        360.0 * forces.flexible.peak_time / forces.period,
    )
}
