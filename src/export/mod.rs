//! Every file format we write.

pub mod reference;
