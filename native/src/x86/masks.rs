//! Which comparisons the mask registers hold. A comparison lies in a mask register alone until something other than a selection reads it,
//! or masks run out: copies to and from vector registers would be a ninth of the code that concludes a step.
//! In: comparisons as they are made and read. Out: mask registers. Never knows bytes.

use crate::straight::allocate::Allocation;
use crate::straight::graph::Id;
use crate::straight::place::Register;

use super::emit::push;
use super::instruction::{Instruction, MASKS, MaskRegister, Target};

/// What each mask register holds; the first is no register.
#[derive(Default)]
pub(super) struct Masks([Option<Id>; MASKS]);

impl Masks {
    /// A mask register for a comparison that is about to be made; what `locked` names keeps its register.
    pub(super) fn take(
        &mut self,
        allocation: &mut Allocation<'_, Target>,
        id: Id,
        locked: &[Id],
    ) -> MaskRegister {
        // One that is read no more comes before all that are.
        let next_read =
            |mask: MaskRegister| self.0[usize::from(mask)].and_then(|held| allocation.next_read(held));
        let furthest = |mask: &MaskRegister| next_read(*mask).unwrap_or(u32::MAX);
        let mask = (1..MASKS as MaskRegister).max_by_key(furthest).unwrap_or(1);
        let held = self.0[usize::from(mask)].replace(id);
        if let Some(held) = held.filter(|held| allocation.next_read(*held).is_some()) {
            copy(allocation, held, mask, locked);
        }
        mask
    }

    /// The mask register of a comparison; what `locked` names keeps its register.
    pub(super) fn mask_of(
        &mut self,
        allocation: &mut Allocation<'_, Target>,
        id: Id,
        locked: &[Id],
    ) -> MaskRegister {
        if let Some(mask) = self.position(id) {
            return mask;
        }
        let of = allocation.load(id, locked);
        let mask = self.take(allocation, id, locked);
        push(allocation, id, Instruction::SignToMask { mask, of });
        mask
    }

    /// Has those of some values that are comparisons in vector registers or in memory too.
    pub(super) fn copy(&self, allocation: &mut Allocation<'_, Target>, ids: &[Id], locked: &[Id]) {
        for id in ids {
            if let Some(mask) = self.position(*id) {
                copy(allocation, *id, mask, locked);
            }
        }
    }

    /// Before a call, which may change every mask register: has all that are read again in memory.
    pub(super) fn save(&mut self, allocation: &mut Allocation<'_, Target>) {
        for (mask, held) in (0..).zip(std::mem::take(&mut self.0)) {
            if let Some(id) = held.filter(|held| allocation.next_read(*held).is_some())
                && let Some(to) = copy(allocation, id, mask, &[])
            {
                allocation.evict(to);
            }
        }
    }

    fn position(&self, id: Id) -> Option<MaskRegister> {
        self.0.iter().position(|held| *held == Some(id)).map(|at| at as MaskRegister)
    }
}

/// Copies a comparison from its mask register to a vector register, unless it lies elsewhere too.
fn copy(
    allocation: &mut Allocation<'_, Target>,
    id: Id,
    mask: MaskRegister,
    locked: &[Id],
) -> Option<Register> {
    if allocation.is_placed(id) {
        return None;
    }
    let to = allocation.place(id, locked);
    push(allocation, id, Instruction::MaskToRegister { to, mask });
    Some(to)
}
