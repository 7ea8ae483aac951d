//! A master of MTS-ESP retunes keys, also while they sound, leaves keys out, comes and goes. `master.c` is the master.

use crate::host::reference::{self, At, assert_same_bits};
use crate::host::{Address, Instance, Sent};
use crate::patches::load;
use crate::process::{command, scratch, succeeds};
use libloading::{Library, Symbol};
use sprung::engine::{EventKind, NoteId};
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::units::{frequency_from_key, key_from_frequency};
use std::process::{Command, ExitCode};

/// Environment variable by which the plugin finds the library.
const PLACE: &str = "SPRUNG_MTS_ESP";

const RATE: f64 = 48_000.0;
const BLOCK: usize = 480;

pub(crate) fn a_master_of_mts_esp_is_followed() {
    let library = scratch("master.so");
    let mut cc = Command::new("cc");
    cc.args(["-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-o"]).arg(&library);
    cc.arg(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/hosts/master.c"));
    succeeds(cc);
    let mut command = command("tuning");
    command.env(PLACE, library);
    succeeds(command);
}

/// Runs in the process that the test starts.
#[allow(unsafe_code)]
pub(crate) fn work() -> ExitCode {
    // SAFETY: the library is `master.c`, whose functions have these types.
    let master = unsafe { Library::new(std::env::var_os(PLACE).unwrap()).unwrap() };
    let (tune, be_present, leave_out, clients) = unsafe {
        let tune: Symbol<extern "C" fn(i32, f64)> = master.get(b"test_tune\0").unwrap();
        let be_present: Symbol<extern "C" fn(bool)> = master.get(b"test_be_present\0").unwrap();
        let leave_out: Symbol<extern "C" fn(i32)> = master.get(b"test_leave_out\0").unwrap();
        let clients: Symbol<extern "C" fn() -> i32> = master.get(b"test_clients\0").unwrap();
        (tune, be_present, leave_out, clients)
    };
    let equal = |key: u8| frequency_from_key(key.into(), 440.0);
    (0..128).for_each(|key| tune(key.into(), equal(key)));
    leave_out(60);

    let patch = Patch::default().with(Param::Decay, 3.0).with(Param::Tuning, 442.0);
    let mut instance = Instance::new();
    load(&mut instance, &patch);
    let mut player = instance.play(RATE, BLOCK as u32);
    assert_eq!(clients(), 1);
    let at = |block: usize| (block * BLOCK) as u64;
    let on = |block, key: i16| Sent::On(Address::note(0, key, key.into()), 0.8).at(at(block));
    let song = [on(2, 69), on(4, 60), on(6, 71), on(24, 60), on(26, 72)];
    let mut block = 0;
    let rendered = player.render(&song, 40 * BLOCK, || {
        match block {
            1 => be_present(true),
            10 => tune(69, 450.0),
            12 => tune(71, f64::NAN),
            20 => be_present(false),
            _ => {}
        }
        block += 1;
        BLOCK
    });
    // The key that was left out has ended at once, and sounds again without the master.
    let [ended] = rendered.ended[..] else { panic!("{:?}", rendered.ended) };
    assert_eq!((ended.frame, ended.note), (at(4), Address::note(0, 60, 60)));

    let retuned = |block, key: u8, frequency: f64| {
        let pitch = key_from_frequency(frequency, 442.0) as f32;
        At(at(block), 0, EventKind::Tune { key, pitch, sounding: true })
    };
    let untuned = |block, key: u8| At(at(block), 0, EventKind::Tune { key, pitch: key.into(), sounding: true });
    let struck = |block, key: u8| {
        let id = NoteId::new(key.into());
        At(at(block), 0, EventKind::NoteOn { key, detune: 0.0, velocity: 0.8, id })
    };
    let mut expected: Vec<At> = (0..128).map(|key| retuned(1, key, equal(key))).collect();
    expected.extend([struck(2, 69), struck(6, 71), retuned(10, 69, 450.0), untuned(12, 71)]);
    expected.extend((0..128).map(|key| untuned(20, key)));
    expected.extend([struck(24, 60), struck(26, 72)]);
    assert_same_bits("a master", &rendered.channels, &reference::render(&patch, RATE, &expected, 40 * BLOCK));

    drop(player.stop());
    assert_eq!(clients(), 0);
    ExitCode::SUCCESS
}
