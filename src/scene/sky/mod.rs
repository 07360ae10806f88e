//! What is seen behind everything: the stars and the Milky Way, as files and as light.

pub mod milky_way;
pub mod stars;
