//! Operating time on the calendar. In: a first day, how long a working day is, which days are worked on. Out: dates.
//! Never knows what ends on them.

use chrono::{Datelike as _, Days, NaiveDate, Weekday};
use clap::Args;
use serde_json::{Value, json};

use super::value::positive;

/// The last year that dates have four digits in.
const LAST_YEAR: i32 = 9999;
const EXAMPLE: &str = "2026-11-23";

/// When it runs.
#[derive(Clone, Debug, Args)]
pub struct Calendar {
    /// The day that the present is the morning of, as 2026-11-23: lives are told as dates too.
    #[arg(long, value_name = "DATE", value_parser = date, requires = "per_day")]
    from: Option<NaiveDate>,
    /// Time that it runs on a working day, in the unit of the lives.
    #[arg(long, value_name = "TIME", value_parser = positive, requires = "from")]
    per_day: Option<f64>,
    /// Days of the week that it runs on, as mon-fri or mon,wed,fri [default: all].
    #[arg(long, value_name = "DAYS", value_parser = working_days, requires = "from")]
    working_days: Option<WorkingDays>,
    /// Days that it stands still, the last one too, as 2026-12-24..2027-01-06. Repeatable.
    #[arg(long, value_name = "DATE..DATE", value_parser = pause, requires = "from")]
    pause: Vec<Pause>,
}

impl Calendar {
    /// Whether dates are asked for.
    pub fn is_given(&self) -> bool {
        self.from.is_some()
    }

    /// The day on which an operating time >= 0 from the present ends; none after the year 9999.
    pub fn date(&self, time: f64) -> Option<NaiveDate> {
        let (from, per_day) = (self.from?, self.per_day?);
        let days = time / per_day;
        let mut left = if days.is_finite() { days.ceil().max(1.0) } else { return None };
        let mut day = from;
        while day.year() <= LAST_YEAR {
            if self.works(day) {
                left -= 1.0;
                if left <= 0.0 {
                    return Some(day);
                }
            }
            day = day.checked_add_days(Days::new(1))?;
        }
        None
    }

    /// The same for people.
    pub fn told(&self, time: f64) -> String {
        self.date(time).map_or_else(|| format!("after {LAST_YEAR}"), |date| date.to_string())
    }

    /// The same for machines: null after the year 9999.
    pub fn json(&self, time: f64) -> Option<String> {
        self.date(time).map(|date| date.to_string())
    }

    /// What provenance tells of it.
    pub fn options(&self) -> Value {
        let pauses: Vec<String> = self.pause.iter().map(|Pause(a, b)| format!("{a}..{b}")).collect();
        let days = self.working_days.map(|days| days.names());
        json!({
            "from": self.from.map(|date| date.to_string()), "per_day": self.per_day,
            "working_days": days, "pauses": pauses,
        })
    }

    fn works(&self, day: NaiveDate) -> bool {
        let rests = |Pause(first, last): &Pause| *first <= day && day <= *last;
        self.working_days.is_none_or(|days| days.0[weekday(day.weekday())]) && !self.pause.iter().any(rests)
    }
}

/// First and last day of a pause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Pause(NaiveDate, NaiveDate);

/// Whether each day of the week is worked on, from Monday.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct WorkingDays([bool; 7]);

impl WorkingDays {
    fn names(self) -> Vec<&'static str> {
        NAMES.into_iter().zip(self.0).filter(|(_, works)| *works).map(|(name, _)| name).collect()
    }
}

const NAMES: [&str; 7] = ["mon", "tue", "wed", "thu", "fri", "sat", "sun"];

fn weekday(day: Weekday) -> usize {
    day.num_days_from_monday() as usize
}

fn date(text: &str) -> Result<NaiveDate, String> {
    let date = text.trim().parse::<NaiveDate>().ok().filter(|date| (1..=LAST_YEAR).contains(&date.year()));
    date.ok_or_else(|| format!("a date is year, month and day, as {EXAMPLE}"))
}

fn pause(text: &str) -> Result<Pause, String> {
    let wrong = || format!("a pause is its first and its last day, as {EXAMPLE}..2027-01-06");
    let (first, last) = text.split_once("..").ok_or_else(wrong)?;
    let (first, last) = (date(first)?, date(last)?);
    if first <= last { Ok(Pause(first, last)) } else { Err(wrong()) }
}

fn working_days(text: &str) -> Result<WorkingDays, String> {
    let wrong = || "name days of the week by three letters, as mon-fri or mon,wed,fri".to_owned();
    let day = |name: &str| {
        let name = name.trim().to_ascii_lowercase();
        NAMES.iter().position(|known| *known == name).ok_or_else(wrong)
    };
    let mut days = [false; 7];
    for part in text.split(',') {
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        let (first, last) = (day(first)?, day(last)?);
        // From Saturday to Monday goes over the end of the week.
        let count = (last + 7 - first) % 7;
        (first..=first + count).for_each(|at| days[at % 7] = true);
    }
    Ok(WorkingDays(days))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn calendar(per_day: f64, days: Option<&str>, pauses: &[&str]) -> Calendar {
        Calendar {
            from: Some(date("2026-11-23").expect("a Monday")),
            per_day: Some(per_day),
            working_days: days.map(|days| working_days(days).expect("days")),
            pause: pauses.iter().map(|text| pause(text).expect("a pause")).collect(),
        }
    }

    #[test]
    fn days_are_counted_from_the_first_one() {
        let all = calendar(16.0, None, &[]);
        for (time, expected) in [
            (0.0, "2026-11-23"),
            (16.0, "2026-11-23"),
            (16.1, "2026-11-24"),
            // 365 days later but one: the first day counts.
            (365.0 * 16.0, "2027-11-22"),
        ] {
            assert_eq!(all.told(time), expected, "{time}");
        }
    }

    #[test]
    fn weekends_and_pauses_are_left_out() {
        let weekdays = calendar(8.0, Some("mon-fri"), &[]);
        // Five days a week: the sixth is the next Monday.
        assert_eq!(weekdays.told(40.0), "2026-11-27");
        assert_eq!(weekdays.told(41.0), "2026-11-30");
        let paused = calendar(8.0, Some("mon-fri"), &["2026-11-24..2026-11-29", "2026-11-30..2026-11-30"]);
        assert_eq!(paused.told(8.5), "2026-12-01");
        assert_eq!(working_days("sat-mon"), Ok(WorkingDays([true, false, false, false, false, true, true])));
        assert_eq!(working_days("Mon,WED"), Ok(WorkingDays([true, false, true, false, false, false, false])));
    }

    #[test]
    fn what_never_comes_has_no_date() {
        let all = calendar(1.0, None, &[]);
        for time in [1e9, 1e300, f64::INFINITY, f64::NAN] {
            assert_eq!(all.date(time), None, "{time}");
            assert_eq!(all.told(time), "after 9999");
        }
        let closed = calendar(1.0, None, &["2026-11-23..9999-12-31"]);
        assert_eq!(closed.date(0.5), None);
    }

    #[test]
    fn what_is_no_day_is_refused() {
        for bad in ["23.11.2026", "2026-02-30", "-2026-01-01", "today", "", "10000-01-01"] {
            assert!(date(bad).is_err(), "{bad}");
        }
        for bad in ["2026-11-23", "2026-11-23..2026-11-22", "..", "2026-11-23..x"] {
            assert!(pause(bad).is_err(), "{bad}");
        }
        for bad in ["", "monday", "mon-", "mon,,tue", "1-5"] {
            assert!(working_days(bad).is_err(), "{bad}");
        }
    }
}
