//! The rewrite rules, one per line: name, left-hand side, right-hand side, conditions. Each holds for real matrices
//! wherever its left-hand side is defined; its right-hand side is then defined too. Terms are in the prefix notation
//! of [`super::language::Term`]; variables begin with `?`.

use super::conditions::RuleCondition::{self, *};
use super::worth::Join::{Product, Scale, Sum};
use super::worth::Worth::{self, *};

/// Name, left-hand side, right-hand side, conditions, and when the rule is worth applying.
pub type Row = (
    &'static str,
    &'static str,
    &'static str,
    &'static [RuleCondition<&'static str>],
    &'static [Worth<&'static str>],
);

/// Groups of rules, which take part in different rounds of the search.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Group {
    /// Reorders summands: n summands give about n 2^n terms.
    Order,
    /// Brings nested sums to one form.
    Nest,
    /// Expands products.
    Linear,
    /// Rotates products: cyclic order in traces, brackets in reverse.
    Turn,
    /// All other rules.
    Plain,
}

/// The whole table.
pub const TABLE: [(Group, &[Row]); 11] = [
    (Group::Order, ORDER),
    (Group::Nest, NESTING),
    (Group::Linear, LINEAR),
    (Group::Plain, SUMS),
    (Group::Plain, SCALINGS),
    (Group::Plain, PRODUCTS),
    (Group::Plain, TRACES),
    (Group::Turn, TURNS),
    (Group::Plain, VECTORS),
    (Group::Plain, LETTERS),
    (Group::Plain, FUNCTIONS),
];

#[rustfmt::skip]
const ORDER: &[Row] = &[
    ("order of a sum",               "(+ ?a ?b)",                      "(+ ?b ?a)",                              &[], &[Single("?a"), Single("?b")]),
    ("exchange in a sum",            "(+ ?a (+ ?b ?c))",               "(+ ?b (+ ?a ?c))",                       &[], &[Single("?a"), Single("?b"), Composite(Sum, "?b", "?c"), Apart("?a")]),
];

#[rustfmt::skip]
const NESTING: &[Row] = &[
    ("nesting of a sum",             "(+ (+ ?a ?b) ?c)",               "(+ ?a (+ ?b ?c))",                       &[], &[Composite(Sum, "?a", "?b"), Apart("?c")]),
];

#[rustfmt::skip]
const LINEAR: &[Row] = &[
    ("scaling of a sum",             "(. ?s (+ ?a ?b))",               "(+ (. ?s ?a) (. ?s ?b))",                &[], &[Independent("?a", "?b")]),
    ("scaling by a sum",             "(. (+ ?s ?t) ?a)",               "(+ (. ?s ?a) (. ?t ?a))",                &[], &[Symbolic("?s", "?t")]),
    ("product with a sum",           "(* ?a (+ ?b ?c))",               "(+ (* ?a ?b) (* ?a ?c))",                &[], &[]),
    ("product of a sum",             "(* (+ ?a ?b) ?c)",               "(+ (* ?a ?c) (* ?b ?c))",                &[], &[]),
    ("transpose of a sum",           "(T (+ ?a ?b))",                  "(+ (T ?a) (T ?b))",                      &[], &[]),
    ("trace of a sum",               "(tr (+ ?a ?b))",                 "(+ (tr ?a) (tr ?b))",                    &[], &[]),
    ("hat of a sum",                 "(hat (+ ?a ?b))",                "(+ (hat ?a) (hat ?b))",                  &[], &[]),
    ("vee of a sum",                 "(vee (+ ?a ?b))",                "(+ (vee ?a) (vee ?b))",                  &[], &[]),
    ("diagonal of a sum",            "(diag (+ ?a ?b))",               "(+ (diag ?a) (diag ?b))",                &[], &[]),
];

#[rustfmt::skip]
const SUMS: &[Row] = &[
    ("adding a zero matrix",         "(+ ?a (zero ?n ?m))",            "?a",                                     &[], &[]),
    ("adding to a zero matrix",      "(+ (zero ?n ?m) ?a)",            "?a",                                     &[], &[]),
    ("adding zero",                  "(+ ?a 0)",                       "?a",                                     &[], &[]),
    ("adding to zero",               "(+ 0 ?a)",                       "?a",                                     &[], &[]),
    ("adding numbers",               "(+ ?p ?q)",                      "?r",                                     &[Number("?p"), Number("?q"), Plus("?r", "?p", "?q")], &[]),
    ("adding numbers first",         "(+ ?p (+ ?q ?a))",               "(+ ?r ?a)",                              &[Number("?p"), Number("?q"), Plus("?r", "?p", "?q")], &[]),
    ("twice the same",               "(+ ?a ?a)",                      "(. 2 ?a)",                               &[], &[Nonzero("?a")]),
    ("twice the same first",         "(+ ?a (+ ?a ?b))",               "(+ (. 2 ?a) ?b)",                        &[], &[Nonzero("?a")]),
    ("one more of the same",         "(+ ?a (. ?p ?a))",               "(. ?r ?a)",                              &[Number("?p"), After("?r", "?p")], &[Nonzero("?a")]),
    ("one more of the same first",   "(+ ?a (+ (. ?p ?a) ?b))",        "(+ (. ?r ?a) ?b)",                       &[Number("?p"), After("?r", "?p")], &[Nonzero("?a")]),
    ("collecting the same",          "(+ (. ?p ?a) (. ?q ?a))",        "(. ?r ?a)",                              &[Number("?p"), Number("?q"), Plus("?r", "?p", "?q")], &[Nonzero("?a")]),
    ("collecting the same first",    "(+ (. ?p ?a) (+ (. ?q ?a) ?b))", "(+ (. ?r ?a) ?b)",                       &[Number("?p"), Number("?q"), Plus("?r", "?p", "?q")], &[Nonzero("?a")]),
    // This rule proves that a quantity equal to its negative is zero.
    ("half of the double",           "(. -1 ?a)",                      "(. 1/2 (+ (. -1 ?a) (. -1 ?a)))",        &[], &[Itself("?a")]),
];

#[rustfmt::skip]
const SCALINGS: &[Row] = &[
    ("scaling by one",               "(. 1 ?a)",                       "?a",                                     &[], &[]),
    ("scaling by zero",              "(. 0 ?a)",                       "?z",                                     &[Zero("?z")], &[]),
    ("scaling of a zero matrix",     "(. ?s (zero ?n ?m))",            "(zero ?n ?m)",                           &[], &[]),
    ("multiplying numbers",          "(. ?p ?q)",                      "?r",                                     &[Number("?p"), Number("?q"), Times("?r", "?p", "?q")], &[]),
    ("scaling twice",                "(. ?p (. ?q ?a))",               "(. ?r ?a)",                              &[Number("?p"), Number("?q"), Times("?r", "?p", "?q")], &[Nonzero("?a")]),
    ("order of scalars",             "(. ?s ?t)",                      "(. ?t ?s)",                              &[Scalar("?t")], &[Unknown("?s")]),
    ("exchange of scalars",          "(. ?s (. ?t ?a))",               "(. ?t (. ?s ?a))",                       &[], &[Unknown("?s"), Composite(Scale, "?t", "?a")]),
    ("nesting of scalings",          "(. (. ?s ?t) ?a)",               "(. ?s (. ?t ?a))",                       &[], &[Composite(Scale, "?s", "?t")]),
    ("a number before a matrix",     "(* ?s ?a)",                      "(. ?s ?a)",                              &[Scalar("?s")], &[]),
    ("a number behind a matrix",     "(* ?a ?s)",                      "(. ?s ?a)",                              &[Scalar("?s")], &[]),
];

#[rustfmt::skip]
const PRODUCTS: &[Row] = &[
    // Products nest to the right, but a column before a row closes its product.
    ("nesting to the right",         "(* (* ?a ?b) ?c)",               "(* ?a (* ?b ?c))",                       &[Wide("?b")], &[Composite(Product, "?a", "?b")]),
    ("nesting to the left",          "(* ?a (* ?b ?c))",               "(* (* ?a ?b) ?c)",                       &[Column("?b")], &[Composite(Product, "?b", "?c")]),
    ("scaled first factor",          "(* (. ?s ?a) ?b)",               "(. ?s (* ?a ?b))",                       &[], &[]),
    ("scaled second factor",         "(* ?a (. ?s ?b))",               "(. ?s (* ?a ?b))",                       &[], &[]),
    ("identity before",              "(* (id ?n) ?a)",                 "?a",                                     &[], &[]),
    ("identity behind",              "(* ?a (id ?n))",                 "?a",                                     &[], &[]),
    ("zero before",                  "(* (zero ?n ?m) ?a)",            "?z",                                     &[Zero("?z")], &[]),
    ("zero behind",                  "(* ?a (zero ?n ?m))",            "?z",                                     &[Zero("?z")], &[]),
    ("transpose twice",              "(T (T ?a))",                     "?a",                                     &[], &[]),
    ("transpose of a product",       "(T (* ?a ?b))",                  "(* (T ?b) (T ?a))",                      &[], &[]),
    ("transpose of a scaling",       "(T (. ?s ?a))",                  "(. ?s (T ?a))",                          &[], &[]),
    ("transpose of a number",        "(T ?s)",                         "?s",                                     &[Scalar("?s")], &[]),
    ("transpose of an identity",     "(T (id ?n))",                    "(id ?n)",                                &[], &[]),
    ("transpose of a zero",          "(T (zero ?n ?m))",               "(zero ?m ?n)",                           &[], &[]),
    ("inverse behind",               "(* ?a (inv ?a))",                "?i",                                     &[Identity("?i")], &[]),
    ("inverse before",               "(* (inv ?a) ?a)",                "?i",                                     &[Identity("?i")], &[]),
    ("inverse behind, in a word",    "(* ?a (* (inv ?a) ?b))",         "?b",                                     &[], &[]),
    ("inverse before, in a word",    "(* (inv ?a) (* ?a ?b))",         "?b",                                     &[], &[]),
    ("inverse twice",                "(inv (inv ?a))",                 "?a",                                     &[], &[]),
    ("inverse of a product",         "(inv (* ?a ?b))",                "(* (inv ?b) (inv ?a))",                  &[Square("?a"), Square("?b")], &[]),
    ("inverse of a scaling",         "(inv (. ?s ?a))",                "(. (^ ?s -1) (inv ?a))",                 &[], &[]),
    ("inverse of an identity",       "(inv (id ?n))",                  "(id ?n)",                                &[], &[]),
    ("transpose of an inverse",      "(T (inv ?a))",                   "(inv (T ?a))",                           &[], &[]),
    ("inverse of a transpose",       "(inv (T ?a))",                   "(T (inv ?a))",                           &[], &[]),
];

#[rustfmt::skip]
const TRACES: &[Row] = &[
    ("trace of a scaling",           "(tr (. ?s ?a))",                 "(. ?s (tr ?a))",                         &[], &[]),
    ("trace of a number",            "(tr ?s)",                        "?s",                                     &[Scalar("?s")], &[]),
    ("trace of an identity",         "(tr (id ?n))",                   "?r",                                     &[Rows("?r", "?n")], &[]),
    ("trace of a zero",              "(tr (zero ?n ?m))",              "0",                                      &[], &[]),
    ("trace of a hat",               "(tr (hat ?v))",                  "0",                                      &[], &[]),
    ("trace of a diagonal part",     "(tr (diag ?a))",                 "(tr ?a)",                                &[], &[]),
    ("symmetric part",               "(sym ?a)",                       "(. 1/2 (+ ?a (T ?a)))",                  &[], &[]),
    ("skew part",                    "(skew ?a)",                      "(. 1/2 (+ ?a (. -1 (T ?a))))",           &[], &[]),
    ("diagonal of a scaling",        "(diag (. ?s ?a))",               "(. ?s (diag ?a))",                       &[], &[]),
    ("diagonal of a transpose",      "(diag (T ?a))",                  "(diag ?a)",                              &[], &[]),
    ("transpose of a diagonal",      "(T (diag ?a))",                  "(diag ?a)",                              &[], &[]),
    ("diagonal twice",               "(diag (diag ?a))",               "(diag ?a)",                              &[], &[]),
    ("diagonal of an identity",      "(diag (id ?n))",                 "(id ?n)",                                &[], &[]),
];

#[rustfmt::skip]
const TURNS: &[Row] = &[
    ("transposed bracket",           "(* ?a ?b)",                      "(* (T ?b) (T ?a))",                      &[Bilinear("?a", "?b")], &[Unsplit]),
    ("trace is cyclic",              "(tr (* ?a ?b))",                 "(tr (* ?b ?a))",                         &[], &[Unsplit]),
    ("trace of the transpose",       "(tr ?a)",                        "(tr (T ?a))",                            &[], &[Unsplit]),
    ("trace with a hat",             "(tr (* (hat ?v) ?a))",           "(. -2 (* (T ?v) (vee ?a)))",             &[], &[Unsplit]),
    ("vee of the transpose",         "(vee ?a)",                       "(. -1 (vee (T ?a)))",                    &[], &[Unsplit]),
    ("vee of a rotation first",      "(vee (* ?g ?a))",                "(* ?g (vee (* ?a ?g)))",                 &[Orthogonal("?g")], &[Unsplit]),
    ("vee of a transpose first",     "(vee (* (T ?g) ?a))",            "(* (T ?g) (vee (* ?a (T ?g))))",         &[Orthogonal("?g")], &[Unsplit]),
];

#[rustfmt::skip]
const VECTORS: &[Row] = &[
    ("dot is a bracket",             "(dot ?u ?v)",                    "(* (T ?u) ?v)",                          &[], &[]),
    ("cross is a hat",               "(cross ?u ?v)",                  "(* (hat ?u) ?v)",                        &[], &[]),
    ("hat of a scaling",             "(hat (. ?s ?v))",                "(. ?s (hat ?v))",                        &[], &[]),
    ("hat of a zero",                "(hat (zero ?n ?m))",             "?z",                                     &[Zero("?z")], &[]),
    ("hat is skew",                  "(T (hat ?v))",                   "(. -1 (hat ?v))",                        &[], &[]),
    ("hat exchanged",                "(* (hat ?u) ?v)",                "(. -1 (* (hat ?v) ?u))",                 &[Vector("?v")], &[]),
    ("hat exchanged in a row",       "(* (T ?u) (hat ?v))",            "(. -1 (* (T ?v) (hat ?u)))",             &[Vector("?u")], &[]),
    ("hat exchanged in a bracket",   "(* (T ?u) (* (hat ?v) ?a))",     "(. -1 (* (T ?v) (* (hat ?u) ?a)))",      &[Vector("?u")], &[]),
    ("hat of itself",                "(* (hat ?v) ?v)",                "?z",                                     &[Zero("?z")], &[]),
    ("hat times hat",                "(* (hat ?u) (hat ?v))",          "(+ (* ?v (T ?u)) (. -1 (. (* (T ?u) ?v) ?i)))", &[Identity("?i")], &[]),
    ("hat times hat, in a word",     "(* (hat ?u) (* (hat ?v) ?a))",   "(+ (* ?v (* (T ?u) ?a)) (. -1 (. (* (T ?u) ?v) ?a)))", &[], &[]),
    ("hat of a cross",               "(hat (* (hat ?u) ?v))",          "(+ (* ?v (T ?u)) (. -1 (* ?u (T ?v))))", &[], &[]),
    ("hat of a vee",                 "(hat (vee ?a))",                 "(. 1/2 (+ ?a (. -1 (T ?a))))",           &[], &[]),
    ("product of two vees",          "(* (T (vee ?a)) (vee ?b))",      "(. -1/4 (tr (* (+ ?a (. -1 (T ?a))) ?b)))", &[], &[]),
    ("vee of a hat",                 "(vee (hat ?v))",                 "?v",                                     &[], &[]),
    ("vee of a scaling",             "(vee (. ?s ?a))",                "(. ?s (vee ?a))",                        &[], &[]),
    ("vee of a zero",                "(vee (zero ?n ?m))",             "?z",                                     &[Zero("?z")], &[]),
    ("vee of a dyad",                "(vee (* ?u ?v))",                "(. 1/2 (* (hat (T ?v)) ?u))",            &[Column("?u")], &[]),
    ("vee with a hat",               "(vee (* (hat ?v) ?a))",          "(. 1/2 (+ (. (tr ?a) ?v) (. -1 (* ?a ?v))))", &[], &[]),
];

#[rustfmt::skip]
const LETTERS: &[Row] = &[
    ("symmetric",                    "(T ?j)",                         "?j",                                     &[Symmetric("?j")], &[]),
    ("skew",                         "(T ?x)",                         "(. -1 ?x)",                              &[Skew("?x")], &[]),
    ("diagonal",                     "(diag ?d)",                      "?d",                                     &[Diagonal("?d")], &[]),
    ("diagonal matrices commute",    "(* ?d ?e)",                      "(* ?e ?d)",                              &[Diagonal("?d"), Diagonal("?e")], &[]),
    ("diagonal, in a word",          "(* ?d (* ?e ?a))",               "(* ?e (* ?d ?a))",                       &[Diagonal("?d"), Diagonal("?e")], &[]),
    ("hat of symmetric times",       "(hat (* ?j ?v))",                "(+ (. (tr ?j) (hat ?v)) (. -1 (+ (* ?j (hat ?v)) (* (hat ?v) ?j))))", &[Symmetric("?j")], &[]),
    ("transpose behind a rotation",  "(* ?g (T ?g))",                  "?i",                                     &[Orthogonal("?g"), Identity("?i")], &[]),
    ("transpose before a rotation",  "(* (T ?g) ?g)",                  "?i",                                     &[Orthogonal("?g"), Identity("?i")], &[]),
    ("rotated back, in a word",      "(* ?g (* (T ?g) ?a))",           "?a",                                     &[Orthogonal("?g")], &[]),
    ("rotated forth, in a word",     "(* (T ?g) (* ?g ?a))",           "?a",                                     &[Orthogonal("?g")], &[]),
    ("inverse of a rotation",        "(inv ?g)",                       "(T ?g)",                                 &[Orthogonal("?g")], &[]),
    ("determinant of a rotation",    "(det ?g)",                       "1",                                      &[Orthogonal("?g")], &[]),
    ("hat of a rotated vector",      "(hat (* ?g ?v))",                "(* ?g (* (hat ?v) (T ?g)))",             &[Orthogonal("?g")], &[]),
    ("hat of a vector rotated back", "(hat (* (T ?g) ?v))",            "(* (T ?g) (* (hat ?v) ?g))",             &[Orthogonal("?g")], &[]),
];

#[rustfmt::skip]
const FUNCTIONS: &[Row] = &[
    ("power of a number",            "(^ ?p ?q)",                      "?r",                                     &[Number("?p"), Number("?q"), Raised("?r", "?p", "?q")], &[]),
    ("first power",                  "(^ ?s 1)",                       "?s",                                     &[], &[]),
    ("zeroth power",                 "(^ ?s 0)",                       "1",                                      &[], &[]),
    ("square",                       "(^ ?s 2)",                       "(. ?s ?s)",                              &[], &[Unknown("?s")]),
    ("twice the same factor",        "(. ?s ?s)",                      "(^ ?s 2)",                               &[], &[Unknown("?s")]),
    ("twice the same factor first",  "(. ?s (. ?s ?a))",               "(. (^ ?s 2) ?a)",                        &[], &[Unknown("?s"), Nonzero("?a")]),
    ("one more power",               "(. ?s (^ ?s ?q))",               "(^ ?s ?r)",                              &[Number("?q"), After("?r", "?q")], &[Unknown("?s")]),
    ("one more power first",         "(. ?s (. (^ ?s ?q) ?a))",        "(. (^ ?s ?r) ?a)",                       &[Number("?q"), After("?r", "?q")], &[Unknown("?s"), Nonzero("?a")]),
    ("product of powers",            "(. (^ ?s ?p) (^ ?s ?q))",        "(^ ?s ?r)",                              &[Number("?p"), Number("?q"), Plus("?r", "?p", "?q")], &[Unknown("?s")]),
    ("product of powers first",      "(. (^ ?s ?p) (. (^ ?s ?q) ?a))", "(. (^ ?s ?r) ?a)",                       &[Number("?p"), Number("?q"), Plus("?r", "?p", "?q")], &[Unknown("?s"), Nonzero("?a")]),
    ("power of a multiple",          "(^ (. ?p ?s) ?q)",               "(. ?r (^ ?s ?q))",                       &[Number("?p"), Number("?q"), Raised("?r", "?p", "?q")], &[Unknown("?s")]),
    ("power of a product",           "(^ (. ?s ?t) ?q)",               "(. (^ ?s ?q) (^ ?t ?q))",                &[Number("?q"), Whole("?q")], &[Unknown("?s"), Unknown("?t")]),
    ("power of a power",             "(^ (^ ?s ?p) ?q)",               "(^ ?s ?r)",                              &[Number("?p"), Number("?q"), Whole("?p"), Whole("?q"), Times("?r", "?p", "?q")], &[Unknown("?s")]),
    ("determinant of a product",     "(det (* ?a ?b))",                "(. (det ?a) (det ?b))",                  &[Square("?a"), Square("?b")], &[]),
    ("determinant of a transpose",   "(det (T ?a))",                   "(det ?a)",                               &[], &[]),
    ("determinant of an inverse",    "(det (inv ?a))",                 "(^ (det ?a) -1)",                        &[], &[]),
    ("determinant of a scaling",     "(det (. ?s ?a))",                "(. (^ ?s ?r) (det ?a))",                 &[Rows("?r", "?a")], &[]),
    ("determinant of an identity",   "(det (id ?n))",                  "1",                                      &[], &[]),
    ("determinant of a hat",         "(det (hat ?v))",                 "0",                                      &[], &[]),
    ("exponential of a sum",         "(exp (+ ?s ?t))",                "(. (exp ?s) (exp ?t))",                  &[], &[]),
    ("exponential of zero",          "(exp 0)",                        "1",                                      &[], &[]),
    ("exponential of a logarithm",   "(exp (log ?s))",                 "?s",                                     &[], &[]),
    ("logarithm of an exponential",  "(log (exp ?s))",                 "?s",                                     &[], &[]),
    ("logarithm of one",             "(log 1)",                        "0",                                      &[], &[]),
    ("sum of logarithms",            "(+ (log ?s) (log ?t))",          "(log (. ?s ?t))",                        &[], &[]),
    ("sum of logarithms first",      "(+ (log ?s) (+ (log ?t) ?a))",   "(+ (log (. ?s ?t)) ?a)",                 &[], &[]),
    ("multiple of a logarithm",      "(. ?p (log ?s))",                "(log (^ ?s ?p))",                        &[Number("?p")], &[]),
];
