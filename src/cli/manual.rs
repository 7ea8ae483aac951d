//! `sprung manual`: prints the pages of the manual.

use super::terminal::print;
use clap::builder::PossibleValuesParser;
use sprung::Result;
use sprung::internals::text::{CONTENTS, PAGES};

pub(super) const EXAMPLES: &str = "\
Examples:
  sprung manual
  sprung manual recipes | less";

#[derive(clap::Args)]
pub(super) struct Args {
    /// The page to print; without it, the table of contents
    #[arg(value_parser = PossibleValuesParser::new(PAGES.iter().map(|(name, _)| *name)))]
    page: Option<String>,
}

pub(super) fn run(args: &Args) -> Result<()> {
    let wanted = args.page.as_deref();
    let page = PAGES.iter().find(|(name, _)| Some(*name) == wanted);
    print(page.map_or(CONTENTS, |(_, text)| text))
}
