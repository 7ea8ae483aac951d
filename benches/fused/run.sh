#!/bin/sh
# Prints how fast fused multiplication is emulated, before and now: on this CPU and, in Node, as WebAssembly.
# SPRUNG_CROSS_RUSTC is the compiler for WebAssembly, if the present toolchain's has no standard library for it.
set -eu
cd "$(dirname "$0")"
target=../../target/fused
echo "| code | rounded to odd, G | now, G | |"
echo "|---|---|---|---|"
cargo run --quiet --release --target-dir "$target"
for flags in "" "-C target-feature=+simd128"; do
    RUSTC=${SPRUNG_CROSS_RUSTC:-rustc} RUSTFLAGS=$flags \
        cargo build --quiet --release --target wasm32-unknown-unknown --target-dir "$target"
    # The optimised code from the start, which Node otherwise comes to later.
    node --no-liftoff run.mjs "$target/wasm32-unknown-unknown/release/sprung-fused.wasm"
done
uptime | sed 's/.*load/load/'
