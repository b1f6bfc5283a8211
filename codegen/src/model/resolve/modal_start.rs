//! Start values of flexible bodies, kept until the bodies are resolved.

use crate::id::BodyId;
use crate::source::Span;

/// Start values of a flexible body's modes as written.
pub(super) struct ModalStart {
    pub(super) body: BodyId,
    pub(super) position: Vec<f64>,
    pub(super) speed: Vec<f64>,
    pub(super) span: Span,
}
