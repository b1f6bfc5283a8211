//! temp
use super::flexible::{Use, Written};
use super::Resolver;
use crate::model::{Body, Carrier, Flexible, Joint};
impl Resolver<'_> {
    pub(super) fn beam(
        &mut self,
        _carrier: Carrier,
        _written: Written<'_>,
        _body: &Body,
        _joints: &[Joint],
        _uses: &[Use],
    ) -> Option<Flexible> {
        None
    }
}
