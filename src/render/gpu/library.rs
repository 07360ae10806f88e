//! The modules of `shaders/` that passes import, and the composer that joins them (naga_oil).
//!
//! A module's import path is its place in the folder: `lensrunner::lensing::lookup` is `shaders/lensing/lookup.wgsl`. What is chosen for a
//! pass has a path of its own, under which one file of several is put in: `lensrunner::chosen::method`, `lensrunner::chosen::static_body`,
//! `lensrunner::chosen::worldlines`.

use std::collections::HashMap;

use naga_oil::compose::{ComposableModuleDescriptor, Composer, ComposerError, NagaModuleDescriptor, ShaderDefValue};
use thiserror::Error;
use wgpu::naga::Module;
use wgpu::naga::valid::Capabilities;

use crate::lensing::methods::Method;

/// A file of shaders: its path in the repository, and its text.
pub type File = (&'static str, &'static str);

/// A file of `shaders/`.
macro_rules! file {
    ($path:literal) => {
        (concat!("shaders/", $path), include_str!(concat!("../../../shaders/", $path)))
    };
}
pub(super) use file;

/// How the points of models go through spacetime.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Worldlines {
    /// As those of bodies whose flight was recorded: `shaders/instances/recorded.wgsl`.
    #[default]
    Bodies,
    /// As those of bodies that turn evenly: `shaders/instances/even.wgsl`.
    Even,
    /// As those of rings round the hole: `shaders/instances/ring.wgsl`.
    Rings,
}

/// What the text of modules asks for by `#{NAME}`.
#[derive(Clone, Copy, Debug)]
pub struct Values {
    /// `SEES_INSIDE`: whether the camera may be inside the horizon.
    pub inside: bool,
    /// `DATA_GROUP`: the group in which instances are, and the numbers of the disk.
    pub data_group: u32,
}

/// Why a shader is none: file, line and what is wrong there.
#[derive(Debug, Error)]
#[error("{0}")]
pub struct ShaderError(String);

impl ShaderError {
    fn new(error: &ComposerError, composer: &Composer) -> ShaderError {
        ShaderError(error.emit_to_string(composer))
    }
}

/// The modules of one choice. Each is worked out when the first pass asks for it.
#[derive(Debug)]
pub struct Library {
    composer: Composer,
}

impl Library {
    /// With `others` in place of the modules of the same import path, and beside them; each after those that it imports.
    pub fn new(worldlines: Worldlines, method: Method, others: &[File]) -> Result<Library, ShaderError> {
        // What the device lacks it refuses itself.
        let mut library = Library { composer: Composer::default().with_capabilities(Capabilities::all()) };
        let mut others: Vec<(&str, File)> = others.iter().map(|&other| (import_path(other), other)).collect();
        for (path, file) in modules(worldlines, method) {
            if let Some(last) = others.iter().position(|(other, _)| *other == path) {
                others.drain(..=last).try_for_each(|(path, file)| library.add(path, file))?;
            } else if !library.composer.contains_module(path) {
                library.add(path, file)?;
            }
        }
        for (path, file) in others {
            library.add(path, file)?;
        }
        Ok(library)
    }

    fn add(&mut self, path: &str, (file_path, source): File) -> Result<(), ShaderError> {
        let descriptor = ComposableModuleDescriptor { source, file_path, as_name: Some(path.to_owned()), ..Default::default() };
        match self.composer.add_composable_module(descriptor) {
            Ok(_) => Ok(()),
            Err(error) => Err(ShaderError::new(&error, &self.composer)),
        }
    }

    /// A shader with all that it imports. `file` is what errors call it.
    pub fn compose(&mut self, file: &str, source: &str, values: Values) -> Result<Module, ShaderError> {
        let shader_defs = HashMap::from([
            ("SEES_INSIDE".to_owned(), ShaderDefValue::Bool(values.inside)),
            ("DATA_GROUP".to_owned(), ShaderDefValue::UInt(values.data_group)),
        ]);
        let descriptor = NagaModuleDescriptor { source, file_path: file, shader_defs, ..Default::default() };
        self.composer.make_naga_module(descriptor).map_err(|error| ShaderError::new(&error, &self.composer))
    }
}

/// The path by which a file says that it is imported.
fn import_path((_, source): File) -> &'static str {
    source.lines().find_map(|line| line.strip_prefix("#define_import_path ")).unwrap_or("").trim()
}

/// All modules by their import paths, each after those that it imports.
fn modules(worldlines: Worldlines, method: Method) -> Vec<(&'static str, File)> {
    let static_body = if method.bends { file!("method/static_body.wgsl") } else { file!("method/at_rest.wgsl") };
    let worldlines = match worldlines {
        Worldlines::Bodies => file!("instances/recorded.wgsl"),
        Worldlines::Even => file!("instances/even.wgsl"),
        Worldlines::Rings => file!("instances/ring.wgsl"),
    };
    let own = |file| (import_path(file), file);
    vec![
        own(file!("gpu/types.wgsl")),
        own(file!("gpu/bindings.wgsl")),
        own(file!("gpu/random.wgsl")),
        own(file!("gpu/colour.wgsl")),
        own(file!("lensing/closed_form.wgsl")),
        own(file!("lensing/inside.wgsl")),
        own(file!("lensing/slice.wgsl")),
        own(file!("lensing/lookup.wgsl")),
        own(file!("lensing/orbit.wgsl")),
        own(file!("lensing/exact.wgsl")),
        own(file!("lensing/static_ray.wgsl")),
        ("lensrunner::chosen::method", method.shader),
        ("lensrunner::chosen::static_body", static_body),
        own(file!("instances/instance.wgsl")),
        own(file!("instances/local_motion.wgsl")),
        ("lensrunner::chosen::worldlines", worldlines),
        own(file!("instances/held.wgsl")),
        own(file!("instances/view.wgsl")),
        own(file!("geometry/clip.wgsl")),
        own(file!("geometry/project.wgsl")),
        own(file!("geometry/bindings.wgsl")),
        own(file!("geometry/patch.wgsl")),
        own(file!("instances/bounds.wgsl")),
        own(file!("models/hiding.wgsl")),
        own(file!("geometry/emit.wgsl")),
        own(file!("post_process/coverage.wgsl")),
        own(file!("post_process/tiles.wgsl")),
        own(file!("post_process/tone_curve.wgsl")),
        own(file!("shading/bindings.wgsl")),
        own(file!("shading/aurora_light.wgsl")),
        own(file!("shading/shade.wgsl")),
        own(file!("sky/table.wgsl")),
        own(file!("sky/direction.wgsl")),
        own(file!("sky/star_clusters.wgsl")),
        own(file!("sky/star_spot.wgsl")),
        own(file!("aurora/stroke.wgsl")),
        own(file!("aurora/streaks.wgsl")),
        own(file!("aurora/levels/lit_tiles.wgsl")),
        own(file!("aurora/levels/lit_corners.wgsl")),
        own(file!("aurora/levels/enlarge.wgsl")),
        own(file!("aurora/capacities.wgsl")),
        own(file!("disk/types.wgsl")),
        own(file!("disk/motion.wgsl")),
        own(file!("disk/sigma.wgsl")),
        own(file!("disk/arcs/bindings.wgsl")),
        own(file!("disk/arcs/place.wgsl")),
        own(file!("disk/light.wgsl")),
        own(file!("disk/gas.wgsl")),
        own(file!("disk/radial.wgsl")),
        own(file!("disk/sprites_types.wgsl")),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lensing::methods::flat;

    const VALUES: Values = Values { inside: true, data_group: 1 };
    const BROKEN: File = ("shaders/broken.wgsl", "#define_import_path lensrunner::broken\n\nfn wrong() -> u32 {\n    return nothing;\n}\n");

    fn error(others: &[File], source: &str) -> String {
        let library = Library::new(Worldlines::Bodies, Method::default(), others);
        library.and_then(|mut library| library.compose("shaders/pass.wgsl", source, VALUES)).unwrap_err().to_string()
    }

    #[test]
    fn an_error_names_file_and_line() {
        let main = "#import lensrunner::broken::wrong\n@compute @workgroup_size(1) fn main() { _ = wrong(); }\n";
        let found = error(&[BROKEN], main);
        assert!(found.contains("shaders/broken.wgsl:4:"), "{found}");
        // Behind an imported module the lines of a file are its own.
        let main =
            "#import lensrunner::gpu::bindings::frame\n\n@compute @workgroup_size(1)\nfn main() {\n    let x: u32 = frame.size.x;\n}\n";
        let found = error(&[], main);
        assert!(found.contains("shaders/pass.wgsl:5:"), "{found}");
    }

    #[test]
    fn a_name_is_known_where_it_is_imported_alone() {
        let main = "@compute @workgroup_size(1)\nfn main() {\n    _ = frame.size;\n}\n";
        let found = error(&[], main);
        assert!(found.contains("shaders/pass.wgsl:3:") && found.contains("frame"), "{found}");
        let found = error(&[], "#import lensrunner::nowhere::nothing\n@compute @workgroup_size(1) fn main() { nothing(); }\n");
        assert!(found.contains("shaders/pass.wgsl:2:") && found.contains("lensrunner::nowhere"), "{found}");
    }

    /// A module is imported by its place in the folder.
    #[test]
    fn import_paths_are_places() {
        for (path, file) in modules(Worldlines::Bodies, flat::METHOD) {
            let place = file.0.replace("shaders/", "lensrunner/").replace(".wgsl", "").replace('/', "::");
            assert_eq!(import_path(file), place);
            assert!(path == place || path.starts_with("lensrunner::chosen::"), "{path}");
        }
    }
}
