//! What all charts share.

mod toolkit;
