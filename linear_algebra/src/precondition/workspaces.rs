//! Work space of tasks.

use std::sync::Mutex;

/// Workspaces that are made once for as many tasks as run at a time; each is left as it was found.
pub(super) struct Workspaces<T, M> {
    free: Mutex<Vec<T>>,
    make: M,
}

impl<T, M: Fn() -> T> Workspaces<T, M> {
    pub(super) fn new(make: M) -> Self {
        Self { free: Mutex::new(Vec::new()), make }
    }

    /// Works in one that nobody else works in.
    pub(super) fn lend<R>(&self, work: impl FnOnce(&mut T) -> R) -> R {
        let free = self.free.lock().expect("no task panics with the lock").pop();
        let mut own = free.unwrap_or_else(&self.make);
        let result = work(&mut own);
        self.free.lock().expect("no task panics with the lock").push(own);
        result
    }
}
