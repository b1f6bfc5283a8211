//! What a run has added up and met so far, step by step, over any scalar: lanes of machine code keep it as a lone trajectory does.
//! In: what the end of an accepted step shows. Out: running numbers. Never knows what is made of them.

use crate::scalar::Scalar;
use crate::wear::{Extremes, Load};

/// Energies at one instant [J].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Energies<T> {
    pub(crate) kinetic: T,
    pub(crate) potential: T,
    /// Work that drivers supplied, and that forces dissipated, since the run began.
    pub(crate) supplied: T,
    pub(crate) dissipated: T,
    /// Stored in all contacts; lost in them since the run began.
    pub(crate) elastic: T,
    pub(crate) contact_loss: T,
}

/// What the end of a step shows of a contact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touched<T> {
    pub(crate) load: Load<T>,
    /// Mean pressure [Pa].
    pub(crate) pressure: T,
}

/// What the end of a step shows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shown<'s, T> {
    /// Time [s], and how long the step was [s].
    pub(crate) t: T,
    pub(crate) length: T,
    pub(crate) energies: Energies<T>,
    /// Free speeds, and which of them turn.
    pub(crate) speeds: &'s [T],
    pub(crate) turning: &'s [bool],
}

/// The balance of energy [J].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Balance<T> {
    /// What there was at the begin.
    pub(crate) start: T,
    /// Largest error so far, and the most that a step added to it.
    pub(crate) error: T,
    pub(crate) added: T,
    /// Sum of what went from one form into another.
    pub(crate) throughput: T,
    /// Largest of all energies but those of contacts, since errors are judged.
    pub(crate) largest: T,
    /// What there was at the end of the last step.
    kinetic: T,
    supplied: T,
    dissipated: T,
    contact_loss: T,
    /// What contacts stored then.
    elastic: T,
}

/// What one joint with clearance has done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touches<T> {
    /// Largest of what acted in the present turn.
    pub(crate) extremes: Extremes<T>,
    /// Time in contact in the present turn [s], by steps that ended in contact.
    pub(crate) touching: T,
    /// Largest penetration of the run [m], and when [s].
    pub(crate) deepest: T,
    pub(crate) deepest_at: T,
}

/// All running numbers of a run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ledger<T> {
    pub(crate) balance: Balance<T>,
    /// Largest speed of any coordinate [rad/s, m/s], and of those that turn [rad/s], since errors are judged.
    pub(crate) fastest: T,
    pub(crate) fastest_turning: T,
    /// How far loops were open at most [m], [rad].
    pub(crate) open: [T; 2],
    /// Longest step [s].
    pub(crate) longest_step: T,
    /// One per joint with clearance.
    pub(crate) joints: Vec<Touches<T>>,
}

impl<T: Scalar> Balance<T> {
    /// Begins where there are these energies.
    pub(crate) fn new(now: &Energies<T>) -> Self {
        let zero = T::constant(0.0);
        let mut balance = Self {
            start: zero,
            error: zero,
            added: zero,
            throughput: zero,
            largest: zero,
            kinetic: zero,
            supplied: zero,
            dissipated: zero,
            contact_loss: zero,
            elastic: zero,
        };
        balance.go_on_from(now);
        balance
    }

    /// Goes on from other energies, as if nothing had happened between: errors are judged from here on.
    pub(crate) fn go_on_from(&mut self, now: &Energies<T>) {
        self.start =
            now.kinetic + now.potential - now.supplied + now.dissipated + (now.elastic + now.contact_loss);
        self.largest = T::constant(0.0);
        self.end_at(now);
    }

    /// Notes the error at an instant.
    pub(crate) fn note(&mut self, now: &Energies<T>) {
        let error = now.kinetic + now.potential - self.start - now.supplied + now.dissipated;
        let error = error + (now.elastic + now.contact_loss);
        self.error = self.error.max(error.abs());
        for energy in [now.kinetic, now.potential, now.supplied, now.dissipated] {
            self.largest = self.largest.max(energy.abs());
        }
    }

    /// Notes the end of a step.
    fn note_step(&mut self, now: &Energies<T>) {
        let known = self.error;
        self.note(now);
        self.added = self.added.max(self.error - known);
        self.throughput = self.throughput
            + ((now.supplied - self.supplied).abs()
                + (now.dissipated - self.dissipated).abs()
                + (now.kinetic - self.kinetic).abs())
            + (now.contact_loss - self.contact_loss).abs();
        self.end_at(now);
    }

    fn end_at(&mut self, now: &Energies<T>) {
        (self.kinetic, self.supplied) = (now.kinetic, now.supplied);
        (self.dissipated, self.contact_loss, self.elastic) = (now.dissipated, now.contact_loss, now.elastic);
    }

    /// What errors are judged by: what went through, and what contacts store. One that rests under a load passes nothing on.
    pub(crate) fn at_stake(&self) -> T {
        self.throughput + self.elastic
    }
}

impl<T: Scalar> Touches<T> {
    fn nothing() -> Self {
        let zero = T::constant(0.0);
        Self { extremes: Extremes::nothing(), touching: zero, deepest: zero, deepest_at: zero }
    }

    /// A turn begins where this acts.
    pub(crate) fn begin_turn(&mut self, now: &Touched<T>) {
        self.extremes = Extremes::nothing();
        self.extremes.include(now.pressure, &now.load);
        self.touching = T::constant(0.0);
    }

    /// Notes the end of a step.
    fn note_step(&mut self, (t, length): (T, T), now: &Touched<T>) {
        let penetration = now.load.penetration;
        self.extremes.include(now.pressure, &now.load);
        let touches = T::constant(0.0).lt(penetration);
        self.touching = T::select(touches, self.touching + length, self.touching);
        let deeper = self.deepest.lt(penetration);
        self.deepest_at = T::select(deeper, t, self.deepest_at);
        self.deepest = T::select(deeper, penetration, self.deepest);
    }
}

impl<T: Scalar> Ledger<T> {
    /// Begins with these energies, at speeds that are not known yet.
    pub(crate) fn new(balance: Balance<T>, contacts: usize) -> Self {
        let zero = T::constant(0.0);
        Self {
            balance,
            fastest: zero,
            fastest_turning: zero,
            open: [zero; 2],
            longest_step: zero,
            joints: vec![Touches::nothing(); contacts],
        }
    }

    /// Notes speeds.
    pub(crate) fn note_speeds(&mut self, speeds: &[T], turning: &[bool]) {
        for (speed, turns) in speeds.iter().zip(turning) {
            let size = speed.abs();
            self.fastest = self.fastest.max(size);
            if *turns {
                self.fastest_turning = self.fastest_turning.max(size);
            }
        }
    }

    /// Notes how far loops are open [m], [rad].
    pub(crate) fn note_open(&mut self, open: [T; 2]) {
        for (most, open) in self.open.iter_mut().zip(open) {
            *most = most.max(open);
        }
    }

    /// Notes what the end of an accepted step shows, and its contacts joint by joint.
    pub(crate) fn note_step(&mut self, shown: &Shown<'_, T>, touched: impl Iterator<Item = Touched<T>>) {
        self.longest_step = self.longest_step.max(shown.length);
        for (joint, now) in self.joints.iter_mut().zip(touched) {
            joint.note_step((shown.t, shown.length), &now);
        }
        self.balance.note_step(&shown.energies);
        self.note_speeds(shown.speeds, shown.turning);
    }

    /// How many numbers they are, with so many joints.
    pub(crate) const fn len(contacts: usize) -> usize {
        15 + 7 * contacts
    }

    /// Of numbers in that order.
    pub(crate) fn of(numbers: &[T], contacts: usize) -> Self {
        let zero = T::constant(0.0);
        let nothing = Energies {
            kinetic: zero,
            potential: zero,
            supplied: zero,
            dissipated: zero,
            elastic: zero,
            contact_loss: zero,
        };
        let mut ledger = Self::new(Balance::new(&nothing), contacts);
        let mut numbers = numbers.iter();
        ledger.visit(&mut |number| *number = numbers.next().copied().unwrap_or(zero));
        ledger
    }

    /// Shows every number, in one order, to be read or put back.
    pub(crate) fn visit(&mut self, visit: &mut dyn FnMut(&mut T)) {
        let Self { balance, fastest, fastest_turning, open: [metres, radians], longest_step, joints } = self;
        let Balance { start, error, added, throughput, largest, .. } = balance;
        [start, error, added, throughput, largest].into_iter().for_each(&mut *visit);
        let Balance { kinetic, supplied, dissipated, contact_loss, elastic, .. } = balance;
        [kinetic, supplied, dissipated, contact_loss, elastic].into_iter().for_each(&mut *visit);
        [fastest, fastest_turning, metres, radians, longest_step].into_iter().for_each(&mut *visit);
        for Touches { extremes, touching, deepest, deepest_at } in joints {
            let Extremes { normal_force, pressure, pressure_speed, penetration } = extremes;
            [normal_force, pressure, pressure_speed, penetration].into_iter().for_each(&mut *visit);
            [touching, deepest, deepest_at].into_iter().for_each(&mut *visit);
        }
    }
}

/// Sum of a number of every joint with clearance.
pub(crate) fn sum<T: Scalar>(numbers: impl Iterator<Item = T>) -> T {
    numbers.reduce(|sum, number| sum + number).unwrap_or(T::constant(0.0))
}
