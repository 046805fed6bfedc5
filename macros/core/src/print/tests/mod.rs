//! Tests of the printers on one list of expressions that holds every kind of node.

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
