//! The trailer's sound, from its first picture to its last: what the ship of each part hears, and the music through all of them.

use crate::play::sound::heard::Heard;
use crate::play::sound::volumes::Volumes;
use crate::play::trailer::plan::{Part, TrailerMoment};
use crate::play::trailer::take::Take;

/// What is heard changes so often a second, as in the game's steps at the usual pace.
const CHANGES: f64 = 48.0;
/// Of the parts of the mix: here the music leads.
pub const VOLUMES: Volumes = Volumes {
    master: 1.0,
    effects: 0.8,
    music: 1.0,
    beacon: 0.6,
    master_muted: false,
    effects_muted: false,
    music_muted: false,
    beacon_muted: false,
};
/// What is heard in a trailer of so many seconds, and how many seconds each of it lasts.
pub fn score(parts: &[Part], takes: &[Take], seconds: f64) -> (Vec<Heard>, f64) {
    let count = (seconds * CHANGES).ceil().max(1.0);
    let mut joined = Joined::default();
    let moments = (0..count as usize)
        .map(|index| {
            let moment = TrailerMoment::at(parts, index as f64 / count, seconds);
            let heard = takes.get(moment.part).map_or(Heard::MUSIC, |take| take.heard(moment.time));
            let tension = parts.get(moment.part).map_or(0.0, |part| part.tension);
            joined.next(moment.part, Heard { danger: heard.danger.max(tension), alarm: None, ..heard })
        })
        .collect();
    (moments, seconds / count)
}

/// Flights one after the other: what had happened before a part begins is not heard as news.
#[derive(Default)]
struct Joined {
    /// The part, what was heard first in it, and what was said last before it.
    part: Option<(usize, Heard, Heard)>,
    last: Heard,
}

impl Joined {
    fn next(&mut self, part: usize, heard: Heard) -> Heard {
        let (_, first, before) = *self.part.get_or_insert((part, heard, Heard::MUSIC));
        let (first, before) = if self.part.is_some_and(|(other, ..)| other != part) {
            self.part = Some((part, heard, self.last));
            (heard, self.last)
        } else {
            (first, before)
        };
        let since = |now: u32, then: u32, base: u32| base + now.saturating_sub(then);
        self.last = Heard {
            bolt: if heard.bolt == first.bolt { before.bolt } else { heard.bolt },
            hits: since(heard.hits, first.hits, before.hits),
            successes: since(heard.successes, first.successes, before.successes),
            losses: since(heard.losses, first.losses, before.losses),
            ..heard
        };
        self.last
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A part that begins after a success chimes no more; one in it is heard.
    #[test]
    fn only_what_happens_in_a_part_is_news() {
        let mut joined = Joined::default();
        let with = |successes: u32, bolt: Option<f64>| Heard { successes, bolt, ..Heard::MUSIC };
        let heard = [
            joined.next(0, with(2, None)),
            joined.next(0, with(3, Some(4.0))),
            joined.next(1, with(0, None)),
            joined.next(1, with(1, None)),
            joined.next(2, with(7, Some(9.0))),
        ];
        assert_eq!(heard.map(|heard| heard.successes), [0, 1, 1, 2, 2]);
        assert_eq!(heard.map(|heard| heard.bolt), [None, Some(4.0), Some(4.0), Some(4.0), Some(4.0)]);
    }
}
