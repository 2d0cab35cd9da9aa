//! Ranks that are threads of this process: messages pass through one board that all of them reach.

use std::any::Any;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex};
use std::time::Duration;

use zelus::core::communication::{Communicator, Ranks};

/// A rank that the others wait for longer than this has failed.
const PATIENCE: Duration = Duration::from_secs(120);

type Message = Box<dyn Any + Send>;

#[derive(Default)]
struct Board {
    /// Messages by receiver and sender.
    messages: Vec<Vec<Option<Message>>>,
    /// Ranks that have come to the present meeting, and meetings so far.
    here: usize,
    rounds: usize,
}

struct Group {
    size: usize,
    board: Mutex<Board>,
    met: Condvar,
    failed: AtomicBool,
}

struct ThreadRank {
    rank: usize,
    group: Arc<Group>,
}

/// As many ranks as threads: the results of `work` on each of them.
pub fn on_threads<T: Send>(count: usize, work: impl Fn(Ranks) -> T + Sync) -> Vec<T> {
    let messages = (0..count).map(|_| (0..count).map(|_| None).collect()).collect();
    let board = Mutex::new(Board { messages, ..Board::default() });
    let group = Arc::new(Group { size: count, board, met: Condvar::new(), failed: AtomicBool::new(false) });
    std::thread::scope(|scope| {
        let start = |rank| {
            let ranks = Ranks::new(ThreadRank { rank, group: Arc::clone(&group) });
            scope.spawn(|| work(ranks))
        };
        let threads: Vec<_> = (0..count).map(start).collect();
        threads.into_iter().map(|thread| thread.join().expect("a rank")).collect()
    })
}

impl ThreadRank {
    /// Waits for all ranks.
    fn meet(&self) {
        let mut board = self.group.board.lock().expect("no rank has failed");
        board.here += 1;
        if board.here == self.group.size {
            board.here = 0;
            board.rounds += 1;
            self.group.met.notify_all();
            return;
        }
        let round = board.rounds;
        let waited = self.group.met.wait_timeout_while(board, PATIENCE, |board| board.rounds == round);
        assert!(!waited.expect("no rank has failed").1.timed_out(), "a rank does not come");
    }

    fn exchange<T: Clone + Send + 'static>(&self, parts: &[Vec<T>]) -> Vec<Vec<T>> {
        let on_board = |act: &mut dyn FnMut(&mut Board)| act(&mut self.group.board.lock().expect("no rank has failed"));
        on_board(&mut |board| {
            for (to, part) in parts.iter().enumerate() {
                board.messages[to][self.rank] = Some(Box::new(part.clone()));
            }
        });
        self.meet();
        let mut received = Vec::new();
        on_board(&mut |board| received = board.messages[self.rank].iter_mut().map(Option::take).collect());
        self.meet();
        let open = |message: Option<Message>| *message.expect("sent").downcast().expect("ranks do the same");
        received.into_iter().map(open).collect()
    }

    fn gather<T: Clone + Send + 'static>(&self, own: &[T]) -> Vec<Vec<T>> {
        self.exchange(&vec![own.to_vec(); self.group.size])
    }
}

impl Communicator for ThreadRank {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.group.size
    }

    fn gather_bytes(&self, own: &[u8]) -> Vec<Vec<u8>> {
        self.gather(own)
    }

    fn gather_numbers(&self, own: &[f64]) -> Vec<Vec<f64>> {
        self.gather(own)
    }

    fn gather_equal_bytes(&self, own: &[u8]) -> Vec<u8> {
        self.gather(own).concat()
    }

    fn or(&self, bytes: &mut [u8]) {
        for of_rank in self.gather(bytes) {
            bytes.iter_mut().zip(of_rank).for_each(|(byte, other)| *byte |= other);
        }
    }

    fn gather_counted(&self, own: &[f64], counts: &[usize]) -> Vec<f64> {
        assert_eq!(own.len(), counts[self.rank]);
        self.gather(own).concat()
    }

    fn gather_to_root(&self, own: &[f64], counts: &[usize]) -> Vec<f64> {
        // Ranks that receive nothing need not know how much is sent.
        assert!(self.rank != 0 || own.len() == counts[0]);
        let all = self.gather(own).concat();
        if self.rank == 0 { all } else { Vec::new() }
    }

    fn exchange_numbers(&self, parts: &[Vec<f64>]) -> Vec<Vec<f64>> {
        self.exchange(parts)
    }

    fn exchange_indices(&self, parts: &[Vec<u32>]) -> Vec<Vec<u32>> {
        self.exchange(parts)
    }

    fn announce_failure(&self) {
        self.group.failed.store(true, Ordering::Relaxed);
    }

    fn failure_is_announced(&self) -> bool {
        self.group.failed.load(Ordering::Relaxed)
    }

    fn abort(&self, code: u8) -> ! {
        panic!("rank {} ends with {code}", self.rank)
    }
}
