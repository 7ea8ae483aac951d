//! Devices, sample rates and MIDI ports of the program, as its window shows and chooses them. In a host there are none.

use serde::{Deserialize, Serialize};
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Arc, Mutex, PoisonError};

/// What is chosen. What has no value is chosen by the program.
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

/// What there is, and what is used.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Devices {
    pub(crate) outputs: Vec<Output>,
    /// Sample rates that the chosen device has, in Hz.
    pub(crate) rates: Vec<u32>,
    pub(crate) ports: Vec<String>,
    pub(crate) chosen: Chosen,
    /// The device with its settings, for people.
    pub(crate) playing: String,
}

/// Where the program shows what there is, and the window says what it wishes. Neither waits for the other's work.
#[derive(Default)]
pub(crate) struct Desk {
    shown: Mutex<Arc<Devices>>,
    wish: Mutex<Option<Chosen>>,
    is_watched: AtomicBool,
}

impl Desk {
    /// For the window: what there is. The program looks for it again while it is looked at.
    pub(crate) fn look(&self) -> Arc<Devices> {
        self.is_watched.store(true, Relaxed);
        self.shown.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// For the window: asks for another choice. It is shown as chosen at once, since the next wish builds on it.
    pub(crate) fn ask(&self, wish: Chosen) {
        let mut waiting = self.wish.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::make_mut(&mut *self.shown.lock().unwrap_or_else(PoisonError::into_inner)).chosen = wish.clone();
        *waiting = Some(wish);
    }
}

#[cfg(any(feature = "standalone", test))]
impl Desk {
    /// For the program: shows what there is. A wish that still waits stays shown as chosen.
    pub(crate) fn show(&self, mut devices: Devices) {
        let waiting = self.wish.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(wish) = &*waiting {
            devices.chosen = wish.clone();
        }
        *self.shown.lock().unwrap_or_else(PoisonError::into_inner) = Arc::new(devices);
    }

    /// For the program: what the window wishes since the last call.
    pub(crate) fn take_wish(&self) -> Option<Chosen> {
        self.wish.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// For the program: whether somebody has looked since the last call.
    pub(crate) fn was_watched(&self) -> bool {
        self.is_watched.swap(false, Relaxed)
    }
}
