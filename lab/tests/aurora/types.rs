//! What crosses from Rust to the experiment's shaders has one layout in both languages.

use lensrunner::render::gpu::library::{Library, Values, Worldlines};
use lensrunner::render::method::Method;
use lensrunner_lab::aurora::race::{Electron, Experiment};

use crate::layout::{fields, fields_of};

const FILE: (&str, &str) = ("lab/shaders/aurora/experiment.wgsl", include_str!("../../shaders/aurora/experiment.wgsl"));

#[test]
fn structs_of_the_experiment_have_one_layout_in_both_languages() {
    let cases = [
        ("Experiment", fields!(Experiment: origin, place, axes, across, across_seen, screen, various, lattice, cells)),
        ("Electron", fields!(Electron: top, end, numbers)),
    ];
    let mut library = Library::new(Worldlines::Bodies, Method::Table, &[FILE]).unwrap();
    for (name, rust) in cases {
        let text = format!("var<workgroup> variable: lensrunner_lab::aurora::experiment::{name};");
        let module = library.compose("types", &text, Values { inside: false, data_group: 1 }).unwrap();
        assert_eq!(fields_of(&module, name), rust, "{name}");
    }
}
