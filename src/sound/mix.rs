//! The mix of the channels of a song.

use crate::params::Param;

/// Gain and space of the sum of all channels, before the limiter. By default there is neither.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mix {
    /// Gain in dB. It applies to the space too.
    pub gain: f32,
    /// Parameters of the space that all channels share: those of the section "Space", except the mix. Controller 91 of each
    /// channel sets its send (40 at the start, as in General MIDI 2). Empty for no space. At a full send, white noise returns
    /// 8 dB softer. The space takes as much time as that of one channel.
    pub space: Vec<(Param, f32)>,
}
