//! What was changed in the overlay, to be undone and done again.

use std::collections::BTreeSet;

use crate::scene::GameConfig;
use crate::scene::config::{self, Setting, Value};

/// The most changes that are kept.
const MOST: usize = 1000;

/// A setting's place in the list of all, its value before, and its value after.
pub type Edit = (usize, Value, Value);

/// Changes, each of one setting or more that were changed at once.
#[derive(Clone, Debug, Default)]
pub struct EditHistory {
    done: Vec<Vec<Edit>>,
    undone: Vec<Vec<Edit>>,
    touched: BTreeSet<usize>,
}

impl EditHistory {
    /// What leads `config` to these values of settings, by their places; None where that is nothing.
    pub fn edits(config: &GameConfig, to: impl IntoIterator<Item = (usize, Value)>) -> Option<Vec<Edit>> {
        let edits = to.into_iter().map(|(place, value)| (place, config::settings()[place].get(config), value));
        let edits: Vec<Edit> = edits.filter(|(_, before, after)| before != after).collect();
        (!edits.is_empty()).then_some(edits)
    }

    /// Keeps a change. `continues`: it goes on with the one before, as when a slider is dragged.
    pub fn did(&mut self, edits: Vec<Edit>, continues: bool) {
        self.touched.extend(edits.iter().map(|edit| edit.0));
        self.undone.clear();
        if let (true, Some(last), [edit]) = (continues, self.done.last_mut(), &edits[..])
            && let [before] = &mut last[..]
            && before.0 == edit.0
        {
            before.2 = edit.2.clone();
            return;
        }
        self.done.push(edits);
        if self.done.len() > MOST {
            self.done.remove(0);
        }
    }

    /// The values to go back to; none where nothing was changed.
    pub fn undo(&mut self) -> Vec<(usize, Value)> {
        let Some(edits) = self.done.pop() else { return Vec::new() };
        let back = edits.iter().map(|(place, before, _)| (*place, before.clone())).collect();
        self.undone.push(edits);
        back
    }

    /// The values that were undone last; none where nothing was.
    pub fn redo(&mut self) -> Vec<(usize, Value)> {
        let Some(edits) = self.undone.pop() else { return Vec::new() };
        let on = edits.iter().map(|(place, _, after)| (*place, after.clone())).collect();
        self.done.push(edits);
        on
    }

    /// How many changes can be undone, and done again.
    pub fn depth(&self) -> (usize, usize) {
        (self.done.len(), self.undone.len())
    }

    /// Whether a setting was ever changed here.
    pub fn has_touched(&self, place: usize) -> bool {
        self.touched.contains(&place)
    }
}

/// How a setting stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mark {
    /// It is not its default.
    pub changed: bool,
    /// It was changed here, and is not as the game would begin with it.
    pub unsaved: bool,
}

/// The marks of all settings: `config` is what is played, `begun` what the game would begin with.
pub fn marks(config: &GameConfig, begun: &GameConfig, history: &EditHistory) -> Vec<Mark> {
    let usual = GameConfig::default();
    let mark = |(place, setting): (usize, &Setting<GameConfig>)| {
        let value = setting.get(config);
        Mark { changed: value != setting.get(&usual), unsaved: history.has_touched(place) && value != setting.get(begun) }
    };
    config::settings().iter().enumerate().map(mark).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(path: &str) -> usize {
        config::settings().iter().position(|setting| setting.path() == path).expect("a setting")
    }

    #[test]
    fn what_is_dragged_is_one_change() {
        let (mut history, mut config) = (EditHistory::default(), GameConfig::default());
        let bloom = place("render.bloom");
        for (step, value) in [0.4, 0.5, 0.6].into_iter().enumerate() {
            let edits = EditHistory::edits(&config, [(bloom, Value::Number(value))]).expect("a change");
            config.render.bloom = value;
            history.did(edits, step > 0);
        }
        assert_eq!(EditHistory::edits(&config, [(bloom, Value::Number(0.6))]), None);
        assert_eq!(history.depth(), (1, 0));
        assert_eq!(history.undo(), [(bloom, Value::Number(0.3))]);
        assert_eq!(history.redo(), [(bloom, Value::Number(0.6))]);
        assert_eq!(history.undo().len() + history.undo().len(), 1);
        history.did(vec![(place("render.orders"), Value::Integer(2), Value::Integer(1))], false);
        assert_eq!((history.redo(), history.depth()), (vec![], (1, 0)), "another way leads on");
        let marks = marks(&config, &GameConfig::default(), &history);
        assert_eq!(marks[bloom], Mark { changed: true, unsaved: true });
        assert_eq!(marks[place("render.orders")], Mark::default());
    }
}
