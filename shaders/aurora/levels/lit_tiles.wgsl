#define_import_path lensrunner::aurora::levels::lit_tiles

// The numbers of each image of the aurora while it is drawn, and the lit tiles into which the screen is divided: only tiles with light are
// cleared, enlarged into and coloured. Twin of src/render/aurora/capacities.rs.

/// Levels of the pyramid, each of half the size of the one before.
const PYRAMID: u32 = 7u;
/// Columns of lit tiles, each a bit of its row's word, and rows.
const LIT_TILE_COLUMNS: u32 = 32u;
const LIT_TILE_ROWS: u32 = 16u;

/// The first of the numbers of an image: the arguments of each level's drawing, strokes in each pair of levels, a word for each row of lit
/// tiles that the finest level may light, and one for each that coarser levels may.
fn numbers_of(image: u32) -> u32 {
    return image * (4u * (PYRAMID + 1u) + 2u * LIT_TILE_ROWS);
}

/// The first of those words.
fn lit_tiles_of(image: u32, finest: bool) -> u32 {
    return numbers_of(image) + 4u * (PYRAMID + 1u) + select(LIT_TILE_ROWS, 0u, finest);
}
