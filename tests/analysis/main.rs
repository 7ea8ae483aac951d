//! What the analysis says of sounds: the bank's measures, and fits of presets and recordings; and files that it reads.

mod bank;
mod fit;
mod kept_files;
