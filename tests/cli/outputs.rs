//! Destinations of WAVs: files, links, pipes, devices.

#[cfg(unix)]
use crate::exists;
use crate::{Sandbox, Wav, end, note_on, song};
use std::io::Read;
use std::process::{Command, Stdio};

#[test]
fn lengths_are_exact_in_frames() {
    let sandbox = Sandbox::new();
    sandbox.write("song.mid", song(&[note_on(0, 0, 60), end(240)]));
    for (args, rate, bits, channels, frames) in [
        ("--note C2 --length 0.5 --tail none", 48_000, 24, 2, 24_000),
        ("--note C2 --length 0.1 --tail none --rate 44100 --bits 16", 44_100, 16, 2, 4410),
        ("--note C2 --length 0.1 --tail none --rate 22050 --bits 32f --mono", 22_050, 32, 1, 2205),
        ("--note C2 --length 0.0001 --tail none --rate 8000 --mono", 8_000, 24, 1, 1),
        ("--note C2 --length 0 --tail none", 48_000, 24, 2, 0),
        ("--note C2,E2 --length 0.25 --tail 0.125 --rate 192000", 192_000, 24, 2, 72_000),
        ("song.mid --tail none", 48_000, 24, 2, 12_000),
        ("song.mid --tail 1.5 --rate 768000", 768_000, 24, 2, 1_344_000),
    ] {
        sandbox.succeeds(&format!("render {args} --force -o out.wav"));
        let wav = sandbox.wav("out.wav");
        let format = (wav.spec.sample_rate, wav.spec.bits_per_sample, wav.spec.channels);
        assert_eq!((format, wav.frames), ((rate, bits, channels), frames), "{args}");
    }
    assert_eq!(sandbox.files(), ["out.wav", "song.mid"]);
}

#[test]
fn a_pipe_gets_the_bytes_of_the_file() {
    let sandbox = Sandbox::new();
    for bits in ["--bits 16", "--bits 16 --dither", "--bits 24", "--bits 32f"] {
        for channels in ["", "--mono"] {
            for tail in ["auto", "none", "0.01"] {
                let args = format!("render --note C4 --length 0.0501 --set decay=0.1 {bits} {channels} --tail {tail}");
                sandbox.succeeds(&format!("{args} --force -o out.wav"));
                let piped = sandbox.succeeds(&format!("{args} -o -"));
                assert!(piped == sandbox.read("out.wav"), "{args}");
                assert_eq!(piped.len() % 2, 0, "{args}");
                Wav::read(&piped);
            }
        }
    }
}

#[test]
fn json_goes_where_the_wav_does_not() {
    let sandbox = Sandbox::new();
    let stdout = sandbox.succeeds("render --note C2 --length 0.5 --tail 0.25 --json -o out.wav");
    let report: serde_json::Value = serde_json::from_slice(&stdout).unwrap();
    assert_eq!(report["frames"], 36_000);
    assert_eq!(report["seconds"], 0.75);
    assert_eq!(report["tail_seconds"], 0.25);
    assert_eq!(report["output"], "out.wav");
    for key in ["peak_dbfs", "rms_dbfs", "lufs", "voices_used", "realtime_factor", "clipped_samples", "gain_db"] {
        assert!(report.get(key).is_some(), "{key}");
    }
    let output = sandbox.sprung("render --note C2 --length 0.5 --json -o -").assert().success().get_output().clone();
    Wav::read(&output.stdout);
    let report: serde_json::Value = serde_json::from_slice(&output.stderr).unwrap();
    assert_eq!(report["output"], "stdout");
}

#[test]
fn without_json_stdout_stays_clean_and_stderr_has_one_line() {
    let sandbox = Sandbox::new();
    let output = sandbox.sprung("render --note C2 --length 0.1 -o out.wav").assert().success().get_output().clone();
    assert!(output.stdout.is_empty());
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(stderr.starts_with("out.wav: ") && stderr.lines().count() == 1, "{stderr}");
}

#[test]
fn force_replaces_a_file() {
    let sandbox = Sandbox::new();
    sandbox.write("out.wav", "old");
    sandbox.succeeds("render --note C2 --length 0.1 --force -o out.wav");
    assert_eq!(sandbox.wav("out.wav").spec.channels, 2);
    assert_eq!(sandbox.files(), ["out.wav"]);
}

#[test]
fn a_song_comes_through_stdin() {
    let sandbox = Sandbox::new();
    let song = song(&[note_on(0, 0, 60), end(240)]);
    sandbox.write("song.mid", &song);
    sandbox.succeeds("render song.mid -o file.wav");
    sandbox.sprung("render - -o stdin.wav").write_stdin(song).assert().success();
    assert!(sandbox.read("file.wav") == sandbox.read("stdin.wav"));
}

#[test]
fn a_closed_pipe_ends_a_render_with_a_message() {
    let sandbox = Sandbox::new();
    let mut child = Command::new(assert_cmd::cargo::cargo_bin!("sprung"))
        .args(["render", "--note", "C2", "--length", "100", "-o", "-"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .current_dir(sandbox.path("."))
        .spawn()
        .unwrap();
    child.stdout.take().unwrap().read_exact(&mut [0; 100]).unwrap();
    let output = child.wait_with_output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), stderr.lines().count()), (Some(1), 1), "{stderr}");
    assert!(stderr.starts_with("sprung: error: stdout: "), "{stderr}");
}

#[cfg(unix)]
#[test]
fn devices_and_named_pipes_are_written_straight() {
    let sandbox = Sandbox::new();
    if exists("/dev/null") {
        sandbox.succeeds("render --note C2 --length 0.1 -o /dev/null");
    }
    assert!(Command::new("mkfifo").arg(sandbox.path("fifo")).status().unwrap().success());
    let fifo = sandbox.path("fifo");
    let reader = std::thread::spawn(move || std::fs::read(fifo).unwrap());
    sandbox.succeeds("render --note C2 --length 0.1 -o fifo");
    let through_fifo = reader.join().unwrap();
    sandbox.succeeds("render --note C2 --length 0.1 -o out.wav");
    assert!(through_fifo == sandbox.read("out.wav"));
    assert_eq!(sandbox.files(), ["fifo", "out.wav"]);
}

#[cfg(target_os = "linux")]
#[test]
fn stdout_is_written_by_its_names() {
    let sandbox = Sandbox::new();
    let args = "render --note C2 --length 0.1";
    sandbox.succeeds(&format!("{args} -o out.wav"));
    for name in ["/dev/stdout", "/proc/self/fd/1", "/dev/fd/1"] {
        assert!(sandbox.succeeds(&format!("{args} -o {name}")) == sandbox.read("out.wav"), "through a pipe to {name}");
        // The report must not be mixed into the samples.
        let stdout = std::fs::File::create(sandbox.path("redirected.wav")).unwrap();
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sprung"));
        command.args(format!("{args} --json -o {name}").split_whitespace()).stdout(stdout).stderr(Stdio::null());
        assert!(command.status().unwrap().success());
        assert!(sandbox.read("redirected.wav") == sandbox.read("out.wav"), "into a file by {name}");
    }
}

#[cfg(unix)]
#[test]
fn a_link_that_leads_nowhere_is_written_through() {
    let sandbox = Sandbox::new();
    std::fs::create_dir(sandbox.path("folder")).unwrap();
    std::os::unix::fs::symlink("folder/out.wav", sandbox.path("link.wav")).unwrap();
    sandbox.succeeds("render --note C2 --length 0.1 --force -o link.wav");
    assert!(std::fs::symlink_metadata(sandbox.path("link.wav")).unwrap().is_symlink());
    assert_eq!(sandbox.wav("folder/out.wav").spec.channels, 2);
    assert_eq!(sandbox.files(), ["folder", "link.wav"]);
}

#[test]
fn a_read_only_file_is_not_replaced() {
    let sandbox = Sandbox::new();
    let path = sandbox.write("out.wav", "keep me");
    let mut permissions = std::fs::metadata(&path).unwrap().permissions();
    permissions.set_readonly(true);
    std::fs::set_permissions(&path, permissions).unwrap();
    sandbox.fails("render --note C2 --force -o out.wav", 1, "out.wav: the file is read-only: make it writable, or");
    assert_eq!(sandbox.read("out.wav"), b"keep me");
}
