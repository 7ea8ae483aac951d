//! Measures by which real instruments are judged, of a recording and of its fit.

use super::played::{Stereo, mean};
use sprung::internals::measures::{Least, attack_flatness, from_onset, high_share, motion, partials};

/// Measures of the mean of both channels of a sound; the library documents each.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measures {
    pub(crate) flatness_db: f64,
    pub(crate) high_db: f64,
    pub(crate) motion_db: Option<f64>,
    pub(crate) partials: usize,
}

impl Measures {
    pub(crate) fn of(sound: &Stereo) -> Self {
        let mean = mean(sound);
        let sound = from_onset(&mean);
        Self {
            flatness_db: attack_flatness(sound),
            high_db: high_share(sound),
            motion_db: motion(sound),
            partials: partials(sound),
        }
    }

    /// Names of the measures that reach `least` in a recording, but not in this sound.
    pub(crate) fn short_of(&self, recording: &Self, least: &Least) -> Vec<&'static str> {
        let of = |measures: &Self| {
            let Self { flatness_db, high_db, motion_db, partials } = measures;
            [
                ("flatness", *flatness_db >= least.attack_flatness),
                ("high frequencies", *high_db >= least.high_share),
                ("motion", motion_db.is_none_or(|motion| motion >= least.motion)),
                ("partials", *partials >= least.partials),
            ]
        };
        let both = of(self).into_iter().zip(of(recording));
        both.filter(|((_, own), (_, wanted))| *wanted && !own).map(|((name, _), _)| name).collect()
    }
}
