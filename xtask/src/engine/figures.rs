//! `cargo xtask figures`: the picture of the demo song that the README shows.

use crate::shell::root;
use sprung::analysis::figure::{Render, waveform_and_spectrogram};
use sprung::io::Song;
use sprung::preset::{Preset, Programs};
use sprung::render::{Job, Options, Tail};
use std::fs::File;

/// Renders the suite and draws it to `assets/demo.png`.
pub(crate) fn run() -> Result<(), String> {
    draw().map_err(|error| error.to_string())
}

fn draw() -> sprung::Result<()> {
    let origin = "assets/midi/suite.mid";
    let file = File::open(root().join(origin)).map_err(|error| sprung::Error::io(origin, error))?;
    let mut song = Song::read(file, origin)?;
    song.select_by_bank();
    let kit = Preset::find("init")?.kit();
    let programs = Programs::factory_kits();
    let options = Options { sample_rate: 48_000, seed: 0, block: 1024, tail: Tail::Auto };
    let job = Job { programs: &programs, mix: Some(&Programs::general_midi().mix), ..Job::new(&song, &kit, options) };
    let (mut left, mut right) = (Vec::new(), Vec::new());
    job.render(|block_left, block_right| {
        left.extend(block_left);
        right.extend(block_right);
        Ok(())
    })?;
    let path = root().join("assets/demo.png");
    let render = Render { left: &left, right: &right, sample_rate: 48_000.0 };
    waveform_and_spectrogram(render, "suite.mid", &path)?;
    println!("{}", path.display());
    Ok(())
}
