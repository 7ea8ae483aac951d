//! "Groove": eight bars for drums; every drum has its own channel.

use super::score::{Part, file};

/// Delay in beats of the second of two sixteenths.
const SWING: f64 = 0.045;

/// A bar of sixteenths: a digit is the velocity in ninths of the maximum, a dot is a rest.
fn bar(part: &mut Part, bar: u32, key: u8, pattern: &str) {
    for (step, strength) in pattern.chars().filter(|c| *c != ' ').enumerate() {
        if let Some(strength) = strength.to_digit(10) {
            let late = if step % 2 == 1 { SWING } else { 0.0 };
            let velocity = 127 * strength / 9;
            part.note(f64::from(bar) * 4.0 + step as f64 * 0.25 + late, 0.1, key, velocity as u8);
        }
    }
}

pub(super) fn compose() -> Result<Vec<u8>, String> {
    let part = |name, channel, preset, volume, pan| {
        Part::new(name, channel, preset, volume, pan).map(|part| part.loosen(0.012, 9.0))
    };
    let mut kick = part("Kick", 0, "Kick", 112, 64)?;
    let mut snare = part("Snare", 1, "Snare", 104, 60)?;
    let mut closed = part("Closed hat", 2, "Closed Hat", 118, 80)?;
    let mut open = part("Open hat", 3, "Open Hat", 98, 80)?;
    let mut low = part("Low tom", 4, "Low Tom", 106, 64)?;
    let mut high = part("High tom", 5, "High Tom", 104, 64)?;
    let mut cowbell = part("Cowbell", 6, "Cowbell", 90, 38)?;
    let mut clave = part("Clave", 7, "Clave", 90, 96)?;
    let mut clap = part("Clap", 8, "Clap", 100, 64)?;
    let mut shaker = part("Shaker", 10, "Shaker", 106, 28)?;
    let mut deep = part("Deep kick", 11, "Deep Kick", 92, 64)?;

    for n in [0, 1, 2, 4, 5, 6] {
        let kicks = ["8..5 ..8. ..7. ..5.", "8... ..8. 6.7. ...."][n as usize % 2];
        bar(&mut kick, n, 60, kicks);
        // Ghost notes around the back beat.
        let snares = ["..2. 8..2 .2.. 8...", "...2 8... .2.2 8..3"][n as usize % 2];
        bar(&mut snare, n, 60, snares);
    }
    for n in [0, 2, 4, 6] {
        bar(&mut closed, n, 60, "7.4. 7.43 7.4. 7.4.");
    }
    // The closed hats that follow cut off the open ones.
    for n in [1, 5] {
        bar(&mut closed, n, 60, "7.4. 7.4. 7.43 7.4.");
        bar(&mut open, n, 60, ".... .... .... ...6");
    }
    for n in [4, 6] {
        bar(&mut open, n, 60, ".... ..7. .... ....");
    }
    for n in [2, 4, 5, 6] {
        bar(&mut cowbell, n, 60, "7... 5... 7... 5.4.");
    }
    for n in 4..7 {
        // Son clave, two bars long.
        bar(&mut clave, n, 60, ["7..7 ..7. .... ....", "..7. 7... .... ...."][n as usize % 2]);
        bar(&mut shaker, n, 60, "6243 6243 6243 6243");
        bar(&mut clap, n, 60, ".... 6... .... 7...");
    }

    // Bar four: a fill on the toms.
    bar(&mut kick, 3, 60, "8... ..6. 7... 7...");
    bar(&mut closed, 3, 60, "7.4. 7... .... ....");
    bar(&mut snare, 3, 60, "..2. 8.45 .... ....");
    bar(&mut high, 3, 64, ".... .... 8.6. ....");
    bar(&mut high, 3, 60, ".... .... ..67 ....");
    bar(&mut low, 3, 65, ".... .... .... 8.6.");
    bar(&mut low, 3, 60, ".... .... .... ..78");
    // Bar eight: a longer fill, and the end.
    bar(&mut kick, 7, 60, "8... 7... 7... ....");
    bar(&mut snare, 7, 60, "6345 .... .... ....");
    bar(&mut high, 7, 65, ".... 8.67 .... ....");
    bar(&mut high, 7, 60, ".... .... 8.6. ....");
    bar(&mut low, 7, 66, ".... .... ...6 8...");
    bar(&mut low, 7, 60, ".... .... .... ..78");
    bar(&mut shaker, 7, 60, "6243 6243 6243 6...");
    bar(&mut deep, 8, 60, "9... .... .... ....");
    bar(&mut snare, 8, 60, "7... .... .... ....");
    bar(&mut clap, 8, 60, "8... .... .... ....");
    bar(&mut open, 8, 60, "8... .... .... ....");

    let parts = vec![kick, snare, closed, open, low, high, cowbell, clave, clap, shaker, deep];
    file("Groove", &[(0.0, 108.0)], parts)
}
