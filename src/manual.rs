//! The pages of the manual, which the command prints and the plugin shows.

macro_rules! pages {
    ($($name:literal)*) => {
        /// Names of the pages and their Markdown, in the order of the table of contents.
        pub const PAGES: &[(&str, &str)] = &[$(($name, include_str!(concat!("../assets/manual/", $name, ".md")))),*];
    };
}

pages! {
    "sound" "window" "recipes" "exciters" "bodies" "modulation" "space" "kits" "tuning" "daw" "live"
    "midi" "learn" "mts-esp" "outputs" "resonator" "hosts" "recordings" "command" "batch" "python" "lab"
}

/// The table of contents, as Markdown.
pub const CONTENTS: &str = include_str!("../assets/manual/README.md");

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
