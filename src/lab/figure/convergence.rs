//! Draws error against step size on logarithmic axes, with the fitted orders.

use super::super::convergence::Convergence;
use super::{legend, stroke};
use crate::figure::panel::{Axis, Panel, Stroke, line};
use crate::figure::{Area, Drawn, Picture, text};
use libm::{ceil, floor, log10};
use plotters::prelude::*;

/// The figure of some methods' convergence.
pub struct ConvergenceFigure<'a>(pub &'a [Convergence]);

/// Guide lines with the slope of an order.
const GUIDE: Stroke = Stroke { colour: RGBColor(170, 170, 178), width: 1, dashed: true };
/// Smaller errors are drawn at this value, because an error of 0 has no logarithm.
const LEAST: f64 = 1e-17;

impl Picture for ConvergenceFigure<'_> {
    fn size(&self) -> (u32, u32) {
        (1200, 760)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<B> {
        area.draw_text("Error against step size", &text(22), (20, 12))?;
        let (_, body) = area.split_vertically(46);
        let (plot, key) = body.split_horizontally(820);
        let points = |c: &Convergence| -> Vec<(f64, f64)> {
            c.points.iter().map(|p| (log10(p.h), log10(p.error.max(LEAST)))).collect()
        };
        let all: Vec<(f64, f64)> = self.0.iter().flat_map(points).filter(|(_, y)| y.is_finite()).collect();
        let extent = |value: fn(&(f64, f64)) -> f64| {
            all.iter().map(value).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)))
        };
        let ((left, right), (low, high)) = (extent(|p| p.0), extent(|p| p.1));
        let bottom = floor(low.min(0.0));
        let panel = Panel {
            x: Axis::logarithmic(left - 0.1..right + 0.1, "step / s"),
            y: Axis::logarithmic(bottom..ceil(high.min(2.0)).max(bottom + 1.0), "greatest error / m"),
            title: "",
        };
        let mut chart = panel.draw(&plot)?;
        for power in [1.0, 2.0, 4.0] {
            // A guide with the slope of this order, which starts at the longest step.
            let top = panel.y.range.end - 0.5 * power;
            let guide: Vec<_> = [right, left].iter().map(|x| (*x, top + power * (x - right))).collect();
            line(&mut chart, &guide, GUIDE)?;
        }
        let mut entries = Vec::new();
        for convergence in self.0 {
            let stroke = stroke(convergence.method);
            line(&mut chart, &points(convergence), stroke)?;
            let shown = points(convergence).into_iter().filter(|p| panel.y.range.contains(&p.1));
            chart.draw_series(shown.map(|point| Circle::new(point, 3, stroke.colour.filled())))?;
            let order = convergence.order.map_or("rounding".to_owned(), |order| format!("{order:.2}"));
            entries.push((stroke, format!("{:<24} {order}", convergence.method.title())));
        }
        key.draw_text("method                   fitted order", &text(14), (62, 24))?;
        legend(&key, &entries, (16, 62))?;
        let below = 74 + 24 * entries.len() as i32;
        legend(&key, &[(GUIDE, "slopes 1, 2 and 4".to_owned())], (16, below))
    }
}

/// One row per method and step.
pub fn csv(convergences: &[Convergence]) -> String {
    let mut csv = String::from("method,step_s,error_m,rounding_m,fitted,order\n");
    for convergence in convergences {
        let order = convergence.order.map_or(String::new(), |order| order.to_string());
        for p in &convergence.points {
            let key = convergence.method.key();
            csv += &format!("{key},{},{},{},{},{order}\n", p.h, p.error, p.rounding, u8::from(p.fitted));
        }
    }
    csv
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::convergence::{converge, halving};
    use crate::lab::method::Method;
    use crate::lab::system::{State, System};

    #[test]
    fn orders_stand_in_the_legend_and_rows_in_the_table() {
        let system = System::linear(1.0, 50.0, 0.0).unwrap();
        let methods = [Method::ExplicitEuler, Method::Exponential];
        let found = converge(&methods, &system, State { x: 0.5, v: 0.0 }, &halving(0.01, 5), 0.5).unwrap();
        let document = crate::figure::svg(&ConvergenceFigure(&found)).unwrap();
        assert!(document.contains("explicit Euler") && document.contains("rounding") && document.contains("error / m"));
        let csv = csv(&found);
        assert_eq!(csv.lines().count(), 11);
        assert!(csv.lines().nth(1).unwrap().starts_with("explicit-euler,0.01,"));
    }
}
