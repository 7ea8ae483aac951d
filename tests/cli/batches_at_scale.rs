//! Two thousand sounds of a batch have the same bytes after ten kills at random moments, and when four shards make them.

use crate::Sandbox;
use crate::batches::{files, start};
use sha2::{Digest, Sha256};
use sprung::internals::random::{key, unit};
use std::fs;
use std::time::{Duration, Instant, SystemTime};

const JOBS: &str = r#"{"preset": "Kick", "note": "C2", "length": 1, "tail": "none", "repeat": 2000, "sweep": {"uniform": [0, 36]}, "decay": {"log_uniform": ["50 ms", "2 s"]}, "velocity": {"integer": [40, 127]}}"#;
const COUNT: usize = 2000;
const KILLS: u64 = 10;

/// The SHA-256 of all files in a folder, manifest included, and of their names.
fn digest(sandbox: &Sandbox, folder: &str) -> String {
    let files = files(&sandbox.path(folder));
    assert_eq!(files.len(), COUNT + 1, "files in {folder}");
    let mut hash = Sha256::new();
    for (path, contents) in files {
        hash.update(path.to_str().unwrap());
        hash.update((contents.len() as u64).to_le_bytes());
        hash.update(contents);
    }
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
#[ignore = "takes minutes"]
fn killed_ten_times_or_in_four_shards_it_is_the_same() {
    let sandbox = Sandbox::new();
    sandbox.write("jobs.jsonl", JOBS);
    let started = Instant::now();
    sandbox.succeeds("batch jobs.jsonl --out whole");
    let whole = digest(&sandbox, "whole");
    println!("undisturbed:     {whole}, {:.1} s", started.elapsed().as_secs_f64());

    kill_ten_times(&sandbox);
    sandbox.succeeds("batch jobs.jsonl --out parts --resume");
    let killed = digest(&sandbox, "parts");
    println!("after ten kills: {killed}");
    assert_eq!(killed, whole);

    let shards = [3, 1, 4, 2]
        .map(|shard| start(&sandbox, &format!("batch jobs.jsonl --out shards --resume --jobs 1 --shard {shard}/4")));
    for mut shard in shards {
        assert!(shard.wait().unwrap().success());
    }
    let output = sandbox.sprung("batch jobs.jsonl --out shards --resume").assert().success().get_output().clone();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.contains("0 sounds") && told.contains("2000 found finished"), "{told}");
    for shard in 1..=4 {
        fs::remove_file(sandbox.path(&format!("shards/manifest-{shard}-of-4.jsonl"))).unwrap();
    }
    let sharded = digest(&sandbox, "shards");
    println!("of four shards:  {sharded}");
    assert_eq!(sharded, whole);
}

/// Starts a batch ten times and kills it each time at a later moment; each start resumes the batch.
fn kill_ten_times(sandbox: &Sandbox) {
    // The moments differ in each run; the printed seed repeats them.
    let seed = match std::env::var("SPRUNG_BATCH_SEED") {
        Ok(seed) => seed.parse().expect("SPRUNG_BATCH_SEED is a whole number"),
        Err(_) => SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap().subsec_nanos().into(),
    };
    println!("SPRUNG_BATCH_SEED={seed}");
    let chance = |n| unit(key(seed, 0), n);
    // Early enough that the batch is not finished before it is killed.
    let mut moments: Vec<usize> = (0..KILLS).map(|n| (chance(n) * 0.95 * COUNT as f64) as usize).collect();
    moments.sort_unstable();
    let made = || {
        let manifest = fs::read(sandbox.path("parts/manifest.jsonl")).unwrap_or_default();
        manifest.iter().filter(|byte| **byte == b'\n').count()
    };
    for (kill, lines) in (KILLS..).zip(moments) {
        let mut child = start(sandbox, "batch jobs.jsonl --out parts --resume");
        while made() < lines && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        // Anywhere within a job, not just after its line.
        std::thread::sleep(Duration::from_secs_f64(0.03 * chance(kill)));
        child.kill().unwrap();
        let status = child.wait().unwrap();
        println!("after line {:>4}: {status}", made());
        assert!(!status.success() && made() < COUNT, "it was killed before it was done");
    }
}
