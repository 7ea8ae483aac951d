//! A client of MTS-ESP: a master, which is another plugin in the same host, says what frequency each key has, also while it sounds.
//!
//! Clients and masters share a library, which is loaded if it is installed where its documentation says
//! (<https://github.com/ODDSound/MTS-ESP>). Its tables for single channels are not read, since all channels of an instrument share a
//! tuning. A sound with a tuning of its own keeps it.

#![allow(unsafe_code, reason = "functions of a shared library")]

use libloading::{Library, Symbol};
use sprung::engine::EventKind;
use sprung::sound::KEYS;
use sprung::units::key_from_frequency;
use std::ffi::{c_char, c_schar};
use std::path::PathBuf;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

/// Environment variable: where the library is, if not in its usual place.
const PLACE: &str = "SPRUNG_MTS_ESP";

/// What a client needs of the library, which stays loaded until the process ends.
struct Shared {
    register: unsafe extern "C" fn(),
    deregister: unsafe extern "C" fn(),
    has_master: unsafe extern "C" fn() -> bool,
    filters: unsafe extern "C" fn(c_char, c_schar) -> bool,
    /// The bits of each key's frequency in Hz.
    table: &'static [AtomicU64; KEYS],
}

impl Shared {
    /// Loads the library at the first call.
    fn library() -> Option<&'static Self> {
        static SHARED: OnceLock<Option<Shared>> = OnceLock::new();
        SHARED.get_or_init(Self::load).as_ref()
    }

    fn load() -> Option<Self> {
        // SAFETY: a library of this name and place is MTS-ESP's, whose constructors may be run. It is never closed, so that what
        // is taken from it lives as long as the process.
        let library: &'static Library = Box::leak(Box::new(unsafe { Library::new(place()?) }.ok()?));
        // SAFETY: the types are those of `Client/libMTSClient.cpp`. The table has 128 doubles and is never moved; masters write it
        // while clients read it, on all supported systems by a whole word, as an atomic does.
        unsafe {
            let table: Symbol<unsafe extern "C" fn() -> *const [AtomicU64; KEYS]> =
                library.get(b"MTS_GetTuningTable\0").ok()?;
            Some(Self {
                register: *library.get(b"MTS_RegisterClient\0").ok()?,
                deregister: *library.get(b"MTS_DeregisterClient\0").ok()?,
                has_master: *library.get(b"MTS_HasMaster\0").ok()?,
                filters: *library.get(b"MTS_ShouldFilterNote\0").ok()?,
                table: table().as_ref()?,
            })
        }
    }
}

/// Where the library is.
fn place() -> Option<PathBuf> {
    if let Some(place) = std::env::var_os(PLACE) {
        Some(place.into())
    } else if cfg!(windows) {
        std::env::var_os("CommonProgramFiles").map(|folder| PathBuf::from(folder).join("MTS-ESP").join("LIBMTS.dll"))
    } else if cfg!(target_os = "macos") {
        Some("/Library/Application Support/MTS-ESP/libMTS.dylib".into())
    } else {
        Some("/usr/local/lib/libMTS.so".into())
    }
}

/// A client, registered until it is dropped. Real-time safe but for making and dropping it.
pub(crate) struct Client {
    shared: &'static Shared,
    has_master: bool,
    /// The frequency of each key over that of A4, as last told; 0 where there is none.
    told: [f64; KEYS],
}

impl Client {
    /// None if the library is not there.
    pub(crate) fn register() -> Option<Self> {
        let shared = Shared::library()?;
        // SAFETY: as in `Shared::load`.
        unsafe { (shared.register)() };
        Some(Self { shared, has_master: false, told: [0.0; KEYS] })
    }

    /// Looks for a master, at the beginning of a block.
    pub(crate) fn look(&mut self) {
        // SAFETY: as in `Shared::load`.
        self.has_master = unsafe { (self.shared.has_master)() };
    }

    /// What makes a key sound as the master says, if that has changed; without a master, as in equal temperament. `a4` is the
    /// frequency of A4 in Hz.
    pub(crate) fn change(&mut self, key: u8, a4: f64) -> Option<EventKind> {
        let (place, told) = (self.shared.table.get(usize::from(key))?, self.told.get_mut(usize::from(key))?);
        let frequency = f64::from_bits(place.load(Ordering::Relaxed));
        let is_tuned = self.has_master && frequency.is_finite() && frequency > 0.0;
        let ratio = if is_tuned { frequency / a4 } else { 0.0 };
        if ratio == std::mem::replace(told, ratio) {
            return None;
        }
        let pitch = if is_tuned { key_from_frequency(frequency, a4) as f32 } else { f32::from(key) };
        Some(EventKind::Tune { key, pitch, sounding: true })
    }

    /// Whether the master leaves a key out, so that it does not sound.
    pub(crate) fn leaves_out(&self, channel: u8, key: u8) -> bool {
        // SAFETY: as in `Shared::load`.
        self.has_master && unsafe { (self.shared.filters)(key as c_char, channel as c_schar) }
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        // SAFETY: as in `Shared::load`; it was registered once.
        unsafe { (self.shared.deregister)() };
    }
}
