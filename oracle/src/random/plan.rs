//! What connects to what in a random mechanism, with enough freedom in every loop.
//! In: a recipe. Out: [`Plan`]. Never knows text.

use super::dice::Dice;
use super::recipe::Recipe;
use crate::kind::Kind;

/// A joint to be written.
#[derive(Clone, Debug)]
pub struct PlannedJoint {
    pub name: String,
    pub kind: Kind,
    /// Body nearer to the ground (`None`: the ground) and the other.
    pub inner: Option<usize>,
    pub outer: usize,
    /// The file names the outer body first.
    pub reversed: bool,
    /// A driven coordinate.
    pub drive: Option<usize>,
    /// The loop it is in.
    pub ring: Option<usize>,
}

/// A mechanism to be written: joint `k` below the number of bodies carries body `k`, the rest close loops.
#[derive(Clone, Debug)]
pub struct Plan {
    pub joints: Vec<PlannedJoint>,
}

impl Plan {
    pub fn new(recipe: &Recipe, dice: &mut Dice) -> Self {
        let mut joints = Vec::new();
        for body in 0..recipe.bodies {
            let kind = *dice.pick(&recipe.kinds);
            // Chains more often than stars, so that loops find room.
            let inner = if body == 0 || dice.chance(0.2) {
                None
            } else if dice.chance(0.6) {
                Some(body - 1)
            } else {
                Some(dice.below(body))
            };
            joints.push(PlannedJoint {
                name: format!("j{body}"),
                kind,
                inner,
                outer: body,
                reversed: dice.chance(0.3),
                drive: None,
                ring: None,
            });
        }
        if joints.iter().all(|joint| joint.kind == Kind::Fixed) {
            // Something must move.
            joints[0].kind = Kind::Revolute;
        }
        let mut plan = Self { joints };
        for ring in 0..recipe.loops {
            plan.close(recipe, ring, dice);
        }
        plan.drive(recipe, dice);
        plan
    }

    /// Joints from a body to the ground.
    fn path(&self, body: usize) -> Vec<usize> {
        let mut path = vec![body];
        while let Some(inner) = self.joints[path[path.len() - 1]].inner {
            path.push(inner);
        }
        path
    }

    /// Joints between two bodies (or a body and the ground).
    fn between(&self, a: usize, b: Option<usize>) -> Vec<usize> {
        let from_a = self.path(a);
        let from_b = b.map_or_else(Vec::new, |b| self.path(b));
        let lone = |mine: &[usize], other: &[usize]| -> Vec<usize> {
            mine.iter().copied().filter(|joint| !other.contains(joint)).collect()
        };
        [lone(&from_a, &from_b), lone(&from_b, &from_a)].concat()
    }

    /// Adds a joint that closes a loop of at least three joints over joints of no other loop.
    fn close(&mut self, recipe: &Recipe, ring: usize, dice: &mut Dice) {
        let mut choices = Vec::new();
        for outer in 0..recipe.bodies {
            for inner in std::iter::once(None).chain((0..outer).map(Some)) {
                let way = self.between(outer, inner);
                if way.len() >= 2 && way.iter().all(|joint| self.joints[*joint].ring.is_none()) {
                    choices.push((outer, inner, way));
                }
            }
        }
        if choices.is_empty() {
            return;
        }
        let (outer, inner, mut way) = dice.pick(&choices).clone();
        way.push(self.joints.len());
        self.joints.push(PlannedJoint {
            name: format!("close{ring}"),
            kind: *dice.pick(&recipe.kinds),
            inner,
            outer,
            reversed: dice.chance(0.3),
            drive: None,
            ring: None,
        });
        for joint in &way {
            self.joints[*joint].ring = Some(ring);
        }
        // A random walk over kinds; it ends, since a ball and universals or cylinders elsewhere always do.
        while self.mobility(ring) < 1 {
            let joint = *dice.pick(&way);
            let wide = self.ring(ring).filter(|joint| joint.kind.is_wide()).count();
            let kind = &mut self.joints[joint].kind;
            if kind.is_wide() || kind.freedoms() == [0, 0] || wide >= 2 {
                *kind = *dice.pick(&[Kind::Cylindrical, Kind::Universal]);
            } else {
                *kind = *dice.pick(&[Kind::Spherical, Kind::Planar]);
            }
        }
    }

    fn ring(&self, ring: usize) -> impl Iterator<Item = &PlannedJoint> {
        self.joints.iter().filter(move |joint| joint.ring == Some(ring))
    }

    /// Freedoms of a loop that are more than idle spin, as far as counting tells; zero if its rotations
    /// alone are locked.
    fn mobility(&self, ring: usize) -> usize {
        let [turns, slides] = self.ring(ring).fold([0, 0], |[turns, slides], joint| {
            let [t, s] = joint.kind.freedoms();
            [turns + t, slides + s]
        });
        // What stands between two balls spins about the line through them, between a ball and a plane about the
        // normal through the ball, and between two planes it slides along their common line: idle.
        let balls = self.ring(ring).filter(|joint| joint.kind.is_wide()).count();
        if turns < 4 || balls > 2 {
            return 0;
        }
        (turns + slides).saturating_sub(6 + balls.saturating_sub(1))
    }

    fn drive(&mut self, recipe: &Recipe, dice: &mut Dice) {
        for _ in 0..recipe.drives {
            let index = dice.below(self.joints.len());
            let joint = &self.joints[index];
            let count = joint.kind.coordinates().len();
            let room = joint.ring.is_none_or(|ring| {
                self.ring(ring).filter(|joint| joint.drive.is_some()).count() < self.mobility(ring)
            });
            if count > 0 && room && joint.drive.is_none() {
                self.joints[index].drive = Some(dice.below(count));
            }
        }
    }
}
