//! What holds of any input whatever: an answer or a refusal, never a panic, and no answer that cannot be. In: bytes.
//! Fuzz targets ask with bytes that they breed; `tests/hostile.rs` asks with a few drawn ones and with all that failed.

use std::fs;
use std::path::Path;

use linkwear::csv_table::CsvTable;
use linkwear::life::LifeJournal;
use linkwear_codegen::flexible::ModalData;
use linkwear_codegen::input::Reach;
use linkwear_codegen::model::{Overrides, resolve};
use linkwear_codegen::{Diagnostics, Options, SourceFile, compile, spec};
use linkwear_gamma::data::{Gauge, Observations, Reading, Rounding};
use linkwear_gamma::fit::{Model, estimate};
use linkwear_gamma::life::{Method, OperatingState};
use linkwear_gamma::process::PROCESSES;
use linkwear_gamma::{FitFile, Prediction, Questions};

/// Longest text of an answer: a hundred faults of ten lines.
const MOST_SAID: usize = 1 << 20;
/// Bodies of a mechanism whose equations are derived, too: larger ones take longer than a fuzzer waits.
const MOST_BODIES: usize = 3;
/// Readings that are fitted.
const MOST_READINGS: usize = 40;

/// A mechanism file gives equations, or faults that can be printed.
pub fn mechanism(text: &str) {
    let source = SourceFile { name: "fuzzed.toml".to_owned(), text: text.to_owned() };
    let front = spec::parse(&source).and_then(|spec| resolve(&spec, &Overrides::default(), Reach::Below));
    let small = match front {
        Err(errors) => return refused(&errors),
        Ok((mechanism, _)) => {
            let is_flexible = mechanism.bodies.iter().any(|body| body.flexible.is_some());
            mechanism.bodies.len() <= MOST_BODIES && !is_flexible
        }
    };
    if !small {
        return;
    }
    match compile(&source, &Options::default()) {
        Err(errors) => refused(&errors),
        Ok(compiled) => {
            assert!(!compiled.rust_source().is_empty());
            assert!(compiled.parameters().iter().all(|value| value.is_finite()));
        }
    }
}

fn refused(errors: &Diagnostics) {
    assert!(errors.has_errors());
    let said = errors.to_string();
    assert!(!said.is_empty() && said.len() < MOST_SAID, "{} bytes", said.len());
    assert!(errors.entries().iter().all(|entry| entry.line > 0 && !entry.message.is_empty()));
}

/// A formula, wherever one may stand.
pub fn expression(text: &str) {
    let text = toml::Value::String(text.to_owned());
    mechanism(&format!(
        r#"spec = 1
name = "formula"
[parameters]
a = "0.1 m"
b = {text}
c = {{ value = {text}, tunable = true }}
[points]
O = [0, 0, 0]
A = [{text}, 0, 0]
[bodies]
arm = {{ rod = ["O", "A"], radius = "5 mm", mass = {text} }}
[joints]
R1 = {{ revolute = ["ground", "arm"], at = "O", axis = [0, 0, 1], drive = {text} }}
[forces]
F = {{ force = "arm", at = "A", value = [{text}, "0 N", "0 N"] }}
"#
    ));
}

/// A table of readings gives fits of finite numbers, or a fault.
pub fn readings(text: &str) {
    let Ok(table) = CsvTable::parse(Path::new("fuzzed.csv"), text) else { return };
    let columns = (table.texts("unit"), table.numbers("wear"), table.numbers("exposure"));
    let (Ok(units), Ok(wears), Ok(exposures)) = columns else { return };
    let rows = units.into_iter().zip(wears).zip(exposures).zip(table.lines());
    let readings: Vec<Reading> = rows
        .map(|(((unit, wear), exposure), row)| Reading {
            unit,
            exposure,
            wear,
            covariates: Vec::new(),
            row,
            ..Reading::default()
        })
        .collect();
    if readings.len() > MOST_READINGS {
        return;
    }
    for gauge in [Gauge::Exact, Gauge::Noisy, Gauge::Resolution(Rounding::to(0.5))] {
        for from_zero in [false, true] {
            let Ok(data) = Observations::new(&readings, from_zero, gauge) else { continue };
            let resolution = if let Gauge::Resolution(rounding) = gauge { Some(rounding) } else { None };
            for process in
                PROCESSES.into_iter().filter(|process| process.is_increasing() != (gauge == Gauge::Noisy))
            {
                for power_law in [false, true] {
                    let model = Model { process, power_law, resolution, ..Model::default() };
                    if let Ok(fit) = estimate(&data, &model) {
                        assert!(
                            fit.parameters().iter().all(|value| value.is_finite() && *value > 0.0),
                            "{fit:?}"
                        );
                        assert!(fit.log_likelihood.is_finite(), "{fit:?}");
                    }
                }
            }
        }
    }
}

/// A modal data file gives constants that are written back to the same bits, or a fault of a few words.
pub fn modal_data(text: &str) {
    match ModalData::from_toml(text) {
        Err(error) => assert!(!error.to_string().is_empty()),
        Ok(data) => {
            let written = data.to_toml().expect("what was read can be written");
            assert_eq!(ModalData::from_toml(&written).as_ref(), Ok(&data));
        }
    }
}

/// A fit gives a prediction of numbers that can be, or a fault.
pub fn fit_file(text: &str) {
    let fit = match FitFile::parse(text) {
        Ok(fit) => fit,
        Err(error) => return assert!(!error.message.is_empty() && !error.cure.is_empty()),
    };
    let values: Vec<(String, f64)> = fit.covariates.iter().map(|known| (known.name.clone(), 2.0)).collect();
    let Ok(estimate) = fit.estimate(&values) else { return };
    for threshold in [1e-3, 10.0, 1e6] {
        let state = OperatingState::new(threshold).expect("it is positive");
        if let Ok(prediction) = Prediction::by_fit(&estimate, &state, Method::Delta, &Questions::default()) {
            let lives = prediction.quantiles.each_ref().map(|band| band.value);
            assert!(lives[0] >= 0.0 && lives.is_sorted(), "{lives:?}");
            let (first, last) = prediction.interval;
            assert!(first >= 0.0 && first <= last, "{first} {last}");
            if let Some((moments, _)) = &prediction.moments {
                assert!(moments.mean >= 0.0 && moments.std >= 0.0, "{moments:?}");
            }
        }
    }
}

/// A journal goes on with what is whole, or is refused and left as it was.
pub fn journal(bytes: &[u8]) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("life.journal");
    fs::write(&file, bytes).expect("a file");
    let resumed = LifeJournal::resume(folder.path()).map(drop);
    let kept = fs::read(&file).expect("a file");
    match resumed {
        Ok(()) => assert!(bytes.starts_with(&kept)),
        Err(_) => assert_eq!(bytes, kept),
    }
}
