//! Flexible bodies: which points need a node, where the floating frame lies, and the constants of the body,
//! from a beam ([`super::beam`]) or from a file of modal data.

use std::path::Path;

use super::inertia;
use super::quantity::Allowed;
use super::resolver::{Resolver, place};
use crate::diagnostic::{Code, brief};
use crate::flexible::ModalData;
use crate::id::{BodyId, PointId};
use crate::input::read_named;
use crate::limits;
use crate::model::{Body, Carrier, Direction, Flexible, Force, Formula, Joint, Station};
use crate::spec::{At, Dimension, File, FlexibleSpec, Name, Quantity};

/// Nodes of modal data match points that are nearer than this share of the body's size: coordinates written
/// with six digits do.
const NODE_DISTANCE: f64 = 1e-5;

/// A place where something holds, pushes or looks at a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Use {
    pub(super) point: PointId,
    /// A joint is there.
    pub(super) held: bool,
    /// That joint constrains orientation.
    pub(super) turns: bool,
}

/// What is known of a flexible body before its constants are.
#[derive(Clone, Copy)]
pub(super) struct Bending<'a> {
    pub(super) name: &'a Name,
    pub(super) carrier: Carrier,
    pub(super) spec: &'a At<FlexibleSpec>,
    pub(super) body: &'a Body,
    pub(super) joints: &'a [Joint],
    pub(super) uses: &'a [Use],
    /// In W [m/s²].
    pub(super) gravity: [f64; 3],
}

impl Resolver<'_> {
    pub(super) fn resolve_flexible(
        &mut self,
        file: &File,
        bodies: &mut [Body],
        joints: &[Joint],
        forces: &[Force],
        gravity: &[Formula; 3],
    ) {
        // Without points nothing says where a body lies, or what holds it; that is reported where they are named.
        if self.points.is_empty() {
            return;
        }
        let gravity = self.values_of(gravity);
        for (index, (name, body)) in file.bodies.0.iter().enumerate() {
            let Some(spec) = &body.value.flexible else { continue };
            let carrier = Carrier::Body(BodyId::new(index));
            let uses = self.uses_of(carrier, &bodies[index], joints, forces);
            let of = Bending { name, carrier, spec, body: &bodies[index], joints, uses: &uses, gravity };
            let flexible = match &spec.value.data {
                Some(data) => {
                    self.check_modal_keys(name, &body.value, &spec.value);
                    self.read_modal_data(of, data)
                }
                None => self.beam(of),
            };
            bodies[index].flexible = flexible.map(Box::new);
        }
        self.take_modal_starts(bodies);
    }

    /// Every point at which the body is held, pushed or looked at.
    fn uses_of(&self, carrier: Carrier, body: &Body, joints: &[Joint], forces: &[Force]) -> Vec<Use> {
        let mut uses: Vec<Use> = Vec::new();
        let mut add = |point: PointId, held: bool, turns: bool| match uses
            .iter_mut()
            .find(|known| known.point == point)
        {
            Some(known) => (known.held, known.turns) = (known.held | held, known.turns | turns),
            None => uses.push(Use { point, held, turns }),
        };
        for joint in joints.iter().filter(|joint| joint.parent == carrier || joint.child == carrier) {
            let [on_parent, on_child] = joint.points();
            let point = if joint.parent == carrier { on_parent } else { on_child };
            add(point, true, !joint.model.turns_freely());
        }
        for force in forces {
            for (_, point) in force.attachments().into_iter().filter(|(body, _)| *body == carrier) {
                add(point, false, force.kind.turns);
            }
        }
        for point in body.inertia.points() {
            add(point, false, false);
        }
        for (index, point) in self.points.iter().enumerate() {
            if point.carrier == carrier {
                add(PointId::new(index), false, false);
            }
        }
        uses
    }

    /// A number fixed at generation, or the default.
    pub(super) fn fixed(
        &mut self,
        name: &Name,
        key: &str,
        quantity: Option<&Quantity>,
        dimension: Dimension,
        default: f64,
    ) -> f64 {
        let Some(quantity) = quantity else { return default };
        let what = place(key, "body", name);
        let formula = self.formula(quantity, Some(dimension), Allowed::CONSTANTS, &what);
        self.value(&formula)
    }

    /// Position of a point on a flexible body, which may not move with a tunable parameter.
    pub(super) fn fixed_position(&mut self, name: &Name, point: PointId, carrier: Carrier) -> [f64; 3] {
        let known = &self.points[point.index()];
        if known.position_for(carrier).iter().any(|x| self.is_tunable(x)) {
            let message = format!(
                "the point `{}` of the flexible body `{}` depends on a tunable parameter",
                known.name, name.value
            );
            self.refuse(Code::TunableNotAllowed, known.span, message)
                .help("modes are computed at generation; take the `tunable` mark away");
        }
        self.position_value(point, carrier)
    }

    /// The share of modes that `[initial]` gives values for.
    fn take_modal_starts(&mut self, bodies: &mut [Body]) {
        // A body whose modes failed has none for another reason.
        let faulty = self.has_errors();
        for start in std::mem::take(&mut self.modal_starts) {
            let body = &mut bodies[start.body.index()];
            let Some(flexible) = &mut body.flexible else {
                if faulty {
                    continue;
                }
                let message = format!("the body `{}` has no modes to start from", body.name);
                self.refuse(Code::BadStart, start.span, message).help("take it away");
                continue;
            };
            let modes = flexible.start.len();
            for (what, list) in [("eta", &start.position), ("eta_v", &start.speed)] {
                if !list.is_empty() && list.len() != modes {
                    let message =
                        format!("`{what}` of `{}` has {} values for {modes} modes", body.name, list.len());
                    self.refuse(Code::BadStart, start.span, message).help("give one value for each mode");
                }
            }
            for (at, own) in flexible.start.iter_mut().enumerate() {
                own[0] = start.position.get(at).copied().unwrap_or(0.0);
                own[1] = start.speed.get(at).copied().unwrap_or(0.0);
            }
        }
    }

    /// Constants from a file beside this one.
    fn read_modal_data(&mut self, of: Bending<'_>, file: &Name) -> Option<Flexible> {
        let Bending { name, carrier, spec, .. } = of;
        let found = read_named(Path::new(&self.source.name), &file.value, self.reach, limits::DATA_BYTES);
        let data = found.map_err(|error| error.to_string()).and_then(|(path, text)| {
            self.attached.push(path);
            ModalData::from_toml(&text).map_err(|error| error.to_string())
        });
        let mut data = match data {
            Ok(data) => data,
            Err(reason) => {
                // The reason may quote the file, which need not be meant for who reads the message.
                let message = format!("the modal data `{}` cannot be used: {}", file.value, brief(&reason));
                self.refuse(Code::BadModalData, file.span, message).help(
                    "docs/modal-data.md describes the file; its path is relative to this file, and leads out of its \
                     folder only with --allow-outside-data",
                );
                return None;
            }
        };
        self.check_modal_mass(of, &data);
        self.warn_modal_products(file, &data);
        // Those that are written are for people.
        let frequencies = data.natural_frequencies();
        data.modes.iter_mut().zip(frequencies).for_each(|(mode, frequency)| mode.frequency = frequency);
        let Some(origin) = &spec.value.origin else {
            let message = format!("nothing says where the floating frame of `{}` lies", name.value);
            self.lacking(spec.span, spec.span, "origin", message)
                .help("add `origin = \"P\"`, the point at the origin of the modal data");
            return None;
        };
        let origin = self.point_on(origin, Some((carrier, name)), &format!("body `{}`", name.value))?;
        let axes = match &spec.value.axes {
            Some(axes) => self.axes(name, axes),
            None => inertia::AXES_OF_W,
        };
        let nodes = self.nodes_of(of, &data, &axes, origin);
        let start = vec![[0.0; 2]; data.modes.len()];
        let looked_at = |index: &usize| !nodes.iter().any(|(_, node)| node == index);
        let stations = (0..data.nodes.len())
            .filter(looked_at)
            .map(|node| Station { name: data.nodes[node].name.clone(), node, stress: None })
            .collect();
        let (young, damped, left_out) = (None, file.span, Vec::new());
        Some(Flexible { axes, origin, nodes, stations, start, young, damped, left_out, data })
    }

    /// The node at every point used.
    fn nodes_of(
        &mut self,
        of: Bending<'_>,
        data: &ModalData,
        axes: &[[f64; 3]; 3],
        origin: PointId,
    ) -> Vec<(PointId, usize)> {
        let Bending { name, carrier, uses, .. } = of;
        let start = self.fixed_position(name, origin, carrier);
        let size =
            data.nodes.iter().map(|node| inertia::dot(node.position, node.position)).fold(0.0, f64::max);
        let mut nodes = Vec::new();
        for own in uses {
            let place = inertia::between(start, self.fixed_position(name, own.point, carrier));
            let local = axes.map(|axis| inertia::dot(axis, place));
            let apart = |node: &crate::flexible::Node| inertia::distance(node.position, local);
            let nearest = (0..data.nodes.len())
                .min_by(|a, b| apart(&data.nodes[*a]).total_cmp(&apart(&data.nodes[*b])));
            let Some(node) = nearest else {
                let point = &self.points[own.point.index()];
                let message = format!(
                    "the flexible body `{}` has no node at `{}`: its modal data have no nodes at all",
                    name.value, point.name
                );
                self.refuse(Code::NoNodeHere, point.span, message)
                    .help("add a `[[node]]` to the modal data for every point of the body that is used");
                continue;
            };
            if apart(&data.nodes[node]) <= NODE_DISTANCE * size.sqrt() {
                nodes.push((own.point, node));
                continue;
            }
            let point = &self.points[own.point.index()];
            let message = format!(
                "the flexible body `{}` has no node at `{}`; the nearest, `{}`, is {:.3e} m away",
                name.value,
                point.name,
                data.nodes[node].name,
                apart(&data.nodes[node])
            );
            self.refuse(Code::NoNodeHere, point.span, message)
                .help("add a node to the modal data, or move the point");
        }
        nodes
    }
}

/// Directions of a round link's section axes: with a revolute axis at right angles to the link as z, else as
/// near to the ground frame's as possible.
pub(super) fn section_axes(x: [f64; 3], hinges: &[[f64; 3]]) -> [[f64; 3]; 3] {
    let across = hinges.iter().find(|axis| inertia::dot(**axis, x).abs() < 1e-9);
    let least = (0..3).min_by(|a, b| x[*a].abs().total_cmp(&x[*b].abs())).unwrap_or(2);
    let mut helper = [0.0; 3];
    helper[if least == 0 { 2 } else { least }] = 1.0;
    let along = inertia::dot(helper, x).abs() > 0.9;
    let helper = if along { [0.0, 1.0, 0.0] } else { helper };
    let z = across.copied().unwrap_or(helper);
    let z = inertia::unit(inertia::perpendicular_part(z, x)).unwrap_or([0.0, 0.0, 1.0]);
    [x, inertia::cross(z, x), z]
}

/// Axes about which joints turn, as a body's branch describes them.
pub(super) fn hinges(carrier: Carrier, joints: &[Joint]) -> Vec<[f64; 3]> {
    let mut list = Vec::new();
    for joint in joints {
        let own = |axis: &crate::model::Axis| if joint.child == carrier { axis.child } else { axis.parent };
        if joint.parent != carrier && joint.child != carrier {
            continue;
        }
        let turns = joint.model.turns().into_iter();
        list.extend(turns.map(|direction| own(&joint.model.axes[usize::from(direction == Direction::X)])));
    }
    list
}
