//! Chart of a plan: cost over the age of replacement, with what a fit leaves open. In: the course of the cost. Out: a chart. Never
//! knows what it rests on.

use linkwear_gamma::plan::{AgePlan, Course, Ends};

use super::chart::{Chart, Series, Stroke};

/// The chart.
pub fn chart(course: &Course, plan: &AgePlan, best: Option<Ends>, unit: &str) -> Chart {
    let line = course.iter().map(|(age, rate, _)| [*age, *rate]).collect();
    let band: Vec<(f64, Ends)> = course.iter().filter_map(|(age, _, band)| Some((*age, (*band)?))).collect();
    let up = band.iter().map(|(age, (lower, _))| [*age, *lower]);
    let down = band.iter().rev().map(|(age, (_, upper))| [*age, *upper]);
    let ends = course.first().into_iter().chain(course.last()).map(|(age, ..)| [*age, plan.failure_only]);
    let mut marks: Vec<(f64, String)> =
        plan.age.map(|age| (age, format!("best {age:.4}"))).into_iter().collect();
    let drawn = |age: &f64| course.last().is_some_and(|(last, ..)| age <= last);
    if let Some((low, high)) = best {
        marks.extend([low, high].into_iter().filter(drawn).map(|age| (age, "95 %".to_owned())));
    }
    Chart {
        title: "cost of replacements at an age".to_owned(),
        x: format!("age [{unit}]"),
        y: "[cost/time]".to_owned(),
        series: vec![
            Series::line("what the fit leaves open, 95 %", 0, up.chain(down).collect()).drawn(Stroke::Band),
            Series::line("replaced at this age", 0, line),
            Series::line("replaced at failure", 1, ends.collect()).drawn(Stroke::Dashed),
        ],
        marks,
        from_zero: true,
        ..Chart::default()
    }
}
