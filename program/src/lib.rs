//! The program of a step as data.
//!
//! A [`Kernel`] is straight-line code on numbers and small matrices: no branches, no side effects, every value
//! computed once. The engine lowers expressions to kernels and prints them as Rust. This crate verifies kernels,
//! evaluates them over any [`Arithmetic`], records an evaluation as a [`Tape`] of scalar operations, runs tapes on a
//! [`Machine`], counts their operations and lists them for readers. It depends on neither the engine nor the runtime.

mod arithmetic;
mod array;
mod compiled;
mod counts;
mod derivative;
mod evaluate;
mod instruction;
mod kernel;
mod layout;
mod listing;
mod machine;
mod operation;
mod record;
mod shape;
mod tape;
mod verify;

pub use arithmetic::{Arithmetic, Doubles, Functionals};
pub use array::Array;
pub use compiled::{Compiled, Compiler, compile_by};
pub use counts::Counts;
pub use evaluate::{Unvalued, evaluate};
pub use instruction::{Called, Check, Instruction, Register};
pub use kernel::{Input, Kernel, Line, Value};
pub use machine::{Frame, Machine, WIDTH};
pub use operation::{Call, Form, Number, Operation, Pair, Single};
pub use record::Recorder;
pub use shape::{Dim, Kind, Shape};
pub use tape::{Decisions, Function, Guard, Part, Recording, Scalar, Step, Tape, Test, Whole};
pub use verify::{Misfit, kind_of};
