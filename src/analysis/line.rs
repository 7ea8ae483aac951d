//! A straight line through weighted points, by least squares.

/// The line `y + slope · (x − middle)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    /// The mean of the points' `x`, and of their `y`: the line goes through it.
    pub(crate) middle: f64,
    pub(crate) y: f64,
    /// 0 if all points have the same `x`.
    pub(crate) slope: f64,
    /// The sum of the squares of the distances from the middle.
    pub(crate) spread: f64,
    /// The sum of the weights.
    pub(crate) weight: f64,
}

impl Line {
    /// Through points of `x`, `y` and a weight; none if they weigh nothing.
    pub(crate) fn through(points: impl Iterator<Item = [f64; 3]> + Clone) -> Option<Self> {
        let sum =
            |value: &dyn Fn(f64, f64) -> f64| points.clone().map(|[x, y, weight]| weight * value(x, y)).sum::<f64>();
        let weight = sum(&|_, _| 1.0);
        if weight < 1e-12 {
            return None;
        }
        let (middle, y) = (sum(&|x, _| x) / weight, sum(&|_, y| y) / weight);
        let spread = sum(&|x, _| (x - middle) * (x - middle));
        let slope = if spread > 0.0 { sum(&|x, level| (x - middle) * (level - y)) / spread } else { 0.0 };
        Some(Self { middle, y, slope, spread, weight })
    }

    /// Through the values at 0, 1, 2 and so on.
    pub(crate) fn through_values(values: &[f64]) -> Option<Self> {
        Self::through(values.iter().enumerate().map(|(n, value)| [n as f64, *value, 1.0]))
    }

    pub(crate) fn at(&self, x: f64) -> f64 {
        self.y + self.slope * (x - self.middle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heavy_point_pulls_the_line() {
        let line = Line::through_values(&[1.0, 3.0, 5.0]).unwrap();
        assert!((line.slope - 2.0).abs() < 1e-12 && (line.at(10.0) - 21.0).abs() < 1e-12, "{line:?}");
        let points = [[0.0, 0.0, 1e6], [1.0, 1.0, 1.0], [2.0, 4.0, 1e6]];
        let line = Line::through(points.into_iter()).unwrap();
        assert!((line.slope - 2.0).abs() < 1e-9 && line.at(0.0).abs() < 1e-5, "{line:?}");
        assert_eq!(Line::through(std::iter::once([3.0, 2.0, 1.0])).unwrap().slope, 0.0);
        assert_eq!(Line::through_values(&[]), None);
    }
}
