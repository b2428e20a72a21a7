//! The window on what Lightvein finds.
