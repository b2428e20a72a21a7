//! What the user was told: errors, warnings and notes, kept for the log panel and shown as toasts.

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// Something did not work.
    Error,
    /// Something worked with a reservation.
    Warning,
    /// Something was done.
    Note,
}

/// One thing that was told.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// How bad it is.
    pub level: Level,
    /// The file or the scene that it is about.
    pub about: String,
    /// What happened and why.
    pub text: String,
    /// How often it was told in a row.
    pub times: usize,
}

impl Entry {
    /// The entry as a line of text.
    pub fn line(&self) -> String {
        let level = match self.level {
            Level::Error => "error",
            Level::Warning => "warning",
            Level::Note => "note",
        };
        let times = if self.times > 1 { format!(" ({} times)", self.times) } else { String::new() };
        if self.about.is_empty() || self.text.contains(&self.about) {
            format!("{level}: {}{times}", self.text)
        } else {
            format!("{level}: {}: {}{times}", self.about, self.text)
        }
    }
}

/// All that was told since the start, up to the last thousand.
#[derive(Debug, Clone, Default)]
pub struct Log {
    /// The entries, the latest last.
    pub entries: Vec<Entry>,
    /// What has not been shown as a toast yet.
    fresh: Vec<Entry>,
}

/// Most entries that are kept.
const LONGEST: usize = 1000;

impl Log {
    /// Tells something, also as a toast; the same thing twice in a row is one entry.
    pub fn tell(&mut self, level: Level, about: impl Into<String>, text: impl Into<String>) {
        let entry = Entry { level, about: about.into(), text: text.into(), times: 1 };
        if self.fresh.last() != Some(&entry) {
            self.fresh.push(entry.clone());
        }
        self.keep(entry);
    }

    /// The same without a toast: for what comes in numbers and can wait.
    pub fn note(&mut self, level: Level, about: impl Into<String>, text: impl Into<String>) {
        self.keep(Entry { level, about: about.into(), text: text.into(), times: 1 });
    }

    fn keep(&mut self, entry: Entry) {
        match self.entries.last_mut() {
            Some(last) if (last.level, &last.about, &last.text) == (entry.level, &entry.about, &entry.text) => {
                last.times += 1;
            }
            _ => self.entries.push(entry),
        }
        if self.entries.len() > LONGEST {
            self.entries.remove(0);
        }
    }

    /// What has not been shown as a toast yet.
    pub fn take_fresh(&mut self) -> Vec<Entry> {
        std::mem::take(&mut self.fresh)
    }

    /// All entries as text, a line each.
    pub fn text(&self) -> String {
        self.entries.iter().map(|entry| entry.line() + "\n").collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_thing_twice_is_one_entry() {
        let mut log = Log::default();
        log.tell(Level::Error, "a.toml", "a.toml:3: no such key");
        log.tell(Level::Error, "a.toml", "a.toml:3: no such key");
        log.tell(Level::Note, "", "saved");
        assert_eq!(log.text(), "error: a.toml:3: no such key (2 times)\nnote: saved\n");
        assert_eq!((log.take_fresh().len(), log.take_fresh().len()), (2, 0));
    }

    #[test]
    fn the_oldest_entries_are_forgotten() {
        let mut log = Log::default();
        (0..LONGEST + 7).for_each(|number| log.tell(Level::Note, "x", number.to_string()));
        assert_eq!((log.entries.len(), log.entries[0].line()), (LONGEST, "note: x: 7".to_owned()));
    }
}
