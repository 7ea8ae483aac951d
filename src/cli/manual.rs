//! `sprung manual`: prints the pages of the manual.

use super::terminal::print;
use clap::builder::PossibleValuesParser;
use sprung::Result;

pub(super) const EXAMPLES: &str = "\
Examples:
  sprung manual
  sprung manual recipes | less";

macro_rules! pages {
    ($($name:literal)*) => {
        /// The pages and their names, in the order of the table of contents.
        const PAGES: &[(&str, &str)] = &[$(($name, include_str!(concat!("../../assets/manual/", $name, ".md")))),*];
    };
}

pages! {
    "sound" "recipes" "exciters" "bodies" "modulation" "space" "kits" "tuning" "command" "batch" "python" "midi" "live"
    "daw" "window" "recordings" "lab"
}

/// The table of contents.
const CONTENTS: &str = include_str!("../../assets/manual/README.md");

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_page_is_there_in_the_order_of_the_contents() {
        let linked: Vec<&str> =
            CONTENTS.split("](").skip(1).filter_map(|rest| rest.split_once(".md)")).map(|(page, _)| page).collect();
        assert_eq!(PAGES.iter().map(|(name, _)| *name).collect::<Vec<_>>(), linked);
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/manual");
        let files = std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
        let pages = files.filter(|path| path.extension().is_some_and(|ending| ending == "md")).count();
        assert_eq!(pages, PAGES.len() + 1);
    }
}
