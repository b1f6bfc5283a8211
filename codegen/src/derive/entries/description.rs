//! What a derived mechanism is called: sizes, names, units, rows, for the runtime's [`Description`].
//! In: the deriver's symbols and rows. Out: [`Sizes`], [`Description`]. Never derives.

use linkwear_runtime::{
    BendInfo, Channel, CoefficientFactor, ContactInfo, Description, DriverInfo, InputRole, JournalWear,
    MissionInfo, Motion as MotionInfo, ParameterInfo, RowInfo, SegmentInfo, Sizes, VALUE, VariableInfo,
};

use super::deriver::{Deriver, Instant};
use super::names::{INPUT_RATES, variable_names};
use super::own_states::unit;
use crate::derive::geometry::Geometry;
use crate::derive::linkage::{Freedom, Link};
use crate::derive::start::StartValues;
use crate::derive::wear_factor::steps;
use crate::id::ParameterId;
use crate::model::{Coordinate, Mission, Parameter, Segment, StateVariable};
use crate::spec::Dimension;

impl Deriver<'_> {
    pub(super) fn sizes(&self, channels: usize) -> Sizes {
        Sizes {
            parameters: self.given.tunable.len() + self.given.inputs.len(),
            coordinates: self.free_q.len() + self.own.len(),
            speeds: self.partition.free.len() + self.own.len(),
            all_coordinates: self.q_all.len() + self.own.len(),
            all_speeds: self.v_all.len() + self.own.len(),
            rows: self.keep.iter().filter(|kept| **kept).count(),
            all_rows: self.keep.len(),
            drivers: self.drivers.len(),
            contacts: self.contacts.len(),
            channels,
            held: 0,
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
        let (inputs, roles) = self.input_infos();
        let tunable = mechanism.parameters.iter().filter(|parameter| parameter.tunable);
        let parameters: Vec<ParameterInfo> = tunable.map(parameter_info).chain(inputs).collect();
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
        let missions = self.mission_infos(&parameters);
        Description {
            name: mechanism.name.clone().into(),
            parameters: parameters.into(),
            inputs: roles.into(),
            coordinates: [pick(&names.0, &self.free_q, &start.held_q), self.own_infos(".integral", 1)]
                .concat()
                .into(),
            speeds: [pick(&names.1, &self.partition.free, &start.held_v), self.own_infos(VALUE, 0)]
                .concat()
                .into(),
            motions: self.motions().into(),
            quaternions: self.quaternions().into(),
            rows: rows.into(),
            drivers: drivers.into(),
            channels: channels.into(),
            turn_driver,
            contacts: self.contact_infos().into(),
            journals: self.journals().into(),
            guides: self.guides().into(),
            coefficients: self.coefficients().into(),
            missions: missions.into(),
            bends: self.bends().into(),
        }
    }

    /// Flexible bodies whose field is linear in their modes, with the displacement of their nodes.
    fn bends(&self) -> Vec<BendInfo> {
        let Geometry { mechanism, linkage, .. } = self.geometry;
        let links = linkage.links.iter().filter_map(|link| match link.freedom {
            Freedom::Flexible { modes } => Some((link, modes)),
            _ => None,
        });
        let bend = |(link, modes): (&Link, usize)| {
            let body = mechanism.body(link.body);
            let data = &body.flexible.as_ref().filter(|own| own.data.second_order.is_none())?.data;
            let first = self.free_q.iter().position(|i| *i == link.first_coordinate)?;
            let shapes = data.nodes.iter().flat_map(|node| &node.displacement).flatten().copied();
            let shapes: Vec<f64> = shapes.collect();
            Some(BendInfo {
                body: body.name.clone().into(),
                length: data.length(),
                first,
                modes,
                shapes: shapes.into(),
            })
        };
        links.filter_map(bend).collect()
    }

    /// States of the file's own, or their integrals.
    fn own_infos(&self, suffix: &str, seconds: i32) -> Vec<VariableInfo> {
        let states = self.geometry.mechanism.states.iter().take(self.own.len());
        let info = |state: &StateVariable| VariableInfo {
            name: format!("{}{suffix}", state.name).into(),
            unit: unit(state.initial.dimension, seconds).into(),
            held: true,
        };
        states.map(info).collect()
    }

    /// The inputs, each with its rates behind it where a drive follows it, and what each of them is.
    fn input_infos(&self) -> (Vec<ParameterInfo>, Vec<InputRole>) {
        let mechanism = self.geometry.mechanism;
        let (mut infos, mut roles) = (Vec::new(), Vec::new());
        for (at, input) in mechanism.parameters.iter().enumerate().filter(|(_, parameter)| parameter.input) {
            infos.push(parameter_info(input));
            roles.push(InputRole::Value);
            let mut dimension = Some(input.dimension);
            for suffix in INPUT_RATES.iter().filter(|_| mechanism.drives_follow(ParameterId::new(at))) {
                dimension = dimension.and_then(|of| of.over(Dimension::TIME));
                let unit = dimension.map(|of| of.unit_counting(input.turning)).unwrap_or_default();
                let name = format!("{}{suffix}", input.name);
                infos.push(ParameterInfo { name: name.into(), unit: unit.into(), default: 0.0 });
                roles.push(InputRole::RateOfPrevious);
            }
        }
        (infos, roles)
    }

    /// What the rows of all cuts and couplings forbid, and which of them are kept, by index among the kept ones.
    pub(super) fn row_infos(&self, instant: &Instant<'_>) -> Vec<RowInfo> {
        let mechanism = self.geometry.mechanism;
        let mut kept = 0;
        let of_cuts = instant.cuts.iter().flat_map(|cut| {
            let name = &mechanism.joint(cut.cut.joint).name;
            cut.rows.iter().map(move |row| (name, row))
        });
        let names = mechanism.rigid_couplings().map(|coupling| &coupling.name);
        let of_couplings = names.zip(instant.couplings.iter().map(|coupling| &coupling.row));
        of_cuts
            .chain(of_couplings)
            .zip(&self.keep)
            .map(|((name, row), keep)| RowInfo {
                joint: name.clone().into(),
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
        let joints = self.geometry.mechanism.joints.iter();
        joints.flat_map(|joint| joint.contact_places()).map(|place| place.laws).collect()
    }

    /// Contacts of rods that slide along their bushes or tilt there, by their places.
    fn guides(&self) -> Vec<usize> {
        let mechanism = self.geometry.mechanism;
        let contacts = self.contacts.iter().enumerate();
        let guides = contacts.filter(|(_, contact)| mechanism.joint(contact.joint).model.is_loose_guide());
        guides.map(|(at, _)| at).collect()
    }

    /// Factors on wear coefficients, by the places of their joints there.
    fn coefficients(&self) -> Vec<CoefficientFactor> {
        let joints = self.contacts.iter().map(|contact| self.geometry.mechanism.joint(contact.joint));
        let clearances = joints.filter_map(|joint| joint.clearance.as_ref()).enumerate();
        let of = |factor| steps(self.geometry.inputs, factor).into();
        clearances
            .filter_map(|(contact, clearance)| {
                Some(CoefficientFactor { contact, steps: of(clearance.factor.as_ref()?) })
            })
            .collect()
    }

    /// Journals that wear, by the places of their joints there.
    fn journals(&self) -> Vec<JournalWear> {
        let joints = self.contacts.iter().map(|contact| self.geometry.mechanism.joint(contact.joint));
        let clearances = joints.filter_map(|joint| joint.clearance.as_ref()).enumerate();
        clearances
            .filter_map(|(contact, clearance)| Some(JournalWear { contact, ratio: clearance.journal? }))
            .collect()
    }

    /// Duty cycles, by the places of parameters and contacts here.
    fn mission_infos(&self, parameters: &[ParameterInfo]) -> Vec<MissionInfo> {
        let mechanism = self.geometry.mechanism;
        let joints: Vec<&str> =
            self.contacts.iter().map(|contact| &*mechanism.joint(contact.joint).name).collect();
        let segment = |segment: &Segment| {
            let place = |(id, value): &(ParameterId, f64)| {
                let name = &mechanism.parameter(*id).name;
                Some((parameters.iter().position(|known| known.name == *name)?, *value))
            };
            SegmentInfo {
                name: segment.name.clone().into(),
                amount: segment.amount,
                values: segment.values.iter().filter_map(place).collect(),
                factors: joints.iter().map(|joint| segment.factors_of(joint)).collect(),
            }
        };
        let mission = |mission: &Mission| MissionInfo {
            name: mission.name.clone().into(),
            ordered: mission.ordered,
            segments: mission.segments.iter().map(segment).collect(),
            coarser: mission.coarser.iter().map(segment).collect(),
        };
        mechanism.missions.iter().map(mission).collect()
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
            .chain(self.own.iter().map(|_| MotionInfo::Scalar { driver: None }))
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

fn parameter_info(parameter: &Parameter) -> ParameterInfo {
    // Values of inputs come with units of their own: a turn is no radian there.
    let unit = if parameter.input {
        parameter.dimension.unit_counting(parameter.turning)
    } else {
        parameter.dimension.si_unit()
    };
    ParameterInfo { name: parameter.name.clone().into(), unit: unit.into(), default: parameter.value }
}
