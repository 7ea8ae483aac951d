//! Retired parameters: their ids occur in old presets and are never used again.

use super::{Change, Curve, Param, ParamInfo, Unit};

/// A former parameter, which a route or other parameters have replaced.
#[derive(Debug)]
pub struct Retired {
    id: &'static str,
    /// Its former row, if a route replaces it; `param` is the destination of that route.
    pub(crate) row: Option<ParamInfo>,
    /// What replaces it, for messages.
    pub replacement: &'static str,
}

impl Retired {
    /// The retired parameter with this id.
    pub fn from_id(id: &str) -> Option<&'static Retired> {
        RETIRED.iter().find(|retired| retired.id == id)
    }

    /// Its id.
    pub fn id(&self) -> &'static str {
        self.id
    }

    /// A message that it is retired, and what replaces it.
    pub fn message(&self) -> String {
        format!("‘{}’ is retired: {} replaces it", self.id, self.replacement)
    }
}

macro_rules! retired {
    ($($other:literal: $by:literal;)* by routes: $($param:ident $id:literal, $unit:ident $min:literal..$max:literal = $default:literal, $replacement:literal;)*) => {
        /// All retired parameters.
        pub static RETIRED: &[Retired] = &[$(Retired { id: $other, row: None, replacement: $by },)* $(Retired {
            id: $id,
            row: Some(ParamInfo {
                param: Param::$param, id: $id, name: $id, section: "", unit: Unit::$unit, min: $min, max: $max,
                default: $default, curve: Curve::Linear, change: Change::NextNote, is_fixed: true, choices: &[],
                help: "",
            }),
            replacement: $replacement,
        },)*];
    };
}

retired! {
    "exciter": "a level for each exciter";
    "hardness": "mallet_hardness or pluck_hardness";
    "position": "pluck_position";
    by routes:
    MalletHardness "hardness_velocity", Percent 0.0..100.0 = 0.0, "a route from velocity to hardness";
    Sweep "sweep_velocity", Percent 0.0..100.0 = 0.0, "a route from velocity to sweep";
    Decay "decay_key", Percent -100.0..100.0 = 0.0, "a route from key to decay";
    Release "release_velocity", Percent 0.0..100.0 = 0.0, "a route from release_velocity to release";
    Vibrato "wheel_vibrato", Cents 0.0..1200.0 = 50.0, "a route from wheel to vibrato";
    Vibrato "pressure_vibrato", Cents 0.0..1200.0 = 0.0, "a route from pressure to vibrato";
    Damper "pressure_damping", Percent 0.0..100.0 = 0.0, "a route from pressure to damper";
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ids may be added to this list, but never removed.
    #[test]
    fn retired_ids_are_pinned_and_no_parameter_has_one() {
        let ids: Vec<_> = RETIRED.iter().map(Retired::id).collect();
        let pinned = "exciter hardness position hardness_velocity sweep_velocity decay_key release_velocity wheel_vibrato pressure_vibrato \
            pressure_damping";
        assert_eq!(ids, pinned.split_whitespace().collect::<Vec<_>>());
        assert!(ids.iter().all(|id| Param::from_id(id).is_none()));
        assert_eq!(
            Retired::from_id("decay_key").map(Retired::message).as_deref(),
            Some("‘decay_key’ is retired: a route from key to decay replaces it")
        );
    }
}
