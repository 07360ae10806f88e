//! The order in which the pixels of a picture make good packets.

/// Pixels (x + width · y) of a picture in tiles of `size` × `size`, each tile in quarters of quarters down to blocks of 4 × 2, so that
/// every aligned run of 16 · 4ᵏ rays is a square. Tiles at the right and lower edge are cut. Also gives where each tile starts, and the
/// end.
pub fn tiles(picture: [usize; 2], size: usize) -> (Vec<u32>, Vec<usize>) {
    arranged(picture, size, key)
}

/// The same in quarters of quarters down to single pixels: left before right, upper before lower.
pub fn squares(picture: [usize; 2], size: usize) -> (Vec<u32>, Vec<usize>) {
    arranged(picture, size, |x, y| spread(x) | spread(y) << 1)
}

fn arranged([width, height]: [usize; 2], size: usize, key: fn(usize, usize) -> u64) -> (Vec<u32>, Vec<usize>) {
    let mut order = Vec::with_capacity(width * height);
    let mut starts = vec![0];
    let mut patch = Vec::new();
    for y in 0..size {
        for x in 0..size {
            patch.push((key(x, y), x, y));
        }
    }
    patch.sort_unstable();
    for top in (0..height).step_by(size) {
        for left in (0..width).step_by(size) {
            let inside = patch.iter().map(|&(_, x, y)| (left + x, top + y)).filter(|&(x, y)| x < width && y < height);
            order.extend(inside.map(|(x, y)| (x + width * y) as u32));
            starts.push(order.len());
        }
    }
    (order, starts)
}

/// Bits of x and y alternate from the top; at the bottom y, x, x make the block of 4 × 2, and the y above it makes that a square.
fn key(x: usize, y: usize) -> u64 {
    let (low, high) = ((x & 3) | (y & 1) << 2, spread(x >> 2) << 1 | spread(y >> 1));
    high << 3 | low as u64
}

/// Bit k goes to place 2 k.
fn spread(v: usize) -> u64 {
    (0..24).fold(0, |all, bit| all | ((v >> bit & 1) as u64) << (2 * bit))
}
