//! Pure numerics: no events, no files, no threads.
