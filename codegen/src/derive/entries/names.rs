//! What coordinates and speeds are called, and their units.
//! In: [`Mechanism`], [`Linkage`]. Out: [`Names`]. Never derives.

use crate::derive::linkage::{Freedom, Linkage};
use crate::model::{Coordinate, Mechanism};
use linkwear_runtime::MODE;

/// Names and units of all coordinates and of all speeds, in tree order.
pub(super) type Names = (Vec<(String, &'static str)>, Vec<(String, &'static str)>);

/// What the rates of an input are called behind its name: as those of a joint's coordinate.
pub(super) const INPUT_RATES: [&str; 2] = [".v", ".a"];

pub(super) fn variable_names(mechanism: &Mechanism, linkage: &Linkage) -> Names {
    let (mut positions, mut speeds) = (Vec::new(), Vec::new());
    for link in &linkage.links {
        let joint = mechanism.joint(link.joint);
        let name = &joint.name;
        match link.freedom {
            Freedom::Rotation { .. } | Freedom::Translation { .. } => {
                let offset = joint.model.offsets().position(|number| number == link.joint_coordinate);
                if let Some(axis) = offset.map(|axis| ["x", "y", "z"][axis]) {
                    positions.push((format!("{name}.{axis}"), "m"));
                    speeds.push((format!("{name}.v{axis}"), "m/s"));
                    continue;
                }
                let tilt = joint.model.tilts().position(|number| number == link.joint_coordinate);
                if let Some(axis) = tilt.map(|axis| ["x", "y"][axis]) {
                    positions.push((format!("{name}.tilt_{axis}"), "rad"));
                    speeds.push((format!("{name}.tilt_v{axis}"), "rad/s"));
                    continue;
                }
                let coordinates = joint.model.coordinates();
                let suffix = number_among(coordinates.len(), link.joint_coordinate);
                let [unit, rate, _] = units(coordinates[link.joint_coordinate]);
                positions.push((format!("{name}.q{suffix}"), unit));
                speeds.push((format!("{name}.v{suffix}"), rate));
            }
            Freedom::Ball | Freedom::Free => {
                positions.extend((0..4).map(|i| (format!("{name}.q{i}"), "1")));
                speeds.extend(["x", "y", "z"].map(|axis| (format!("{name}.w{axis}"), "rad/s")));
                if link.freedom == Freedom::Free {
                    positions.extend(["x", "y", "z"].map(|axis| (format!("{name}.{axis}"), "m")));
                    speeds.extend(["x", "y", "z"].map(|axis| (format!("{name}.v{axis}"), "m/s")));
                }
            }
            Freedom::Flexible { modes } => {
                let body = mechanism.body(link.body);
                let unit = body.flexible.as_ref().map_or("1", |flexible| flexible.data.modal_unit());
                let rate = if unit == "1" { "1/s" } else { "kg^0.5 m/s" };
                positions.extend((1..=modes).map(|k| (format!("{}{MODE}{k}", body.name), unit)));
                speeds.extend((1..=modes).map(|k| (format!("{}{MODE}{k}_v", body.name), rate)));
            }
            Freedom::Weld | Freedom::Node => {}
        }
    }
    (positions, speeds)
}

/// What follows the name of one of several coordinates: its number, from 1. A single one needs none.
pub(crate) fn number_among(count: usize, index: usize) -> String {
    if count > 1 { (index + 1).to_string() } else { String::new() }
}

/// Units of a coordinate, its rate and the rate of that.
pub(super) fn units(coordinate: Coordinate) -> [&'static str; 3] {
    match coordinate {
        Coordinate::Angle => ["rad", "rad/s", "rad/s^2"],
        _ => ["m", "m/s", "m/s^2"],
    }
}
