//! "Groove": nine bars for the drum kit of channel 10.

use super::score::{Part, drum, file};

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
    let part = |name| Part::drums(name, 112).loosen(0.012, 9.0);
    let [mut kick, mut snare, mut hats, mut toms, mut bells, mut hands] =
        ["Kick", "Snare", "Hats", "Toms", "Bells", "Hands"].map(part);

    for n in [0, 1, 2, 4, 5, 6] {
        let kicks = ["8..5 ..8. ..7. ..5.", "8... ..8. 6.7. ...."][n as usize % 2];
        bar(&mut kick, n, drum::KICK, kicks);
        // Ghost notes around the back beat.
        let snares = ["..2. 8..2 .2.. 8...", "...2 8... .2.2 8..3"][n as usize % 2];
        bar(&mut snare, n, drum::SNARE, snares);
    }
    for n in [0, 2, 4, 6] {
        bar(&mut hats, n, drum::CLOSED_HAT, "7.4. 7.43 7.4. 7.4.");
    }
    // The closed hats that follow cut off the open ones.
    for n in [1, 5] {
        bar(&mut hats, n, drum::CLOSED_HAT, "7.4. 7.4. 7.43 7.4.");
        bar(&mut hats, n, drum::OPEN_HAT, ".... .... .... ...6");
    }
    for n in [4, 6] {
        bar(&mut hats, n, drum::OPEN_HAT, ".... ..7. .... ....");
    }
    for n in [2, 4, 5, 6] {
        bar(&mut bells, n, drum::COWBELL, "7... 5... 7... 5.4.");
    }
    for n in 4..7 {
        // Son clave, two bars long.
        bar(&mut bells, n, drum::CLAVES, ["7..7 ..7. .... ....", "..7. 7... .... ...."][n as usize % 2]);
        bar(&mut hands, n, drum::MARACAS, "6243 6243 6243 6243");
        bar(&mut hands, n, drum::CLAP, ".... 6... .... 7...");
    }

    // Bar four: a fill on the toms.
    bar(&mut kick, 3, drum::KICK, "8... ..6. 7... 7...");
    bar(&mut hats, 3, drum::CLOSED_HAT, "7.4. 7... .... ....");
    bar(&mut snare, 3, drum::SNARE, "..2. 8.45 .... ....");
    bar(&mut toms, 3, drum::HIGH_TOM, ".... .... 8.6. ....");
    bar(&mut toms, 3, drum::MIDDLE_TOM, ".... .... ..67 ....");
    bar(&mut toms, 3, drum::LOW_TOM, ".... .... .... 8.6.");
    bar(&mut toms, 3, drum::FLOOR_TOM, ".... .... .... ..78");
    // Bar eight: a longer fill, and the end.
    bar(&mut kick, 7, drum::KICK, "8... 7... 7... ....");
    bar(&mut snare, 7, drum::SNARE, "6345 .... .... ....");
    bar(&mut toms, 7, drum::HIGH_TOM, ".... 8.67 .... ....");
    bar(&mut toms, 7, drum::MIDDLE_TOM, ".... .... 8.6. ....");
    bar(&mut toms, 7, drum::LOW_TOM, ".... .... ...6 8...");
    bar(&mut toms, 7, drum::FLOOR_TOM, ".... .... .... ..78");
    bar(&mut hands, 7, drum::MARACAS, "6243 6243 6243 6...");
    bar(&mut kick, 8, drum::DEEP_KICK, "9... .... .... ....");
    bar(&mut snare, 8, drum::SNARE, "7... .... .... ....");
    bar(&mut hands, 8, drum::CLAP, "8... .... .... ....");
    bar(&mut hats, 8, drum::OPEN_HAT, "8... .... .... ....");

    bar(&mut hats, 8, drum::CRASH, "8... .... .... ....");

    let parts = vec![kick, snare, hats, toms, bells, hands];
    file("Groove", &[(0.0, 108.0)], parts)
}
