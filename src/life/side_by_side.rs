//! Random lives by the dynamics, several in the lanes of every thread. In: a plan, machine code of the mechanism for lanes.
//! Out: the lives, the same bits as one after the other. Never knows what a life is.

use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::{Builder, scope};

use linkwear_runtime::{SINGULAR_PIVOT, TurnQueue, TurnRequests, TurnRunner, WideBundle, turn_queue};

use super::error::LifeError;
use super::result::LifeResult;
use super::run::{Body, Plan};
use crate::backend::Lanes;

impl Plan<'_> {
    /// Machine code for the random lives side by side; none where there are no lives, or their method has no lanes.
    pub(super) fn lanes(&self) -> Option<Lanes> {
        let wanted = self.process.as_ref().and(self.trajectories);
        wanted.filter(|_| self.study.takes_bundles()).and_then(|_| self.study.mechanism.lanes())
    }

    /// The random lives, in the lanes of a bundle for each thread.
    pub(super) fn draw_in_lanes(&self, result: &mut LifeResult, bundle: &Lanes) -> Result<(), LifeError> {
        scope(|scope| {
            // A few lives go on as many threads as there are, in a lane each.
            let wanted = usize::try_from(self.trajectories.unwrap_or(0)).unwrap_or(usize::MAX).max(1);
            let (queues, requests): (Vec<TurnQueue>, Vec<TurnRequests>) =
                (0..self.threads.get().min(wanted)).map(|_| turn_queue()).unzip();
            // Where the system gives no thread, or it ends, turns are run by those who ask for them.
            let spawn = |requests| {
                Builder::new().spawn_scoped(scope, move || self.serve(bundle.wide(), requests)).ok()
            };
            let servers: Vec<_> = requests.into_iter().filter_map(spawn).collect();
            let next = AtomicUsize::new(0);
            let scale = |body: Body<'_>| {
                let system = self.study.mechanism.system();
                let queue = queues[next.fetch_add(1, Ordering::Relaxed) % queues.len()].clone();
                body(&mut self.source(&*system, &|source| source.through(queue.clone()))?);
                Ok(())
            };
            let lanes =
                self.threads.saturating_mul(NonZero::new(bundle.count()).unwrap_or(NonZero::<usize>::MIN));
            let drawn = self.draw(result, &scale, lanes);
            drop(queues);
            for server in servers {
                let _ = server.join();
            }
            drawn
        })
    }

    fn serve(&self, bundle: WideBundle<'_>, requests: TurnRequests) {
        let mechanism = self.study.mechanism;
        let system = mechanism.system();
        let integrator = self.study.revolutions.integrator;
        let runner = || {
            let (description, parameters) = (&mechanism.description, &mechanism.parameters);
            TurnRunner::new(&*system, description, parameters, integrator, SINGULAR_PIVOT)
        };
        // Requests that no lane serves are run by who asks.
        let _ = bundle.serve(&runner, requests);
    }
}
