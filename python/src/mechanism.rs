//! A mechanism, its runs and its lives. In: the text of a file, words as on the command line. Out: arrays and JSON.

use linkwear::batch::Batch;
use linkwear::cli::ask;
use linkwear::life::LifeResult;
use linkwear_codegen::SourceFile;
use linkwear_runtime::Run;
use numpy::{PyArray1, PyArray2, PyArrayMethods as _};
use pyo3::prelude::*;

use crate::failure::raised;
use crate::work::watched;

/// The text of a mechanism's file, with words that are said in every question about it.
#[pyclass(frozen)]
pub struct Mechanism {
    source: SourceFile,
    words: Vec<String>,
}

/// Names of columns, their numbers (column, row), and the JSON.
type Recorded<'py> = (Vec<String>, Bound<'py, PyArray2<f64>>, String);

#[pymethods]
impl Mechanism {
    /// Compiles the text; `name` is said where it is at fault, and data files are looked for beside it.
    #[new]
    fn new(py: Python<'_>, text: String, name: String, words: Vec<String>) -> PyResult<Self> {
        let source = SourceFile { name, text };
        let compiled = watched(py, None, |_| ask::compile(&words, &source).map(drop))?;
        compiled.map_err(|failure| raised(py, &failure))?;
        Ok(Self { source, words })
    }

    /// The JSON of `check`.
    fn check(&self, py: Python<'_>) -> PyResult<String> {
        let answer = watched(py, None, |_| ask::check(&self.words, &self.source))?;
        answer.map(|json| json.to_string()).map_err(|failure| raised(py, &failure))
    }

    /// The rows and the JSON of `simulate`.
    #[pyo3(signature = (words, progress=None))]
    fn simulate<'py>(
        &self,
        py: Python<'py>,
        words: Vec<String>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Recorded<'py>> {
        let words = [&self.words[..], &words].concat();
        let simulated = watched(py, progress.as_ref(), |watch| {
            let simulated = ask::simulate(&words, &self.source, watch)?;
            let columns = columns(&simulated.run);
            Ok((columns, simulated))
        })?;
        let ((names, numbers), simulated) = simulated.map_err(|failure| raised(py, &failure))?;
        let (count, rows) = (names.len(), simulated.run.rows.len());
        let numbers = PyArray1::from_vec(py, numbers).reshape([count, rows])?;
        Ok((names, numbers, simulated.json.to_string()))
    }

    /// The JSON of `life`, and its lives.
    #[pyo3(signature = (words, progress=None))]
    fn life(&self, py: Python<'_>, words: Vec<String>, progress: Option<Py<PyAny>>) -> PyResult<(String, Lives)> {
        let words = [&self.words[..], &words].concat();
        let lived = watched(py, progress.as_ref(), |watch| ask::life(&words, &self.source, watch))?;
        let lived = lived.map_err(|failure| raised(py, &failure))?;
        Ok((lived.json.to_string(), Lives::of(py, &lived.result)))
    }

    /// Lives one shard into a folder, as `life --shard I/N --out DIR --resume`; returns the number of its first life, from 0, and its
    /// lives.
    #[pyo3(signature = (words, shard, folder, progress=None))]
    fn live_shard(
        &self,
        py: Python<'_>,
        words: Vec<String>,
        shard: String,
        folder: String,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(u64, Lives)> {
        let words = [&self.words[..], &words].concat();
        let lived =
            watched(py, progress.as_ref(), |watch| ask::shard(&words, &self.source, (&shard, &folder), watch))?;
        let part = lived.map_err(|failure| raised(py, &failure))?;
        Ok((part.shard.numbers(part.trajectories).start, Lives::of(py, &part.result)))
    }

    /// The page of `report` or `view`, or the picture of `draw`.
    #[pyo3(signature = (subcommand, words, progress=None))]
    fn page(
        &self,
        py: Python<'_>,
        subcommand: &str,
        words: Vec<String>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<String> {
        let words = [&self.words[..], &words].concat();
        let page = watched(py, progress.as_ref(), |watch| ask::page(subcommand, &words, &self.source, watch))?;
        page.map_err(|failure| raised(py, &failure))
    }

    /// The JSON of `study`.
    #[pyo3(signature = (words, progress=None))]
    fn study(&self, py: Python<'_>, words: Vec<String>, progress: Option<Py<PyAny>>) -> PyResult<String> {
        let words = [&self.words[..], &words].concat();
        let studied = watched(py, progress.as_ref(), |watch| ask::study(&words, &self.source, watch))?;
        studied.map(|studied| studied.json.to_string()).map_err(|failure| raised(py, &failure))
    }

    /// Runs one shard of a study into a file, as `study --shard I/N --out FILE --resume`; returns its JSON.
    #[pyo3(signature = (words, shard, file, progress=None))]
    fn study_shard(
        &self,
        py: Python<'_>,
        words: Vec<String>,
        shard: String,
        file: String,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<String> {
        let words = [&self.words[..], &words].concat();
        let studied =
            watched(py, progress.as_ref(), |watch| ask::study_shard(&words, &self.source, (&shard, &file), watch))?;
        studied.map(|json| json.to_string()).map_err(|failure| raised(py, &failure))
    }
}

impl Mechanism {
    /// Its entries at many states.
    pub fn batch(&self, py: Python<'_>) -> PyResult<Batch> {
        let made = watched(py, None, |_| Ok(Batch::new(&ask::compile(&self.words, &self.source)?)))?;
        made.map_err(|failure| raised(py, &failure))
    }

    /// The text, and the words of every question.
    pub fn source(&self) -> (&SourceFile, &[String]) {
        (&self.source, &self.words)
    }
}

/// Names with units, and all numbers, one column after the other.
fn columns(run: &Run) -> (Vec<String>, Vec<f64>) {
    let channels = run.channels.iter().map(|channel| format!("{} [{}]", channel.name, channel.unit));
    let names = std::iter::once("t [s]".to_owned()).chain(channels).collect();
    let mut numbers = run.times.clone();
    numbers.reserve_exact(run.channels.len() * run.rows.len());
    for at in 0..run.channels.len() {
        numbers.extend(run.rows.iter().map(|row| row[at]));
    }
    (names, numbers)
}

/// Random lives, by their numbers: cycles, whole cycles, and the place of the joint that failed.
#[pyclass(frozen, get_all)]
pub struct Lives {
    cycles: Py<PyArray1<f64>>,
    whole_cycles: Py<PyArray1<u64>>,
    failed: Py<PyArray1<u64>>,
    joints: Vec<String>,
}

impl Lives {
    /// Those that a result lists.
    pub fn of(py: Python<'_>, result: &LifeResult) -> Self {
        let lives = &result.lives;
        Self {
            cycles: PyArray1::from_iter(py, lives.iter().map(|end| end.cycles)).unbind(),
            whole_cycles: PyArray1::from_iter(py, lives.iter().map(|end| end.whole_cycles)).unbind(),
            failed: PyArray1::from_iter(py, lives.iter().map(|end| end.joint as u64)).unbind(),
            joints: result.names(),
        }
    }
}
