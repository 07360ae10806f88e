//! Pictures of scenes without the game, to be compared with those of other machines (`page/drive/pictures.mjs`).

use lensrunner::picture_file::png;
use lensrunner::render::shot::{ShotRequest, shot_later};
use lensrunner::scene::GameConfig;
use wasm_bindgen::JsError;
use wasm_bindgen::prelude::wasm_bindgen;

/// The picture that `lensrunner shot --scene NAME --size WIDTHxHEIGHT` writes, as PNG; for the other arguments see [`play`](crate::play).
#[wasm_bindgen]
pub async fn shot(table: Vec<u8>, shaders: String, scene: String, width: u32, height: u32) -> Result<Vec<u8>, JsError> {
    crate::bring(&table, &shaders)?;
    let size = [width, height];
    let request = ShotRequest { scene: &scene, size, at: 0.0, layers: false, fill: true };
    let picture = shot_later(&request, &GameConfig::default()).await?;
    let opaque: Vec<u8> = picture.display.as_chunks::<4>().0.iter().flat_map(|[red, green, blue, _]| [*red, *green, *blue]).collect();
    png(&opaque, picture.size, true, None).map_err(|error| JsError::new(&error))
}
