//! Reads the output of `benches/songs.sh`.

/// A song, and the user seconds that each synthesizer takes for it on one thread.
#[derive(Debug, PartialEq)]
pub(super) struct Song {
    pub(super) name: String,
    pub(super) sprung: f64,
    pub(super) fluidsynth: f64,
}

impl Song {
    /// How many times as long Sprung takes.
    pub(super) fn ratio(&self) -> f64 {
        self.sprung / self.fluidsynth
    }
}

/// Parses the script's output.
pub(super) fn parse(lines: &str) -> Result<Vec<Song>, String> {
    let song = |line: &str| {
        let [name, sprung, fluidsynth] = line.split('\t').collect::<Vec<_>>()[..] else { return None };
        let [sprung, fluidsynth] = [sprung, fluidsynth].map(|seconds| seconds.parse().ok());
        Some(Song { name: name.to_owned(), sprung: sprung?, fluidsynth: fluidsynth? })
    };
    let read = |line| song(line).ok_or_else(|| format!("benches/songs.sh: a name and two times expected in ‘{line}’"));
    lines.lines().map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_songs() {
        let songs = parse("groove\t1.5\t0.75\n").unwrap();
        assert_eq!((songs[0].name.as_str(), songs[0].ratio()), ("groove", 2.0));
        assert!(parse("groove\t1.5\n").is_err() && parse("groove\t1.5\tfailed\n").is_err());
    }
}
