//! `sprung play` without a sound card: on ALSA's file plugin, on JACK's dummy driver, and in a terminal.

mod allocation;
mod alsa;
mod jack;
mod sandbox;
mod terminal;

/// Forbids allocation wherever a test asks for it.
#[global_allocator]
static ALLOCATOR: assert_no_alloc::AllocDisabler = assert_no_alloc::AllocDisabler;
