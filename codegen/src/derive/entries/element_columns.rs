//! Output columns of stops and force elements. In: link motion. Out: channels with expressions.

use super::observe::Channels;
use crate::derive::elements::force_columns;
use crate::derive::stops::pressed;

impl Channels<'_, '_> {
    /// Depth and force of every stop, then what kinds of force elements tell of themselves.
    pub(super) fn elements(&mut self) {
        let (state, geometry) = (&self.instant.state, self.deriver.geometry);
        let g = geometry.g;
        for stop in &geometry.mechanism.stops {
            g.begin_section(format!("stop {}", stop.name));
            let coordinates = state.coordinates(g, stop.joint);
            let own = [&coordinates.position, &coordinates.speed].map(|list| list[stop.coordinate]);
            let pressed = pressed(g, state, stop, own);
            let [depth, force] =
                if stop.angular { [("depth", "rad"), ("T", "N m")] } else { [("depth", "m"), ("F", "N")] };
            self.push(format!("{}.{}", stop.name, depth.0), depth.1, pressed.depth);
            self.push(format!("{}.{}", stop.name, force.0), force.1, pressed.force);
        }
        for force in &geometry.mechanism.forces {
            for (name, unit, value) in force_columns(force, g, state) {
                self.push(format!("{}.{name}", force.name), unit, value);
            }
        }
    }
}
