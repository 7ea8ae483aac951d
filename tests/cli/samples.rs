//! Sampler instruments: a small reader plays their SFZ files, and what it plays is compared with the command's own sound.

use crate::Sandbox;
use std::collections::BTreeMap;
use std::fs;

/// The opcodes of each region of an SFZ file, with those of `<global>`.
fn regions(text: &str) -> Vec<BTreeMap<String, String>> {
    let (mut global, mut regions) = (BTreeMap::new(), Vec::<BTreeMap<String, String>>::new());
    let mut in_region = false;
    for word in text.lines().filter(|line| !line.starts_with("//")).flat_map(str::split_whitespace) {
        match word {
            "<global>" => in_region = false,
            "<region>" => {
                in_region = true;
                regions.push(global.clone());
            }
            opcode => {
                let (name, value) = opcode.split_once('=').unwrap();
                let into = if in_region { regions.last_mut().unwrap() } else { &mut global };
                into.insert(name.to_owned(), value.to_owned());
            }
        }
    }
    regions
}

fn number(region: &BTreeMap<String, String>, opcode: &str) -> f64 {
    region[opcode].parse().unwrap()
}

/// Plays a key as a sampler does: the region of key, velocity and turn, its loop, and no change of pitch at its centre.
fn play(sandbox: &Sandbox, folder: &str, sfz: &str, [key, velocity, turn]: [f64; 3], frames: usize) -> [Vec<f32>; 2] {
    let text = String::from_utf8(sandbox.read(&format!("{folder}/{sfz}"))).unwrap();
    let within = |region: &BTreeMap<String, String>, low: &str, high: &str, value: f64| {
        (number(region, low)..=number(region, high)).contains(&value)
    };
    let regions: Vec<_> = regions(&text)
        .into_iter()
        .filter(|region| within(region, "lokey", "hikey", key) && within(region, "lovel", "hivel", velocity))
        .filter(|region| region.get("seq_position").is_none_or(|position| position.parse::<f64>().unwrap() == turn))
        .collect();
    let [region] = &regions[..] else { panic!("{} regions play key {key} at {velocity}", regions.len()) };
    assert_eq!((number(region, "pitch_keycenter"), number(region, "amp_veltrack")), (key, 0.0));
    let file = fs::File::open(sandbox.path(&format!("{folder}/{}", region["sample"]))).unwrap();
    let sound = sprung::io::sound_file::read(file, "sample").unwrap();
    let looped = (region["loop_mode"] == "loop_continuous")
        .then(|| [number(region, "loop_start") as usize, number(region, "loop_end") as usize + 1]);
    let side = |side: &Vec<f32>| {
        let at = |n: usize| match looped {
            Some([start, end]) if n >= end => start + (n - start) % (end - start),
            _ => n,
        };
        (0..frames).map(|n| side.get(at(n)).copied().unwrap_or(0.0)).collect()
    };
    [side(&sound.channels[0]), side(&sound.channels[1])]
}

/// Levels in dB of octaves, of the sum of both sides' powers, by filters of second order; those 60 dB below the loudest are left out.
fn bands(sound: &[Vec<f32>; 2]) -> Vec<Option<f64>> {
    let levels: Vec<f64> = (0..8)
        .map(|octave| {
            let omega = std::f64::consts::TAU * 62.5 * f64::from(1 << octave) / 48_000.0;
            let alpha = libm::sin(omega) / (2.0 * std::f64::consts::SQRT_2);
            let (b, a1, a2) =
                (alpha / (1.0 + alpha), -2.0 * libm::cos(omega) / (1.0 + alpha), (1.0 - alpha) / (1.0 + alpha));
            let power = |side: &Vec<f32>| {
                let [mut x1, mut x2, mut y1, mut y2] = [0.0; 4];
                let mut sum = 0.0;
                for x in side.iter().map(|sample| f64::from(*sample)) {
                    let y = b * (x - x2) - a1 * y1 - a2 * y2;
                    (x2, x1, y2, y1) = (x1, x, y1, y);
                    sum += y * y;
                }
                sum
            };
            10.0 * libm::log10(sound.iter().map(power).sum::<f64>() + 1e-30)
        })
        .collect();
    let loudest = levels.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    levels.into_iter().map(|level| Some(level).filter(|level| *level > loudest - 60.0)).collect()
}

/// Compares what an instrument plays with what the command renders, by band.
fn compare(sandbox: &Sandbox, args: &str, played: &[Vec<f32>; 2]) {
    compare_with_tail(sandbox, &format!("{args} --tail none"), played);
}

fn compare_with_tail(sandbox: &Sandbox, args: &str, played: &[Vec<f32>; 2]) {
    sandbox.succeeds(&format!("render {args} --bits 32f --force -o source.wav"));
    let source = sandbox.wav("source.wav");
    let side = |side| source.samples.iter().skip(side).step_by(2).map(|sample| *sample as f32).collect::<Vec<f32>>();
    let source = [side(0), side(1)];
    assert_eq!(source[0].len(), played[0].len());
    for (octave, (wanted, found)) in bands(&source).into_iter().zip(bands(played)).enumerate() {
        let Some(wanted) = wanted else { continue };
        let found = found.unwrap_or(f64::NEG_INFINITY);
        assert!(
            (wanted - found).abs() < 1.0,
            "{args}, octave {octave}: {wanted} dB in the source, {found} dB in the sample"
        );
    }
}

#[test]
fn a_sampled_preset_plays_as_its_source() {
    let sandbox = Sandbox::new();
    sandbox.succeeds("sample Marimba -o marimba --keys C3-C5 --every 6 --velocities 2 --strikes 1 --length 1.5");
    for (key, velocity) in [(50, 127), (56, 64), (68, 127)] {
        let played = play(&sandbox, "marimba", "marimba.sfz", [key.into(), velocity.into(), 1.0], 72_000);
        let velocity = if velocity <= 63 { 63 } else { 127 };
        compare(&sandbox, &format!("--preset Marimba --note {key} --velocity {velocity} --length 1.5"), &played);
    }
    let text = String::from_utf8(sandbox.read("marimba/marimba.sfz")).unwrap();
    // Keys 48 to 72 in zones of six semitones, with two layers each.
    let all = regions(&text);
    let mut keys: Vec<f64> = all.iter().flat_map(|region| [number(region, "lokey"), number(region, "hikey")]).collect();
    keys.sort_by(f64::total_cmp);
    assert_eq!((all.len(), keys[0], keys[keys.len() - 1]), (10, 48.0, 72.0));
    let decent = String::from_utf8(sandbox.read("marimba/marimba.dspreset")).unwrap();
    assert_eq!(decent.matches("<sample ").count(), 10);
}

#[test]
fn a_steady_sound_is_looped_and_sounds_on_like_its_source() {
    let sandbox = Sandbox::new();
    // A mass that is bowed: nothing else about it changes.
    let sound = "--set bow_level=0 --set mallet_level=-60 --set noise_level=-60 --set release=0.5";
    sandbox.succeeds(&format!("sample init {sound} --keys 57-57 --velocities 1 --strikes 2 --length 3 -o bowed"));
    let text = String::from_utf8(sandbox.read("bowed/init.sfz")).unwrap();
    let [region] = &regions(&text)[..] else { panic!("its strikes are all alike: {text}") };
    assert_eq!(region["loop_mode"], "loop_continuous");
    let release = number(region, "ampeg_release");
    // A sampler falls by e⁹ in this time.
    let seconds_of_60_db = release * 60.0 / (9.0 * 20.0 * std::f64::consts::LOG10_E);
    assert!((seconds_of_60_db - 0.5).abs() < 0.05, "{release}");
    let played = play(&sandbox, "bowed", "init.sfz", [57.0, 127.0, 1.0], 6 * 48_000);
    compare(&sandbox, &format!("--preset init {sound} --note 57 --velocity 127 --length 6"), &played);
    let wav = sandbox.read(&format!("bowed/{}", region["sample"]));
    let chunk = wav.windows(4).position(|window| window == b"smpl").unwrap();
    assert_eq!(wav[chunk + 20..chunk + 24], 57_u32.to_le_bytes(), "the key of the sample");
}

#[test]
fn a_played_sound_is_looped_and_sounds_on_like_its_source() {
    let sandbox = Sandbox::new();
    for preset in ["Violin", "Trombone", "Oboe"] {
        sandbox.succeeds(&format!("sample {preset} -o loops --keys 60-60 --velocities 1 --strikes 1 --length 3"));
        let sfz = format!("{}.sfz", preset.to_lowercase());
        let text = String::from_utf8(sandbox.read(&format!("loops/{sfz}"))).unwrap();
        assert_eq!(regions(&text)[0]["loop_mode"], "loop_continuous", "{preset}");
        let played = play(&sandbox, "loops", &sfz, [60.0, 127.0, 1.0], 6 * 48_000);
        compare(&sandbox, &format!("--preset {preset} --note 60 --velocity 127 --length 6"), &played);
        fs::remove_dir_all(sandbox.path("loops")).unwrap();
    }
}

#[test]
fn a_kit_keeps_its_keys_and_choke_groups_and_rings_on() {
    let sandbox = Sandbox::new();
    let mut sample = sandbox.sprung("sample --keys 36-46 --velocities 1 --strikes 2 --length 0.2 --format flac -o kit");
    sample.args(["Acoustic Kit"]).assert().success();
    let text = String::from_utf8(sandbox.read("kit/acoustic-kit.sfz")).unwrap();
    let regions = regions(&text);
    let of_key = |key: f64| regions.iter().filter(move |region| number(region, "pitch_keycenter") == key);
    assert!(of_key(36.0).all(|region| region["lokey"] == region["hikey"] && region["loop_mode"] == "one_shot"));
    let group = |key: f64| of_key(key).next().unwrap().get("off_by").cloned();
    assert!(group(42.0).is_some() && group(42.0) == group(46.0) && group(36.0).is_none());
    assert_eq!(of_key(36.0).count(), 2, "strikes that alternate");
    let [first, second] = [1.0, 2.0].map(|turn| play(&sandbox, "kit", "acoustic-kit.sfz", [36.0, 100.0, turn], 9600));
    assert!(first != second);
    let mut render =
        sandbox.sprung("render --note 36 --velocity 127 --length 0.2 --tail none --bits 32f -o source.wav");
    render.args(["--preset", "Acoustic Kit"]).assert().success();
    let source = sandbox.wav("source.wav");
    let quiet = 9600 - 960;
    let left = source.samples.iter().step_by(2).take(quiet);
    assert!(left.zip(&first[0]).all(|(a, b)| (a - f64::from(*b)).abs() < 1e-6), "but for the fade at its end");
}

#[test]
fn a_pad_whose_strikes_are_alike_does_not_alternate() {
    let sandbox = Sandbox::new();
    let plain = "format = 1\nname = \"Plain\"\nmodes = [{ ratio = 1 }]\n[params]\nnoise_level = -60\n";
    sandbox.write("plain.toml", plain);
    let keys = "[{ key = \"C2\", sound = \"plain.toml\" }, { key = \"D2\", sound = \"Snare\" }]";
    sandbox.write("two.toml", format!("kit = 1\nname = \"Two\"\nkeys = {keys}\n"));
    sandbox.succeeds("sample two.toml --velocities 1 --strikes 2 --length 0.2 -o two");
    let text = String::from_utf8(sandbox.read("two/two.sfz")).unwrap();
    let regions = regions(&text);
    let turns = |key: &str| -> Vec<_> {
        let of_key = regions.iter().filter(|region| region["pitch_keycenter"] == key);
        of_key.map(|region| ["seq_length", "seq_position"].map(|turn| region.get(turn).cloned())).collect()
    };
    let turn = |number: &str| [Some("2".to_owned()), Some(number.to_owned())];
    assert_eq!((turns("36"), turns("38")), (vec![[None, None]], vec![turn("1"), turn("2")]));
    let decent = String::from_utf8(sandbox.read("two/two.dspreset")).unwrap();
    assert_eq!(["seqMode=\"always\"", "seqMode=\"round_robin\""].map(|mode| decent.matches(mode).count()), [1, 2]);
}

#[test]
fn a_release_is_a_sample_that_is_softer_after_a_longer_note() {
    let sandbox = Sandbox::new();
    let sound = "--set space=room --set space_mix=40 --set decay=2 --set release=0.2 --set noise_level=-60";
    let keys = "--keys 60-60 --velocities 1 --strikes 1 --length 2";
    sandbox.succeeds(&format!("sample init {sound} {keys} --releases --bits 32f -o room"));
    let text = String::from_utf8(sandbox.read("room/init.sfz")).unwrap();
    let [held, let_go] = &regions(&text)[..] else { panic!("{text}") };
    assert_eq!((held.get("trigger"), let_go["trigger"].as_str()), (None, "release"));
    let sides = |region: &BTreeMap<String, String>| {
        let wav = sandbox.wav(&format!("room/{}", region["sample"]));
        [0, 1].map(|side| wav.samples.iter().skip(side).step_by(2).copied().collect::<Vec<f64>>())
    };
    let (held_sides, let_go_sides, release) = (sides(held), sides(let_go), number(held, "ampeg_release"));
    for seconds in [0.3, 0.6, 1.2] {
        let end = (seconds * 48_000.0) as usize;
        let level = number(let_go, "volume") - number(let_go, "rt_decay") * seconds;
        let gain = libm::pow(10.0, level / 20.0);
        let played = [0, 1].map(|side| {
            let sample = |n: usize| {
                let held = held_sides[side].get(n).copied().unwrap_or(0.0);
                let Some(after) = n.checked_sub(end) else { return held as f32 };
                let time = after as f64 / 48_000.0;
                let (fade, attack) = (libm::exp(-9.0 * time / release), time / number(let_go, "ampeg_attack"));
                let after = let_go_sides[side].get(after).copied().unwrap_or(0.0);
                (fade * held + gain * attack.min(1.0) * after) as f32
            };
            (0..end + 24_000).map(sample).collect::<Vec<f32>>()
        });
        assert!(played[0][end..].iter().any(|sample| sample.abs() > 1e-3));
        let args = format!("--preset init {sound} --note 60 --velocity 127 --length {seconds} --tail 0.5");
        compare_with_tail(&sandbox, &args, &played);
    }
    // Without the option, and in the DecentSampler file, there are none.
    assert_eq!(String::from_utf8(sandbox.read("room/init.dspreset")).unwrap().matches("<sample ").count(), 1);
    sandbox.succeeds(&format!("sample init {sound} {keys} -o dry"));
    assert!(!String::from_utf8(sandbox.read("dry/init.sfz")).unwrap().contains("trigger"));
}

#[test]
fn an_instrument_that_was_broken_off_goes_on() {
    let sandbox = Sandbox::new();
    let base = "sample Kick --keys 36-38 --every 1 --velocities 2 --strikes 1 --length 0.3";
    sandbox.succeeds(&format!("{base} -o whole"));
    sandbox.succeeds(&format!("{base} -o part"));
    let list = sandbox.read("part/samples.jsonl");
    let lines: Vec<&[u8]> = list.split_inclusive(|byte| *byte == b'\n').collect();
    assert_eq!(lines.len(), 7);
    // Three finished samples, and a line that was cut off; of the finished files, one has vanished and one was cut off.
    sandbox.write("part/samples.jsonl", [&lines[..4].concat(), &lines[4][..9]].concat());
    let first: serde_json::Value = serde_json::from_slice(lines[1]).unwrap();
    fs::remove_file(sandbox.path(&format!("part/{}", first["file"].as_str().unwrap()))).unwrap();
    let second: serde_json::Value = serde_json::from_slice(lines[2]).unwrap();
    let cut = format!("part/{}", second["file"].as_str().unwrap());
    sandbox.write(&cut, &sandbox.read(&cut)[..500]);
    sandbox.fails(&format!("{base} -o part"), 1, "an instrument is there already: add --resume");
    sandbox.fails(&format!("{base} -o part --resume --seed 1"), 1, "it has other settings");
    let output = sandbox.sprung(&format!("{base} -o part --resume")).assert().success().get_output().clone();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.contains("6 samples, 0 loops, 1 found finished"), "{told}");
    for name in ["kick.sfz", "kick.dspreset"] {
        assert!(sandbox.read(&format!("part/{name}")) == sandbox.read(&format!("whole/{name}")), "{name}");
    }
    for entry in fs::read_dir(sandbox.path("whole/samples")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let same = sandbox.read(&format!("part/samples/{name}")) == sandbox.read(&format!("whole/samples/{name}"));
        assert!(same, "{name}");
    }
    sandbox.fails("sample Kick -o no --length 0", 1, "--length: no frame is as short");
    sandbox.fails("sample Kick -o no --length 86400 --format flac", 1, "--format: the sound is too long for FLAC");
    sandbox.fails("sample Kick -o no --keys 40-30", 2, "‘40-30’ is no range of keys");
    sandbox.fails("sample Kick -o no --bits 32f --format flac", 1, "--bits: FLAC has no floats");
}

#[test]
fn a_kit_is_resumed_only_with_the_same_presets() {
    let sandbox = Sandbox::new();
    let base = "sample --keys 36-36 --velocities 1 --strikes 1 --length 0.1";
    let sample = |args: &str| {
        let mut sample = sandbox.sprung(&format!("{base} {args}"));
        sample.arg("Acoustic Kit");
        sample
    };
    sample("-o kit").assert().success();
    sample("-o kit --resume").assert().success();
    let output = sample("-o kit --resume --set decay=0.1").assert().code(1).get_output().clone();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.contains("it has other settings"), "{told}");
}

#[test]
fn a_file_in_the_way_is_found_before_the_work() {
    let sandbox = Sandbox::new();
    fs::create_dir(sandbox.path("kick")).unwrap();
    sandbox.write("kick/kick.dspreset", "mine");
    let base = "sample Kick --keys 36-36 --velocities 2 --strikes 1 --length 0.1 -o kick";
    sandbox.fails(base, 1, "kick.dspreset");
    assert_eq!(fs::read_dir(sandbox.path("kick/samples")).unwrap().count(), 0);
    fs::remove_file(sandbox.path("kick/kick.dspreset")).unwrap();
    sandbox.succeeds(base);
}

#[test]
fn an_instrument_without_a_name_of_letters_has_one() {
    let sandbox = Sandbox::new();
    let preset = String::from_utf8(sandbox.succeeds("presets show init")).unwrap();
    let named = preset.lines().map(|line| if line.starts_with("name = ") { "name = \"♪\"" } else { line });
    sandbox.write("bell.toml", named.collect::<Vec<_>>().join("\n"));
    // Nothing of it sounds: its samples have a frame all the same.
    sandbox.succeeds(
        "sample bell.toml --set mallet_level=-60 --set noise_level=-60 --keys 60-60 --velocities 1 --strikes 1 --length 0.1 --format flac -o bell",
    );
    let text = String::from_utf8(sandbox.read("bell/sound.sfz")).unwrap();
    let [region] = &regions(&text)[..] else { panic!("{text}") };
    let file = fs::File::open(sandbox.path(&format!("bell/{}", region["sample"]))).unwrap();
    assert_eq!(sprung::io::sound_file::read(file, "sample").unwrap().channels[0], [0.0]);
}
