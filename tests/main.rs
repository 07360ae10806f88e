//! All integration tests in one binary (linking is the slow part); the modules mirror `src/`.

mod measure_project;
mod spacetime_light;
