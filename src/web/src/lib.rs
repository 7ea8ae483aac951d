//! Sprung as a WebAssembly module without imports: JavaScript creates and plays a synth through plain functions.
//!
//! A page shares no memory with its audio worklet, so each has an instance of the module of its own: the worklet's
//! instance plays, the page's instance lists the presets and renders takes. Addresses are valid until the next call that allocates:
//! [`create`], [`presets`], [`controls`], [`say`], [`load`], [`put`], [`make`], [`process`] after one of these three, [`energies`], [`draw`],
//! [`tile`], [`floor`], [`numbers`] or [`touch`]; of these six, the first after another preset computes the shapes of its modes, which is
//! slow.

mod controls;
mod drawn;
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

/// Plays a preset from the next block on, by its index in the list. Allocates, and so does that block. An index beyond the list changes
/// nothing.
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

/// Turns the parameter with a number to a position from 0 to 1, at a frame of the next block. Real-time safe.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn turn(player: *mut Player, frame: u32, number: usize, position: f64) {
    // SAFETY: as above.
    unsafe { at(player) }.turn(frame, number, position);
}

/// Writes the list of what the page can set and how it looks: a line for each kind and thing, separated by tabs, as `controls::list`
/// says. Returns the length in bytes; [`text`] returns its address.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn controls(player: *mut Player) -> usize {
    // SAFETY: as above.
    unsafe { at(player) }.list_controls()
}

/// The position of the parameter with a number in the preset, from 0 to 1.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn position(player: *mut Player, number: usize) -> f64 {
    // SAFETY: as above.
    unsafe { at(player) }.position(number)
}

/// Writes the value of a parameter at a position. Returns its length in bytes; [`text`] returns its address.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn say(player: *mut Player, number: usize, position: f64) -> usize {
    // SAFETY: as above.
    unsafe { at(player) }.say(number, position)
}

/// Gives the preset a body of a model and a material, by their numbers in the lists of [`controls`], from the next block on; −1 leaves
/// what it has. A table of modes becomes a body, of two joined bodies the first one stays. Allocates.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn make(player: *mut Player, model: i32, material: i32) {
    // SAFETY: as above.
    unsafe { at(player) }.make([model, material]);
}

/// The number of the preset's model (`which` 0) or material (1) in the lists of [`controls`]; −1 for another or none.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn made_of(player: *mut Player, which: usize) -> i32 {
    // SAFETY: as above.
    unsafe { at(player) }.made_of()[which.min(1)]
}

/// Draws the tile of the model with a number, as [`draw`] does.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tile(player: *mut Player, model: usize, width: f32, height: f32, glow: u32) -> usize {
    // SAFETY: as above.
    unsafe { at(player) }.drawn().tile(model, [width, height], glow)
}

/// Renders the next block of up to [`BLOCK`] frames. Returns whether anything sounds. Real-time safe, but for a preset that begins.
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

/// Lets the body of the preset be struck, or be heard, at a place from the next block on, each coordinate from 0 to 1. Allocates. A table
/// of modes, which has no body, and two joined bodies stay as they are.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn put(player: *mut Player, is_ear: bool, x: f64, y: f64) {
    // SAFETY: as above.
    unsafe { at(player) }.put(is_ear, x, y);
}

/// Writes the place where the body is struck, or heard, as two [`numbers`]. Returns whether it can be moved. Allocates.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn place(player: *mut Player, is_ear: bool) -> bool {
    // SAFETY: as above.
    unsafe { at(player) }.drawn().place(is_ear)
}

/// The address of 64 numbers: the energies of the modes with which the body is drawn, to be written.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn energies(player: *mut Player) -> *mut f32 {
    // SAFETY: as above.
    unsafe { at(player) }.drawn().energies.as_mut_ptr()
}

/// Draws the body of the preset as it is some seconds after the last time (at its greatest bend if they are negative), `width` by `height`
/// pixels large, with a colour (0xRRGGBB) for what moves. Returns how many numbers describe it, as `Drawn::draw` says; [`numbers`] returns
/// their address. Allocates.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn draw(player: *mut Player, width: f32, height: f32, seconds: f32, glow: u32) -> usize {
    // SAFETY: as above.
    unsafe { at(player) }.drawn().draw([width, height], seconds, glow)
}

/// Draws the floor of a stage of `width` by `height` pixels, whose middle reaches from `left` to `right`, for the level that sounds, as a
/// share of the 60 dB below full scale. Returns how many numbers describe it, as `Drawn::floor` says; [`numbers`] returns their address.
/// Allocates.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn floor(
    player: *mut Player,
    width: f32,
    height: f32,
    left: f32,
    right: f32,
    level: f32,
) -> usize {
    // SAFETY: as above.
    unsafe { at(player) }.floor([width, height], [left, right], level)
}

/// The address of the last numbers of [`draw`], [`tile`], [`floor`] or [`touch`].
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn numbers(player: *mut Player) -> *const f32 {
    // SAFETY: as above.
    unsafe { at(player) }.drawn().numbers.as_ptr()
}

/// Finds the point of the body that is nearest to a place in the picture, as two [`numbers`] for [`put`]. Returns 0 beside the body, 1 on
/// it, and 2 where it can be struck or heard elsewhere. Allocates.
///
/// # Safety
/// `player` is from [`create`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn touch(player: *mut Player, is_ear: bool, width: f32, height: f32, x: f32, y: f32) -> u32 {
    // SAFETY: as above.
    unsafe { at(player) }.drawn().touch(is_ear, [width, height], [x, y])
}
