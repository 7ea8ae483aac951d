//! Finds the minimum of a function of a few numbers (downhill simplex, Nelder & Mead 1965).

use crate::error::Result;

/// Side of the first simplex.
const SIDE: f64 = 0.2;

/// The place where a function is least, searched from the origin in `steps` steps, and its value there.
///
/// # Errors
/// Those of the function.
pub(super) fn least<const N: usize>(
    steps: usize,
    mut function: impl FnMut([f64; N]) -> Result<f64>,
) -> Result<([f64; N], f64)> {
    let mut at = |place: [f64; N]| function(place).map(|value| (place, value));
    let mut corners = vec![at([0.0; N])?];
    for number in 0..N {
        let mut place = [0.0; N];
        place[number] = SIDE;
        corners.push(at(place)?);
    }
    for _ in 0..steps {
        corners.sort_by(|a, b| a.1.total_cmp(&b.1));
        let worst = corners[N];
        let middle: [f64; N] =
            std::array::from_fn(|n| corners[..N].iter().map(|(place, _)| place[n]).sum::<f64>() / N as f64);
        let along = |share: f64| -> [f64; N] { std::array::from_fn(|n| middle[n] + share * (worst.0[n] - middle[n])) };
        let mirrored = at(along(-1.0))?;
        corners[N] = if mirrored.1 < corners[0].1 {
            let further = at(along(-2.0))?;
            if further.1 < mirrored.1 { further } else { mirrored }
        } else if mirrored.1 < corners[N - 1].1 {
            mirrored
        } else {
            let (share, least) = if mirrored.1 < worst.1 { (-0.5, mirrored.1) } else { (0.5, worst.1) };
            let nearer = at(along(share))?;
            if nearer.1 >= least {
                let best = corners[0].0;
                for corner in &mut corners[1..] {
                    *corner = at(std::array::from_fn(|n| 0.5 * (best[n] + corner.0[n])))?;
                }
                continue;
            }
            nearer
        };
    }
    corners.sort_by(|a, b| a.1.total_cmp(&b.1));
    Ok(corners[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bottom_of_a_bent_valley_is_found() {
        // Rosenbrock's function, shifted.
        let (place, value) = least(200, |[x, y]: [f64; 2]| {
            let (x, y) = (x + 0.5, y + 0.5);
            Ok((1.0 - x) * (1.0 - x) + 100.0 * (y - x * x) * (y - x * x))
        })
        .unwrap();
        assert!((place[0] - 0.5).abs() < 1e-3 && (place[1] - 0.5).abs() < 1e-3 && value < 1e-6, "{place:?}, {value}");
    }
}
