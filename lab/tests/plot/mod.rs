//! How charts are drawn.

mod figures;
