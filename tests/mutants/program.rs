//! The program under a watch: ended by itself, by Ctrl-C, or not at all.

use std::io::{BufRead, BufReader, Read};
use std::process::Child;
use std::sync::mpsc::{Receiver, channel};
use std::thread::{JoinHandle, sleep, spawn};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::command::start;

/// How long the program may take for what.
#[derive(Clone, Copy)]
pub struct Patience {
    /// Then Ctrl-C, if it gets on or nobody asks whether it does.
    pub run: Duration,
    /// It may stand still for so long.
    pub standstill: Option<Duration>,
    /// From Ctrl-C to the end.
    pub end: Duration,
}

/// How a run ended.
pub enum Ended {
    /// With exit 0 and this object.
    Done(Value),
    /// With an error that has a code and a message, or by Ctrl-C.
    Refused,
    Interrupted,
}

/// Runs and waits. An error says what the program may never do.
pub fn run(arguments: &[&str], patience: Patience) -> Result<Ended, String> {
    let mut child = start(arguments);
    let out = collect(child.stdout.take().expect("piped"));
    let lines = watch(child.stderr.take().expect("piped"));
    let (code, err, stopped) = wait(&mut child, &lines, patience)?;
    let out = out.join().expect("a reader");
    let said = err.join("\n");
    if said.contains("panicked") || code == Some(101) {
        return Err(format!("panic: {said}"));
    }
    let answer = || {
        serde_json::from_str::<Value>(&out).map_err(|error| format!("no JSON ({error}): {out:.200}{said}"))
    };
    match code {
        Some(0) => answer().map(Ended::Done),
        Some(1 | 2) if !stopped => {
            let answer = answer()?;
            let errors =
                answer["errors"].as_array().filter(|errors| !errors.is_empty()).ok_or("no errors")?;
            let said = |error: &Value| {
                ["code", "message"].iter().all(|key| error[key].as_str().is_some_and(|text| !text.is_empty()))
            };
            if errors.iter().all(said) {
                Ok(Ended::Refused)
            } else {
                Err(format!("errors without words: {answer}"))
            }
        }
        Some(1) | None if stopped => Ok(Ended::Interrupted),
        code => Err(format!("exit {code:?}: {said}")),
    }
}

fn collect(mut pipe: impl Read + Send + 'static) -> JoinHandle<String> {
    spawn(move || {
        let mut bytes = Vec::new();
        let _ = pipe.read_to_end(&mut bytes);
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

fn watch(pipe: impl Read + Send + 'static) -> Receiver<String> {
    let (send, receive) = channel();
    spawn(move || BufReader::new(pipe).lines().map_while(Result::ok).try_for_each(|line| send.send(line)));
    receive
}

/// Exit code, what it said, whether it was asked to end.
fn wait(
    child: &mut Child,
    lines: &Receiver<String>,
    patience: Patience,
) -> Result<(Option<i32>, Vec<String>, bool), String> {
    let begin = Instant::now();
    let mut said: Vec<String> = Vec::new();
    let (mut far, mut moved) = (0.0, begin);
    let mut asked: Option<Instant> = None;
    loop {
        if let Some(status) = child.try_wait().expect("a child") {
            said.extend(lines.iter());
            return Ok((status.code(), said, asked.is_some()));
        }
        for line in lines.try_iter() {
            let percent =
                |line: &str| line.split_once(" %").and_then(|(percent, _)| percent.parse::<f64>().ok());
            if percent(&line).is_some_and(|percent| percent > far) {
                far = percent(&line).unwrap_or(far);
                moved = Instant::now();
            }
            said.push(line);
        }
        let gets_on = moved > begin;
        match asked {
            Some(asked) if asked.elapsed() > patience.end => {
                let _ = child.kill();
                let _ = child.wait();
                return Err(format!("no end {} s after Ctrl-C", patience.end.as_secs()));
            }
            None if patience.standstill.is_some_and(|standstill| moved.elapsed() > standstill) => {
                let _ = child.kill();
                let _ = child.wait();
                return Err(format!("stands still at {:?}", said.last()));
            }
            None if (gets_on || patience.standstill.is_none()) && begin.elapsed() > patience.run => {
                asked = Some(Instant::now());
                interrupt(child);
            }
            _ => {}
        }
        sleep(Duration::from_millis(if begin.elapsed().as_millis() < 200 { 2 } else { 20 }));
    }
}

fn interrupt(child: &Child) {
    let status = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(status.expect("kill").success());
}
