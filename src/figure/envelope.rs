//! Reduces a signal to a line that keeps its extremes, however many samples share a pixel.

/// The samples as points. If there are many, only the minimum and the maximum of each interval are kept; there are two
/// intervals for each of the `columns`.
pub(crate) fn envelope(samples: &[f32], sample_rate: f64, columns: usize) -> Vec<(f64, f64)> {
    let seconds = |frame: usize| frame as f64 / sample_rate;
    let value = |sample: f32| if sample.is_finite() { f64::from(sample) } else { 0.0 };
    if samples.len() <= 3 * columns.max(1) {
        return samples.iter().enumerate().map(|(frame, sample)| (seconds(frame), value(*sample))).collect();
    }
    // Two intervals per pixel: with one, rounding would leave some columns empty.
    let stretches = 2 * columns.max(1);
    let start = |index: usize| index * samples.len() / stretches;
    let mut points = Vec::with_capacity(2 * stretches);
    for index in 0..stretches {
        let range = samples[start(index)..start(index + 1)].iter().map(|sample| value(*sample));
        let (low, high) = range.fold((f64::MAX, f64::MIN), |(low, high), y| (low.min(y), high.max(y)));
        // The order alternates, so that the line does not cross the interval twice.
        let pair = if index % 2 == 0 { [low, high] } else { [high, low] };
        points.extend(pair.map(|y| (seconds(start(index)), y)));
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_envelope_keeps_the_extremes() {
        let mut samples = vec![0.0_f32; 10_000];
        samples[5003] = 0.9;
        samples[7001] = -0.8;
        let points = envelope(&samples, 10_000.0, 100);
        assert_eq!(points.len(), 400);
        assert_eq!(points.iter().map(|p| p.1 as f32).fold(0.0, f32::max), 0.9);
        assert_eq!(points.iter().map(|p| p.1 as f32).fold(0.0, f32::min), -0.8);
        assert_eq!(envelope(&[0.5, f32::NAN], 1.0, 100), [(0.0, 0.5), (1.0, 0.0)]);
    }
}
