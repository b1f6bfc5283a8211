//! Draws the picture of the README from a run of the shipped RSSR linkage.
//! `cargo run --release --example readme_picture` writes `docs/rssr.svg`.

mod drawing;

use linkwear::mechanisms::rssr_rigid;
use linkwear::runtime::{Settings, Span, Watch, simulate};

use drawing::Curves;

/// The first turn starts from a guess of the coupler's spin; the picture shows the second.
const TURNS: f64 = 2.0;
/// Rows of one turn; a multiple of the number of ghost positions.
const ROWS_PER_TURN: usize = 240;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mechanism = rssr_rigid::Mechanism::default();
    let description = rssr_rigid::description();
    let settings =
        Settings { span: Span::Turns(TURNS), samples: 2 * ROWS_PER_TURN + 1, ..Settings::default() };
    let run = simulate(&mechanism, description, &mechanism.parameters(), &settings, Watch::NONE)?;
    let vector = |stem: &str| run.vector(stem).map(|rows| rows[ROWS_PER_TURN..].to_vec());
    let length = |v: &[f64; 3]| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    let curves = Curves {
        crank_tip: vector("A.")?,
        rocker_tip: vector("B.")?,
        torque: run.column("R1.drive")?[ROWS_PER_TURN..].to_vec(),
        force: vector("R1.F")?.iter().map(length).collect(),
    };
    std::fs::write("docs/rssr.svg", drawing::svg(&curves))?;
    println!("docs/rssr.svg written");
    Ok(())
}
