//! Preset files: a patch with its name, author, tags and comment, in TOML.
