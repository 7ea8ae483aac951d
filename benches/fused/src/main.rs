//! Measures the emulation of fused multiplication for CPUs without the instruction, beside the emulation that it has replaced.

mod host;

/// The engine's own files, and their measurement in the same module, because their items are not visible elsewhere.
#[path = "../../../src/dsp"]
#[allow(dead_code, reason = "the engine uses more of it")]
mod dsp {
    pub(crate) mod simd {
        mod fused;
        #[path = "../../../benches/fused/src/rates.rs"]
        pub(crate) mod rates;
        #[path = "../../../benches/fused/src/rounded_to_odd.rs"]
        mod rounded_to_odd;
        #[cfg(target_arch = "x86_64")]
        mod sse2;
        #[allow(clippy::needless_range_loop, reason = "several arrays are indexed in step")]
        mod vector;
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        mod wasm;
    }
}

fn main() {
    dsp::simd::rates::print();
}
