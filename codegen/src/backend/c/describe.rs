//! The mechanism's description as constant tables of C. In: [`Description`]. Out: text.

use std::fmt::{Debug, Write};

use linkwear_runtime::{ContactInfo, Description, Motion};

use super::text::{literal, number};

/// Types of the tables, for the header.
pub const TYPES: &str = include_str!("describe.h");

/// One table: its type, its name, its rows; nothing without rows, which C does not have.
fn table(text: &mut String, named: &dyn Fn(String) -> String, [of, name]: [&str; 2], rows: &[String]) {
    if rows.is_empty() {
        return;
    }
    text.push_str(&named(format!("const pfx_{of} pfx_{name}[] = {{\n")));
    for row in rows {
        let _ = writeln!(text, "    {{{row}}},");
    }
    text.push_str("};\n\n");
}

fn index(value: Option<usize>) -> String {
    value.map_or_else(|| "-1".to_owned(), |value| value.to_string())
}

/// The tables of a mechanism; `named` puts the prefix.
pub fn tables(own: &Description, named: &dyn Fn(String) -> String) -> String {
    let mut text = String::new();
    let flag = |flag: bool| i32::from(flag);
    let parameters = own.parameters.iter().map(|parameter| {
        [literal(&parameter.name), literal(&parameter.unit), number(parameter.default)].join(", ")
    });
    table(&mut text, named, ["parameter_info", "parameter_table"], &parameters.collect::<Vec<_>>());
    for (name, variables) in [("coordinates", &own.coordinates), ("speeds", &own.speeds)] {
        let rows = variables.iter().map(|variable| {
            format!("{}, {}, {}", literal(&variable.name), literal(&variable.unit), flag(variable.held))
        });
        table(&mut text, named, ["variable_info", name], &rows.collect::<Vec<_>>());
    }
    let motions = own.motions.iter().map(|motion| match motion {
        Motion::Scalar { driver } => format!("0, {}", index(*driver)),
        Motion::Rotation => "1, -1".to_owned(),
        Motion::Pose => "2, -1".to_owned(),
    });
    table(&mut text, named, ["motion_info", "motions"], &motions.collect::<Vec<_>>());
    let rows = own.rows.iter().map(|row| {
        format!(
            "{}, {}, {}, {}",
            literal(&row.joint),
            literal(&row.meaning),
            flag(row.angular),
            index(row.kept)
        )
    });
    table(&mut text, named, ["row_info", "rows"], &rows.collect::<Vec<_>>());
    let drivers =
        own.drivers.iter().map(|driver| format!("{}, {}", literal(&driver.joint), flag(driver.angular)));
    table(&mut text, named, ["driver_info", "drivers"], &drivers.collect::<Vec<_>>());
    let channels = own.channels.iter().map(|channel| {
        format!("{}, {}, {}", literal(&channel.name), literal(&channel.unit), flag(channel.wraps))
    });
    table(&mut text, named, ["channel_info", "channels"], &channels.collect::<Vec<_>>());
    table(
        &mut text,
        named,
        ["contact_info", "contact_table"],
        &own.contacts.iter().map(contact).collect::<Vec<_>>(),
    );
    text
}

fn law(law: impl Debug) -> String {
    literal(&format!("{law:?}"))
}

fn contact(info: &ContactInfo) -> String {
    let numbers = [
        info.journal_radius,
        info.length,
        info.modulus,
        info.restitution,
        info.exponent,
        info.impact_speed_floor,
    ];
    let friction = info.friction.map_or_else(
        || ["\"\"".to_owned(), "\"\"".to_owned(), "0.0".to_owned()],
        |(strength, onset, slope)| [law(strength), law(onset), number(slope)],
    );
    let wear = info.wear.as_ref().map_or_else(
        || "0, 0.0, 0.0, \"\", 0.0, 0.0, 0.0, 0.0, 0.0".to_owned(),
        |wear| {
            let (alpha, beta) = wear.scatter.map_or((0.0, 0.0), |scatter| (scatter.alpha, scatter.beta));
            let after = [wear.feedback, wear.threshold, wear.revolutions_per_cycle, alpha, beta].map(number);
            let before = [wear.coefficient, wear.hardness].map(number).join(", ");
            format!("1, {before}, {}, {}", law(wear.area), after.join(", "))
        },
    );
    [
        literal(&info.joint),
        i32::from(info.ball).to_string(),
        numbers.map(number).join(", "),
        law(info.stiffness),
        law(info.law),
        friction.join(", "),
        wear,
    ]
    .join(", ")
}
