//! Geometry of belts and chains: strands between two pulleys. In: plain numbers. Out: [`Mesh`], or what is wrong.

use super::inertia::{between, cross, dot, perpendicular_part, unit};
use super::mesh::{Mesh, Misfit, WheelAxis, Wrench, digits, length, misfit, plus, push, times};
use super::wheels::is_parallel;
use crate::model::{ByMultiplier, PitchCircle};

/// Two pulleys; strands have a tension at rest, or the slack one carries nothing. The components are the pull and the
/// tensions of both strands.
pub(super) fn belt(
    axes: [WheelAxis; 2],
    radii: [f64; 2],
    crossed: bool,
    tension: f64,
) -> Result<Mesh, Misfit> {
    let u = axes[0].direction;
    if !is_parallel(u, axes[1].direction) {
        return misfit("the axes of its wheels are not parallel", "give both joints one `axis`");
    }
    let apart = perpendicular_part(between(axes[0].centre, axes[1].centre), u);
    let span = length(apart);
    let Some(e) = unit(apart).filter(|_| span > radii[0] + radii[1]) else {
        return misfit(
            format!(
                "its wheels are {} mm apart and have radii of {} mm in all: they would overlap",
                digits(span * 1e3),
                digits((radii[0] + radii[1]) * 1e3)
            ),
            "correct the points or `radii`",
        );
    };
    let f = cross(u, e);
    let second = if crossed { -radii[1] } else { radii[1] };
    let cosine = (radii[0] - second) / span;
    let sine = (1.0 - cosine * cosine).sqrt();
    // In the plane of the first wheel's joint.
    let centres = [axes[0].centre, plus(axes[0].centre, apart)];
    let mut sides = [Wrench::default(); 2];
    let mut components = [ByMultiplier { signed: 1.0, ..ByMultiplier::default() }; 3];
    for (strand, side) in [(1, 1.0), (2, -1.0)] {
        let normal = plus(times(cosine, e), times(side * sine, f));
        let direction = plus(times(sine, e), times(-side * cosine, f));
        let pressed = if tension > 0.0 { 0.0 } else { 0.5 };
        let pull = ByMultiplier { constant: tension, signed: side / 2.0, pressed };
        components[strand] = pull;
        for (wheel, radius, sign) in [(0, radii[0], 1.0), (1, second, -1.0)] {
            let place = plus(centres[wheel], times(radius, normal));
            push(&mut sides[wheel], &axes[wheel], place, pull.map(|pull| times(sign * pull, direction)));
        }
    }
    for i in 0..2 {
        sides[i].circle = Some(PitchCircle { centre: centres[i], radius: radii[i] });
    }
    let factors = std::array::from_fn(|i| radii[i].copysign(dot(sides[i].moment.signed, axes[i].direction)));
    Ok(Mesh { factors, sides, components })
}
