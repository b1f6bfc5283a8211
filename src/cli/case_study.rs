//! `case-study`: the figures and tables of the paper's case study, recomputed, in a folder.

use std::fs;
use std::io::{self, Write as _};
use std::path::Path;
use std::sync::Mutex;

use linkwear::case_study::{self, Options, Picture, Study, StudyError};
use serde_json::Value;

use super::failure::Failure;
use super::file::{print, write_whole};
use super::progress::{Progress, catch_interrupts, stop_requested};
use super::{CaseStudyArguments, Format};

/// Answers `case-study`.
pub fn run(arguments: &CaseStudyArguments, format: Format) -> Result<(), Failure> {
    refuse_used(&arguments.out)?;
    catch_interrupts();
    let options = Options { quick: arguments.quick, seed: arguments.seed };
    let threads = arguments.threads.map_or_else(processors, |threads| usize::from(threads.get()));
    let progress = Mutex::new(Progress::new());
    let hear = |part: f64| {
        if let Ok(mut progress) = progress.lock() {
            progress.set(part);
        }
    };
    let studied = case_study::run(options, threads, &hear, &stop_requested);
    if let Ok(progress) = progress.lock() {
        progress.finish();
    }
    let study = studied.map_err(failed)?;
    let pictures = case_study::pictures(&study).map_err(failed)?;
    let results = serde_json::to_value(&study)
        .map_err(|error| Failure::Write(arguments.out.join("results.json"), io::Error::other(error)))?;
    let files = write(&arguments.out, &study, &pictures, &results)?;
    match format {
        Format::Json => print(&results),
        Format::Text => print(&said(&arguments.out, &study, &files)),
    }
}

fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// A folder with something in it may be a study of somebody.
fn refuse_used(folder: &Path) -> Result<(), Failure> {
    match fs::read_dir(folder) {
        Ok(mut entries) => match entries.next() {
            Some(_) => Err(Failure::Exists(folder.to_path_buf())),
            None => Ok(()),
        },
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(Failure::Write(folder.to_path_buf(), error)),
    }
}

fn failed(error: StudyError) -> Failure {
    match error {
        StudyError::Mechanism(diagnostics) => Failure::Mechanism(diagnostics),
        error => Failure::Study(error),
    }
}

/// Writes every file whole; returns their names.
fn write(out: &Path, study: &Study, pictures: &[Picture], results: &Value) -> Result<Vec<String>, Failure> {
    fs::create_dir_all(out).map_err(|error| Failure::Write(out.to_path_buf(), error))?;
    let mut files: Vec<(String, Vec<u8>)> = Vec::new();
    for picture in pictures {
        files.push((format!("{}.svg", picture.name), picture.svg.clone().into_bytes()));
        files.push((format!("{}.png", picture.name), picture.png.clone()));
    }
    files.push(("case-study.md".to_owned(), case_study::markdown(study).into_bytes()));
    files.push(("case-study.html".to_owned(), case_study::html(study, pictures).into_bytes()));
    files.push(("results.json".to_owned(), format!("{results:#}\n").into_bytes()));
    for (name, bytes) in &files {
        write_whole(&out.join(name), |file| file.write_all(bytes))?;
    }
    Ok(files.into_iter().map(|(name, _)| name).collect())
}

fn said(out: &Path, study: &Study, files: &[String]) -> String {
    format!("{}\n\nin {}: {}", case_study::summary(study), out.display(), files.join(", "))
}
