//! The origin of a sound's modes: a body, two joined bodies, or a table without a body.

use sprung::internals::editor::{body_of_modes, modes_of_body, modes_of_pair, pair_of_modes};
use sprung::patch::ModeTable;
use sprung::sound::bodies::{Body, MATERIALS, Model, Pitch};
use sprung::sound::pairs::{Link, Pair};

/// The origin of a sound's modes.
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// A body of a model.
    FromBody(Box<Body>),
    /// Two joined bodies.
    FromPair(Box<Pair>),
    /// A table of its own, which knows nothing of a body.
    Table,
}

impl Origin {
    /// Where these modes come from.
    pub fn of(modes: &ModeTable) -> Self {
        match (body_of_modes(modes), pair_of_modes(modes)) {
            (_, Some(pair)) => Self::FromPair(Box::new(pair)),
            (Some(body), None) => Self::FromBody(Box::new(body)),
            (None, None) => Self::Table,
        }
    }

    /// Treats a body whose model has no places to strike as a table: it cannot be drawn.
    pub fn with_places(self) -> Self {
        match self {
            Self::FromBody(body) if matches!(body.model, Model::Custom(_) | Model::Mass) => Self::Table,
            other => other,
        }
    }

    /// The body that is struck.
    pub fn body(&self) -> Option<&Body> {
        match self {
            Self::FromBody(body) => Some(body),
            Self::FromPair(pair) => Some(&pair.first),
            Self::Table => None,
        }
    }

    /// Like [`Origin::body`], to be changed.
    pub fn body_mut(&mut self) -> Option<&mut Body> {
        match self {
            Self::FromBody(body) => Some(body),
            Self::FromPair(pair) => Some(&mut pair.first),
            Self::Table => None,
        }
    }

    /// The two bodies, if there are two.
    pub fn pair(&self) -> Option<&Pair> {
        match self {
            Self::FromPair(pair) => Some(pair),
            _ => None,
        }
    }

    /// Like [`Origin::pair`], to be changed.
    pub fn pair_mut(&mut self) -> Option<&mut Pair> {
        match self {
            Self::FromPair(pair) => Some(pair),
            _ => None,
        }
    }

    /// The same with the body that is struck of another material; `None` without a body, and for a material that there is not.
    pub fn of_material(&self, id: &str) -> Option<Self> {
        let mut other = self.clone();
        other.body_mut()?.material = *MATERIALS.iter().find(|material| material.id == id)?;
        Some(other)
    }

    /// Computes the modes; `None` for a table, which has no body. The error says why the two bodies have no modes.
    pub fn modes(&self) -> Result<Option<ModeTable>, String> {
        match self {
            Self::FromBody(body) => Ok(Some(modes_of_body(body))),
            Self::FromPair(pair) => modes_of_pair(pair).map(Some).map_err(|error| error.to_string()),
            Self::Table => Ok(None),
        }
    }

    /// The T60 to which the modes' decays are relative, in seconds; `None` for a table. This is slow.
    pub fn t60(&self) -> Option<f64> {
        match self {
            Self::FromBody(body) => Some(body.t60()),
            Self::FromPair(pair) => Some(pair.t60()),
            Self::Table => None,
        }
    }

    /// The same, with the model of a body replaced: of the second body if `is_second`, otherwise of the only or first
    /// one. Without a model, the second body is removed.
    pub fn with_model(&self, is_second: bool, model: Option<&Model>) -> Self {
        let new = model.map(|model| Body::new(model.clone()));
        match (self, new, is_second) {
            (Self::Table, Some(new), _) => Self::FromBody(Box::new(new)),
            (Self::FromBody(body), Some(new), false) => Self::FromBody(Box::new(like(body, new))),
            (Self::FromBody(body), Some(new), true) => {
                Self::FromPair(Box::new(Pair::new((**body).clone(), new, Link::Apart)))
            }
            (Self::FromPair(pair), Some(new), false) => {
                Self::FromPair(Box::new(Pair { first: like(&pair.first, new), ..(**pair).clone() }))
            }
            (Self::FromPair(pair), Some(new), true) => {
                Self::FromPair(Box::new(Pair { second: like(&pair.second, new), ..(**pair).clone() }))
            }
            // A single body always follows the keys.
            (Self::FromPair(pair), None, true) => {
                Self::FromBody(Box::new(Body { follows_key: true, ..pair.first.clone() }))
            }
            (other, None, _) => other.clone(),
        }
    }

    /// The two bodies with another kind of joint.
    pub fn linked(&self, link: Link) -> Self {
        match self {
            Self::FromPair(pair) => {
                let new = Pair::new(pair.first.clone(), pair.second.clone(), link);
                let Pair { mass, heard, polarisation, keys, .. } = **pair;
                Self::FromPair(Box::new(Pair { mass, heard, polarisation, keys, ..new }))
            }
            other => other.clone(),
        }
    }
}

/// The new body, with those properties of the old one that the model does not determine. A material that is not the usual one of the
/// old model was chosen and stays, unless one of the two is of air, which is no material to choose.
fn like(old: &Body, new: Body) -> Body {
    let Body { pitch, damping, spread, pan, strike_share, follows_key, modes, seed, .. } = *old;
    let pitch = if matches!(pitch, Pitch::Frequency(_)) { pitch } else { new.pitch };
    let is_usual = old.material == Body::new(old.model.clone()).material;
    let is_air = [old, &new].iter().any(|body| body.material.id == "air");
    let material = if is_usual || is_air { new.material } else { old.material };
    Body { pitch, material, damping, spread, pan, strike_share, follows_key, modes, seed, ..new }
}

/// The name of a model as shown to the user.
pub fn model_name(id: &str) -> String {
    id.replace('_', " ")
}

/// A name after its article.
pub fn with_article(name: &str) -> String {
    let article = if name.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
    format!("{article} {name}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chosen_material_stays_where_the_new_body_is_made_of_one() {
        let model = |id: &str| Model::find(id).unwrap();
        let mut origin = Origin::Table.with_model(false, Some(model("church_bell")));
        let material =
            |origin: &Origin, id: &str| origin.with_model(false, Some(model(id))).body().unwrap().material.id;
        assert_eq!(material(&origin, "marimba"), "rosewood", "nobody has chosen the bell's bronze");
        origin = origin.of_material("glass").unwrap();
        assert_eq!(["marimba", "open_tube"].map(|id| material(&origin, id)), ["glass", "air"]);
        assert_eq!(material(&origin.with_model(false, Some(model("open_tube"))), "marimba"), "rosewood");
    }
}
