//! Between the thread of a run and the thread of Python: one asks, the other answers.

use std::sync::mpsc::{Receiver, Sender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use zelus::core::assembly::System;
use zelus::core::model::Model;
use zelus::{Error, Result};

use crate::event::Event;
use crate::residual::Description;

/// Answers of Python to a question of the run.
pub(crate) enum Answer {
    /// Go on.
    Go,
    /// Do the work at this point, and ask again.
    Act,
    /// End the run, for this reason.
    Fail(String),
    /// There is a process of that number, and the description of its residual where it has one; `None` leaves it to the registry.
    Process(Option<(usize, Option<Description>)>),
    /// Residual and tangent.
    Numbers(Vec<f64>, Vec<f64>),
    /// Yes or no.
    Truth(bool),
}

/// The model, lent to Python while the run waits for an answer.
pub(crate) struct Lent {
    model: *const Model,
    /// The same, where it may be changed.
    writable: Option<*mut Model>,
    system: Option<*const System>,
}

// SAFETY: whoever lends it waits until it is taken back.
unsafe impl Send for Lent {}

impl Lent {
    fn new(model: &mut Model, system: Option<&System>) -> Self {
        let writable = std::ptr::from_mut(model);
        Self { model: writable, writable: Some(writable), system: system.map(std::ptr::from_ref) }
    }

    fn to_read(model: &Model) -> Self {
        Self { model, writable: None, system: None }
    }

    /// The model, to change; `None` where it is lent to be read.
    pub(crate) fn model_mut(&mut self) -> Option<&mut Model> {
        // SAFETY: the lender waits, and the lock around this value keeps others out.
        self.writable.map(|model| unsafe { &mut *model })
    }

    /// The model, to change, and the system that computes on it.
    pub(crate) fn both(&mut self) -> Option<(&mut Model, Option<&System>)> {
        // SAFETY: as above; they are apart.
        self.writable.map(|model| unsafe { (&mut *model, self.system.map(|system| &*system)) })
    }

    pub(crate) fn model(&self) -> &Model {
        // SAFETY: as above.
        unsafe { &*self.model }
    }

    pub(crate) fn system(&self) -> Option<&System> {
        // SAFETY: as above.
        self.system.map(|system| unsafe { &*system })
    }
}

/// Where the lent model lies; empty while the run computes.
pub(crate) type Shelf = Arc<Mutex<Option<Lent>>>;

/// The lent model, also where a thread that held it has panicked.
pub(crate) fn shelf(shelf: &Shelf) -> MutexGuard<'_, Option<Lent>> {
    shelf.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The run's end of the line.
pub(crate) struct Line {
    events: Mutex<Sender<Event>>,
    answers: Mutex<Receiver<Answer>>,
    shelf: Shelf,
    root: Root,
}

/// Name of the part that is solved for; empty before that is known.
pub(crate) type Root = Arc<Mutex<String>>;

impl Line {
    pub(crate) fn new(events: Sender<Event>, answers: Receiver<Answer>, shelf: Shelf, root: Root) -> Arc<Self> {
        Arc::new(Self { events: Mutex::new(events), answers: Mutex::new(answers), shelf, root })
    }

    /// Notes the part that is solved for.
    pub(crate) fn solves_for(&self, root: &str) {
        root.clone_into(&mut self.root.lock().unwrap_or_else(PoisonError::into_inner));
    }

    /// Tells Python, if it still listens.
    pub(crate) fn tell(&self, event: Event) {
        let _ = self.events.lock().expect("senders do not panic").send(event);
    }

    /// Lends the model and tells Python, which takes it back by its next command or answer.
    pub(crate) fn lend(&self, event: Event, model: &mut Model, system: Option<&System>) {
        *shelf(&self.shelf) = Some(Lent::new(model, system));
        self.tell(event);
    }

    /// Lends the model, and waits for the answer.
    ///
    /// # Errors
    /// Python fails, or is gone.
    pub(crate) fn ask(&self, event: Event, model: &mut Model, system: Option<&System>) -> Result<Answer> {
        self.lend(event, model, system);
        self.answer()
    }

    /// As [`Line::ask`], with a model that is only to be read.
    ///
    /// # Errors
    /// As [`Line::ask`].
    pub(crate) fn ask_of(&self, event: Event, model: &Model) -> Result<Answer> {
        *shelf(&self.shelf) = Some(Lent::to_read(model));
        self.tell(event);
        self.answer()
    }

    /// As [`Line::ask`], while the model is in use.
    ///
    /// # Errors
    /// As [`Line::ask`].
    pub(crate) fn ask_alone(&self, event: Event) -> Result<Answer> {
        self.tell(event);
        self.answer()
    }

    fn answer(&self) -> Result<Answer> {
        let answer = self.answers.lock().expect("receivers do not panic").recv();
        shelf(&self.shelf).take();
        match answer {
            Ok(Answer::Fail(why)) => Err(Error::System(why)),
            Ok(answer) => Ok(answer),
            Err(_) => Err(Error::System("the program that drove the run is gone".to_owned())),
        }
    }
}
