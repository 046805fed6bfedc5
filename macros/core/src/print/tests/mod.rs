//! Tests of the printers on a shared list of expressions with every kind of node.

mod alike;
mod derivations;
mod documents;
mod functionals;
mod mathml;
mod readers;
mod sample;
mod spelling;
mod statements;
mod structure;
mod typeset;
