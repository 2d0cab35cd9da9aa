//! The communicator of MPI, through the crate `mpi`; the only file that names it.

#[cfg(feature = "petsc")]
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use mpi::Threading;
use mpi::collective::SystemOperation;
use mpi::datatype::{Partition, PartitionMut};
use mpi::request::{Request, Scope, scope};
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator as _, CommunicatorCollectives, Destination, Equivalence, Root, Source};

use super::Communicator;
use crate::diagnostics::{Error, Result};

use mpi::environment::Universe;

/// Tag of the message that the run has failed.
const FAILED: i32 = 4711;
/// Tag of numbers on their way between two ranks.
const NUMBERS: i32 = 4712;
/// How long a rank that waits for the others keeps its core busy.
const BUSY: Duration = Duration::from_micros(50);
/// The longest it then sleeps at a time.
const NAP: Duration = Duration::from_millis(1);

/// All ranks that mpirun has started; dropped, this one leaves them.
pub(super) struct MpiWorld {
    rank: usize,
    size: usize,
    announced: AtomicBool,
    /// PETSc, once something needs it; it ends before MPI does.
    #[cfg(feature = "petsc")]
    petsc: Mutex<Option<zelus_petsc::Session>>,
    _universe: Universe,
}

/// Starts MPI; a panic on one rank ends all of them.
pub(super) fn start() -> Result<MpiWorld> {
    let (universe, threading) = mpi::initialize_with_threading(Threading::Serialized)
        .ok_or_else(|| Error::System("MPI is in use already".to_owned()))?;
    if !matches!(threading, Threading::Serialized | Threading::Multiple) {
        return Err(Error::System(format!("this MPI library offers only {threading:?} threads, not serialised ones")));
    }
    let all = SimpleCommunicator::world();
    let say = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        say(panic);
        SimpleCommunicator::world().abort(101);
    }));
    Ok(MpiWorld {
        rank: all.rank() as usize,
        size: all.size() as usize,
        announced: AtomicBool::new(false),
        #[cfg(feature = "petsc")]
        petsc: Mutex::default(),
        _universe: universe,
    })
}

/// Waits for a request under way.
fn wait_for<'a, D: ?Sized, S: Scope<'a>>(mut request: Request<'a, D, S>) {
    let start = Instant::now();
    while let Err(pending) = request.test() {
        request = pending;
        let waited = start.elapsed();
        if waited > BUSY {
            std::thread::sleep((waited / 8).min(NAP));
        }
    }
}

fn counts(lengths: impl Iterator<Item = usize>) -> (Vec<i32>, Vec<i32>) {
    let counts: Vec<i32> =
        lengths.map(|length| i32::try_from(length).expect("a message of fewer than 2^31 entries")).collect();
    let mut end = 0_i32;
    let starts = counts
        .iter()
        .map(|count| {
            let start = end;
            end = end.checked_add(*count).expect("messages of fewer than 2^31 entries together");
            start
        })
        .collect();
    (counts, starts)
}

fn split<T: Clone>(all: &[T], counts: &[i32], starts: &[i32]) -> Vec<Vec<T>> {
    counts.iter().zip(starts).map(|(&n, &start)| all[start as usize..(start + n) as usize].to_vec()).collect()
}

impl MpiWorld {
    /// All ranks, once all of them are here.
    ///
    /// MPI's own waits take a whole core each, which the ranks that are still at work may need.
    fn together(&self) -> SimpleCommunicator {
        let all = SimpleCommunicator::world();
        wait_for(all.immediate_barrier());
        all
    }

    fn gather<T: Equivalence + Clone + Default>(&self, own: &[T]) -> Vec<Vec<T>> {
        let all = self.together();
        let mut lengths = vec![0_u64; self.size];
        all.all_gather_into(&(own.len() as u64), &mut lengths[..]);
        let (counts, starts) = counts(lengths.into_iter().map(|n| n as usize));
        let total: i32 = counts.iter().sum();
        let mut received = vec![T::default(); total as usize];
        if total > 0 {
            let mut target = PartitionMut::new(&mut received[..], &counts[..], &starts[..]);
            all.all_gather_varcount_into(own, &mut target);
        }
        split(&received, &counts, &starts)
    }

    fn exchange<T: Equivalence + Clone + Default>(&self, parts: &[Vec<T>]) -> Vec<Vec<T>> {
        let all = self.together();
        let (to, to_starts) = counts(parts.iter().map(Vec::len));
        let mut from = vec![0_i32; self.size];
        all.all_to_all_into(&to[..], &mut from[..]);
        let (from, from_starts) = counts(from.into_iter().map(|n| n as usize));
        let sent = parts.concat();
        let mut received = vec![T::default(); from.iter().sum::<i32>() as usize];
        let source = Partition::new(&sent[..], &to[..], &to_starts[..]);
        let mut target = PartitionMut::new(&mut received[..], &from[..], &from_starts[..]);
        all.all_to_all_varcount_into(&source, &mut target);
        split(&received, &from, &from_starts)
    }
}

impl Communicator for MpiWorld {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn gather_bytes(&self, own: &[u8]) -> Vec<Vec<u8>> {
        self.gather(own)
    }

    fn gather_numbers(&self, own: &[f64]) -> Vec<Vec<f64>> {
        self.gather(own)
    }

    fn gather_equal_bytes(&self, own: &[u8]) -> Vec<u8> {
        let mut received = vec![0_u8; own.len() * self.size];
        self.together().all_gather_into(own, &mut received[..]);
        received
    }

    fn or(&self, bytes: &mut [u8]) {
        let own = bytes.to_vec();
        self.together().all_reduce_into(&own[..], bytes, SystemOperation::bitwise_or());
    }

    fn gather_counted(&self, own: &[f64], lengths: &[usize]) -> Vec<f64> {
        let (counts, starts) = counts(lengths.iter().copied());
        let mut received = vec![0.0; lengths.iter().sum()];
        let mut target = PartitionMut::new(&mut received[..], &counts[..], &starts[..]);
        self.together().all_gather_varcount_into(own, &mut target);
        received
    }

    fn gather_to_root(&self, own: &[f64], lengths: &[usize]) -> Vec<f64> {
        let all = self.together();
        let root = all.process_at_rank(0);
        if self.rank != 0 {
            root.gather_varcount_into(own);
            return Vec::new();
        }
        let (counts, starts) = counts(lengths.iter().copied());
        let mut received = vec![0.0; lengths.iter().sum()];
        let mut target = PartitionMut::new(&mut received[..], &counts[..], &starts[..]);
        root.gather_varcount_into_root(own, &mut target);
        received
    }

    fn exchange_numbers(&self, parts: &[Vec<f64>]) -> Vec<Vec<f64>> {
        self.exchange(parts)
    }

    fn exchange_indices(&self, parts: &[Vec<u32>]) -> Vec<Vec<u32>> {
        self.exchange(parts)
    }

    fn gather_equal_numbers(&self, own: &[f64]) -> Vec<f64> {
        let mut received = vec![0.0; own.len() * self.size];
        scope(|scope| wait_for(SimpleCommunicator::world().immediate_all_gather_into(scope, own, &mut received[..])));
        received
    }

    fn exchange_counted(&self, parts: &[Vec<f64>], counts: &[usize]) -> Vec<Vec<f64>> {
        let all = SimpleCommunicator::world();
        let mut received: Vec<Vec<f64>> = counts.iter().map(|&count| vec![0.0; count]).collect();
        received[self.rank].copy_from_slice(&parts[self.rank]);
        scope(|scope| {
            let others = |rank: &usize| *rank != self.rank;
            let mut requests = Vec::new();
            for (rank, buffer) in
                received.iter_mut().enumerate().filter(|(rank, list)| others(rank) && !list.is_empty())
            {
                let from = all.process_at_rank(rank as i32);
                requests.push(from.immediate_receive_into_with_tag(scope, &mut buffer[..], NUMBERS));
            }
            let mut sends = Vec::new();
            for (rank, part) in parts.iter().enumerate().filter(|(rank, list)| others(rank) && !list.is_empty()) {
                sends.push(all.process_at_rank(rank as i32).immediate_send_with_tag(scope, &part[..], NUMBERS));
            }
            requests.into_iter().for_each(wait_for);
            sends.into_iter().for_each(wait_for);
        });
        received
    }

    fn announce_failure(&self) {
        if self.rank == 0 && !self.announced.swap(true, Ordering::Relaxed) {
            let all = SimpleCommunicator::world();
            // A message of one byte leaves at once, whether or not the other side waits for it.
            (1..self.size).for_each(|rank| all.process_at_rank(rank as i32).send_with_tag(&1_u8, FAILED));
        }
    }

    fn failure_is_announced(&self) -> bool {
        SimpleCommunicator::world().process_at_rank(0).immediate_probe_with_tag(FAILED).is_some()
    }

    fn abort(&self, code: u8) -> ! {
        SimpleCommunicator::world().abort(i32::from(code))
    }

    #[cfg(feature = "petsc")]
    fn petsc(&self) -> Option<Result<zelus_petsc::Communicator>> {
        let mut session = self.petsc.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if session.is_none() {
            match zelus_petsc::Session::start() {
                Ok(started) => *session = Some(started),
                Err(error) => return Some(Err(Error::System(error.to_string()))),
            }
        }
        session.as_ref().map(|session| Ok(session.world()))
    }
}
