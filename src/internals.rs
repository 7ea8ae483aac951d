//! What only this project's own programs, tests and benches need: of no use to others, and it changes without notice.

pub use crate::dsp::CONTROL_FRAMES;
pub use crate::dsp::simd::Level;
pub use crate::engine::voice_manager::MAX_VOICES;
pub use crate::error::nearest;

/// Random numbers, as the engine draws them.
pub mod random {
    pub use crate::dsp::random::*;
}

/// What moves the masses.
pub mod exciter {
    pub use crate::dsp::exciter::*;
}

/// The effects behind the voices, which parameters set, and the limiter.
pub mod space {
    pub use crate::dsp::limiter::Limiter;
    pub use crate::dsp::space::*;
    pub use crate::engine::blend::Blend;
}

/// The curves of a sound's parts.
pub mod curves {
    pub use crate::engine::curves::*;
}

/// What displays read while an engine plays.
pub mod display {
    pub use crate::engine::scope::SCOPE_FRAMES;
    pub use crate::engine::telemetry::*;
}

/// Controllers that users bind to parameters.
pub mod learned {
    pub use crate::params::learned::*;
}

/// What editors of kits, bodies and pairs offer.
pub mod editor {
    pub use crate::preset::about::with_ending;
    pub use crate::preset::body::*;
    pub use crate::preset::pair::*;
    pub use crate::sound::bodies::fields::{FIELDS, Field};
    pub use crate::sound::kit::{CHOKE_GROUPS, GAINS_DB};
    pub use crate::sound::pairs::fields::{LINK_FIELDS, LinkField};
}

/// Two bodies as one set of modes.
pub mod coupled {
    pub use crate::sound::coupled::*;
}

/// The user's folder of presets, and lists of presets.
pub mod library {
    pub use crate::preset::catalogue::*;
    pub use crate::preset::library::*;
}

/// Files that programs are told to read and write.
pub mod files {
    pub use crate::io::inputs::Inputs;
    pub use crate::io::output::Output;
    #[cfg(feature = "fit")]
    pub use crate::io::sound_file::codecs::DECODER;
    pub use crate::io::target::Target;
    #[cfg(feature = "render")]
    pub use crate::render::{looped::to_looped_wav, stems::*, wav::to_wav};
}

/// FLAC files.
#[cfg(feature = "batch")]
pub mod flac {
    pub use crate::io::flac::*;
}

/// Texts as programs print them, and the manual.
pub mod text {
    pub use crate::manual::{CONTENTS, PAGES};
    pub use crate::text::number::*;
    pub use crate::text::*;
}

/// How many threads render.
#[cfg(feature = "render")]
pub mod threads {
    pub use crate::render::meter::*;
    pub use crate::render::threads::*;
}

/// Requests to render, with the option names that the command, batches and Python share.
#[cfg(feature = "batch")]
pub mod request {
    pub use crate::request::*;
}

/// Measures that tests and documents take of sounds.
#[cfg(feature = "fit")]
pub mod measures {
    #[cfg(feature = "analysis")]
    pub use crate::analysis::digest::Digest;
    #[cfg(feature = "analysis")]
    pub use crate::analysis::measures::*;

    pub mod diff {
        pub use crate::analysis::diff::*;
    }
    pub mod level {
        pub use crate::analysis::level::*;
    }
    pub mod spectrum {
        pub use crate::analysis::spectrum::*;
    }
}

/// What the command shows of the spring lab, and the integration that tests compare with.
#[cfg(feature = "lab")]
pub mod lab {
    pub mod animation {
        pub use crate::lab::animation::*;
    }
    pub mod convergence {
        pub use crate::lab::figure::convergence::csv;
    }
    pub mod pitch {
        pub use crate::lab::figure::pitch::{csv, notes};
    }
    pub mod reference {
        pub use crate::lab::reference::*;
    }
    pub mod report {
        pub use crate::lab::report::*;
    }
    pub mod stability {
        pub use crate::lab::figure::stability::csv;
    }
}

/// Parts of HTML pages.
#[cfg(feature = "analysis")]
pub mod page {
    pub use crate::figure::page::*;
}

/// Parts of a player for a sound device.
#[cfg(feature = "live")]
pub mod realtime {
    pub use crate::realtime::block_clock::*;
    pub use crate::realtime::convert::*;
    pub use crate::realtime::fade::Fade;
    pub use crate::realtime::player::MAX_BLOCK;
    pub use crate::realtime::recorder::*;

    pub mod device {
        pub use crate::realtime::device::{Output, list, outputs, silence_library};
    }
    pub mod midi_ports {
        pub use crate::realtime::midi_ports::*;
    }
}
