//! The language of `model!`: everything a statement may hold, and what it means. This page is the reference
//! that the repository has as `docs/language.md`.
#![cfg_attr(doc, doc = include_str!("../../docs/language.md"))]
