//! No output may be one of the inputs, however the file is named.

use crate::{Sandbox, end, note_on, song};
use sprung::preset::Preset;
#[cfg(unix)]
use std::fs::{File, OpenOptions};

fn sandbox() -> Sandbox {
    let sandbox = Sandbox::new();
    sandbox.write("song.mid", song(&[note_on(0, 0, 60), end(240)]));
    sandbox.write("mine.toml", Preset::find("Kick").unwrap().to_toml());
    sandbox
}

#[test]
fn an_input_is_not_replaced() {
    let sandbox = sandbox();
    std::fs::hard_link(sandbox.path("mine.toml"), sandbox.path("hard.wav")).unwrap();
    std::fs::create_dir(sandbox.path("folder")).unwrap();
    let mut ways = vec!["mine.toml", "./mine.toml", "folder/../mine.toml", "hard.wav"];
    if cfg!(unix) {
        #[cfg(unix)]
        std::os::unix::fs::symlink("mine.toml", sandbox.path("soft.wav")).unwrap();
        ways.push("soft.wav");
    }
    let expected = sandbox.read("mine.toml");
    for way in ways {
        for force in ["", "--force"] {
            let args = format!("render song.mid --preset mine.toml {force} -o {way}");
            sandbox.fails(
                &args,
                1,
                &format!("{way}: this is the input ‘mine.toml’: expected another file to write to"),
            );
        }
    }
    assert!(sandbox.read("mine.toml") == expected);
    let song = sandbox.read("song.mid");
    std::fs::hard_link(sandbox.path("song.mid"), sandbox.path("hard-song.wav")).unwrap();
    sandbox.fails("render song.mid --force -o hard-song.wav", 1, "hard-song.wav: this is the input ‘song.mid’");
    assert!(sandbox.read("song.mid") == song);
}

/// Opens a file for appending, as the shell does for `>>`.
#[cfg(unix)]
fn append(sandbox: &Sandbox, name: &str) -> File {
    OpenOptions::new().append(true).open(sandbox.path(name)).unwrap()
}

#[cfg(unix)]
#[test]
fn an_input_is_not_written_to_through_stdout() {
    let sandbox = sandbox();
    let (song, preset) = (sandbox.read("song.mid"), sandbox.read("mine.toml"));
    std::fs::hard_link(sandbox.path("song.mid"), sandbox.path("song.wav")).unwrap();
    for (args, stdout, stdin) in [
        ("render song.mid -o -", "song.mid", None),
        ("render - -o -", "song.mid", Some("song.mid")),
        ("render - --force -o song.wav", "out", Some("song.mid")),
        ("render song.mid -o /dev/stdout", "song.mid", None),
        ("render song.mid --preset mine.toml -o -", "mine.toml", None),
        ("render song.mid --preset mine.toml --json -o out.wav", "mine.toml", None),
        ("presets show mine.toml", "mine.toml", None),
        ("presets check mine.toml", "mine.toml", None),
    ] {
        sandbox.write("out", "");
        let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin!("sprung"));
        command.args(args.split_whitespace()).current_dir(sandbox.path(".")).stdout(append(&sandbox, stdout));
        if let Some(stdin) = stdin {
            command.stdin(File::open(sandbox.path(stdin)).unwrap());
        }
        let output = command.output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{args}: {stderr}");
        assert!(stderr.contains(": this is the input ‘") && stderr.lines().count() == 1, "{args}: {stderr}");
        assert!(sandbox.read("song.mid") == song && sandbox.read("mine.toml") == preset, "{args}");
    }
    assert_eq!(sandbox.files(), ["mine.toml", "out", "song.mid", "song.wav"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_descriptor_of_an_input_is_that_input() {
    let sandbox = sandbox();
    let expected = sandbox.read("song.mid");
    let stdin = File::open(sandbox.path("song.mid")).unwrap();
    let output = std::process::Command::new(assert_cmd::cargo::cargo_bin!("sprung"))
        .args(["render", "-", "--force", "-o", "/proc/self/fd/0"])
        .current_dir(sandbox.path("."))
        .stdin(stdin)
        .output()
        .unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(stderr.contains("/proc/self/fd/0: this is the input ‘stdin’"), "{stderr}");
    assert!(sandbox.read("song.mid") == expected);
}

#[cfg(target_os = "linux")]
#[test]
fn names_that_are_not_utf_8_are_names() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let sandbox = sandbox();
    let name = |bytes: &'static [u8]| OsStr::from_bytes(bytes);
    let folder = sandbox.path(".");
    std::fs::rename(folder.join("song.mid"), folder.join(name(b"s\xf6ng.mid"))).unwrap();
    std::fs::rename(folder.join("mine.toml"), folder.join(name(b"m\xffine.toml"))).unwrap();
    let args = [b"render", &b"s\xf6ng.mid"[..], b"--preset", b"m\xffine.toml", b"-o", b"\xf6ut.wav"].map(name);
    sandbox.sprung("").args(args).assert().success();
    assert!(std::fs::metadata(folder.join(name(b"\xf6ut.wav"))).unwrap().len() > 1000);
    let shown = sandbox.sprung("presets show").arg(name(b"m\xffine.toml")).assert().success().get_output().clone();
    assert!(String::from_utf8(shown.stdout).unwrap().contains("Kick"));
}
