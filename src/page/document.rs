//! The page: sections in their order, data for its scripts. In: what is known of a mechanism, its run, its life. Out: HTML in one
//! text that loads nothing. Never knows how numbers came about; every number is one of the JSON that the page holds.

use std::fmt::Write as _;

use linkwear_codegen::Compiled;
use linkwear_runtime::Run;
use serde_json::{Value, json};

use super::curves;
use super::drawing;
use super::escape::{data, escaped};
use super::lives;
use super::motion::Motion;
use super::scene::Scene;
use crate::number::number;

/// All that is shown.
pub struct Page<'a> {
    pub compiled: &'a Compiled,
    /// With columns of poses.
    pub run: &'a Run,
    /// What `simulate --format json` says of it.
    pub simulation: &'a Value,
    /// What `life --format json` says of its life.
    pub life: Option<&'a Value>,
    /// Whether the parameters are told.
    pub with_parameters: bool,
}

const SCRIPTS: [&str; 4] = [
    include_str!("solid.js"),
    include_str!("view.js"),
    include_str!("bearing.js"),
    include_str!("player.js"),
];

impl Page<'_> {
    /// The whole page.
    pub fn html(&self) -> String {
        let name = escaped(&self.compiled.mechanism.name);
        let mut out = format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:\">\n\
             <meta name=\"generator\" content=\"linkwear {}\">\n<title>{name}</title>\n<style>{}</style>\n</head>\n<body>\n<header><h1>{name}</h1>{}</header>\n<main>\n",
            env!("CARGO_PKG_VERSION"),
            include_str!("page.css"),
            self.lead(),
        );
        let drawing = drawing::within_page(self.compiled, self.run).unwrap_or_default();
        out.push_str(&include_str!("motion.html").replace("<!-- drawing -->", &drawing));
        if let Some(life) = self.life {
            Self::life(&mut out, life);
        }
        self.curves(&mut out);
        self.loads(&mut out);
        if self.with_parameters {
            self.parameters(&mut out);
        }
        self.warnings(&mut out);
        self.provenance(&mut out);
        out.push_str("</main>\n");
        let motion = json!({ "scene": Scene::new(self.compiled), "run": Motion::new(self.run) });
        let mut hold = |id: &str, value: &Value| {
            let _ = writeln!(out, "<script type=\"application/json\" id=\"{id}\">{}</script>", data(value));
        };
        hold("motion", &motion);
        hold("simulation", self.simulation);
        hold("life", self.life.unwrap_or(&Value::Null));
        let _ = writeln!(
            out,
            "<script>\"use strict\";(() => {{\n{}}})();</script>\n</body>\n</html>",
            SCRIPTS.join("\n")
        );
        out
    }

    /// What there is to know at first sight.
    fn lead(&self) -> String {
        let mechanism = &self.compiled.mechanism;
        let mut facts = vec![
            ("bodies", mechanism.bodies.len().to_string()),
            ("joints", mechanism.joints.len().to_string()),
            ("mobility", self.compiled.analysis.mobility.to_string()),
            ("time shown", format!("{} s", shown(&self.simulation["time_s"]))),
        ];
        if let Some(life) = self.life {
            let first = |key: &str| shown(&life["quantiles"][key]);
            facts = vec![
                (
                    if life["random"] == true { "mean life" } else { "life of the mean path" },
                    format!("{} cycles", shown(&life["mean"])),
                ),
                ("revolutions", shown(&life["revolutions"])),
            ];
            if life["random"] == true {
                facts.push(("10 % fail before (B10)", format!("{} cycles", first("p10"))));
                facts.push(("half fail before", format!("{} cycles", first("p50"))));
            }
            if life["time"]["mean"]["hours"].is_number() {
                let [hours, years] = ["hours", "years"].map(|key| shown(&life["time"]["mean"][key]));
                facts.push(("without a pause", format!("{hours} h, {years} years")));
            }
            facts.push(("fails by joint", shown(&life["failed_joint"])));
        }
        let facts = facts
            .iter()
            .map(|(name, value)| format!("<div><dt>{name}</dt><dd>{}</dd></div>", escaped(value)));
        format!("<dl class=\"facts\">{}</dl>", facts.collect::<String>())
    }

    fn curves(&self, out: &mut String) {
        out.push_str("<section><h2>Curves</h2><p class=\"hint\">Point at a curve: the picture stands at that instant.</p>\n<div class=\"charts\">\n");
        for chart in curves::charts(self.run) {
            let _ = writeln!(out, "<figure>{}</figure>", chart.figure());
        }
        out.push_str("<figure><label>any column <select id=\"column\"></select></label><div id=\"chosen\"></div></figure>\n</div></section>\n");
    }

    fn life(out: &mut String, json: &Value) {
        out.push_str("<section><h2>Life</h2>\n<div class=\"charts\">\n");
        for chart in lives::charts(json) {
            let _ = writeln!(out, "<figure>{}</figure>", chart.figure());
        }
        out.push_str(include_str!("wear.html"));
        out.push_str("</div>\n<div class=\"tables\">\n");
        let row = |name: &str, value: &Value, error: &Value, interval: &Value| {
            let plus = if error.is_number() { format!(" ± {}", shown(error)) } else { String::new() };
            let interval = if interval.is_object() {
                format!("{} to {}", shown(&interval["lower"]), shown(&interval["upper"]))
            } else {
                String::new()
            };
            vec![name.to_owned(), format!("{}{plus}", shown(value)), interval]
        };
        let of = |name: &str, key: &str| {
            row(name, &json[key], &json["standard_errors"][key], &json["intervals95"][key])
        };
        let quantile = |name: &str, key: &str| {
            row(
                name,
                &json["quantiles"][key],
                &json["standard_errors"]["quantiles"][key],
                &json["intervals95"]["quantiles"][key],
            )
        };
        let is_random = json["random"] == true;
        let rows = if is_random {
            vec![
                of("mean", "mean"),
                of("standard deviation", "std"),
                quantile("10 % fail before (B10)", "p10"),
                quantile("half fail before (B50)", "p50"),
                quantile("90 % fail before (B90)", "p90"),
            ]
        } else {
            // One path has no spread: what is no number is not told as one.
            vec![row("mean path", &json["mean_path"]["cycles"], &Value::Null, &Value::Null)]
        };
        table(out, "Life in cycles", &["", "cycles ± standard error", "95 %"], &rows);
        let time = |name: &str, of: &Value| vec![name.to_owned(), shown(&of["hours"]), shown(&of["years"])];
        if json["time"].is_object() {
            let (of, quantiles) = (&json["time"], &json["time"]["quantiles"]);
            let rows = if is_random {
                vec![
                    time("mean", &of["mean"]),
                    time("standard deviation", &of["std"]),
                    time("10 % fail before (B10)", &quantiles["p10"]),
                    time("half fail before (B50)", &quantiles["p50"]),
                    time("90 % fail before (B90)", &quantiles["p90"]),
                ]
            } else {
                vec![time("mean path", &of["mean"])]
            };
            table(out, "Life in time, running without a pause", &["", "hours", "years"], &rows);
        }
        let budget = json["error_budget"]["half_widths_95"].as_object();
        let rows: Vec<Vec<String>> = budget
            .into_iter()
            .flatten()
            .map(|(name, value)| vec![name.replace('_', " "), shown(value)])
            .collect();
        let total = vec!["total".to_owned(), shown(&json["error_budget"]["total"])];
        table(
            out,
            "Error budget of the mean: half-widths at 95 %",
            &["by", "cycles"],
            &[rows, vec![total]].concat(),
        );
        out.push_str("</div></section>\n");
    }

    fn loads(&self, out: &mut String) {
        let peaks = self.simulation["peaks"].as_array().map_or(&[][..], |peaks| peaks);
        if peaks.is_empty() {
            return;
        }
        let keys = ["joint", "force_N", "force_time_s", "moment_N_m", "moment_time_s"];
        let rows: Vec<Vec<String>> =
            peaks.iter().map(|peak| keys.iter().map(|key| shown(&peak[*key])).collect()).collect();
        out.push_str("<section><h2>Loads</h2>\n");
        table(
            out,
            "Peak loads, by the integrator's steps",
            &["joint", "force [N]", "at t [s]", "moment [N m]", "at t [s]"],
            &rows,
        );
        out.push_str("</section>\n");
    }

    fn parameters(&self, out: &mut String) {
        let row = |parameter: &linkwear_codegen::model::Parameter| {
            let (value, unit) =
                parameter.written.clone().unwrap_or_else(|| (parameter.value, parameter.dimension.si_unit()));
            let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
            let notes =
                [(parameter.assumed, "assumed"), (parameter.tunable, "tunable"), (parameter.input, "input")];
            let notes: Vec<&str> = notes.iter().filter(|(is, _)| *is).map(|(_, word)| *word).collect();
            vec![parameter.name.clone(), format!("{value}{unit}"), notes.join(", ")]
        };
        let rows: Vec<Vec<String>> = self.compiled.mechanism.parameters.iter().map(row).collect();
        out.push_str("<section><h2>Parameters</h2>\n");
        table(out, "Values marked assumed are not from the cited source", &["name", "value", ""], &rows);
        out.push_str("</section>\n");
    }

    fn warnings(&self, out: &mut String) {
        let of = |json: &Value| json["warnings"].as_array().cloned().unwrap_or_default();
        let mut all = of(self.simulation);
        for warning in self.life.map(of).unwrap_or_default() {
            if !all.contains(&warning) {
                all.push(warning);
            }
        }
        let text = |warning: &Value| {
            let (code, message, help) = (&warning["code"], &warning["message"], &warning["help"]);
            let words = [code, message, help]
                .iter()
                .filter_map(|part| part.as_str())
                .filter(|part| !part.is_empty())
                .collect::<Vec<_>>();
            format!(
                "<li>{}</li>",
                escaped(&if words.is_empty() { warning.to_string() } else { words.join(": ") })
            )
        };
        let list: String = all.iter().map(text).collect();
        let list = if list.is_empty() { "<p>None.</p>".to_owned() } else { format!("<ul>{list}</ul>") };
        let _ = writeln!(out, "<section><h2>Warnings</h2>{list}</section>");
    }

    fn provenance(&self, out: &mut String) {
        let provenance = self.life.unwrap_or(self.simulation)["provenance"].clone();
        let text = serde_json::to_string_pretty(&provenance).unwrap_or_default();
        let _ = writeln!(
            out,
            "<section><h2>Provenance</h2><p>All numbers of this page stand in its source as JSON, under <code>simulation</code> and <code>life</code>, as the command line gives them.</p><pre>{}</pre></section>",
            escaped(&text)
        );
    }
}

/// A number for people, a text as it is.
fn shown(value: &Value) -> String {
    match (value.as_f64(), value.as_str()) {
        (Some(value), _) => number(value),
        (None, Some(text)) => text.to_owned(),
        (None, None) => "?".to_owned(),
    }
}

fn table(out: &mut String, caption: &str, head: &[&str], rows: &[Vec<String>]) {
    let head: String = head.iter().map(|cell| format!("<th scope=\"col\">{}</th>", escaped(cell))).collect();
    let _ = writeln!(
        out,
        "<div class=\"table\"><table><caption>{}</caption><thead><tr>{head}</tr></thead><tbody>",
        escaped(caption)
    );
    for row in rows {
        let cells: String = row.iter().map(|cell| format!("<td>{}</td>", escaped(cell))).collect();
        let _ = writeln!(out, "<tr>{cells}</tr>");
    }
    out.push_str("</tbody></table></div>\n");
}
