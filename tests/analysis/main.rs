//! What the analysis says of sounds: the bank's measures, and fits of presets and recordings.

mod bank;
mod fit;
