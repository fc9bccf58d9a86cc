//! Freikugel and its peers, measured in one go: what is measured, how, and how it is printed.

#![forbid(unsafe_code)]

pub mod evaluation;
pub mod fields;
pub mod growth;
pub mod measure;
pub mod nearest;
pub mod peer;
pub mod picture;
pub mod scattered;
pub mod table;
pub mod whole;
