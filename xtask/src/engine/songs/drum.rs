//! Keys of drums in General MIDI.

pub(super) const DEEP_KICK: u8 = 35;
pub(super) const KICK: u8 = 36;
pub(super) const SIDE_STICK: u8 = 37;
pub(super) const SNARE: u8 = 38;
pub(super) const CLAP: u8 = 39;
pub(super) const SECOND_SNARE: u8 = 40;
pub(super) const FLOOR_TOM: u8 = 41;
pub(super) const CLOSED_HAT: u8 = 42;
pub(super) const PEDAL_HAT: u8 = 44;
pub(super) const LOW_TOM: u8 = 45;
pub(super) const OPEN_HAT: u8 = 46;
pub(super) const MIDDLE_TOM: u8 = 48;
pub(super) const CRASH: u8 = 49;
pub(super) const HIGH_TOM: u8 = 50;
pub(super) const RIDE: u8 = 51;
pub(super) const TAMBOURINE: u8 = 54;
pub(super) const COWBELL: u8 = 56;
pub(super) const MUTE_CONGA: u8 = 62;
pub(super) const CONGA: u8 = 63;
pub(super) const LOW_CONGA: u8 = 64;
pub(super) const CLAVES: u8 = 75;
pub(super) const TRIANGLE: u8 = 81;
pub(super) const SHAKER: u8 = 82;

/// Those of the orchestra's kit.
pub(super) mod orchestra {
    /// On D, A, G and F.
    pub(in super::super) const TIMPANI: [u8; 4] = [50, 45, 43, 41];
    pub(in super::super) const CLASH: u8 = 59;
    pub(in super::super) const BELL_TREE: u8 = 84;
    pub(in super::super) const GONG: u8 = 85;
    pub(in super::super) const TAM_TAM: u8 = 88;
}

/// Those of the kit of metal and glass.
pub(super) mod metal {
    pub(in super::super) const BOTTLE: u8 = 70;
    /// On C, F, C and F.
    pub(in super::super) const GLASSES: [u8; 4] = [69, 66, 64, 61];
}
