//! What a derived mechanism is called: sizes, names, units, rows, for the runtime's [`Description`].
//! In: the deriver's symbols and rows. Out: [`Sizes`], [`Description`]. Never derives.

use linkwear_runtime::{
    Channel, ContactInfo, Description, DriverInfo, Motion as MotionInfo, ParameterInfo, RowInfo, Sizes,
    VariableInfo,
};

use super::Deriver;
use crate::derive::closure::CutRows;
use crate::derive::geometry::Geometry;
use crate::derive::linkage::{Freedom, Linkage};
use crate::derive::start::StartValues;
use crate::model::{Coordinate, Mechanism};

impl Deriver<'_> {
    pub(super) fn sizes(&self, channels: usize) -> Sizes {
        Sizes {
            parameters: self.parameters.len(),
            coordinates: self.free_q.len(),
            speeds: self.partition.free.len(),
            all_coordinates: self.q_all.len(),
            all_speeds: self.v_all.len(),
            rows: self.keep.iter().filter(|kept| **kept).count(),
            all_rows: self.keep.len(),
            drivers: self.drivers.len(),
            contacts: self.contacts.len(),
            channels,
            workspace: 0,
        }
    }

    pub(super) fn description(
        &self,
        start: &StartValues<'_>,
        rows: Vec<RowInfo>,
        channels: Vec<Channel>,
    ) -> Description {
        let Geometry { mechanism, linkage, .. } = self.geometry;
        let names = variable_names(mechanism, linkage);
        let pick = |names: &[(String, &'static str)], free: &[usize], held: &[bool]| {
            free.iter()
                .map(|i| VariableInfo {
                    name: names[*i].0.clone().into(),
                    unit: names[*i].1.into(),
                    held: held[*i],
                })
                .collect::<Vec<_>>()
        };
        let parameters: Vec<ParameterInfo> = self
            .geometry
            .mechanism
            .parameters
            .iter()
            .filter(|parameter| parameter.tunable)
            .map(|parameter| ParameterInfo {
                name: parameter.name.clone().into(),
                unit: parameter.dimension.si_unit().into(),
                default: parameter.value,
            })
            .collect();
        let drivers: Vec<DriverInfo> = self
            .drivers
            .iter()
            .map(|driver| DriverInfo {
                joint: mechanism.joint(driver.joint).name.clone().into(),
                angular: mechanism.joint(driver.joint).model.coordinates()[driver.joint_coordinate]
                    == Coordinate::Angle,
            })
            .collect();
        let turn_driver =
            self.drivers.iter().position(|driver| mechanism.joint(driver.joint).model.is_hinge());
        Description {
            name: mechanism.name.clone().into(),
            parameters: parameters.into(),
            coordinates: pick(&names.0, &self.free_q, &start.held_q).into(),
            speeds: pick(&names.1, &self.partition.free, &start.held_v).into(),
            motions: self.motions().into(),
            quaternions: self.quaternions().into(),
            rows: rows.into(),
            drivers: drivers.into(),
            channels: channels.into(),
            turn_driver,
            contacts: self.contact_infos().into(),
        }
    }

    /// What the rows of all cuts forbid, and which of them are kept, by index among the kept ones.
    pub(super) fn row_infos(&self, cuts: &[CutRows<'_>]) -> Vec<RowInfo> {
        let mut kept = 0;
        cuts.iter()
            .flat_map(|cut| cut.rows.iter().map(move |row| (cut.cut.joint, row)))
            .zip(&self.keep)
            .map(|((joint, row), keep)| RowInfo {
                joint: self.geometry.mechanism.joint(joint).name.clone().into(),
                meaning: row.meaning.clone().into(),
                angular: row.angular,
                kept: keep.then(|| {
                    kept += 1;
                    kept - 1
                }),
            })
            .collect()
    }

    fn contact_infos(&self) -> Vec<ContactInfo> {
        let joints = self.contacts.iter().map(|contact| self.geometry.mechanism.joint(contact.joint));
        joints.filter_map(|joint| joint.clearance.as_ref()).map(|clearance| clearance.laws.clone()).collect()
    }

    fn motions(&self) -> Vec<MotionInfo> {
        self.geometry
            .linkage
            .links
            .iter()
            .flat_map(|link| match link.freedom {
                Freedom::Rotation { .. } | Freedom::Translation { .. } => vec![MotionInfo::Scalar {
                    driver: self.drivers.iter().position(|driver| driver.speed == link.first_speed),
                }],
                Freedom::Ball => vec![MotionInfo::Rotation],
                Freedom::Free => vec![MotionInfo::Pose],
                Freedom::Flexible { modes } => vec![MotionInfo::Scalar { driver: None }; modes],
                Freedom::Weld | Freedom::Node => Vec::new(),
            })
            .collect()
    }

    /// First index among the free coordinates of every quaternion.
    fn quaternions(&self) -> Vec<usize> {
        self.geometry
            .linkage
            .links
            .iter()
            .filter(|link| matches!(link.freedom, Freedom::Ball | Freedom::Free))
            .filter_map(|link| self.free_q.iter().position(|i| *i == link.first_coordinate))
            .collect()
    }
}

/// Names and units of all coordinates and of all speeds, in tree order.
pub(super) type Names = (Vec<(String, &'static str)>, Vec<(String, &'static str)>);

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
                let coordinates = joint.model.coordinates();
                let suffix = if coordinates.len() > 1 {
                    (link.joint_coordinate + 1).to_string()
                } else {
                    String::new()
                };
                let units = if coordinates[link.joint_coordinate] == Coordinate::Angle {
                    ("rad", "rad/s")
                } else {
                    ("m", "m/s")
                };
                positions.push((format!("{name}.q{suffix}"), units.0));
                speeds.push((format!("{name}.v{suffix}"), units.1));
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
                positions.extend((1..=modes).map(|k| (format!("{}.eta{k}", body.name), unit)));
                speeds.extend((1..=modes).map(|k| (format!("{}.eta{k}_v", body.name), rate)));
            }
            Freedom::Weld | Freedom::Node => {}
        }
    }
    (positions, speeds)
}
