//! A counting allocator: calls, bytes alive and their peak, for each thread.
//! Takes every allocation of this test binary; gives calls and peak since they were last reset. Beyond a hard limit
//! it refuses, so that a runaway ends the test and not the machine.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::io::Write as _;

/// Bytes alive on one thread beyond which allocations are refused: four times what is allowed.
const REFUSED: isize = 2_000_000_000;

thread_local! {
    static ALIVE: Cell<isize> = const { Cell::new(0) };
    static PEAK: Cell<isize> = const { Cell::new(0) };
    static CALLS: Cell<u64> = const { Cell::new(0) };
}

/// The system allocator with counters.
struct Counting;

/// Counts a change of the bytes alive; false if it goes beyond the hard limit.
fn count(change: isize) -> bool {
    // While a thread ends its counters are gone: what it frees then is of no interest.
    ALIVE
        .try_with(|alive| {
            let now = alive.get() + change;
            alive.set(now);
            PEAK.with(|peak| peak.set(peak.get().max(now)));
            CALLS.with(|calls| calls.set(calls.get() + u64::from(change > 0)));
            now <= REFUSED || refuse()
        })
        .unwrap_or(true)
}

/// Says why the process is about to end; the standard error stream is written without allocating.
fn refuse() -> bool {
    let why = b"more than 2 GB are refused; CLEBSCH_FUZZ_TRACE=1 names the input\n";
    let _ = std::io::stderr().write_all(why);
    false
}

fn signed(size: usize) -> isize {
    isize::try_from(size).unwrap_or(isize::MAX / 2)
}

// SAFETY: every call goes to the system allocator unchanged, or returns null, which the trait allows.
#[allow(unsafe_code)]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if !count(signed(layout.size())) {
            count(-signed(layout.size()));
            return std::ptr::null_mut();
        }
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(-signed(layout.size()));
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // Old and new block may be alive together.
        if !count(signed(size)) {
            count(-signed(size));
            return std::ptr::null_mut();
        }
        // SAFETY: the caller keeps the contract of `realloc`.
        let moved = unsafe { System.realloc(pointer, layout, size) };
        count(-signed(if moved.is_null() { size } else { layout.size() }));
        moved
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations made on this thread since `begin`.
pub fn calls() -> u64 {
    CALLS.with(Cell::get)
}

/// Begins a measurement on this thread; returns the bytes alive at its beginning.
pub fn begin() -> isize {
    CALLS.with(|calls| calls.set(0));
    let alive = ALIVE.with(Cell::get);
    PEAK.with(|peak| peak.set(alive));
    alive
}

/// The largest number of bytes alive since `begin`, beyond those alive then.
pub fn peak_since(begin: isize) -> isize {
    PEAK.with(Cell::get) - begin
}
