//! Sprung as a WebAssembly module without imports: a synth that JavaScript creates, plays and reads by plain functions.
//!
//! A page has no shared memory with its audio worklet, so each has an instance of the module of its own: the worklet's plays,
//! the page's lists the presets and renders takes. Positions in memory are valid until the next call that allocates, which
//! is every call but [`midi`], [`process`] and [`look`].

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

/// Writes the list of presets: a line each of name, family, lowest, highest and home key, and comment, separated by tabs.
/// Returns its length in bytes; [`text`] is its place.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn presets(player: *mut Player) -> usize {
    // SAFETY: as above.
    unsafe { at(player) }.list_presets()
}

/// Where the last text is.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn text(player: *mut Player) -> *const u8 {
    // SAFETY: as above.
    unsafe { at(player) }.text().as_ptr()
}

/// Plays a preset from now on, by its place in the list. Allocates. A number beyond the list changes nothing.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn load(player: *mut Player, preset: usize) {
    // SAFETY: as above.
    unsafe { at(player) }.load(preset);
}

/// A MIDI message at a frame of the next block. Real-time safe.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn midi(player: *mut Player, frame: u32, status: u8, first: u8, second: u8) {
    // SAFETY: as above.
    unsafe { at(player) }.midi(frame, [status, first, second]);
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

/// Where the samples of the last block are: `side` 0 is left, 1 right.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn samples(player: *mut Player, side: usize) -> *const f32 {
    // SAFETY: as above.
    unsafe { at(player) }.samples(side).as_ptr()
}

/// Looks at the masses: 1 + 64 + 64 numbers, which are the number of voices, the energies of the modes added up over the
/// voices, and the ratios of the modes; 0 for modes that are not there. Real-time safe.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn look(player: *mut Player) -> *const f32 {
    // SAFETY: as above.
    unsafe { at(player) }.look().as_ptr()
}
