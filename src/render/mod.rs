//! See the map of the house in docs/architecture.md.
