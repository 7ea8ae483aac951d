//! `sprung batch`: renders thousands of sounds from a file of jobs.

use super::interrupt::{self, INTERRUPTED};
use super::progress::Count;
use super::terminal::{complain, complain_lines, counted};
use super::{completion, quantity};
use sprung::batch::{Batch, Done, FileFormat, Shard};
use sprung::internals::threads::THREADS;
use sprung::{Error, Result};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::Instant;

pub(super) const EXAMPLES: &str = r#"A job is a line of JSON with the options of `sprung render` and with parameters. Values may be drawn:
  {"preset": "Kick", "note": "C4", "length": 1, "tail": "none", "repeat": 2000,
   "sweep": {"uniform": [0, 36]}, "decay": {"log_uniform": ["50 ms", "2 s"]}, "velocity": {"integer": [40, 127]}}
(in one line). Ways to draw: uniform, log_uniform, integer, normal [mean, deviation], choice.

Examples:
  sprung batch jobs.jsonl --out sounds
  sprung batch jobs.jsonl --out sounds --resume
  sprung batch jobs.jsonl --out sounds --format flac --seed 7
  sprung batch jobs.jsonl --out sounds --shard 3/16"#;

#[derive(clap::Args)]
pub(super) struct Args {
    /// File of jobs: an object of JSON a line
    #[arg(value_name = "JOBS.jsonl")]
    jobs_file: PathBuf,
    /// Folder for the sounds and their manifest; it is made if it is not there
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Jobs to make at once, 1-256 [default: one a core]
    #[arg(long, value_name = "N", allow_hyphen_values = true,
        value_parser = quantity::whole::<u16>((*THREADS.start()).into()..=(*THREADS.end()).into()))]
    jobs: Option<u16>,
    /// Make only every n-th job, from the i-th: the union of all shards is the whole
    #[arg(long, value_name = "i/n", default_value = "1/1", value_parser = shard)]
    shard: Shard,
    /// Go on with a batch that was broken off. Without --shard, take over what shards have made in the folder
    #[arg(long)]
    resume: bool,
    /// Seed of what is drawn, and of the sounds of jobs that have none of their own
    #[arg(long, default_value_t = 0, value_name = "N", allow_hyphen_values = true,
        value_parser = quantity::whole::<u64>(0..=u64::MAX))]
    seed: u64,
    /// Format of the files
    #[arg(long, default_value = "wav", value_name = "wav|flac", value_parser = quantity::file_format,
        add = completion::among(&["wav", "flac"]))]
    format: FileFormat,
}

fn shard(text: &str) -> std::result::Result<Shard, String> {
    let parts = text.split_once('/').and_then(|(number, count)| Some((number.parse().ok()?, count.parse().ok()?)));
    let (number, count) = parts.ok_or_else(|| format!("‘{text}’ is no part: expected i/n, as in 3/16"))?;
    Shard::new(number, count).map_err(|error| match error {
        Error::Value { message, .. } => message,
        error => error.to_string(),
    })
}

pub(super) fn run(args: &Args) -> ExitCode {
    let started = Instant::now();
    let counter = Mutex::new((Count::new(), None));
    let made = make(args, &counter);
    let (_, last) = counter.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
    match made {
        Ok(Done { jobs, found, .. }) => {
            let (seconds, new) = (started.elapsed().as_secs_f64(), jobs - found);
            let found = if found > 0 { format!(", {found} found finished") } else { String::new() };
            let rate = new as f64 / seconds.max(1e-9);
            let sounds = counted(new as usize, "sound");
            complain_lines(&format!("{}: {sounds} in {seconds:.1} s, {rate:.1}/s{found}\n", args.out.display()));
            ExitCode::SUCCESS
        }
        Err(Error::Interrupted) => {
            let done =
                last.map_or(String::new(), |Done { jobs, of, .. }| format!("; {jobs} of {of} jobs are finished"));
            complain("error", format_args!("interrupted{done}: go on with --resume"));
            ExitCode::from(INTERRUPTED)
        }
        Err(error) => {
            complain("error", error);
            ExitCode::FAILURE
        }
    }
}

fn make(args: &Args, counter: &Mutex<(Count, Option<Done>)>) -> Result<Done> {
    let batch = Batch {
        jobs: args.jobs_file.clone(),
        folder: args.out.clone(),
        format: args.format,
        seed: args.seed,
        shard: args.shard,
        resume: args.resume,
        at_once: args.jobs,
    };
    interrupt::catch(true)?;
    batch.run(&|done| {
        if let Ok(mut counter) = counter.lock() {
            counter.0.show(done.jobs, done.found, done.of);
            counter.1 = Some(done);
        }
        interrupt::check()
    })
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;
    use sprung::internals::request::Request;
    use std::collections::BTreeSet;

    #[test]
    fn jobs_have_the_options_of_render() {
        let command = crate::Cli::command();
        let render = command.find_subcommand("render").unwrap();
        // A batch has its own format, and a job is one file of a sound that ends.
        let own = ["block", "figure", "force", "format", "help", "is_loop", "json", "output", "stems", "threads"];
        let options: BTreeSet<&str> = render.get_arguments().map(|arg| arg.get_id().as_str()).collect();
        let names: BTreeSet<&str> = Request::NAMES.iter().map(|name| name.name).collect();
        let expected = options.into_iter().filter(|option| !own.contains(option));
        assert_eq!(names, expected.collect::<BTreeSet<_>>());
    }
}
