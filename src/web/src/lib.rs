//! Sprung as a WebAssembly module without imports: JavaScript creates and plays a synth through plain functions.
//!
//! A page shares no memory with its audio worklet, so each has an instance of the module of its own: the worklet's
//! instance plays, the page's instance lists the presets and renders takes. Addresses are valid until the next call
//! that allocates: [`create`], [`presets`] or [`load`].

mod player;

pub use player::BLOCK;
use player::Player;

/// The player at an address that [`create`] has returned.
///
/// # Safety
/// Nothing else may use the player meanwhile; JavaScript has one thread for each instance.
unsafe fn at<'a>(player: *mut Player) -> &'a mut Player {
    // SAFETY: as above.
    unsafe { &mut *player }
}

/// A player with the first preset. It is never freed: it lives as long as its instance of the module.
#[unsafe(no_mangle)]
pub extern "C" fn create(sample_rate: f64, seed: u32) -> *mut Player {
    Box::into_raw(Box::new(Player::new(sample_rate, u64::from(seed))))
}

/// Writes the list of presets: for each a line with name, family, lowest, highest and home key, names of macros, and
/// comment, separated by tabs; macros by semicolons. Returns its length in bytes; [`text`] returns its address.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn presets(player: *mut Player) -> usize {
    // SAFETY: as above.
    unsafe { at(player) }.list_presets()
}

/// The address of the last text.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn text(player: *mut Player) -> *const u8 {
    // SAFETY: as above.
    unsafe { at(player) }.text().as_ptr()
}

/// Plays a preset from now on, by its index in the list. Allocates. An index beyond the list changes nothing.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn load(player: *mut Player, preset: usize) {
    // SAFETY: as above.
    unsafe { at(player) }.load(preset);
}

/// Adds a MIDI message at a frame of the next block. Real-time safe.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn midi(player: *mut Player, frame: u32, status: u8, first: u8, second: u8) {
    // SAFETY: as above.
    unsafe { at(player) }.midi(frame, [status, first, second]);
}

/// Turns a macro, counted from 0, to a value from 0 to 100, at a frame of the next block. Real-time safe.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn turn(player: *mut Player, frame: u32, number: usize, value: f32) {
    // SAFETY: as above.
    unsafe { at(player) }.turn(frame, number, value);
}

/// Renders the next block of up to [`BLOCK`] frames. Returns whether anything sounds. Real-time safe.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn process(player: *mut Player, frames: usize) -> bool {
    // SAFETY: as above.
    unsafe { at(player) }.process(frames)
}

/// The address of the samples of the last block: `side` 0 is left, 1 is right.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn samples(player: *mut Player, side: usize) -> *const f32 {
    // SAFETY: as above.
    unsafe { at(player) }.samples(side).as_ptr()
}

/// Returns the address of 1 + 64 + 64 numbers: the number of voices, the energy of each mode as the sum over the
/// voices, and the ratio of each mode; 0 for modes that do not exist. Real-time safe.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn look(player: *mut Player) -> *const f32 {
    // SAFETY: as above.
    unsafe { at(player) }.look().as_ptr()
}
