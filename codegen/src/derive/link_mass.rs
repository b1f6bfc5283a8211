//! Mass of every link, rigid or deformed.
//! In: [`Geometry`], modal coordinates. Out: [`LinkMass`]es. Never knows speeds.

use crate::expr::Expr;

use super::deformation::{ModalMass, deformed};
use super::geometry::Geometry;
use super::linkage::Freedom;
use super::mass_properties::MassProperties;
use super::rigid_part::rigid_part;

/// Mass of a link: as a rigid body in its present shape, and what modes feel of it.
#[derive(Clone, Debug)]
pub struct LinkMass<'g> {
    /// Mass and moments.
    pub rigid: MassProperties<'g>,
    /// Of a flexible body.
    pub modal: Option<Box<ModalMass<'g>>>,
}

/// Mass properties of every link, for given coordinates, of which those of modes matter.
pub fn link_masses<'g>(geometry: &Geometry<'g>, q: &[Expr<'g>]) -> Vec<LinkMass<'g>> {
    let links = geometry.linkage.links.iter().enumerate();
    links
        .map(|(at, link)| match &geometry.mechanism.body(link.body).flexible {
            Some(flexible) if matches!(link.freedom, Freedom::Flexible { .. }) => {
                geometry.g.begin_section(format!("mass properties of the deformed {}", link.name));
                let (rigid, modal) = deformed(geometry.g, &flexible.data, &q[link.coordinates()]);
                LinkMass { rigid, modal: Some(Box::new(modal)) }
            }
            _ => LinkMass { rigid: rigid_part(geometry, at), modal: None },
        })
        .collect()
}
