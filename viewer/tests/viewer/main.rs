//! The viewer as its user meets it.

mod outdoors;
