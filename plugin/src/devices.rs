//! Audio devices, sample rates and MIDI ports of the standalone program, for its window; a host chooses its own.

use crate::lock::lock;
use serde::{Deserialize, Serialize};
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Arc, Mutex};

/// The user's choices. A field without a value leaves the choice to the program.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Chosen {
    /// The audio system.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) host: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) device: Option<String>,
    /// Hz.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) rate: Option<u32>,
    /// Frames per block.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) buffer: Option<u32>,
    /// `all`, `none`, or a part of the name of a MIDI port. No value means `all`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) midi_in: Option<String>,
}

/// A device to play on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Output {
    pub(crate) host: String,
    pub(crate) id: String,
    pub(crate) description: String,
}

/// The devices and ports that exist, and those in use.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Devices {
    pub(crate) outputs: Vec<Output>,
    /// Sample rates that the chosen device has, in Hz.
    pub(crate) rates: Vec<u32>,
    pub(crate) ports: Vec<String>,
    pub(crate) chosen: Chosen,
    /// Frames of the blocks that the device takes; 0 before the first.
    pub(crate) block: u32,
    /// The device in use with its settings, as text for the user.
    pub(crate) playing: String,
}

/// Exchange between the program and the window: the program publishes the devices, the window requests a choice.
/// Neither waits for the other's work.
#[derive(Default)]
pub(crate) struct DeviceLink {
    shown: Mutex<Arc<Devices>>,
    request: Mutex<Option<Chosen>>,
    is_watched: AtomicBool,
    /// Whether the program wants the devices to be shown.
    is_wanted: AtomicBool,
    /// Frames of the last block.
    #[cfg(any(feature = "standalone", test))]
    block: std::sync::atomic::AtomicU32,
}

impl DeviceLink {
    /// For the window: the devices and ports. As long as the window calls this, the program keeps the list up to date.
    pub(crate) fn look(&self) -> Arc<Devices> {
        self.is_watched.store(true, Relaxed);
        lock(&self.shown).clone()
    }

    /// For the window: whether it is to show the devices, once.
    pub(crate) fn is_wanted(&self) -> bool {
        self.is_wanted.swap(false, Relaxed)
    }

    /// For the window: requests another choice. It is shown as chosen at once, since the next request is based on it.
    pub(crate) fn request(&self, request: Chosen) {
        let mut waiting = lock(&self.request);
        Arc::make_mut(&mut *lock(&self.shown)).chosen = request.clone();
        *waiting = Some(request);
    }
}

#[cfg(any(feature = "standalone", test))]
impl DeviceLink {
    /// For the program: publishes the devices and ports. A request that still waits stays shown as chosen.
    pub(crate) fn show(&self, mut devices: Devices) {
        let waiting = lock(&self.request);
        if let Some(request) = &*waiting {
            devices.chosen = request.clone();
        }
        *lock(&self.shown) = Arc::new(devices);
    }

    /// For the program: lets the window show the devices.
    pub(crate) fn want(&self) {
        self.is_wanted.store(true, Relaxed);
    }

    /// For the audio thread: the block has so many frames. Real-time safe.
    pub(crate) fn note_block(&self, frames: u32) {
        self.block.store(frames, Relaxed);
    }

    /// For the program: the frames of the last block.
    pub(crate) fn block(&self) -> u32 {
        self.block.load(Relaxed)
    }

    /// For the program: the window's request since the last call.
    pub(crate) fn take_request(&self) -> Option<Chosen> {
        lock(&self.request).take()
    }

    /// For the program: whether the window has called [`DeviceLink::look`] since the last call.
    pub(crate) fn was_watched(&self) -> bool {
        self.is_watched.swap(false, Relaxed)
    }
}
