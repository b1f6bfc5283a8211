//! Geometry of meshes: from axes, tooth numbers and angles to the force on either wheel per multiplier.
//! In: plain numbers. Out: [`Mesh`], or what is wrong. Never knows files and names.
//!
//! The multiplier is the force along the pitch line, so that the sum of a coupling is a path on the pitch circles.

use super::inertia::{between, cross, dot, perpendicular_part, unit};
use super::wheels::{DRAWN, is_parallel};
use crate::model::{ByMultiplier, PitchCircle};

type Vector = [f64; 3];

/// A wheel's axis: a point of it, and its unit direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct WheelAxis {
    pub(super) centre: Vector,
    pub(super) direction: Vector,
}

/// Angles of the teeth [rad], the hand of the first wheel's helix as a sign.
#[derive(Clone, Copy, Debug)]
pub(super) struct Teeth {
    pub(super) pressure: f64,
    pub(super) helix: f64,
    pub(super) hand: f64,
}

/// What two wheels feel of each other.
#[derive(Clone, Debug)]
pub(super) struct Mesh {
    /// Path on the pitch circles per angle of each wheel [m/rad], of a rack per path, with the signs of the relation.
    pub(super) factors: [f64; 2],
    /// On either wheel: force, and moment about a point of its axis.
    pub(super) sides: [Wrench; 2],
    /// Tangential, radial and axial force on the second wheel.
    pub(super) components: [ByMultiplier<f64>; 3],
}

/// Force, and moment about the wheel's `centre`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Wrench {
    pub(super) force: ByMultiplier<Vector>,
    pub(super) moment: ByMultiplier<Vector>,
    /// The wheel's pitch circle.
    pub(super) circle: Option<PitchCircle>,
}

/// What does not fit: a sentence behind "the coupling `name`: ", and advice.
pub(super) type Misfit = (String, String);

pub(super) fn misfit<T>(message: impl Into<String>, help: impl Into<String>) -> Result<T, Misfit> {
    Err((message.into(), help.into()))
}

pub(super) fn plus(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] + b[i])
}

pub(super) fn times(factor: f64, a: Vector) -> Vector {
    a.map(|x| factor * x)
}

pub(super) fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

impl<T> ByMultiplier<T> {
    pub(super) fn map<U>(self, f: impl Fn(T) -> U) -> ByMultiplier<U> {
        ByMultiplier { constant: f(self.constant), signed: f(self.signed), pressed: f(self.pressed) }
    }
}

/// Adds a force at a place to that on a wheel.
pub(super) fn push(on: &mut Wrench, axis: &WheelAxis, place: Vector, force: ByMultiplier<Vector>) {
    let arm = between(axis.centre, place);
    let moment = force.map(|force| cross(arm, force));
    let add = |a: ByMultiplier<Vector>, b: ByMultiplier<Vector>| ByMultiplier {
        constant: plus(a.constant, b.constant),
        signed: plus(a.signed, b.signed),
        pressed: plus(a.pressed, b.pressed),
    };
    on.force = add(on.force, force);
    on.moment = add(on.moment, moment);
}

/// Wheels that touch at a place with pitch radii: the force is that on the second.
fn touching(axes: [WheelAxis; 2], place: Vector, force: ByMultiplier<Vector>, radii: [f64; 2]) -> Mesh {
    let mut sides = [Wrench::default(); 2];
    push(&mut sides[0], &axes[0], place, force.map(|force| times(-1.0, force)));
    push(&mut sides[1], &axes[1], place, force);
    for (side, axis) in sides.iter_mut().zip(axes) {
        let arm = perpendicular_part(between(axis.centre, place), axis.direction);
        side.circle = Some(PitchCircle { centre: between(arm, place), radius: length(arm) });
    }
    // Of exactly the ratio of the teeth, with the signs of the drawing.
    let factors = std::array::from_fn(|i| radii[i].copysign(dot(sides[i].moment.signed, axes[i].direction)));
    let arm = perpendicular_part(between(axes[1].centre, place), axes[1].direction);
    let radial = unit(perpendicular_part(force.pressed, axes[1].direction)).or_else(|| unit(arm));
    let along = |direction: Vector| force.map(|force| dot(force, direction));
    let radial = along(radial.unwrap_or_default());
    let mut axial = along(axes[1].direction);
    // Rounding of directions at right angles.
    let dust = |x: &mut f64| {
        if x.abs() < DRAWN {
            *x = 0.0
        }
    };
    dust(&mut axial.signed);
    dust(&mut axial.pressed);
    let tangential = ByMultiplier { constant: 0.0, signed: 1.0, pressed: 0.0 };
    let radial = ByMultiplier { signed: 0.0, ..radial };
    Mesh { factors, sides, components: [tangential, radial, axial] }
}

/// How much centre distances may miss what tooth numbers and module say, in modules: as much as backlash is.
const FITS: f64 = 0.01;

/// Two wheels with parallel axes; `internal`: the larger one has its teeth inside.
pub(super) fn parallel(
    axes: [WheelAxis; 2],
    counts: [f64; 2],
    internal: bool,
    teeth: Teeth,
    (module, at): (Option<f64>, Option<Vector>),
) -> Result<Mesh, Misfit> {
    let u = axes[0].direction;
    if !is_parallel(u, axes[1].direction) {
        return misfit(
            "the axes of its wheels are not parallel",
            "give both joints one `axis`; wheels whose axes meet are `bevel`, those of a worm `worm`",
        );
    }
    let apart = perpendicular_part(between(axes[0].centre, axes[1].centre), u);
    let span = length(apart);
    let Some(e) = unit(apart).filter(|_| span > 0.0) else {
        return misfit(
            "both wheels turn about one line",
            "put the joints of the wheels at their own centres",
        );
    };
    if internal && counts[0] == counts[1] {
        return misfit("a wheel with inner teeth needs more teeth than the wheel in it", "check `teeth`");
    }
    let sum = if internal { (counts[0] - counts[1]).abs() } else { counts[0] + counts[1] };
    if let Some(module) = module {
        let needed = module * sum / 2.0 / teeth.helix.cos();
        if (needed - span).abs() > FITS * module {
            return misfit(
                format!(
                    "the axes of its wheels are {} mm apart, where module and tooth numbers need {} mm",
                    digits(span * 1e3),
                    digits(needed * 1e3)
                ),
                "correct the points, `teeth` or `module`; of wheels with profile shift leave `module` out: the radii then \
                 follow from the drawing",
            );
        }
    }
    let radii = counts.map(|count| span * count / sum);
    let first_is_ring = internal && counts[0] > counts[1];
    let outwards = if internal && !first_is_ring { times(-1.0, e) } else { e };
    let mut place = plus(axes[0].centre, times(radii[0], outwards));
    if let Some(at) = at {
        let miss = perpendicular_part(between(place, at), u);
        if length(miss) > DRAWN.sqrt() * span {
            return misfit(
                format!("its point `at` is {} mm off the pitch point", digits(length(miss) * 1e3)),
                "pitch radii have the ratio of the teeth; leave `at` out, or give the point where the pitch circles touch",
            );
        }
        place = plus(place, times(dot(between(place, at), u), u));
    }
    let tangent = cross(u, outwards);
    let apart = if first_is_ring { times(-1.0, outwards) } else { outwards };
    let axial = -teeth.hand * teeth.helix.tan();
    let force = ByMultiplier {
        constant: [0.0; 3],
        signed: plus(tangent, times(axial, u)),
        pressed: times(teeth.pressure.tan() / teeth.helix.cos(), apart),
    };
    Ok(touching(axes, place, force, radii))
}

/// Two bevel wheels that mesh at a place.
pub(super) fn bevel(
    axes: [WheelAxis; 2],
    counts: [f64; 2],
    pressure: f64,
    (module, place): (Option<f64>, Vector),
) -> Result<Mesh, Misfit> {
    let directions = axes.map(|axis| axis.direction);
    let Some(normal) =
        unit(cross(directions[0], directions[1])).filter(|_| !is_parallel(directions[0], directions[1]))
    else {
        return misfit("the axes of its wheels are parallel", "wheels with parallel axes are `gears`");
    };
    let arms = [0, 1].map(|i| perpendicular_part(between(axes[i].centre, place), directions[i]));
    let radii = arms.map(length);
    let size = radii[0].max(radii[1]);
    let apart = dot(between(axes[0].centre, axes[1].centre), normal).abs();
    if apart > DRAWN.sqrt() * size {
        return misfit(
            format!("the axes of its wheels pass each other {} mm apart", digits(apart * 1e3)),
            "the axes of bevel wheels meet; correct the points of their joints",
        );
    }
    let aside = dot(between(axes[0].centre, place), normal).abs();
    if aside > DRAWN.sqrt() * size || radii.iter().any(|radius| *radius <= DRAWN * size) {
        return misfit(
            "its point `at` is not beside both axes in their plane",
            "give the point where the pitch cones touch, in the middle of the face width",
        );
    }
    if (radii[0] * counts[1] - radii[1] * counts[0]).abs() > DRAWN.sqrt() * size * counts[0].max(counts[1]) {
        return misfit(
            format!(
                "its point `at` is {} mm from the first axis and {} mm from the second, which is not the ratio of the teeth",
                digits(radii[0] * 1e3),
                digits(radii[1] * 1e3)
            ),
            "give the point where the pitch cones touch: its distances from the axes are as the numbers of teeth",
        );
    }
    if let Some(module) = module.filter(|module| (module * counts[0] / 2.0 - radii[0]).abs() > FITS * module)
    {
        return misfit(
            format!(
                "its point `at` is {} mm from the first axis, where module and teeth need {} mm",
                digits(radii[0] * 1e3),
                digits(module * counts[0] * 500.0)
            ),
            "`module` is that in the middle of the face width",
        );
    }
    let tangent = unit(cross(directions[0], arms[0])).unwrap_or_default();
    let pitch_line = pitch_line(axes, normal, place);
    let across = unit(perpendicular_part(arms[0], pitch_line)).unwrap_or_default();
    let force = ByMultiplier { constant: [0.0; 3], signed: tangent, pressed: times(pressure.tan(), across) };
    Ok(touching(axes, place, force, [radii[0], radii[0] * counts[1] / counts[0]]))
}

/// Direction from where two axes meet to a place.
fn pitch_line(axes: [WheelAxis; 2], normal: Vector, place: Vector) -> Vector {
    let across = cross(axes[1].direction, normal);
    let along = dot(between(axes[0].centre, axes[1].centre), across) / dot(axes[0].direction, across);
    let apex = plus(axes[0].centre, times(along, axes[0].direction));
    unit(between(apex, place)).unwrap_or_default()
}

/// A worm with so many starts, then its wheel; the module is the axial one.
pub(super) fn worm(
    axes: [WheelAxis; 2],
    counts: [f64; 2],
    module: f64,
    teeth: Teeth,
) -> Result<Mesh, Misfit> {
    let [u, w] = axes.map(|axis| axis.direction);
    if dot(u, w).abs() > DRAWN {
        return misfit(
            "the axes of worm and wheel are not at right angles",
            "give one of the joints another `axis`",
        );
    }
    let normal = cross(u, w);
    let apart = dot(between(axes[0].centre, axes[1].centre), normal);
    let (span, e) = (apart.abs(), times(1.0_f64.copysign(apart), normal));
    let wheel = module * counts[1] / 2.0;
    let radius = span - wheel;
    if radius <= FITS * module {
        return misfit(
            format!(
                "the axes are {} mm apart, but the pitch radius of the wheel alone is {} mm",
                digits(span * 1e3),
                digits(wheel * 1e3)
            ),
            "correct the points, `teeth` or `module`",
        );
    }
    // Over the wheel's middle, where both axes are nearest.
    let along = dot(between(axes[0].centre, axes[1].centre), u);
    let place = plus(plus(axes[0].centre, times(along, u)), times(radius, e));
    // Advance per angle of the worm, and the tangent of its lead angle.
    let advance = module * counts[0] / 2.0;
    let lead = advance / radius;
    let force = ByMultiplier {
        constant: [0.0; 3],
        signed: plus(times(-teeth.hand, u), times(lead, cross(u, e))),
        pressed: times(teeth.pressure.tan() * lead.hypot(1.0), e),
    };
    Ok(touching(axes, place, force, [advance, wheel]))
}

/// A pinion, and a rack that slides along a direction.
pub(super) fn rack(
    pinion: WheelAxis,
    slide: WheelAxis,
    pressure: f64,
    (count, module, place): (Option<f64>, Option<f64>, Vector),
) -> Result<Mesh, Misfit> {
    let u = pinion.direction;
    let arm = perpendicular_part(between(pinion.centre, place), u);
    let radius = length(arm);
    let Some(e) = unit(arm).filter(|_| radius > 0.0) else {
        return misfit(
            "its point `at` lies on the axis of the pinion",
            "give the point where the pitch circle touches the rack",
        );
    };
    if dot(slide.direction, u).abs() > DRAWN.sqrt() || dot(slide.direction, e).abs() > DRAWN.sqrt() {
        return misfit(
            "the rack does not slide along the pitch circle at the point `at`",
            "its direction is at right angles to the pinion's axis and to the line from there to `at`",
        );
    }
    if let (Some(count), Some(module)) = (count, module)
        && (module * count / 2.0 - radius).abs() > FITS * module
    {
        return misfit(
            format!(
                "its point `at` is {} mm from the pinion's axis, where module and teeth need {} mm",
                digits(radius * 1e3),
                digits(module * count * 500.0)
            ),
            "correct the point, `teeth` or `module`",
        );
    }
    let force = ByMultiplier { constant: [0.0; 3], signed: cross(u, e), pressed: times(pressure.tan(), e) };
    let mut mesh = touching([pinion, slide], place, force, [radius, 1.0]);
    mesh.sides[1].circle = None;
    mesh.factors[1] = 1.0_f64.copysign(dot(force.signed, slide.direction));
    mesh.components[1] = ByMultiplier { pressed: pressure.tan(), ..ByMultiplier::default() };
    mesh.components[2] = ByMultiplier::default();
    Ok(mesh)
}

/// A length in a message.
pub(super) fn digits(value: f64) -> String {
    let rounded = format!("{value:.3}");
    rounded.trim_end_matches('0').trim_end_matches('.').to_owned()
}
