//! `wasm-bindgen` of the version that is pinned: `lensrunner_bindgen web|nodejs FILE.wasm FOLDER` writes the program and the JavaScript
//! that a page, or Node, loads it with.

use std::path::Path;

use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [target, program, folder] = &arguments[..] else {
        return Err("usage: lensrunner_bindgen web|nodejs FILE.wasm FOLDER".into());
    };
    let mut bindgen = Bindgen::new();
    let chosen = match target.as_str() {
        "web" => bindgen.web(true),
        "nodejs" => bindgen.nodejs(true),
        other => return Err(format!("{other}: allowed is web or nodejs")),
    };
    chosen
        .and_then(|bindgen| bindgen.typescript(false).input_path(program).generate(Path::new(folder)))
        .map_err(|error| format!("{program}: {error:#}"))
}
