//! Files and messages that remain when a command is interrupted or killed.

use crate::{DEFAULT_SIGNALS, Sandbox, Wav, end as finish, note_on, signals, song};
use sprung::preset::{KitPreset, Preset};
use std::io::Read;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Work that takes many hours.
const ENDLESS: &str = "render --note C2 --length 86400 --rate 8000 --bits 16 --mono";

/// Starts `sprung`, as a child of another program if one is given, and waits until `ready` returns true.
fn start(sandbox: &Sandbox, below: &[&str], args: &str, mut ready: impl FnMut(&mut Child) -> bool) -> Child {
    let sprung = assert_cmd::cargo::cargo_bin!("sprung").to_str().unwrap();
    let words = DEFAULT_SIGNALS.iter().chain(below).copied().chain([sprung]);
    let words: Vec<&str> = words.chain(args.split_whitespace()).collect();
    let mut child = Command::new(words[0])
        .args(&words[1..])
        .current_dir(sandbox.path("."))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let limit = Instant::now() + Duration::from_secs(60);
    while !ready(&mut child) {
        assert!(Instant::now() < limit && child.try_wait().unwrap().is_none(), "it never got going");
        std::thread::sleep(Duration::from_millis(5));
    }
    child
}

/// Whether the first 64 KiB are on disk. Signal handlers are installed long before.
fn has_begun(sandbox: &Sandbox) -> bool {
    sandbox.files().iter().any(|name| std::fs::metadata(sandbox.path(name)).is_ok_and(|file| file.len() > 0))
}

fn send(child: &Child, signal: &str) {
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
}

fn end(mut child: Child, signal: &str) -> ExitStatus {
    send(&child, signal);
    child.wait().unwrap()
}

#[test]
fn interrupts_leave_nothing_behind() {
    for signal in ["-INT", "-TERM", "-HUP"] {
        let sandbox = Sandbox::new();
        let child = start(&sandbox, &[], &format!("{ENDLESS} -o out.wav"), |_| has_begun(&sandbox));
        assert_eq!(end(child, signal).code(), Some(130), "{signal}");
        assert!(sandbox.files().is_empty(), "{:?}", sandbox.files());
    }
    let sandbox = Sandbox::new();
    let ready = |child: &mut Child| child.stdout.as_mut().unwrap().read_exact(&mut [0; 100]).is_ok();
    let child = start(&sandbox, &[], &format!("{ENDLESS} --tail none -o -"), ready);
    assert_eq!(end(child, "-INT").code(), Some(130), "also while nobody reads the pipe");
}

#[test]
fn what_comes_before_a_part_of_a_song_can_be_interrupted() {
    let sandbox = Sandbox::new();
    sandbox.write("song.mid", song(&[note_on(0, 0, 60), finish(80_000 * 960)]));
    for output in ["-o out.wav", "--stems stems/of/song"] {
        let has_begun = |folder: &str| {
            let files = std::fs::read_dir(sandbox.path(folder)).into_iter().flatten();
            files.flatten().any(|file| file.file_name().to_str().unwrap().starts_with(".sprung-"))
        };
        let args = format!("render song.mid --from 79000 --rate 768k --bits 16 {output}");
        let child = start(&sandbox, &[], &args, |_| has_begun(".") || has_begun("stems/of/song"));
        // Signals are caught right after the file is made.
        std::thread::sleep(Duration::from_millis(300));
        assert_eq!(end(child, "-INT").code(), Some(130), "{output}");
        assert_eq!(sandbox.files(), ["song.mid"], "{output}");
    }
}

/// Interrupts a child and returns its exit code and its stderr.
fn interrupted(child: Child) -> (Option<i32>, String) {
    send(&child, "-INT");
    let output = child.wait_with_output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn an_interrupted_analysis_writes_nothing() {
    // Noise is not a sum of modes, so both commands search for modes for a long time.
    let noise = signals::wav(&signals::noise(8 * 44_100), 44_100, 1);
    for args in [
        "analyze noise.wav --figure modes.png",
        "analyze noise.wav --hits --json --figure modes.svg",
        "fit noise.wav -o noise.toml --report noise.html",
        "fit noise.wav@C4@40 noise.wav@C4@100 -o noise.toml",
    ] {
        let sandbox = Sandbox::new();
        sandbox.write("noise.wav", &noise);
        let ready = |_: &mut Child| sandbox.files().iter().any(|name| name.starts_with(".sprung-"));
        let child = start(&sandbox, &[], args, ready);
        let expected = (Some(130), "sprung: error: interrupted; nothing incomplete was written\n".to_owned());
        assert_eq!(interrupted(child), expected, "{args}");
        assert_eq!(sandbox.files(), ["noise.wav"], "{args}");
    }
}

#[test]
fn an_interrupted_audition_says_what_it_has_written() {
    let files = |sandbox: &Sandbox, ending: &str| {
        let folder = std::fs::read_dir(sandbox.path("page")).into_iter().flatten();
        folder.filter(|entry| entry.as_ref().unwrap().file_name().to_str().unwrap().ends_with(ending)).count()
    };
    let audition = |ending: &str| {
        let sandbox = Sandbox::new();
        let ready = |_: &mut Child| files(&sandbox, ending) > 0;
        let (code, said) = interrupted(start(&sandbox, &[], "presets audition --out page", ready));
        assert_eq!(code, Some(130), "{said}");
        let sounds = files(&sandbox, ".wav");
        assert_eq!((files(&sandbox, ".png"), files(&sandbox, "")), (sounds, 2 * sounds), "{said}");
        let all = Preset::factory().len() + KitPreset::factory().len();
        let expected = match sounds {
            0 => "nothing incomplete was written".to_owned(),
            _ => format!("{sounds} of {all} sounds are in page, without a page; --force makes all of them anew"),
        };
        assert_eq!(said, format!("sprung: error: interrupted; {expected}\n"));
        assert_eq!(sandbox.path("page").exists(), sounds > 0, "an empty folder does not remain");
    };
    audition(".part");
    audition(".png");
}

#[test]
fn signals_that_were_ignored_stay_ignored() {
    let sandbox = Sandbox::new();
    // A child inherits ignored signals, from `trap '' …` in a shell as from `nohup`.
    for (signal, trap) in [("-HUP", "HUP"), ("-INT", "INT"), ("-TERM", "TERM")] {
        let script = format!("trap '' {trap}; exec \"$@\"");
        let below = ["sh", "-c", &script, "sh"];
        let child = start(&sandbox, &below, &format!("{ENDLESS} -o out.wav"), |_| has_begun(&sandbox));
        send(&child, signal);
        std::thread::sleep(Duration::from_millis(200));
        let other = if signal == "-INT" { "-TERM" } else { "-INT" };
        let mut child = child;
        assert!(child.try_wait().unwrap().is_none(), "{signal} ended it");
        assert_eq!(end(child, other).code(), Some(130), "the others are not ignored");
        assert!(sandbox.files().is_empty(), "{:?}", sandbox.files());
    }
}

#[test]
fn what_a_killed_render_left_goes_with_the_next_one() {
    let sandbox = Sandbox::new();
    let child = start(&sandbox, &[], &format!("{ENDLESS} -o out.wav"), |_| has_begun(&sandbox));
    let left = sandbox.files();
    assert!(left.len() == 1 && left[0].starts_with(".sprung-") && left[0].ends_with(".part"), "{left:?}");
    // The file that is still being written stays.
    sandbox.succeeds("render --note C2 --length 0.1 -o one.wav");
    assert_eq!(sandbox.files(), [&left[0], "one.wav"]);
    end(child, "-KILL");
    assert_eq!(sandbox.files(), [&left[0], "one.wav"]);
    sandbox.succeeds("render --note C2 --length 0.1 -o two.wav");
    assert_eq!(sandbox.files(), ["one.wav", "two.wav"]);
    Wav::read(&sandbox.read("two.wav"));
}
