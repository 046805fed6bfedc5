//! A counting allocator for this test binary: calls, live bytes and their peak per thread since the last reset. Beyond a hard limit
//! it fails allocations, so that a runaway input ends the test and not the machine.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::io::Write as _;

/// Limit on the live bytes of a thread: four times the limit of an input.
const REFUSED: isize = 2_000_000_000;

thread_local! {
    static ALIVE: Cell<isize> = const { Cell::new(0) };
    static PEAK: Cell<isize> = const { Cell::new(0) };
    static CALLS: Cell<u64> = const { Cell::new(0) };
}

/// The system allocator with counters.
struct Counting;

/// Counts a change of the live bytes; false if it exceeds the hard limit.
fn count(change: isize) -> bool {
    // At thread exit the counters no longer exist, and what the thread frees then does not matter.
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

/// Prints the reason before the process ends; writing to standard error does not allocate.
fn refuse() -> bool {
    let why = b"more than 2 GB are refused; CLEBSCH_FUZZ_TRACE=1 names the input\n";
    let _ = std::io::stderr().write_all(why);
    false
}

fn signed(size: usize) -> isize {
    isize::try_from(size).unwrap_or(isize::MAX / 2)
}

// SAFETY: every call is passed unchanged to the system allocator, or returns null, as the trait permits.
#[allow(unsafe_code)]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if !count(signed(layout.size())) {
            count(-signed(layout.size()));
            return std::ptr::null_mut();
        }
        // SAFETY: the caller satisfies the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(-signed(layout.size()));
        // SAFETY: the caller satisfies the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // The old and the new block may exist at the same time.
        if !count(signed(size)) {
            count(-signed(size));
            return std::ptr::null_mut();
        }
        // SAFETY: the caller satisfies the contract of `realloc`.
        let moved = unsafe { System.realloc(pointer, layout, size) };
        count(-signed(if moved.is_null() { size } else { layout.size() }));
        moved
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations of this thread since `begin`.
pub fn calls() -> u64 {
    CALLS.with(Cell::get)
}

/// Starts a measurement on this thread; returns the current live bytes.
pub fn begin() -> isize {
    CALLS.with(|calls| calls.set(0));
    let alive = ALIVE.with(Cell::get);
    PEAK.with(|peak| peak.set(alive));
    alive
}

/// The peak of live bytes since `begin`, minus the live bytes at that time.
pub fn peak_since(begin: isize) -> isize {
    PEAK.with(Cell::get) - begin
}
