//! Loops and couplings of `<equality>`. In: elements, links and joints. Out: joints that close loops, coordinates that follow others. Never
//! knows text.

use super::super::error::ImportError;
use super::super::place::Place;
use super::super::robot::{Closure, Follows, Joint, Kind};
use super::super::xml::Element;
use super::bodies::Tree;
use super::classes::EQUALITY;
use super::settings::flag;

/// Entries of two places that differ by less are the same [m or 1].
const SAME: f64 = 1e-9;

/// Reads them; what a joint follows is written into it.
pub fn read(root: &Element, tree: &mut Tree<'_>, places: &[Place]) -> Result<Vec<Closure>, ImportError> {
    let mut closures: Vec<Closure> = Vec::new();
    for element in root.all("equality").flat_map(|equality| &equality.children) {
        let element = &tree.classes.applied_as(EQUALITY, element, None)?;
        let what = &*element.tag;
        let name = element.attribute("name");
        let told = name
            .map_or_else(|| format!("<{what}> of line {}", element.line), |name| format!("<{what}> {name}"));
        if tree.settings.disabled.equality {
            // Told of all by its flag.
            continue;
        }
        if !flag(element, "active", true)? {
            tree.left_out.push(format!("{told}: it is not active"));
            continue;
        }
        match what {
            "connect" | "weld" => {
                let (what, kind) =
                    if what == "connect" { ("connect", Kind::Spherical) } else { ("weld", Kind::Fixed) };
                let name = name.map_or_else(|| format!("{what}_{}", closures.len() + 1), str::to_owned);
                let Some((links, at)) = sides(element, tree, places, kind)? else {
                    tree.left_out
                        .push(format!("{told}: it holds places apart that are not where it wants them"));
                    continue;
                };
                closures.push(Closure { name, what, kind, links, at });
            }
            "joint" => joint(element, tree, &told)?,
            _ => tree.left_out.push(told),
        }
    }
    if !closures.is_empty() || tree.joints.iter().any(|joint| joint.follows.is_some() || joint.held.is_some())
    {
        tree.left_out
            .push("what makes <equality> soft (solref, solimp): what it holds is rigid here".to_owned());
    }
    Ok(closures)
}

/// Both links and the place of the joint in each; None where its frames are apart as drawn and must not be.
type Sides = Option<([usize; 2], [[f64; 3]; 2])>;

fn sides(element: &Element, tree: &Tree<'_>, places: &[Place], kind: Kind) -> Result<Sides, ImportError> {
    let unknown = |what: &str, name: &str| {
        element.fault(format!("there is no {what} `{name}`"), "names are case-sensitive")
    };
    if element.attribute("site1").is_some() {
        let site = |key: &str| {
            let name = element.needed(key)?;
            tree.sites.get(name).copied().ok_or_else(|| unknown("site", name))
        };
        let ((first, one), (second, other)) = (site("site1")?, site("site2")?);
        let (a, b) = (places[first].then(&one), places[second].then(&other));
        let apart = (0..3).map(|i| a.origin[i] - b.origin[i]);
        let turned = a.turn.iter().flatten().zip(b.turn.iter().flatten()).map(|(x, y)| x - y);
        let is_met = kind == Kind::Spherical || apart.chain(turned).all(|difference| difference.abs() < SAME);
        return Ok(is_met.then_some(([first, second], [one.origin, other.origin])));
    }
    let body = |key: &str, default: Option<usize>| match (element.attribute(key), default) {
        (None, Some(default)) => Ok(default),
        _ => {
            let name = element.needed(key)?;
            tree.bodies.get(name).copied().ok_or_else(|| unknown("body", name))
        }
    };
    let links = [body("body1", None)?, body("body2", Some(0))?];
    // A quaternion of zero says that both are held as they are drawn.
    let [.., a, b, c, d] = element.numbers("relpose", Some([0.0; 7]))?;
    if kind == Kind::Fixed && [a, b, c, d] != [0.0; 4] {
        return Ok(None);
    }
    // The anchor is given in the first body; the second meets it as drawn.
    let anchor = if kind == Kind::Spherical { element.numbers("anchor", None)? } else { [0.0; 3] };
    let place = places[links[0]].point(anchor);
    Ok(Some((links, [anchor, places[links[1]].back(place)])))
}

/// One coordinate that follows another, or stays.
fn joint(element: &Element, tree: &mut Tree<'_>, told: &str) -> Result<(), ImportError> {
    let find = |key: &str| {
        let name = element.needed(key)?;
        let found = tree.joints.iter().position(|joint: &Joint| joint.name == name);
        found.ok_or_else(|| element.fault(format!("there is no joint `{name}`"), "names are case-sensitive"))
    };
    let own = find("joint1")?;
    let leader = element.attribute("joint2").map(|_| find("joint2")).transpose()?;
    let mut factors = element.up_to("polycoef", 5)?;
    if factors.is_empty() {
        factors = vec![0.0, 1.0];
    }
    factors.resize(5, 0.0);
    let is_single = |joint: usize| tree.joints[joint].kind.is_single();
    let is_straight = leader.is_none() || factors[2..] == [0.0; 3];
    let is_new = tree.joints[own].follows.is_none() && tree.joints[own].held.is_none();
    if !is_straight
        || !is_new
        || !is_single(own)
        || leader.is_some_and(|leader| !is_single(leader) || leader == own)
    {
        tree.left_out
            .push(format!("{told}: a relation that is no straight line between two other coordinates"));
        return Ok(());
    }
    match leader {
        Some(leader) if factors[1] != 0.0 => {
            tree.joints[own].follows = Some(Follows { leader, times: factors[1], plus: factors[0] });
        }
        _ => tree.joints[own].held = Some(factors[0]),
    }
    Ok(())
}
