//! How long work tells how far it is and hears that it shall stop: one form for all of it.

use std::fmt;
use std::ops::ControlFlow;

/// Hears of the finished part of long work, 0 to 1, from any thread; `Break` stops it.
#[derive(Clone, Copy)]
#[must_use]
pub struct Watch<'a> {
    hear: &'a (dyn Fn(f64) -> ControlFlow<()> + Sync),
    begin: Option<&'a (dyn Fn(&'static str) + Sync)>,
    from: f64,
    length: f64,
}

impl Watch<'_> {
    /// Nobody watches, nothing stops.
    pub const NONE: Self = Self { hear: &|_| ControlFlow::Continue(()), begin: None, from: 0.0, length: 1.0 };
}

impl<'a> Watch<'a> {
    /// A watch that calls `hear`.
    pub const fn new(hear: &'a (dyn Fn(f64) -> ControlFlow<()> + Sync)) -> Self {
        Self { hear, begin: None, from: 0.0, length: 1.0 }
    }

    /// The same, hearing too what begins, where work consists of stages that each count from 0 to 1.
    pub const fn with_stages(self, begin: &'a (dyn Fn(&'static str) + Sync)) -> Self {
        Self { begin: Some(begin), ..self }
    }

    /// The same for a piece of the work, from one part of it to another.
    pub fn piece(self, from: f64, to: f64) -> Self {
        Self { from: self.from + from * self.length, length: (to - from) * self.length, ..self }
    }

    /// The same for equal pieces of the work, one after the other.
    pub fn pieces(self, count: u32) -> impl Iterator<Item = Self> {
        let part = move |piece: u32| f64::from(piece) / f64::from(count);
        (0..count).map(move |piece| self.piece(part(piece), part(piece + 1)))
    }

    /// Tells that a stage of the work begins, in a word.
    pub fn begin(self, stage: &'static str) {
        if let Some(begin) = self.begin {
            begin(stage);
        }
    }

    /// Tells the finished part; answers whether to go on.
    pub fn report(self, part: f64) -> ControlFlow<()> {
        (self.hear)(self.from + part * self.length)
    }
}

impl fmt::Debug for Watch<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Watch({}, {})", self.from, self.length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    #[test]
    fn pieces_of_pieces_are_parts_of_the_whole() {
        let heard = Mutex::new(Vec::new());
        let hear = |part: f64| {
            heard.lock().unwrap().push(part);
            if part < 0.7 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        let half = Watch::new(&hear).piece(0.5, 1.0);
        assert!(half.report(0.0).is_continue() && half.piece(0.5, 1.0).report(0.5).is_break());
        assert_eq!(*heard.lock().unwrap(), [0.5, 0.875]);
        assert!(Watch::NONE.report(1.0).is_continue());
        let stages = Mutex::new(Vec::new());
        let begin = |stage| stages.lock().unwrap().push(stage);
        Watch::new(&hear).with_stages(&begin).piece(0.5, 1.0).begin("table");
        Watch::new(&hear).begin("lives");
        assert_eq!(*stages.lock().unwrap(), ["table"]);
    }
}
