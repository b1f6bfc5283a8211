//! Numbers that end right before a page that nobody may touch: a read or a write past them ends the test.
#![expect(unsafe_code, reason = "only the system can forbid pages")]

use std::ptr;

const PAGE: usize = 4096;

/// Numbers before a forbidden page.
pub(super) struct Guarded {
    base: *mut u8,
    pages: usize,
    len: usize,
}

impl Guarded {
    /// Numbers, all of them `fill`.
    pub(super) fn new(len: usize, fill: f64) -> Self {
        let pages = (len * size_of::<f64>()).div_ceil(PAGE).max(1);
        let length = (pages + 1) * PAGE;
        let (allowed, flags) = (libc::PROT_READ | libc::PROT_WRITE, libc::MAP_PRIVATE | libc::MAP_ANONYMOUS);
        // SAFETY: a fresh mapping, where the system wants it.
        let base = unsafe { libc::mmap(ptr::null_mut(), length, allowed, flags, -1, 0) };
        assert_ne!(base, libc::MAP_FAILED);
        let base = base.cast::<u8>();
        // SAFETY: the last page of that mapping, which nothing refers to.
        let forbidden =
            unsafe { libc::mprotect(base.wrapping_add(pages * PAGE).cast(), PAGE, libc::PROT_NONE) };
        assert_eq!(forbidden, 0);
        let mut guarded = Self { base, pages, len };
        guarded.numbers().fill(fill);
        guarded
    }

    /// These numbers.
    pub(super) fn holding(numbers: &[f64]) -> Self {
        let mut guarded = Self::new(numbers.len(), 0.0);
        guarded.numbers().copy_from_slice(numbers);
        guarded
    }

    pub(super) fn numbers(&mut self) -> &mut [f64] {
        let first = self.base.wrapping_add(self.pages * PAGE - self.len * size_of::<f64>());
        // SAFETY: the numbers lie in pages of this mapping that may be read and written; they are borrowed alone.
        unsafe { std::slice::from_raw_parts_mut(first.cast(), self.len) }
    }
}

impl Drop for Guarded {
    fn drop(&mut self) {
        // SAFETY: the whole mapping, which nothing refers to any more.
        unsafe { libc::munmap(self.base.cast(), (self.pages + 1) * PAGE) };
    }
}
