//! Chooses the sound device, its sample rate and block size, and lists the available devices.

use crate::error::{Error, Result, nearest};
use cpal::traits::{DeviceTrait, HostTrait};
use cpal::{BufferSize, HostId, SampleFormat, StreamConfig, SupportedBufferSize, SupportedStreamConfigRange};
use std::fmt::Write;

/// Default sample rates: the first one that the device supports is used.
const USUAL_RATES: [u32; 4] = [48_000, 44_100, 96_000, 88_200];

/// Sample rates offered to the user, if the device supports them.
const OFFERED_RATES: [u32; 6] = [44_100, 48_000, 88_200, 96_000, 176_400, 192_000];

/// Default block size in frames: 5 ms at 48 kHz, which players do not notice.
const USUAL_BLOCK: u32 = 256;

/// Supported sample formats, best first.
const FORMATS: [SampleFormat; 4] = [SampleFormat::F32, SampleFormat::I32, SampleFormat::I16, SampleFormat::U8];

/// Maximum number of channels of a device.
const MAX_CHANNELS: u16 = 8;

/// The user's choice. Fields without a value are chosen automatically.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Choice {
    /// The audio system: `alsa`, `jack` and others, depending on the platform.
    pub host: Option<String>,
    /// The device, by its name or a part of it.
    pub device: Option<String>,
    /// Frames per second.
    pub rate: Option<u32>,
    /// Frames per block.
    pub buffer: Option<u32>,
}

/// A device, and the stream settings to use on it.
pub struct Found {
    pub(super) device: cpal::Device,
    pub(super) config: StreamConfig,
    pub(super) format: SampleFormat,
    host: HostId,
    name: String,
    rates: Vec<u32>,
}

impl Found {
    /// Finds the device that the user chose, or the default one, and stream settings for it.
    ///
    /// # Errors
    /// [`Error::Value`] if there is no such host or device, no device at all, or no settings as chosen.
    pub fn find(choice: &Choice) -> Result<Self> {
        let id = host_id(choice.host.as_deref())?;
        let host = open_host(id)?;
        let (device, name) = match &choice.device {
            Some(wanted) => named(&host, id, wanted)?,
            None => {
                host.default_output_device().map(|device| (device, "default".to_owned())).ok_or_else(|| none(id, ""))?
            }
        };
        let ranges = device.supported_output_configs();
        let ranges: Vec<_> = match ranges {
            Ok(ranges) => ranges.collect(),
            Err(error) if choice.device.is_none() => return Err(none(id, &format!(" ({error})"))),
            Err(error) => return Err(Error::value("--device", format!("‘{name}’ cannot be used: {error}"))),
        };
        let (range, rate) = choose(&ranges, choice.rate, &name)?;
        let config = StreamConfig {
            channels: range.channels(),
            sample_rate: rate,
            buffer_size: BufferSize::Fixed(block(range.buffer_size(), choice.buffer, &name)?),
        };
        let has = |rate: &u32| choose(&ranges, Some(*rate), &name).is_ok();
        let rates = OFFERED_RATES.into_iter().filter(has).collect();
        Ok(Self { device, config, format: range.sample_format(), host: id, name, rates })
    }

    /// The sample rates to offer for this device, in Hz.
    pub(crate) fn rates(&self) -> &[u32] {
        &self.rates
    }

    /// Frames per second.
    pub fn sample_rate(&self) -> u32 {
        self.config.sample_rate
    }

    /// Whether the device belongs to a JACK server.
    pub fn is_jack(&self) -> bool {
        self.host.name().eq_ignore_ascii_case("jack")
    }
}

impl std::fmt::Display for Found {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let StreamConfig { channels, sample_rate, .. } = self.config;
        let (host, name, format) = (self.host.name(), &self.name, self.format);
        write!(f, "{host} ‘{name}’, {sample_rate} Hz, {channels} × {format}")
    }
}

/// The hosts of this system and their devices, as text.
pub fn list() -> String {
    let mut out = String::new();
    for id in cpal::available_hosts() {
        let _ = writeln!(out, "--host {}", id.name().to_lowercase());
        let Ok(host) = open_host(id) else {
            out += "  not available\n";
            continue;
        };
        let devices = devices(&host);
        if devices.is_empty() {
            out += if id.name() == "JACK" { "  no server is running\n" } else { "  no devices\n" };
        }
        for (_, id, description) in devices {
            let _ = writeln!(out, "  --device {id:?}  {description}");
        }
    }
    out
}

/// A device to play on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Output {
    /// The audio system, as in [`Choice::host`].
    pub host: String,
    /// The device, as in [`Choice::device`].
    pub id: String,
    /// A name of the device for the user.
    pub description: String,
}

/// The devices of all audio systems that can be used now. May take some tenths of a second.
pub fn outputs() -> Vec<Output> {
    let of = |id: HostId| {
        let devices = open_host(id).map(|host| devices(&host)).unwrap_or_default();
        let host = id.name().to_lowercase();
        devices.into_iter().map(move |(_, id, description)| Output { host: host.clone(), id, description })
    };
    cpal::available_hosts().into_iter().flat_map(of).collect()
}

/// Stops ALSA's library from printing its errors to stderr on this thread. They are returned as errors anyway.
pub fn silence_library() {
    #[cfg(target_os = "linux")]
    drop(alsa::Output::local_error_handler());
}

fn host_id(name: Option<&str>) -> Result<HostId> {
    let Some(name) = name else { return Ok(cpal::default_host().id()) };
    name.parse().map_err(|_| {
        let hosts: Vec<_> = cpal::ALL_HOSTS.iter().map(|id| id.name().to_lowercase()).collect();
        Error::value("--host", format!("there is no ‘{name}’ here: expected {}", hosts.join(" or ")))
    })
}

fn open_host(id: HostId) -> Result<cpal::Host> {
    cpal::host_from_id(id).map_err(|error| Error::value("--host", format!("{} cannot be used: {error}", id.name())))
}

/// The output devices: each with its identifier and a description.
fn devices(host: &cpal::Host) -> Vec<(cpal::Device, String, String)> {
    let outputs = host.devices().into_iter().flatten().filter(DeviceTrait::supports_output);
    outputs
        .filter_map(|device| {
            let id = device.id().ok()?.id().to_owned();
            let description = device.description().map(|text| text.name().to_owned()).unwrap_or_default();
            Some((device, id, description))
        })
        .collect()
}

/// The device whose identifier or description is `wanted`, or else the only one whose identifier or description
/// contains it.
fn named(host: &cpal::Host, id: HostId, wanted: &str) -> Result<(cpal::Device, String)> {
    let mut devices = devices(host);
    let lower = wanted.to_lowercase();
    let equal = |text: &str| text.eq_ignore_ascii_case(wanted);
    let exact = devices.iter().position(|(_, name, description)| equal(name) || equal(description));
    let index = exact.or_else(|| {
        let has = |text: &str| text.to_lowercase().contains(&lower);
        let mut with = devices.iter().enumerate().filter(|(_, (_, name, text))| has(name) || has(text));
        with.next().filter(|_| with.next().is_none()).map(|(index, _)| index)
    });
    if let Some(index) = index {
        let (device, name, _) = devices.swap_remove(index);
        return Ok((device, name));
    }
    let hint = match nearest(wanted, devices.iter().map(|(_, name, _)| name.as_str())) {
        Some(near) => format!("the nearest is {near}; ‘--list’ shows them all"),
        None => "‘--list’ shows them all".to_owned(),
    };
    Err(Error::value("--device", format!("{} has no device ‘{wanted}’, or several; {hint}", id.name())))
}

fn none(id: HostId, reason: &str) -> Error {
    let host = id.name();
    let server = if host == "JACK" { "no JACK server is running" } else { "there is no sound device to play on" };
    let advice = "‘--list’ shows what there is";
    Error::value("--device", format!("{server}: {host} has none{reason}; {advice}"))
}

/// The best settings: two channels, otherwise one, otherwise as few as possible; then the sample format with the finest
/// steps.
fn choose(
    ranges: &[SupportedStreamConfigRange],
    rate: Option<u32>,
    name: &str,
) -> Result<(SupportedStreamConfigRange, u32)> {
    let rank = |range: &SupportedStreamConfigRange| {
        let format = FORMATS.iter().position(|format| *format == range.sample_format())?;
        let channels = match range.channels() {
            2 => 0,
            channels @ (1 | 3..=MAX_CHANNELS) => channels,
            _ => return None,
        };
        Some((channels, format))
    };
    let mut usable: Vec<_> = ranges.iter().filter(|range| rank(range).is_some()).collect();
    usable.sort_by_key(|range| rank(range));
    let with_rate = |rate: u32| {
        let range = usable.iter().find(|range| (range.min_sample_rate()..=range.max_sample_rate()).contains(&rate));
        range.map(|range| (**range, rate))
    };
    match rate {
        Some(rate) => with_rate(rate).ok_or_else(|| {
            let rates: std::collections::BTreeSet<_> =
                usable.iter().map(|range| (range.min_sample_rate(), range.max_sample_rate())).collect();
            let rates: Vec<_> = rates
                .iter()
                .map(|(low, high)| if low == high { low.to_string() } else { format!("{low} to {high}") })
                .collect();
            let message = format!("‘{name}’ does not run at {rate} Hz: expected {} Hz", rates.join(", "));
            Error::value("--rate", message)
        }),
        None => {
            let engine = crate::render::SAMPLE_RATES;
            let any = usable.iter().map(|range| range.max_sample_rate().min(*engine.end()));
            let rates = USUAL_RATES.into_iter().chain(any.filter(|rate| engine.contains(rate)));
            rates.into_iter().find_map(with_rate).ok_or_else(|| {
                let formats = "floats, 32- or 16-bit integers or 8-bit unsigned ones, on 1 to 8 channels";
                Error::value("--device", format!("‘{name}’ cannot be played on: expected one that takes {formats}"))
            })
        }
    }
}

fn block(supported: &SupportedBufferSize, wanted: Option<u32>, name: &str) -> Result<u32> {
    match (*supported, wanted) {
        (SupportedBufferSize::Range { min, max }, Some(wanted)) if !(min..=max).contains(&wanted) => {
            let range = if min == max { min.to_string() } else { format!("{min} to {max}") };
            Err(Error::value("--buffer", format!("‘{name}’ has no blocks of {wanted} frames: expected {range}")))
        }
        (_, Some(wanted)) => Ok(wanted),
        (SupportedBufferSize::Range { min, max }, None) => Ok(USUAL_BLOCK.clamp(min, max.max(min))),
        (SupportedBufferSize::Unknown, None) => Ok(USUAL_BLOCK),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(channels: u16, rates: (u32, u32), format: SampleFormat) -> SupportedStreamConfigRange {
        let size = SupportedBufferSize::Range { min: 64, max: 1024 };
        SupportedStreamConfigRange::new(channels, rates.0, rates.1, size, format)
    }

    #[test]
    fn stereo_and_fine_steps_come_first() {
        use SampleFormat::{F32, I16, I32, U8, U64};
        let rates = (44_100, 48_000);
        for (ranges, expected) in [
            (&[range(1, rates, F32), range(2, rates, U8), range(2, rates, I16)][..], (2, I16, 48_000)),
            (&[range(6, rates, F32), range(4, rates, I32)], (4, I32, 48_000)),
            (&[range(2, rates, U64), range(1, (44_100, 44_100), I16)], (1, I16, 44_100)),
            (&[range(2, (22_050, 22_050), F32)], (2, F32, 22_050)),
        ] {
            let (range, rate) = choose(ranges, None, "x").unwrap();
            assert_eq!((range.channels(), range.sample_format(), rate), expected);
        }
        assert!(choose(&[range(2, rates, U64), range(9, rates, F32)], None, "x").is_err());
    }

    #[test]
    fn what_a_device_cannot_do_is_refused_with_what_it_can() {
        let ranges = [range(2, (44_100, 44_100), SampleFormat::F32), range(2, (48_000, 96_000), SampleFormat::F32)];
        assert_eq!(choose(&ranges, Some(96_000), "x").unwrap().1, 96_000);
        let error = choose(&ranges, Some(22_050), "x").unwrap_err().to_string();
        assert_eq!(error, "--rate: ‘x’ does not run at 22050 Hz: expected 44100, 48000 to 96000 Hz");
        let size = SupportedBufferSize::Range { min: 64, max: 128 };
        assert_eq!((block(&size, Some(100), "x").unwrap(), block(&size, None, "x").unwrap()), (100, 128));
        let error = block(&size, Some(32), "x").unwrap_err().to_string();
        assert_eq!(error, "--buffer: ‘x’ has no blocks of 32 frames: expected 64 to 128");
    }

    #[test]
    fn an_unknown_host_names_those_there_are() {
        let error = host_id(Some("tape")).unwrap_err().to_string();
        assert!(error.starts_with("--host: there is no ‘tape’ here: expected "), "{error}");
    }
}
