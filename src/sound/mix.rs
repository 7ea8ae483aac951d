//! How the sounds of a song are mixed.

use crate::params::Param;

/// What is done to the sum of all channels, before the limiter. By default nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mix {
    /// Gain in dB, also of the space.
    pub gain: f32,
    /// Parameters of the space that all channels share: those of the section "Space", but for the mix, since each channel's
    /// controller 91 says how much of it is sent there (40 from the start, as General MIDI 2 has it). Empty for none. Of a full
    /// send, white noise returns 8 dB softer. It takes as much time as the space of one channel.
    pub space: Vec<(Param, f32)>,
}
