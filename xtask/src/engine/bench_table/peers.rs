//! Reads the output of `benches/peers/run.sh`.

/// A peer with its result.
#[derive(Debug, PartialEq)]
pub(super) struct Peer {
    pub(super) name: String,
    pub(super) version: String,
    /// `avx2`, `native` for everything that the CPU has, or `packaged` for the build in Debian's archive.
    pub(super) instructions: String,
    /// 10⁹ modes × samples per second; `None` for a peer that does not compute modes.
    pub(super) giga: Option<f64>,
    /// Speed relative to real time, or why it was not measured.
    pub(super) remark: String,
}

impl Peer {
    /// Parses the script's output.
    pub(super) fn parse(lines: &str) -> Result<Vec<Peer>, String> {
        let peer = |line: &str| {
            let fields: Vec<&str> = line.split('\t').collect();
            let [name, version, instructions, giga, remark] = fields[..] else {
                return Err(format!("benches/peers/run.sh: five fields expected in ‘{line}’"));
            };
            let [name, version, instructions, remark] = [name, version, instructions, remark].map(str::to_owned);
            Ok(Peer { name, version, instructions, giga: giga.parse().ok(), remark })
        };
        lines.lines().map(peer).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_rows() {
        let peers = Peer::parse("Klank\t3.13\tpackaged\t1.25\t25.0\nMissing\t-\t-\t-\tis not to be had").unwrap();
        assert_eq!((peers[0].name.as_str(), peers[0].giga), ("Klank", Some(1.25)));
        assert_eq!((peers[1].remark.as_str(), peers[1].giga), ("is not to be had", None));
        assert!(Peer::parse("one\ttwo").is_err());
    }
}
