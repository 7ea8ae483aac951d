//! A block for the audio thread: automation and a note in, samples out.

use super::{FRAMES, Vst3};
use std::ptr::null_mut;
use vst3::Steinberg::Vst::{
    AudioBusBuffers, AudioBusBuffers__type0, Event, Event_::EventTypes_, IAudioProcessorTrait, IEventList,
    IEventListTrait, IParamValueQueue, IParamValueQueueTrait, IParameterChanges, IParameterChangesTrait, NoteOnEvent,
    ParamID, ParamValue, ProcessData, ProcessModes_, SymbolicSampleSizes_,
};
use vst3::Steinberg::{kInvalidArgument, kNotImplemented, kResultOk, tresult};
use vst3::{Class, ComPtr, ComWrapper};

/// The points of one parameter in a block.
struct Queue {
    id: ParamID,
    points: Vec<(i32, ParamValue)>,
}

impl Class for Queue {
    type Interfaces = (IParamValueQueue,);
}

impl IParamValueQueueTrait for Queue {
    unsafe fn getParameterId(&self) -> ParamID {
        self.id
    }

    unsafe fn getPointCount(&self) -> i32 {
        self.points.len() as i32
    }

    unsafe fn getPoint(&self, index: i32, frame: *mut i32, value: *mut ParamValue) -> tresult {
        let Some(point) = usize::try_from(index).ok().and_then(|index| self.points.get(index)) else {
            return kInvalidArgument;
        };
        // SAFETY: the caller provides memory for both.
        unsafe { (*frame, *value) = *point };
        kResultOk
    }

    unsafe fn addPoint(&self, _: i32, _: ParamValue, _: *mut i32) -> tresult {
        kNotImplemented
    }
}

/// The automation of a block: several parameters, each with its points.
pub(crate) struct Automation(Vec<ComPtr<IParamValueQueue>>);

impl Automation {
    /// Two points for each parameter, at the first and the middle frame. Its position changes with every point.
    pub(crate) fn of(parameters: &[ParamID], block: usize) -> Self {
        let queue = |(index, id): (usize, &ParamID)| {
            let value = |step: usize| ((block * 2 + step + index) % 97) as f64 / 96.0;
            let points = vec![(0, value(0)), (FRAMES as i32 / 2, value(1))];
            ComWrapper::new(Queue { id: *id, points }).to_com_ptr::<IParamValueQueue>().unwrap()
        };
        Self(parameters.iter().enumerate().map(queue).collect())
    }
}

impl Class for Automation {
    type Interfaces = (IParameterChanges,);
}

impl IParameterChangesTrait for Automation {
    unsafe fn getParameterCount(&self) -> i32 {
        self.0.len() as i32
    }

    unsafe fn getParameterData(&self, index: i32) -> *mut IParamValueQueue {
        usize::try_from(index).ok().and_then(|index| self.0.get(index)).map_or(null_mut(), ComPtr::as_ptr)
    }

    unsafe fn addParameterData(&self, _: *const ParamID, _: *mut i32) -> *mut IParamValueQueue {
        null_mut()
    }
}

/// A note that starts at the first frame of the block.
struct Note(i16);

impl Class for Note {
    type Interfaces = (IEventList,);
}

impl IEventListTrait for Note {
    unsafe fn getEventCount(&self) -> i32 {
        1
    }

    unsafe fn getEvent(&self, index: i32, event: *mut Event) -> tresult {
        if index != 0 {
            return kInvalidArgument;
        }
        let note = NoteOnEvent { channel: 0, pitch: self.0, tuning: 0.0, velocity: 0.8, length: 0, noteId: -1 };
        // SAFETY: all zeros are a valid value of the type, and the caller provides memory for it.
        unsafe {
            *event = std::mem::zeroed();
            (*event).r#type = EventTypes_::kNoteOnEvent as u16;
            (*event).__field0.noteOn = note;
        }
        kResultOk
    }

    unsafe fn addEvent(&self, _: *mut Event) -> tresult {
        kNotImplemented
    }
}

/// The samples of a processed block, left and right.
pub(crate) struct Block(pub(crate) [[f32; FRAMES]; 2]);

impl Block {
    /// Makes the plugin process a block.
    pub(crate) fn process(plugin: &Vst3, automation: Automation, key: Option<i16>) -> Self {
        let mut samples = [[0.0; FRAMES]; 2];
        let mut channels = samples.each_mut().map(|channel| channel.as_mut_ptr());
        let mut output = AudioBusBuffers {
            numChannels: 2,
            silenceFlags: 0,
            __field0: AudioBusBuffers__type0 { channelBuffers32: channels.as_mut_ptr() },
        };
        let changes = ComWrapper::new(automation).to_com_ptr::<IParameterChanges>().unwrap();
        let notes = key.map(|key| ComWrapper::new(Note(key)).to_com_ptr::<IEventList>().unwrap());
        let mut data = ProcessData {
            processMode: ProcessModes_::kRealtime as i32,
            symbolicSampleSize: SymbolicSampleSizes_::kSample32 as i32,
            numSamples: FRAMES as i32,
            numInputs: 0,
            numOutputs: 1,
            inputs: null_mut(),
            outputs: &raw mut output,
            inputParameterChanges: changes.as_ptr(),
            outputParameterChanges: null_mut(),
            inputEvents: notes.as_ref().map_or(null_mut(), ComPtr::as_ptr),
            outputEvents: null_mut(),
            processContext: null_mut(),
        };
        // SAFETY: everything that is pointed to lives until the call returns.
        assert_eq!(unsafe { plugin.processor.process(&raw mut data) }, kResultOk);
        Self(samples)
    }
}
