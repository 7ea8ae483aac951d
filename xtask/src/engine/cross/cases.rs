//! Compares the digests that a CPU has computed with the accepted ones.

use crate::sha256;
use sprung::internals::measures::Digest;
use std::collections::BTreeMap;
use std::path::Path;

/// The accepted digests by the names of their cases.
pub(crate) struct Accepted(BTreeMap<String, Digest>);

/// The cases that a program was to render.
pub(crate) enum Asked<'a> {
    /// The cases whose names satisfy this condition.
    Named(&'a dyn Fn(&str) -> bool),
    /// Only the cases that the program has printed.
    Printed,
}

/// How many cases have the accepted bits, and which do not.
#[derive(Debug, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) same: usize,
    pub(crate) differing: Vec<String>,
    /// The beginning of one SHA-256 of the names and sums of all cases: equal for CPUs with the same bits.
    pub(crate) digest: String,
}

impl Accepted {
    /// Reads the digests in a folder.
    pub(crate) fn read(folder: &Path) -> Result<Self, String> {
        let at = |error: std::io::Error| format!("{}: {error}", folder.display());
        let mut all = BTreeMap::new();
        for file in std::fs::read_dir(folder).map_err(at)? {
            let path = file.map_err(at)?.path();
            if path.extension().is_some_and(|extension| extension == "toml") {
                let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                let text = std::fs::read_to_string(&path).map_err(at)?;
                let digest = Digest::parse(&text, &path.display().to_string()).map_err(|error| error.to_string())?;
                all.insert(name, digest);
            }
        }
        Ok(Self(all))
    }

    /// Compares lines of the form `name frames sha256 chunk,chunk,…`. The program may end a song after some chunks. A requested
    /// case without a line counts as differing.
    pub(crate) fn compare(&self, lines: &[String], asked: Asked) -> Result<Outcome, String> {
        let mut found = BTreeMap::new();
        for line in lines.iter().filter(|line| !line.starts_with("level ")) {
            let words: Vec<&str> = line.split(' ').collect();
            let &[name, frames, sha256, chunks] = &words[..] else { return Err(format!("not a digest: {line}")) };
            let frames: usize = frames.parse().map_err(|_| format!("not a digest: {line}"))?;
            found.insert(name, (frames, sha256, chunks.split(',').collect::<Vec<_>>()));
        }
        let sums: String = found.iter().map(|(name, (frames, sum, _))| format!("{name} {frames} {sum}\n")).collect();
        let digest = sha256::of(sums.as_bytes())[..16].to_owned();
        let mut outcome = Outcome { same: 0, differing: Vec::new(), digest };
        let is_asked = |name: &str| match asked {
            Asked::Named(is_asked) => is_asked(name),
            Asked::Printed => found.contains_key(name),
        };
        if found.is_empty() {
            return Err("the program has printed no digest".to_owned());
        }
        for (name, accepted) in self.0.iter().filter(|(name, _)| is_asked(name)) {
            let same = found.get(name.as_str()).is_some_and(|(frames, sha256, chunks)| {
                let is_whole = *frames == accepted.frames && *sha256 == accepted.sha256;
                let is_beginning = name.starts_with("song-")
                    && *frames < accepted.frames
                    && accepted.chunks.iter().zip(chunks).filter(|(a, b)| a == b).count() == chunks.len();
                is_whole || is_beginning
            });
            if same { outcome.same += 1 } else { outcome.differing.push(name.clone()) }
        }
        Ok(outcome)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digests_are_compared_whole_and_songs_by_their_beginnings() {
        let samples: Vec<f32> = (0..10_000).map(|n| n as f32).collect();
        let digest = Digest::of(&samples, &samples, 48_000.0);
        let line = |name: &str, digest: &Digest, chunks: usize| {
            let frames = digest.frames.min(4096 * chunks);
            let sha256 = if frames == digest.frames { &digest.sha256 } else { "of-a-part" };
            format!("{name} {frames} {sha256} {}", digest.chunks[..chunks].join(","))
        };
        let accepted = Accepted(["preset-a", "song-b"].map(|name| (name.to_owned(), digest.clone())).into());
        let other = Digest::of(&samples[1..], &samples[1..], 48_000.0);
        let mut digests = std::collections::BTreeSet::new();
        for (lines, differing) in [
            (vec![line("preset-a", &digest, 3), line("song-b", &digest, 2)], vec![]),
            (vec![line("preset-a", &digest, 2), line("song-b", &digest, 3)], vec!["preset-a"]),
            (vec![line("preset-a", &other, 3), line("song-b", &other, 1)], vec!["preset-a", "song-b"]),
            (vec![line("preset-a", &digest, 3)], vec!["song-b"]),
        ] {
            let outcome = accepted.compare(&lines, Asked::Named(&|_| true)).unwrap();
            assert_eq!(outcome.differing, differing, "{lines:?}");
            assert_eq!(outcome.same, 2 - differing.len());
            digests.insert(outcome.digest);
        }
        assert_eq!(digests.len(), 4, "what differs has another digest");
        let [one, two] = [line("preset-a", &digest, 3), line("song-b", &digest, 2)];
        let [forwards, backwards] = [[one.clone(), two.clone()], [two, one]]
            .map(|lines| accepted.compare(&lines, Asked::Named(&|_| true)).unwrap().digest);
        let some = accepted.compare(&[line("song-b", &other, 1)], Asked::Printed).unwrap();
        assert_eq!(
            (some.same, &some.differing[..]),
            (0, &["song-b".to_owned()][..]),
            "what was not asked for does not differ"
        );
        assert!(accepted.compare(&["level neon".to_owned()], Asked::Printed).is_err(), "nothing was run");
        assert_eq!(forwards, backwards, "the order in which cases end does not matter");
        assert!(accepted.compare(&["level neon".to_owned(), "noise".to_owned()], Asked::Printed).is_err());
    }
}
