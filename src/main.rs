//! The command `sprung`.

fn main() {}
