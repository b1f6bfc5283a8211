//! A digital twin of the shipped linkage RSSR: it reads inspections of the bearing R1 as they come and says after each how
//! long the bearing will last, and what to do.
//!
//!     cargo run -- inspections.csv        every line of a file
//!     tail -f inspections.csv | cargo run -- -      lines as they are written
//!
//! The picture `plan.svg` is drawn anew after every line.

mod exposure;
mod picture;
mod plan;

use std::error::Error;
use std::fs::File;
use std::io::{BufRead, BufReader, stdin};
use std::path::Path;

use exposure::Exposure;
use plan::{Inspection, Twin};

mod rssr {
    linkwear_runtime::include_mechanism!("rssr");
}

fn main() -> Result<(), Box<dyn Error>> {
    let source =
        std::env::args().nth(1).ok_or("which file? `inspections.csv`, or `-` for lines that come in")?;
    let lines: Box<dyn BufRead> = match &*source {
        "-" => Box::new(stdin().lock()),
        file => Box::new(BufReader::new(File::open(file).map_err(|error| format!("{file}: {error}"))?)),
    };
    eprintln!("measuring what a revolution wears at each clearance ...");
    let bar = rssr::Mechanism::default();
    let mut twin = Twin::new(Exposure::measure(&bar, rssr::description(), &bar.parameters())?)?;
    println!("cycle  wear [um]  rate / model  B10 left  median left  B90 left  advice");
    for (number, line) in lines.lines().enumerate() {
        let line = line?;
        let Some(inspection) = read(&line).map_err(|error| format!("line {}: {error}", number + 1))? else {
            continue;
        };
        let plan = twin.inspected(inspection).map_err(|error| format!("line {}: {error}", number + 1))?;
        println!("{plan}");
        picture::draw(Path::new("plan.svg"), &twin, &plan)?;
    }
    Ok(())
}

/// The inspection of a line `cycle,wear_um`; none in comments and the header.
fn read(line: &str) -> Result<Option<Inspection>, String> {
    let line = line.trim();
    if line.is_empty() || line.starts_with('#') || line.starts_with("cycle") {
        return Ok(None);
    }
    let number =
        |cell: Option<&str>| cell.and_then(|cell| cell.trim().parse::<f64>().ok().filter(|x| x.is_finite()));
    let mut cells = line.split(',');
    match (number(cells.next()), number(cells.next()), cells.next()) {
        (Some(cycle), Some(wear), None) => Ok(Some(Inspection { cycle, wear: 1e-6 * wear })),
        _ => Err(format!("`{line}` is not `cycle,wear in um`")),
    }
}
