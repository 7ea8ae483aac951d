//! A single mass on its spring.

use super::partial::{Pair, Partial};

pub(super) fn partials() -> Vec<Partial> {
    vec![Partial::new(1.0, Pair::Directions, |_| 1.0)]
}
