//! A value for each parameter.

use super::{Choice, PARAM_COUNT, PARAMS, Param};

/// One value per parameter, always in the parameter's range. Plain data of fixed size, so that the audio thread can
/// copy it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Values([f32; PARAM_COUNT]);

impl Default for Values {
    /// Every parameter at its default.
    fn default() -> Self {
        Self(std::array::from_fn(|index| PARAMS[index].default))
    }
}

impl Values {
    /// The value of a parameter, in the table's unit. Real-time safe.
    pub fn get(&self, param: Param) -> f32 {
        self.0[param as usize]
    }

    /// The choice that a parameter is set to. Real-time safe.
    pub(crate) fn choice<T: Choice>(&self, param: Param) -> T {
        debug_assert!(param.info().choices == T::NAMES, "{param:?} has other choices");
        T::from_value(self.get(param))
    }

    /// Sets a parameter to the nearest value that it can take. Real-time safe. For input from a person, first call
    /// [`super::ParamInfo::check`] or `parse`, which report a value out of range.
    pub fn set(&mut self, param: Param, value: f32) {
        self.0[param as usize] = param.info().clamp(value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_outside_the_range_become_the_nearest_inside() {
        let mut values = Values::default();
        values.set(Param::Gain, 1e9);
        assert_eq!(values.get(Param::Gain), 12.0);
        values.set(Param::Gain, f32::NAN);
        assert_eq!(values.get(Param::Gain), Param::Gain.info().default);
        values.set(Param::Mode, 1.4);
        assert_eq!(values.get(Param::Mode), 1.0);
    }
}
