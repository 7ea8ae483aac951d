//! `cargo xtask notes`: what the changelog says of a version, as the text of its release.

use crate::shell::root;

/// Prints the version's section. It must be the version that is built here.
pub(crate) fn run(version: &str) -> Result<(), String> {
    let own = env!("CARGO_PKG_VERSION");
    if version != own {
        return Err(format!("{version}: expected {own}, which is the version in Cargo.toml"));
    }
    let changelog = std::fs::read_to_string(root().join("CHANGELOG.md")).map_err(|error| error.to_string())?;
    print!("{}", section(&changelog, version)?);
    Ok(())
}

/// The text between a version's heading and that of the next one.
fn section<'a>(changelog: &'a str, version: &str) -> Result<&'a str, String> {
    let sections = changelog.split("\n## ").skip(1);
    let mut of_version = sections.filter(|text| text.starts_with(&format!("[{version}]")));
    let text = of_version.next().ok_or_else(|| format!("CHANGELOG.md has no section ‘## [{version}]’"))?;
    Ok(text.split_once('\n').map_or("", |(_, rest)| rest.trim_start()))
}

#[cfg(test)]
mod tests {
    use super::section;

    #[test]
    fn a_version_s_section_ends_at_the_next_heading() {
        let changelog = "# Changelog\n\n## [Unreleased]\n\nSoon.\n\n## [0.2.0] - 2027-01-01\n\n### New\n\n- All.\n\n## [0.1.0]\nFirst.\n";
        assert_eq!(section(changelog, "0.2.0"), Ok("### New\n\n- All.\n"));
        assert_eq!(section(changelog, "0.1.0"), Ok("First.\n"));
        assert!(section(changelog, "0.3.0").is_err_and(|message| message.contains("0.3.0")));
    }
}
