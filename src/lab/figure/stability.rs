//! Draws the region in which each method stays bounded when it is run, with the theoretical limit.

use super::super::method::Method;
use super::super::stability::{Cell, theory};
use super::legend;
use crate::figure::panel::{Axis, Panel, Stroke, line};
use crate::figure::{Area, Drawn, Picture, text};
use plotters::prelude::*;

/// A method's cells over the plane of step and damping. The method has been run at each cell.
pub struct Region {
    /// The method.
    pub method: Method,
    /// Cells in rows of equal damping ratio.
    pub rows: Vec<Vec<Cell>>,
}

/// The figure of several regions.
pub struct StabilityFigure<'a>(pub &'a [Region]);

const COLUMNS: usize = 4;
const BOUNDED: RGBColor = RGBColor(158, 202, 225);
const THEORY: Stroke = Stroke { colour: RGBColor(213, 94, 0), width: 2, dashed: false };

impl Picture for StabilityFigure<'_> {
    fn size(&self) -> (u32, u32) {
        (1400, 80 + 270 * self.0.len().div_ceil(COLUMNS) as u32)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<B> {
        area.draw_text("Where each method stays bounded", &text(22), (20, 10))?;
        area.draw(&Rectangle::new([(24, 46), (60, 62)], BOUNDED.filled()))?;
        area.draw_text("bounded, found by running it", &text(14), (70, 46))?;
        legend(area, &[(THEORY, "limit of theory".to_owned())], (360, 54))?;
        let (_, body) = area.split_vertically(76);
        let rows = self.0.len().div_ceil(COLUMNS).max(1);
        for (region, area) in self.0.iter().zip(body.split_evenly((rows, COLUMNS))) {
            panel(&area, region)?;
        }
        Ok(())
    }
}

fn panel<B: DrawingBackend>(area: &Area<B>, region: &Region) -> Drawn<B> {
    let (Some(first), Some(last)) = (region.rows.first(), region.rows.last()) else { return Ok(()) };
    let (Some(corner), Some(opposite)) = (first.first(), last.last()) else { return Ok(()) };
    let step = (opposite.omega_h - corner.omega_h) / (first.len().max(2) - 1) as f64;
    let rise = (opposite.zeta - corner.zeta) / (region.rows.len().max(2) - 1) as f64;
    let (x, y) = (corner.omega_h - 0.5 * step..opposite.omega_h + 0.5 * step, corner.zeta..opposite.zeta);
    let panel = Panel {
        x: Axis::linear(x, "ω·h / rad"),
        y: Axis::linear(y.clone(), "damping ratio ζ"),
        title: region.method.title(),
    };
    let mut chart = panel.draw(area)?;
    for cells in &region.rows {
        // Neighbouring cells of the same kind are drawn as one rectangle: the file is smaller and there are no seams.
        for stretch in cells.chunk_by(|a, b| a.bounded == b.bounded).filter(|stretch| stretch[0].bounded) {
            let (from, to) = (stretch[0], stretch[stretch.len() - 1]);
            let low = (from.zeta - 0.5 * rise).max(y.start);
            let high = (from.zeta + 0.5 * rise).min(y.end);
            let corners = [(from.omega_h - 0.5 * step, low), (to.omega_h + 0.5 * step, high)];
            chart.draw_series([Rectangle::new(corners, BOUNDED.filled())])?;
        }
    }
    let limits: Vec<(f64, f64)> = (0..=200)
        .map(|n| y.start + (y.end - y.start) * f64::from(n) / 200.0)
        .map(|zeta| (theory(region.method, zeta), zeta))
        .collect();
    line(&mut chart, &limits, THEORY)
}

/// One row per method, damping ratio and step; the growth is empty if the method refuses the step.
pub fn csv(regions: &[Region]) -> String {
    let mut csv = String::from("method,zeta,omega_h,growth_neper_per_step,bounded,theory_limit\n");
    for region in regions {
        for cell in region.rows.iter().flatten() {
            let Cell { omega_h, zeta, growth, bounded } = cell;
            let growth = if growth.is_nan() { String::new() } else { growth.to_string() };
            let (key, limit) = (region.method.key(), theory(region.method, *zeta));
            csv += &format!("{key},{zeta},{omega_h},{growth},{},{limit}\n", u8::from(*bounded));
        }
    }
    csv
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stability::{cell, spaced};

    #[test]
    fn regions_are_drawn_and_listed() {
        let regions: Vec<Region> = [Method::RungeKutta4, Method::ImplicitEuler]
            .into_iter()
            .map(|method| Region {
                method,
                rows: spaced(0.0, 1.0, 4)
                    .iter()
                    .map(|zeta| spaced(0.1, 4.0, 5).iter().map(|y| cell(method, *y, *zeta).unwrap()).collect())
                    .collect(),
            })
            .collect();
        let document = crate::figure::svg(&StabilityFigure(&regions)).unwrap();
        assert!(document.contains("Runge–Kutta 4") && document.contains("ω·h / rad"));
        let csv = csv(&regions);
        assert_eq!(csv.lines().count(), 1 + 2 * 4 * 5);
        assert!(csv.lines().any(|row| row.starts_with("rk4,0,4,") && row.contains(",0,2.828")));
        assert!(csv.lines().any(|row| row.starts_with("implicit-euler,0,4,") && row.ends_with(",1,inf")));
    }
}
