//! Sound: what the ship hears, made by the program itself.
//!
//! [`read`] takes from the game's world what is heard ([`heard`]: plain numbers), [`mixer`] makes samples of it with the [`voices`], and
//! the same mix goes to the loudspeakers ([`output`], by [`plugin`]) and to a file ([`mod@file`]). See `docs/sound.md`.

pub mod file;
pub mod heard;
pub mod mixer;
pub mod output;
pub mod parts;
pub mod plugin;
pub mod read;
pub mod record;
pub mod sent;
pub mod voices;
pub mod volumes;
