//! Reverbs give the bits of scalar code on every level of vector instructions.

use sprung::internals::Level;
use sprung::internals::random::{key, uniform};
use sprung::internals::space::{Decay, ModalReverb, Plate, Resonator};

#[test]
fn all_levels_have_the_bits_of_scalar_code() {
    let _alone = crate::LEVEL.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    // 333 modes: neither whole blocks nor a whole group.
    let modes = Plate { length: 0.3, width: 0.171, thickness: 0.0005, ..Plate::default() }.modes().leak();
    assert!(!modes.len().is_multiple_of(16), "{}", modes.len());
    let render = |level: Level| {
        level.force().then(|| {
            let body = Resonator::new(modes, Decay { low: 0.3, high: 0.1 }, 48_000.0);
            assert_eq!(body.instructions(), level);
            let mut reverb = ModalReverb::new(body);
            reverb.set_mix(0.5);
            let mut left: Vec<f32> =
                (0..8000).map(|n| if n % 3000 < 1000 { uniform(key(1, 2), n) } else { 0.0 }).collect();
            let mut right = left.clone();
            for (block, (left, right)) in left.chunks_mut(500).zip(right.chunks_mut(500)).enumerate() {
                reverb.set_decay(Decay { low: 0.1 + 0.01 * block as f64, high: 0.1 });
                reverb.process(left, right);
            }
            [left, right].map(|side| side.into_iter().map(f32::to_bits).collect::<Vec<_>>())
        })
    };
    let scalar = render(Level::Scalar).unwrap();
    for level in Level::ALL {
        match render(level) {
            Some(bits) => assert!(bits == scalar, "{} differs", level.name()),
            None => println!("{} is left out: this CPU does not have it", level.name()),
        }
    }
}
