//! `sprung lab` as a program: tables, figures, numbers, sounds, and bad input.

use crate::{DEFAULT_SIGNALS, Sandbox};
use std::io::Read;
use std::process::{Child, Command, Stdio};
#[cfg(unix)]
use std::time::{Duration, Instant};

fn text(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).unwrap()
}

/// The words of the line that begins with `start`.
fn line<'a>(text: &'a str, start: &str) -> Vec<&'a str> {
    let found = text.lines().find(|line| line.starts_with(start)).unwrap_or_else(|| panic!("{start} in {text}"));
    found.split_whitespace().collect()
}

#[test]
fn compare_tells_what_explodes_shrinks_drifts_and_is_exact() {
    let table = text(Sandbox::new().succeeds("lab compare"));
    assert_eq!(table.lines().count(), 1 + 12 * 3);
    for (key, step, verdict) in [
        ("explicit-euler", "0.01", "grows"),
        ("explicit-euler", "0.15", "explodes"),
        ("implicit-euler", "0.15", "shrinks"),
        ("symplectic-euler", "0.05", "drifts"),
        ("rk4", "0.01", "close"),
        ("synth-exact", "0.15", "exact"),
        ("exponential", "0.15", "exact"),
    ] {
        let words = table.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
        let row = words.into_iter().find(|words| words[..2] == [key, step]);
        assert_eq!(row.unwrap_or_default().last(), Some(&verdict), "{key} {step}: {table}");
    }
}

#[test]
fn converge_and_stability_find_the_known_numbers() {
    let sandbox = Sandbox::new();
    let orders = text(sandbox.succeeds("lab converge --csv orders.csv"));
    for (key, order) in
        [("explicit-euler ", 1.0), ("symplectic-euler ", 1.0), ("heun ", 2.0), ("rk4 ", 4.0), ("verlet ", 2.0)]
    {
        assert!((line(&orders, key)[2].parse::<f64>().unwrap() - order).abs() < 0.1, "{orders}");
    }
    assert_eq!(line(&orders, "synth-exact ")[1..3], ["exact", "rounding"]);
    let limits = text(sandbox.succeeds("lab stability --csv limits.csv --grid 10"));
    for (key, limit) in [("explicit-euler", "never"), ("implicit-euler", "any"), ("rk4", "2.83"), ("verlet", "2.00")] {
        assert_eq!(line(&limits, key)[1..3], [limit, limit], "{limits}");
    }
    assert_eq!(text(sandbox.read("orders.csv")).lines().count(), 1 + 12 * 10, "one row per method and step");
    assert_eq!(text(sandbox.read("limits.csv")).lines().count(), 1 + 12 * 10 * 10);
}

#[test]
fn pitch_is_the_published_table() {
    let table = text(
        Sandbox::new().succeeds("lab pitch --methods synth-seed,synth-exact --frequencies 440,4186,8000,27.5,16000"),
    );
    let seeds: Vec<&str> = table.lines().filter(|line| line.starts_with("synth-seed")).collect();
    assert_eq!(line(seeds[0], "synth-seed")[1..4], ["+0.4", "+22.4", "+88.7"]);
    assert_eq!(line(seeds[0], "synth-seed")[5], "explodes");
    assert_eq!(line(seeds[2], "synth-seed")[4], "−149.5", "27.5 Hz in 0.1 s");
    let exact: Vec<&str> = table.lines().filter(|line| line.starts_with("synth-exact")).collect();
    assert_eq!(exact.len(), seeds.len(), "{table}");
    for row in exact {
        assert_eq!(row.split_whitespace().skip(1).collect::<Vec<_>>(), ["0"; 5], "{table}");
    }
}

#[test]
fn every_figure_comes_in_its_formats_and_replaces_nothing_unasked() {
    let sandbox = Sandbox::new();
    let methods = "--methods explicit-euler,synth-exact";
    for (command, formats) in [
        ("compare", &["html", "svg", "png"][..]),
        ("converge", &["svg", "png"]),
        ("stability --grid 8", &["svg", "png"]),
        ("pitch", &["svg", "png"]),
        ("listen sounds --seconds 0.1", &["svg", "png"]),
        ("animate --end 0.5", &["svg", "html", "gif"]),
    ] {
        for format in formats {
            sandbox.succeeds(&format!("lab {command} {methods} -o figure.{format} --csv numbers.csv --force"));
            let starts: &[u8] = match *format {
                "html" => b"<!doctype html>",
                "svg" => b"<svg",
                "png" => b"\x89PNG",
                _ => b"GIF89a",
            };
            let bytes = sandbox.read(&format!("figure.{format}"));
            assert!(bytes.starts_with(starts), "{command} {format}");
            assert!(sandbox.read("numbers.csv").contains(&b','), "{command}");
        }
    }
    let before = sandbox.read("figure.svg");
    sandbox.fails("lab pitch -o figure.svg", 1, "figure.svg: the file exists; add --force");
    sandbox.fails("lab pitch --csv numbers.csv", 1, "numbers.csv: the file exists");
    sandbox.fails("lab listen sounds", 1, "the file exists");
    assert_eq!(sandbox.read("figure.svg"), before);
}

#[test]
fn listen_writes_what_can_be_heard_and_tells_what_explodes() {
    let sandbox = Sandbox::new();
    let said = text(sandbox.succeeds("lab listen sounds --seconds 0.5 --rate 44100"));
    assert_eq!(said.lines().filter(|line| line.contains("explodes: limited from 0.0")).count(), 1, "{said}");
    let names = ["explicit-euler", "implicit-euler", "synth-seed", "synth-exact", "exponential"];
    for name in names {
        let wav = sandbox.wav(&format!("sounds/{name}.wav"));
        assert_eq!((wav.spec.sample_rate, wav.spec.channels, wav.frames), (44_100, 1, 22_050));
        assert!(wav.peak() > 0.3 && wav.peak() < 0.9, "{name}: {}", wav.peak());
    }
    assert_eq!(std::fs::read_dir(sandbox.path("sounds")).unwrap().count(), 12);
}

#[test]
fn numbers_go_to_stdout_and_the_table_out_of_their_way() {
    let output =
        Sandbox::new().sprung("lab compare --methods rk4 --steps 0.05 --csv -").assert().success().get_output().clone();
    assert!(output.stdout.starts_with(b"method,step_s,t_s,x_m"));
    assert_eq!(text(output.stdout).lines().count(), 102);
    assert!(text(output.stderr).contains("close"));
}

/// Starts `sprung`; the caller reads its output.
fn start(sandbox: &Sandbox, args: &str) -> Child {
    let sprung = assert_cmd::cargo::cargo_bin!("sprung");
    let mut command = if cfg!(unix) { Command::new(DEFAULT_SIGNALS[0]) } else { Command::new(sprung) };
    if cfg!(unix) {
        command.arg(DEFAULT_SIGNALS[1]).arg(sprung);
    }
    command
        .args(args.split_whitespace())
        .current_dir(sandbox.path("."))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    // The output is far larger than a pipe's buffer.
    let mut child = start(&Sandbox::new(), "lab compare --csv -");
    child.stdout.take().unwrap().read_exact(&mut [0; 100]).unwrap();
    let output = child.wait_with_output().unwrap();
    let stderr = text(output.stderr);
    assert!(output.status.success() && stderr.contains("explodes") && !stderr.contains("error:"), "{stderr}");
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_long_work_at_once_and_leaves_nothing_behind() {
    let sandbox = Sandbox::new();
    let mut child = start(&sandbox, "lab stability --grid 400 -o figure.png --csv numbers.csv");
    let limit = Instant::now() + Duration::from_secs(60);
    // The files are opened after the signal handler is installed. Seconds of work remain.
    while sandbox.files().len() < 2 {
        assert!(Instant::now() < limit && child.try_wait().unwrap().is_none(), "it never got going");
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(50));
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), text(output.stderr).as_str()), (Some(130), "sprung: error: interrupted\n"));
    assert!(sandbox.files().is_empty(), "{:?}", sandbox.files());
}

#[cfg(target_os = "linux")]
#[test]
fn listen_leaves_no_sound_where_its_numbers_cannot_be_written() {
    let sandbox = Sandbox::new();
    sandbox.fails("lab listen . --methods rk4,verlet --seconds 0.1 --csv /dev/full", 1, "/dev/full: ");
    sandbox.succeeds("lab listen . --methods rk4,verlet --seconds 0.1 --csv numbers.csv");
    assert_eq!(sandbox.files(), ["numbers.csv", "rk4.wav", "verlet.wav"]);
}

#[test]
fn stability_goes_on_where_a_method_refuses_a_step() {
    let sandbox = Sandbox::new();
    for args in ["--longest 20", "--longest 3.141592653589793", "--longest 100 --zeta 2"] {
        sandbox.succeeds(&format!("lab stability --grid 5 --methods synth-exact {args} -o a.svg --csv a.csv --force"));
        let csv = text(sandbox.read("a.csv"));
        assert!(csv.lines().any(|row| row.ends_with(",,1,inf")) && !csv.contains("NaN"), "{args}: {csv}");
    }
}

#[test]
fn systems_of_every_kind_can_be_integrated() {
    let sandbox = Sandbox::new();
    for (args, methods) in [
        ("--damping 20", 12),
        ("--target 0.3 --drive 2 --drive-frequency 1.1 --damping 1", 12),
        ("--spring duffing --cubic 100", 7),
        ("--spring pendulum --x0 2.5 --stiffness 9.81", 7),
        ("--stiffness 0 --v0 1 --damping 2", 9),
        ("--stiffness 0 --v0 1", 9),
    ] {
        let output =
            sandbox.sprung(&format!("lab compare {args} --steps 0.01")).assert().success().get_output().clone();
        assert_eq!(text(output.stdout).lines().count(), 1 + methods, "{args}");
        assert_eq!(text(output.stderr).matches("note: without").count(), 12 - methods, "{args}");
    }
}

#[test]
fn bad_input_is_told_clearly() {
    let sandbox = Sandbox::new();
    for (args, message) in [
        ("compare --mass -1", "mass: must be greater than 0 kg, got -1"),
        ("compare --mass 0", "mass: must be greater than 0 kg"),
        ("compare --stiffness -5", "stiffness: must be 0 N/m or more"),
        ("compare --damping nan", "damping: must be 0 kg/s or more"),
        ("compare --x0 inf", "start: position and velocity must be finite"),
        ("compare --steps 0", "steps: a step must be longer than 0 s"),
        ("compare --steps -0.1", "steps: a step must be longer than 0 s"),
        ("compare --steps 1e-9", "5000000000 steps; at most 5000000 fit in memory"),
        ("compare --steps 1e-5", "states; at most 5000000 fit in memory"),
        ("compare --end 0", "end: must be later than 0 s"),
        (
            "compare --stiffness 0 --methods synth-seed",
            "stiffness: must be greater than 0 where ω = √(k/m) is asked for",
        ),
        ("compare --stiffness 0 --methods chou-implicit", "stiffness: must be greater than 0"),
        ("compare --spring pendulum --methods exponential", "spring: must be linear for exponential"),
        ("compare --spring pendulum --methods implicit-euler --x0 2 --v0 9 --steps 1 --end 20", "did not converge"),
        ("compare --spring pendulum --stiffness 1e20", "steps away for a reference of this nonlinear motion"),
        ("compare --methods rk5", "the nearest is ‘rk4’"),
        ("compare -o figure.gif", "figure.gif: expected a name that ends in .html or .svg or .png"),
        ("compare -o none/figure.svg", "none/figure.svg: "),
        ("compare --csv a.csv -o a.csv", "the same file as --output"),
        ("converge --steps 0.1,0.05", "need at least 3"),
        ("stability --longest 1000", "--longest: 1000 is out of range: expected 0.1 to 100"),
        ("pitch --frequencies 30000", "frequency: must be below half the sample rate, 24000 Hz"),
        ("pitch --rate 0", "rate: must be greater than 0 Hz"),
        ("pitch --t60 0", "t60: must be greater than 0 s"),
        ("listen --frequency -440", "frequency: must be greater than 0 Hz"),
        ("listen --seconds 1e9", "seconds: 1000000000 is out of range: expected more than 0 s and at most 104.166 s"),
        ("listen --seconds 0", "seconds: 0 is out of range: expected more than 0 s"),
        ("animate --step 0", "--step: must be longer than 0 s, got 0"),
        ("animate --fps 0 -o a.gif", "fps: must be more than 0"),
        ("animate --end 1000 -o a.gif", "at most 3000"),
    ] {
        sandbox.fails(&format!("lab {args}"), 1, message);
    }
    sandbox.fails("lab listen --frequency A4", 2, "‘A4’ is not a number: expected Hz, as in 440 or 44.1k");
    sandbox.fails("lab pitch --rate fast", 2, "‘fast’ is not a number");
    sandbox.fails("lab compare --spring rubber", 2, "possible values: linear, duffing, pendulum");
}
