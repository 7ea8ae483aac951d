//! The stems of a song, each a sound of its own: channels, the pads or choke groups of kits, and the shared space.
//!
//! A channel that plays a kit is divided into its pads, before the channel's effects, and the rest: what the effects add, and notes
//! of single sounds. So all stems together are the mix before the limiter, whatever the effects do.

use super::job::{Job, Rendered};
use super::wav::{Delivery, Level, Mix, Progress};
use crate::engine::{EventKind, Owners, PadGroup, Stems};
use crate::error::{Error, Result};
use crate::io::{Output, WavFormat, WavWriter};
use crate::params::Param;
use crate::sound::Kit;
use crate::text::{shortened, slug};
use crate::units::gain_from_db;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// What all stems together may lack of the mix, −120 dBFS. The rest of a channel and the shared space are no stems of their own if they
/// stay below their shares of it.
const INAUDIBLE: f32 = 1e-6;

/// Most characters of a stem's name that come from names of sounds.
const NAME_LENGTH: usize = 40;

/// What a stem has of the mix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Content {
    /// All of a channel.
    Channel(u8),
    /// Pads of a channel's kits.
    Pads(u8, PadGroup),
    /// What a channel has beside its kits' pads.
    Rest(u8),
    /// The shared space.
    Space,
}

/// A stem of a song.
#[derive(Clone, Debug)]
pub struct Stem {
    /// Its name, for a file: the channel's number, for pads the lowest key, and the names of the sounds.
    pub name: String,
    content: Content,
}

/// Figures of stems that were written.
#[derive(Clone, Debug, PartialEq)]
pub struct StemsReport {
    /// What was rendered.
    pub rendered: Rendered,
    /// For each stem, whether it belongs to the result. The rest of a channel and the space do only if they sound.
    pub is_wanted: Vec<bool>,
    /// Number of samples beyond full scale, which an integer format clips.
    pub clipped: u64,
}

/// The stems of a job, in the order of channels and keys.
pub fn stems_of(job: &Job) -> Vec<Stem> {
    let mut playing: [&Arc<Kit>; 16] = [job.kit; 16];
    job.channels.iter().for_each(|(channel, kit)| playing[usize::from((*channel).min(15))] = kit);
    let mut owners = Owners::default();
    let mut channels = BTreeMap::<u8, String>::new();
    let mut pads = BTreeMap::<(u8, PadGroup), BTreeMap<u8, String>>::new();
    for event in &job.song.events {
        owners.hear(&event.at(0));
        let owner = owners.of(event.channel.min(15));
        match event.kind {
            EventKind::Program(number) if owner == event.channel => {
                if let Some(kit) = job.programs.get(usize::from(number)) {
                    playing[usize::from(owner)] = kit;
                }
            }
            EventKind::NoteOn { key, .. } if event.seconds >= job.from => {
                let kit = playing[usize::from(owner)];
                channels.entry(owner).or_insert_with(|| kit.name().to_owned());
                let Some(pad) = kit.pad(key) else { continue };
                let choke = kit.choke(pad, kit.values().get(Param::Choke));
                if let Some(group) = PadGroup::of(kit, key, choke) {
                    pads.entry((owner, group)).or_default().entry(key).or_insert_with(|| pad.name.clone());
                }
            }
            _ => {}
        }
    }
    let divided: BTreeSet<u8> = pads.keys().map(|(channel, _)| *channel).collect();
    let mut stems = Vec::new();
    for (channel, name) in &channels {
        let number = format!("{:02}", channel + 1);
        if !divided.contains(channel) {
            stems.push(Stem { name: named(&number, [name.as_str()]), content: Content::Channel(*channel) });
            continue;
        }
        let own = pads.range((*channel, PadGroup::Choke(0))..).take_while(|((other, _), _)| other == channel);
        let mut own: Vec<_> = own.collect();
        own.sort_by_key(|(_, names)| names.keys().next().copied());
        for ((_, group), names) in own {
            let key = names.keys().next().copied().unwrap_or_default();
            let names = names.values().map(String::as_str);
            stems.push(Stem {
                name: named(&format!("{number}-{key:03}"), names),
                content: Content::Pads(*channel, *group),
            });
        }
        stems.push(Stem { name: format!("{number}-effects"), content: Content::Rest(*channel) });
    }
    if job.mix.is_some_and(|mix| !mix.space.is_empty()) {
        stems.push(Stem { name: "space".to_owned(), content: Content::Space });
    }
    let mut taken = BTreeSet::new();
    for stem in &mut stems {
        let mut name = stem.name.clone();
        let mut number = 2;
        while !taken.insert(name.clone()) {
            name = format!("{}-{number}", stem.name);
            number += 1;
        }
        stem.name = name;
    }
    stems
}

/// A name that begins with a number.
fn named<'a>(number: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    let slug = shortened(slug(&names.into_iter().collect::<Vec<_>>().join("-")), NAME_LENGTH);
    if slug.is_empty() { number.to_owned() } else { format!("{number}-{slug}") }
}

/// Renders a job into one WAV file for each of its `stems`. All have the length of the whole rendering. `progress` is called after
/// each block and can end the work by returning an error.
///
/// # Errors
/// [`Error::Value`] if an option is out of range, or if a level depends on the sound: stems that are scaled each by itself do not add
/// up; [`Error::Io`]; and the errors of `progress`.
pub fn to_stem_wavs(
    job: &Job,
    delivery: &Delivery,
    stems: &[Stem],
    outputs: &mut [Output],
    mut progress: impl FnMut(Progress) -> Result<()>,
) -> Result<StemsReport> {
    let Level::Gain(gain_db) = delivery.level else {
        return Err(Error::value("--normalize", "stems add up to the mix only as they are: expected --mix-gain-db"));
    };
    let channels = if delivery.mono { 1 } else { 2 };
    let format = WavFormat { sample_rate: job.options.sample_rate, channels, samples: delivery.samples };
    let expected = job.least_frames();
    if let Some(first) = outputs.first() {
        first.check_room(format.file_len(expected)?.saturating_mul(stems.len() as u64))?;
    }
    let mut mix = Mix::new(delivery.mono, gain_from_db(gain_db));
    let mut writers = Vec::with_capacity(stems.len());
    for (output, number) in outputs.iter_mut().zip(0..) {
        // Each has noise of its own, so that the noise of all does not add up in phase.
        let dither = delivery.dither.then(|| job.options.seed.wrapping_add(number));
        let name = output.name().to_owned();
        writers.push(WavWriter::new(output.stream(), &name, format, dither, None)?);
    }
    let mut peaks = vec![0.0_f32; stems.len()];
    let (mut sound, mut done) = ([Vec::new(), Vec::new()], 0);
    let in_all = expected.saturating_add(job.first_frame());
    let rendered = job.render_stems(|block, frames| {
        for ((stem, writer), peak) in stems.iter().zip(&mut writers).zip(&mut peaks) {
            let Some(block) = block else { break };
            stem.content.read(block, frames, stems, &mut sound);
            let (left, right) = mix.apply(&sound[0], &sound[1]);
            *peak = left.iter().chain(right).fold(*peak, |peak, sample| peak.max(sample.abs()));
            writer.write(left, right)?;
        }
        done += job.counted(frames);
        progress(Progress { frames: done, expected: in_all.max(done) })
    })?;
    let clipped = writers.iter().map(WavWriter::clipped).sum();
    writers.into_iter().try_for_each(WavWriter::finish)?;
    let is_optional = |stem: &Stem| matches!(stem.content, Content::Rest(_) | Content::Space);
    let share = INAUDIBLE / stems.iter().filter(|stem| is_optional(stem)).count().max(1) as f32;
    let is_wanted = |(stem, peak): (&Stem, &f32)| !is_optional(stem) || *peak > share;
    Ok(StemsReport { rendered, is_wanted: stems.iter().zip(&peaks).map(is_wanted).collect(), clipped })
}

impl Content {
    /// Reads its sound in a block of so many frames.
    fn read(self, block: &Stems, frames: usize, stems: &[Stem], sound: &mut [Vec<f32>; 2]) {
        let whole = match self {
            Self::Channel(channel) | Self::Rest(channel) => block.channel(channel),
            Self::Pads(channel, group) => block.pads(channel, group),
            Self::Space => block.space(),
        };
        for (sound, whole) in sound.iter_mut().zip(whole) {
            sound.clear();
            sound.extend_from_slice(whole);
            sound.resize(frames, 0.0);
        }
        let Self::Rest(channel) = self else { return };
        for stem in stems {
            let Self::Pads(of, group) = stem.content else { continue };
            if of == channel {
                for (sound, pads) in sound.iter_mut().zip(block.pads(channel, group)) {
                    sound.iter_mut().zip(pads).for_each(|(sound, pads)| *sound -= pads);
                }
            }
        }
    }
}
