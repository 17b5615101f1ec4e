//! Long calls: the work runs beside the interpreter's thread, which looks for an interrupt meanwhile.

use std::sync::Mutex;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use luztar::dynamics::Control;
use pyo3::prelude::*;

/// Between two looks: an interrupt is to be answered within 0.2 s, also where the threads are kept waiting.
const LOOK: Duration = Duration::from_millis(20);

/// Runs a job that obeys `control` with the interpreter detached. Signals are looked for, and `told` is called with the
/// lanes done, every 20 ms; if either raises, the job is stopped and waited for before the exception goes on.
pub fn interruptible<T: Send>(
    py: Python<'_>,
    control: &Control,
    told: impl Fn(usize) -> PyResult<()>,
    job: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    std::thread::scope(|scope| {
        let (sender, receiver) = channel();
        let receiver = Mutex::new(receiver);
        let waits = |time: Duration| {
            let receiver = receiver
                .lock()
                .unwrap_or_else(std::sync::PoisonError::into_inner);
            receiver.recv_timeout(time)
        };
        // Nobody listens any more only where this function has panicked.
        scope.spawn(move || drop(sender.send(job())));
        loop {
            match py.detach(|| waits(LOOK)) {
                Ok(made) => return Ok(made),
                Err(RecvTimeoutError::Disconnected) => {
                    unreachable!("the scope passes a panic of the job on")
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
            if let Err(raised) = py.check_signals().and_then(|()| told(control.done())) {
                control.stop();
                let _ = py.detach(|| waits(Duration::MAX));
                return Err(raised);
            }
        }
    })
}
