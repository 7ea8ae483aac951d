//! Turns WAV files of integers into FLAC files.

use super::file_format::{FileFormat, HIGHEST_RATE, check_wav_length};
use super::output::Output;
use crate::error::{Error, Result};
use flacenc::bitsink::ByteSink;
use flacenc::component::{BitRepr, Stream};
use flacenc::config::{Encoder, OrderSel};
use flacenc::error::{Verified, Verify};
use flacenc::source::{Context, Fill, FrameBuf};
use std::fs::File;
use std::io::{BufReader, BufWriter, Seek, SeekFrom, Write};

/// Frames per block.
const BLOCK: usize = 4096;

/// Lets `write` write a WAV file into `output`, or for FLAC what [`encode`] makes of that file. `output` need not be seekable.
///
/// # Errors
/// Those of `write`; for FLAC [`Error::Value`] for floats and for rates above 96 kHz, [`Error::Io`].
pub fn write_as<T>(format: FileFormat, output: &mut Output, write: impl FnOnce(&mut Output) -> Result<T>) -> Result<T> {
    match format {
        FileFormat::Wav => write(output),
        FileFormat::Flac => through_wav(output, write),
    }
}

/// Lets `write` write a WAV file that never gets a name, and encodes it into `output`.
fn through_wav<T>(output: &mut Output, write: impl FnOnce(&mut Output) -> Result<T>) -> Result<T> {
    let mut wav = output.scratch()?;
    let written = write(&mut wav)?;
    let name = output.name().to_owned();
    if output.is_seekable() {
        encode(wav.stream(), output.stream(), &name)?;
        return Ok(written);
    }
    // The header has the length and a checksum of all samples, so it is written last.
    let mut whole = output.scratch()?;
    encode(wav.stream(), whole.stream(), &name)?;
    let copied = whole.stream().seek(SeekFrom::Start(0)).and_then(|_| std::io::copy(whole.stream(), output.stream()));
    copied.map(|_| written).map_err(|source| Error::io(name, source))
}

/// Encodes the WAV file `wav`, of 16- or 24-bit integers and less than 4 GiB, into the empty file `out`. `name` is used
/// in errors. The samples decode unchanged. The same WAV gives the same bytes on every machine: predictors are fixed
/// and chosen by counting bits, so no floating point takes part. Memory use does not grow with the length.
///
/// # Errors
/// [`Error::Value`] for floats, for rates above 96 kHz and for longer files, [`Error::Io`] if reading or writing fails.
pub fn encode(wav: &mut File, out: &mut File, name: &str) -> Result<()> {
    let failed = |source| Error::io(name, source);
    check_wav_length(wav.seek(SeekFrom::End(0)).map_err(failed)?)?;
    wav.seek(SeekFrom::Start(0)).map_err(failed)?;
    let reader = hound::WavReader::new(BufReader::new(wav)).map_err(|error| wrong(name, error))?;
    let hound::WavSpec { channels, sample_rate, bits_per_sample, sample_format } = reader.spec();
    if sample_format == hound::SampleFormat::Float {
        return Err(Error::value(name, "FLAC has no floats: expected 16 or 24 bits"));
    }
    if sample_rate > HIGHEST_RATE {
        return Err(Error::value(
            name,
            format!("{sample_rate} Hz is too high for FLAC: expected at most {HIGHEST_RATE} Hz"),
        ));
    }
    let (channels, bits) = (usize::from(channels), usize::from(bits_per_sample));
    let config = config().map_err(|error| wrong(name, error))?;
    let mut stream = Stream::new(sample_rate as usize, channels, bits).map_err(|error| wrong(name, error))?;
    stream.stream_info_mut().set_block_sizes(BLOCK, BLOCK).map_err(|error| wrong(name, error))?;
    let header = |stream: &Stream| {
        let mut sink = ByteSink::new();
        stream.write(&mut sink).map(|()| sink).map_err(|error| wrong(name, error))
    };

    let mut out = BufWriter::new(out);
    out.write_all(header(&stream)?.as_slice()).map_err(failed)?;
    let mut samples = reader.into_samples::<i32>();
    let mut block = FrameBuf::with_size(channels, BLOCK).map_err(|error| wrong(name, error))?;
    let mut context = Context::new(bits, channels);
    let mut interleaved = Vec::with_capacity(BLOCK * channels);
    loop {
        interleaved.clear();
        for sample in samples.by_ref().take(BLOCK * channels) {
            interleaved.push(sample.map_err(|error| wrong(name, error))?);
        }
        if interleaved.is_empty() {
            break;
        }
        context.fill_interleaved(&interleaved).map_err(|error| wrong(name, error))?;
        block.fill_interleaved(&interleaved).map_err(|error| wrong(name, error))?;
        let number = context.current_frame_number().unwrap_or(0);
        let frame = flacenc::encode_fixed_size_frame(&config, &block, number, stream.stream_info());
        let frame = frame.map_err(|error| wrong(name, error))?;
        let mut sink = ByteSink::new();
        frame.write(&mut sink).map_err(|error| wrong(name, error))?;
        out.write_all(sink.as_slice()).map_err(failed)?;
        stream.stream_info_mut().update_frame_info(&frame);
    }
    let info = stream.stream_info_mut();
    // All blocks but the last have this length. A shorter last block does not count.
    info.set_block_sizes(BLOCK, BLOCK).map_err(|error| wrong(name, error))?;
    info.set_md5_digest(&context.md5_digest());
    info.set_total_samples(context.total_samples());
    out.seek(SeekFrom::Start(0)).map_err(failed)?;
    out.write_all(header(&stream)?.as_slice()).map_err(failed)?;
    out.flush().map_err(failed)
}

fn config() -> std::result::Result<Verified<Encoder>, impl std::fmt::Display> {
    let mut config = Encoder::default();
    config.subframe_coding.use_lpc = false;
    config.subframe_coding.fixed.order_sel = OrderSel::BitCount;
    config.into_verified().map_err(|(_, error)| error)
}

fn wrong(name: &str, error: impl std::fmt::Display) -> Error {
    Error::io(name, std::io::Error::other(error.to_string()))
}
