//! The effects of the command's options on the sound.

use crate::{Sandbox, end, midi, note_on, song};
use midly::{MidiMessage, TrackEvent, TrackEventKind};

fn report(sandbox: &Sandbox, args: &str) -> serde_json::Value {
    serde_json::from_slice(&sandbox.succeeds(&format!("{args} --json --force"))).unwrap()
}

#[test]
fn an_auto_tail_lasts_until_the_sound_has_died() {
    let sandbox = Sandbox::new();
    let report = report(&sandbox, "render --note A4 --length 0.1 --set release=0.5 --set decay=0.5 -o out.wav");
    // The sound decays from −6 dBFS to inaudible by 60 dB per 0.5 s: this takes more than half a second and less than
    // two.
    let tail = report["tail_seconds"].as_f64().unwrap();
    assert!((0.5..2.0).contains(&tail), "{report}");
    assert_eq!(report["voices_used"], 1);
    let wav = sandbox.wav("out.wav");
    assert!(wav.peak() > 0.1 && wav.samples[wav.samples.len() - 100..].iter().all(|sample| sample.abs() < 1e-5));
}

#[test]
fn normalising_hits_its_target() {
    let sandbox = Sandbox::new();
    let base = "render --note A3,E4 --length 1 --set decay=5 --bits 32f";
    let peak = report(&sandbox, &format!("{base} --normalize peak=-1 -o peak.wav"));
    let target = sprung::units::gain_from_db(-1.0);
    assert!((sandbox.wav("peak.wav").peak() / target - 1.0).abs() < 1e-6);
    assert!((peak["peak_dbfs"].as_f64().unwrap() + 1.0).abs() < 1e-5, "{peak}");
    let loud = report(&sandbox, &format!("{base} --normalize lufs=-14 -o loud.wav"));
    // The level is measured before and after, in steps of 0.1 LU.
    assert!((loud["lufs"].as_f64().unwrap() + 14.0).abs() <= 0.1, "{loud}");
    // When the output is a pipe, the two passes give the same sound.
    let piped = sandbox.succeeds(&format!("{base} --normalize lufs=-14 -o -"));
    assert!(piped == sandbox.read("loud.wav"));
}

#[test]
fn gain_and_clipping() {
    let sandbox = Sandbox::new();
    let base = "render --note A3 --length 0.2 --tail none";
    let plain = report(&sandbox, &format!("{base} --bits 32f -o plain.wav"))["peak_dbfs"].as_f64().unwrap();
    let quiet =
        report(&sandbox, &format!("{base} --bits 32f --gain-db -6 -o quiet.wav"))["peak_dbfs"].as_f64().unwrap();
    assert!((plain - quiet - 6.0).abs() < 1e-4, "{plain} {quiet}");
    let clipped = sandbox.sprung(&format!("{base} --gain-db 40 -o out.wav")).assert().success().get_output().clone();
    assert!(String::from_utf8_lossy(&clipped.stderr).contains("samples clipped; lower the level with --normalize"));
    let float = report(&sandbox, &format!("{base} --bits 32f --gain-db 40 -o float.wav"));
    assert_eq!(float["clipped_samples"], 0);
    assert!(sandbox.wav("float.wav").peak() > 10.0);
}

#[test]
fn the_limiter_tells_how_much_it_worked() {
    let sandbox = Sandbox::new();
    let base = "render --note C4,E4,G4,C5 --velocity 127 --length 0.5 --tail none --set gain=6 --bits 32f";
    let peak = |limiter: &str| {
        let args = format!("{base} {limiter} --force -o out.wav");
        let output = sandbox.sprung(&args).assert().success().get_output().clone();
        let told = String::from_utf8_lossy(&output.stderr).matches("sprung: note: the limiter lowered").count();
        let report = report(&sandbox, &format!("{base} {limiter} -o out.wav"));
        let [reduction, seconds] =
            ["limiter_reduction_db", "limiter_seconds"].map(|field| report[field].as_f64().unwrap());
        assert_eq!((told == 1, told == 1), (reduction > 0.0, seconds > 0.0), "{told}: {report}");
        (report["peak_dbfs"].as_f64().unwrap(), reduction, seconds)
    };
    let (limited, reduction, seconds) = peak("");
    assert!((-2.0..-0.3).contains(&limited), "{limited} dBFS");
    assert!(reduction > 6.0 && (0.1..=0.5).contains(&seconds), "{reduction} dB for {seconds} s");
    let (unlimited, reduction, seconds) = peak("--set limiter=off");
    assert!(unlimited > 6.0 && reduction == 0.0 && seconds == 0.0, "{unlimited} dBFS");
    let (quiet, reduction, seconds) = peak("--set gain=-30");
    assert!(quiet < -10.0 && reduction == 0.0 && seconds == 0.0, "{quiet} dBFS");
}

#[test]
fn the_gain_that_the_limiter_advises_keeps_the_balance_and_leaves_it_nothing_to_do() {
    let sandbox = Sandbox::new();
    // Two presets whose gains differ by 14 dB, so that one gain for both would change how loud they are beside each other.
    let program = |channel, number: u8| midi(0, channel, MidiMessage::ProgramChange { program: number.into() });
    let notes = |channel| (0..6).map(move |n| note_on(0, channel, 40 + 5 * n));
    let all: Vec<_> =
        [program(0, 19), program(1, 0)].into_iter().chain(notes(0)).chain(notes(1)).chain([end(480)]).collect();
    sandbox.write("in.mid", song(&all));
    for (base, before) in [
        // A piano at 8 kHz is so loud so soon that single samples are lowered to nothing.
        ("render in.mid --tail none --rate 8000", 18.0),
        ("render in.mid --programs none --tail none --rate 8000", 12.0),
        ("render --note C4,E4,G4,C5 --velocity 127 --length 0.5 --tail none --set gain=6 --rate 8000", 0.0),
    ] {
        let args = format!("{base} --mix-gain-db {before} --force -o limited.wav");
        let output = sandbox.sprung(&args).assert().success().get_output().clone();
        let told = String::from_utf8(output.stderr).unwrap();
        let advice = told.split_once("avoid it with --mix-gain-db ").and_then(|(_, rest)| rest.split_once(','));
        let advice: f64 = advice.unwrap_or_else(|| panic!("{base}: {told}")).0.parse().unwrap();
        let lower = report(&sandbox, &format!("{base} --mix-gain-db {advice} --bits 32f -o lower.wav"));
        assert_eq!(lower["limiter_reduction_db"], 0.0, "{base}: {advice}");
        sandbox.succeeds(&format!("{base} --mix-gain-db {before} --set limiter=off --bits 32f --force -o free.wav"));
        let ratio = sprung::units::gain_from_db(advice - before);
        let (lower, free) = (sandbox.wav("lower.wav").samples, sandbox.wav("free.wav").samples);
        assert!(lower.iter().any(|sample| sample.abs() > 0.5), "{base}: not much lower than it must be");
        assert!(
            lower.len() == free.len() && lower.iter().zip(&free).all(|(a, b)| (a - ratio * b).abs() < 1e-5),
            "{base}"
        );
    }
}

#[test]
fn what_is_set_at_the_frame_of_a_note_holds_from_its_first_sample() {
    let sandbox = Sandbox::new();
    let control = |controller: u8, value: u8| {
        midi(0, 0, MidiMessage::Controller { controller: controller.into(), value: value.into() })
    };
    let master = TrackEvent { delta: 0.into(), kind: TrackEventKind::SysEx(&[0x7f, 0x7f, 4, 1, 0, 0, 0xf7]) };
    let render = |first: TrackEvent<'static>| {
        sandbox.write("in.mid", song(&[first, note_on(0, 0, 60), end(480)]));
        sandbox.succeeds("render in.mid --bits 32f --force -o out.wav");
        let samples = sandbox.wav("out.wav").samples;
        let side = |side| samples.iter().skip(side).step_by(2).fold(0.0_f64, |peak, sample| peak.max(sample.abs()));
        [side(0), side(1)]
    };
    for silent in [master, control(7, 0), control(11, 0)] {
        assert_eq!(render(silent), [0.0; 2]);
    }
    let [left, right] = render(control(7, 127));
    let [soft, _] = render(control(7, 32));
    assert!(left > 0.05 && right > 0.05 && soft < 0.08 * left, "{left} {right} {soft}");
    // The shared plate has both sides, 20 dB below.
    let [left, right] = render(control(10, 0));
    assert!(right < 0.2 * left, "{left} {right}");
    sandbox.write("in.mid", song(&[control(91, 0), note_on(0, 0, 60), end(480)]));
    sandbox.succeeds("render in.mid --stems stems");
    assert!(!sandbox.path("stems/space.wav").exists(), "nothing is sent");
}

#[test]
fn mono_is_the_mean_of_both_channels() {
    let sandbox = Sandbox::new();
    let base = "render --note A3 --length 0.2 --tail none --preset Vibraphone.toml --bits 32f";
    let preset = sprung::preset::Preset::find("Vibraphone").unwrap();
    sandbox.write("Vibraphone.toml", preset.to_toml());
    sandbox.succeeds(&format!("{base} -o stereo.wav"));
    sandbox.succeeds(&format!("{base} --mono -o mono.wav"));
    let (stereo, mono) = (sandbox.wav("stereo.wav"), sandbox.wav("mono.wav"));
    assert!(mono.peak() > 0.01);
    assert!(stereo.samples.chunks(2).any(|frame| frame[0] != frame[1]), "it is a stereo sound");
    for (frame, mean) in stereo.samples.chunks(2).zip(&mono.samples) {
        assert_eq!((0.5 * (frame[0] as f32 + frame[1] as f32)), *mean as f32);
    }
}

#[test]
fn the_samples_do_not_depend_on_blocks_and_threads() {
    let sandbox = Sandbox::new();
    let notes: Vec<_> = (0..6).map(|n| note_on(37, n % 3, 40 + n)).chain([end(100)]).collect();
    sandbox.write("song.mid", song(&notes));
    let base = "render song.mid --preset Kick --tail 0.2 --bits 32f --force -o out.wav";
    sandbox.succeeds(&format!("{base} --block 1024 --threads 1"));
    let expected = sandbox.read("out.wav");
    assert!(sandbox.wav("out.wav").peak() > 0.01);
    for options in ["--block 1", "--block 65536", "--threads 2", "--block 7 --threads 3"] {
        sandbox.succeeds(&format!("{base} {options}"));
        assert!(sandbox.read("out.wav") == expected, "{options}");
    }
}

#[test]
fn a_frequency_is_that_frequency_in_every_tuning() {
    let sandbox = Sandbox::new();
    let base = "render --length 0.5 --tail none --bits 32f";
    sandbox.succeeds(&format!("{base} --note A4 -o a.wav"));
    sandbox.succeeds(&format!("{base} --note 440Hz --set tuning=452 -o b.wav"));
    sandbox.succeeds(&format!("{base} --note A4 --set tuning=452 -o c.wav"));
    let difference = |a: &str, b: &str| {
        let (a, b) = (sandbox.wav(a), sandbox.wav(b));
        a.samples.iter().zip(&b.samples).fold(0.0f64, |worst, (a, b)| worst.max((a - b).abs()))
    };
    assert!(difference("a.wav", "b.wav") < 1e-4, "{}", difference("a.wav", "b.wav"));
    assert!(difference("a.wav", "c.wav") > 0.1);
}

#[test]
fn notes_closer_than_a_key_all_sound() {
    let sandbox = Sandbox::new();
    let report = report(&sandbox, "render --note 60,60.25,59.9,60 --length 0.1 -o out.wav");
    assert_eq!(report["voices_used"], 4);
}

#[test]
fn program_changes_pick_presets_by_number() {
    let sandbox = Sandbox::new();
    let program = |number: u8| midi(0, 3, MidiMessage::ProgramChange { program: number.into() });
    sandbox.write("plain.mid", song(&[note_on(0, 3, 40), end(480)]));
    sandbox.write("one.mid", song(&[program(12), note_on(0, 3, 40), end(480)]));
    let render = |args: &str| {
        let output =
            sandbox.sprung(&format!("render {args} --force -o out.wav")).assert().success().get_output().clone();
        (sandbox.read("out.wav"), String::from_utf8(output.stderr).unwrap())
    };
    let (piano, _) = render("plain.mid");
    let (marimba, _) = render("plain.mid --preset marimba");
    assert!(piano != marimba);
    assert!(render("one.mid").0 == marimba);
    // Settings also apply to the presets that a song selects.
    let (set, _) = render("one.mid --set decay=0.01");
    assert!(set == render("plain.mid --preset marimba --set decay=0.01").0 && set != marimba);
}

#[test]
fn seeds_choose_the_noise() {
    let sandbox = Sandbox::new();
    let render = |args: &str| sandbox.succeeds(&format!("render --note C3 --length 0.1 {args} -o -"));
    for sound in ["--set mallet_level=-60 --set noise_reach=100", "--bits 16 --dither"] {
        assert!(render(&format!("{sound} --seed 1")) == render(&format!("{sound} --seed 1")));
        assert!(render(&format!("{sound} --seed 1")) != render(&format!("{sound} --seed 2")), "{sound}");
    }
}

#[test]
fn kits_play_on_all_channels_and_on_one() {
    let sandbox = Sandbox::new();
    let kick = sprung::preset::Preset::find("Kick").unwrap();
    sandbox.write("mine.toml", kick.to_toml());
    sandbox.write(
        "kit.toml",
        "kit = 1\nname = \"K\"\nkeys = [{ key = 40, sound = \"mine.toml\", pitch = 60 }, { key = 41, sound = \"Clave\" }]",
    );
    let base = "render --bits 32f --tail none --length 0.3 --force -o out.wav";
    let bytes = |args: &str| {
        sandbox.succeeds(&format!("{base} {args}"));
        sandbox.read("out.wav")
    };
    let plain = bytes("--note 60 --preset Kick");
    assert!(sandbox.wav("out.wav").peak() > 0.1);
    assert!(bytes("--note 40 --preset kit.toml") == plain, "the pad has the pitch of its own");
    assert!(bytes("--note 40 --channel 1=kit.toml") == plain);
    assert!(bytes("--note 60 --channel 1=kick --channel 10=kit.toml --preset Gong") == plain);
    let short = bytes("--note 60 --preset Kick --set decay=0.05");
    assert!(short != plain && bytes("--note 40 --preset kit.toml --set decay=0.05") == short);
    let told = sandbox.sprung(&format!("{base} --note 40,42 --preset kit.toml")).output().unwrap().stderr;
    let expected = "warning: 1 of 2 notes are silent: their kits have no pad on their keys (channel 1: F#2)";
    assert!(String::from_utf8_lossy(&told).contains(expected));
    let told = sandbox.sprung(&format!("{base} --note 60 --channel 10=kit.toml")).output().unwrap().stderr;
    let expected = "warning: --channel 10: the song has nothing on channel 10";
    assert!(String::from_utf8_lossy(&told).contains(expected));
    let told = sandbox.sprung(&format!("{base} --note 40 --channel 1=kit.toml")).output().unwrap().stderr;
    assert!(!String::from_utf8_lossy(&told).contains("warning"));
    bytes("--note 42 --preset kit.toml");
    assert_eq!(sandbox.wav("out.wav").peak(), 0.0, "a key without a pad is silent");

    sandbox.write("song.mid", song(&[note_on(0, 9, 40), end(480)]));
    let report = report(&sandbox, "render song.mid --channel 10=kit.toml -o song.wav");
    assert_eq!(report["voices_used"], 1);
}

#[test]
fn kits_that_do_not_fit_are_refused() {
    let sandbox = Sandbox::new();
    for (args, code, message) in [
        ("--channel 17=Kick", 2, "channel 17 is out of range: expected 1 to 16"),
        ("--channel Kick", 2, "expected CHANNEL=NAME, as in 10=drums.toml"),
        ("--channel 1=Kick --channel 1=Snare", 1, "--channel: channel 1 is there twice: expected each channel once"),
        ("--channel 1=kcik", 1, "the nearest is ‘Kick’"),
        ("--channel 1=none.toml", 1, "none.toml: "),
    ] {
        sandbox.fails(&format!("render --note 60 {args} -o out.wav"), code, message);
    }
    // A file that a kit reads must not become its output.
    let mine = sandbox.write("mine.toml", sprung::preset::Preset::find("Kick").unwrap().to_toml());
    std::fs::hard_link(mine, sandbox.path("mine.wav")).unwrap();
    sandbox.write("kit.toml", "kit = 1\nname = \"K\"\nkeys = [{ key = 40, sound = \"mine.toml\" }]");
    sandbox.fails("render --note 40 --preset kit.toml --force -o mine.wav", 1, "expected another file to write to");
}
