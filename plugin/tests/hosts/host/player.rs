//! An instance that is processing: receives events, returns audio and ended notes, in blocks of any size.

use super::Timed;
use super::calls::Host;
use super::event::Address;
use super::instance::Instance;
use clack_extensions::audio_ports::{AudioPortInfoBuffer, PluginAudioPorts};
use clack_extensions::tail::{PluginTail, TailLength};
use clack_host::events::event_types::{NoteEndEvent, ParamValueEvent};
use clack_host::events::io::{OutputEventBuffer, TryPushError};
use clack_host::prelude::*;

/// A note that the plugin has reported as ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Ended {
    /// Frames since the start of the song.
    pub(crate) frame: u64,
    pub(crate) note: Address,
}

/// The result of playing a song.
#[derive(Debug, Default)]
pub(crate) struct Rendered {
    /// One vector of samples for each output channel.
    pub(crate) channels: Vec<Vec<f32>>,
    pub(crate) ended: Vec<Ended>,
    /// The values of parameters that the plugin has told, with their frames.
    pub(crate) values: Vec<(u64, ClapId, f64)>,
    /// Whether nothing was told before something of an earlier frame.
    pub(crate) is_in_order: bool,
}

/// The audio part of an instance. It may move to another thread.
pub(crate) struct Audio {
    processor: StartedPluginAudioProcessor<Host>,
    inputs: Vec<Vec<f32>>,
    outputs: Vec<Vec<f32>>,
    input_ports: AudioPorts,
    output_ports: AudioPorts,
    /// Channels of each output port.
    width: usize,
    /// Samples for all input channels from the first frame on, followed by silence. If empty, the input buffers stay as they are.
    incoming: Vec<f32>,
    /// Whether the input is passed in the memory of the output.
    in_place: bool,
    sent_back: Ends,
    /// Frames since processing started.
    clock: u64,
}

/// An instance and its audio part, on one thread.
pub(crate) struct Player {
    pub(crate) instance: Instance,
    pub(crate) audio: Audio,
}

/// Stores the plugin's NOTE_END events and values of parameters up to its capacity, without allocating.
struct Ends {
    notes: Vec<(u32, Address)>,
    values: Vec<(u32, ClapId, f64)>,
    /// The latest frame of the block that was told, and whether none was told after a later one.
    latest: u32,
    is_in_order: bool,
}

impl OutputEventBuffer for Ends {
    fn try_push(&mut self, event: &UnknownEvent) -> Result<(), TryPushError> {
        let time = event.header().time();
        self.is_in_order &= time >= std::mem::replace(&mut self.latest, time);
        if let Some(value) = event.as_event::<ParamValueEvent>()
            && let Some(id) = value.param_id()
            && self.values.len() < self.values.capacity()
        {
            self.values.push((time, id, value.value()));
        }
        let Some(end) = event.as_event::<NoteEndEvent>() else { return Ok(()) };
        if self.notes.len() == self.notes.capacity() {
            return Err(TryPushError::new());
        }
        self.notes.push((time, end.pckn().into()));
        Ok(())
    }
}

impl Instance {
    /// Activates the plugin and starts processing.
    pub(crate) fn play(self, sample_rate: f64, max_block: u32) -> Player {
        Player::new(self, sample_rate, max_block)
    }
}

impl Player {
    /// Activates an instance for blocks of up to `max_block` frames and starts processing.
    pub(crate) fn new(mut instance: Instance, sample_rate: f64, max_block: u32) -> Self {
        let audio = Audio::new(&mut instance, sample_rate, max_block);
        Self { instance, audio }
    }

    /// Stops processing, deactivates the instance and returns it.
    pub(crate) fn stop(mut self) -> Instance {
        self.instance.clack.deactivate(self.audio.processor.stop_processing());
        self.instance
    }

    /// Plays `frames` frames of a song in blocks whose lengths `block` returns.
    pub(crate) fn render(&mut self, song: &[Timed], frames: usize, mut block: impl FnMut() -> usize) -> Rendered {
        let mut rendered =
            Rendered { channels: vec![Vec::new(); self.audio.outputs.len()], is_in_order: true, ..Rendered::default() };
        let mut events = EventBuffer::new();
        let (mut start, mut next) = (0, 0);
        while start < frames {
            let len = block().min(frames - start).min(self.audio.max_block());
            events.clear();
            while let Some(timed) = song.get(next).filter(|timed| timed.frame < (start + len) as u64) {
                timed.sent.push((timed.frame - start as u64) as u32, &mut events);
                next += 1;
            }
            self.audio.process(&events, len);
            for (channel, output) in rendered.channels.iter_mut().zip(&self.audio.outputs) {
                channel.extend(&output[..len]);
            }
            let (back, at) = (&self.audio.sent_back, |time: u32| start as u64 + u64::from(time));
            rendered.ended.extend(back.notes.iter().map(|&(time, note)| Ended { frame: at(time), note }));
            rendered.values.extend(back.values.iter().map(|&(time, id, value)| (at(time), id, value)));
            rendered.is_in_order &= back.is_in_order;
            start += len;
            self.instance.run_callbacks();
        }
        rendered
    }
}

impl Audio {
    fn new(instance: &mut Instance, sample_rate: f64, max_block: u32) -> Self {
        let channels = |instance: &mut Instance, is_input: bool| -> Vec<u32> {
            let handle = instance.clack.plugin_handle();
            let ports: PluginAudioPorts = handle.get_extension().expect("there are audio ports");
            let mut buffer = AudioPortInfoBuffer::new();
            (0..ports.count(&handle, is_input))
                .map(|index| ports.get(&handle, index, is_input, &mut buffer).expect("a known port").channel_count)
                .collect()
        };
        let (input_widths, output_widths) = (channels(instance, true), channels(instance, false));
        assert!(input_widths.len() <= 1, "one port comes in");
        let width = output_widths[0] as usize;
        assert!(output_widths.iter().all(|other| *other as usize == width), "all outputs are alike");
        let [inputs, outputs] = [&input_widths, &output_widths]
            .map(|widths| vec![vec![0.0; max_block as usize]; widths.iter().sum::<u32>() as usize]);
        let configuration = PluginAudioConfiguration { sample_rate, min_frames_count: 1, max_frames_count: max_block };
        let stopped = instance.clack.activate(|_, _| (), configuration).expect("the plugin can be activated");
        Self {
            processor: stopped.start_processing().expect("processing can start"),
            input_ports: AudioPorts::with_capacity(inputs.len(), 1),
            output_ports: AudioPorts::with_capacity(outputs.len(), output_widths.len()),
            width,
            inputs,
            outputs,
            incoming: Vec::new(),
            in_place: false,
            sent_back: Ends {
                notes: Vec::with_capacity(16_384),
                values: Vec::with_capacity(16_384),
                latest: 0,
                is_in_order: true,
            },
            clock: 0,
        }
    }

    /// From now on, the input has the memory of the output, which is filled with 0.9 before each block.
    pub(crate) fn work_in_place(&mut self) {
        assert_eq!(self.inputs.len(), self.outputs.len(), "in place, there are as many inputs as outputs");
        self.in_place = true;
    }

    /// Sets the samples for all channels of the input.
    pub(crate) fn feed(&mut self, incoming: Vec<f32>) {
        assert!(!self.inputs.is_empty(), "the layout has an input");
        self.incoming = incoming;
    }

    /// Fills the input bus with loud noise.
    pub(crate) fn feed_noise(&mut self) {
        for (channel, seed) in self.inputs.iter_mut().zip(1_u64..) {
            for (sample, n) in channel.iter_mut().zip(0..) {
                *sample = sprung::internals::random::uniform(seed, n);
            }
        }
    }

    pub(crate) fn outputs(&self) -> &[Vec<f32>] {
        &self.outputs
    }

    fn max_block(&self) -> usize {
        self.outputs[0].len()
    }

    /// Processes the next `frames` frames. Does not itself allocate.
    #[allow(unsafe_code)]
    pub(crate) fn process(&mut self, events: &EventBuffer, frames: usize) -> ProcessStatus {
        let back = &mut self.sent_back;
        (back.latest, back.is_in_order) = (0, true);
        back.notes.clear();
        back.values.clear();
        // Samples that the plugin does not write must be noticed.
        let unwritten = if self.in_place { 0.9 } else { f32::NAN };
        self.outputs.iter_mut().for_each(|channel| channel[..frames].fill(unwritten));
        if !self.incoming.is_empty() {
            let rest = self.incoming.get(self.clock as usize..).unwrap_or(&[]);
            for channel in &mut self.inputs {
                let now = frames.min(rest.len());
                channel[..now].copy_from_slice(&rest[..now]);
                channel[now..frames].fill(0.0);
            }
        }
        let mut outputs = self.output_ports.with_output_buffers(self.outputs.chunks_mut(self.width).map(move |port| {
            let channels = port.iter_mut().map(move |channel| &mut channel[..frames]);
            AudioPortBuffer { latency: 0, channels: AudioPortBufferType::f32_output_only(channels) }
        }));
        let (width, same_memory) = (self.width, [outputs.as_raw_buffers()[0]]);
        let inputs = if self.inputs.is_empty() {
            InputAudioBuffers::empty()
        } else if self.in_place {
            // SAFETY: the buffers are those of the output. They outlive this call and have `frames` frames.
            unsafe { InputAudioBuffers::from_raw_buffers(&same_memory, frames as u32) }
        } else {
            self.input_ports.with_input_buffers([AudioPortBuffer {
                latency: 0,
                channels: AudioPortBufferType::f32_input_only(
                    self.inputs.iter_mut().map(|channel| InputChannel::variable(&mut channel[..frames])),
                ),
            }])
        };
        let status = self.processor.process(
            &inputs,
            &mut outputs,
            &InputEvents::from_buffer(events),
            &mut OutputEvents::from_buffer(&mut self.sent_back),
            Some(self.clock),
            None,
        );
        let constant = outputs
            .as_raw_buffers()
            .iter()
            .zip((0..).step_by(width))
            .fold(0, |all, (port, first)| all | port.constant_mask << first);
        for (index, channel) in self.outputs.iter().enumerate() {
            let is_constant = channel[..frames].iter().all(|sample| sample.to_bits() == channel[0].to_bits());
            assert!(constant >> index & 1 == 0 || is_constant, "channel {index} is said to be constant, but is not");
        }
        self.clock += frames as u64;
        status.expect("processing succeeds")
    }

    /// The tail length that the plugin reports.
    pub(crate) fn tail(&mut self) -> TailLength {
        let handle = self.processor.plugin_handle();
        let tail: PluginTail = handle.get_extension().expect("there is a tail");
        tail.get(&handle)
    }

    /// Resets the plugin, as hosts do between songs.
    pub(crate) fn reset(&mut self) {
        self.processor.reset();
        self.clock = 0;
    }
}
