//! What the way of the sound shows of its bodies: a picture and a line of words for each, and how they are joined.

use crate::editor::body::offer::NO_BODY;
use crate::editor::controls::shown::{Shown, Subject};
use sprung::internals::editor::LINK_KINDS;
use sprung::sound::bodies::Body;
use sprung_picture::{Figure, Origin, model_name, small_figure};

/// One of the bodies.
pub(super) struct Drawn {
    pub(super) figure: Figure,
    /// Its model, and its material or what else is known.
    pub(super) about: [String; 2],
}

/// The bodies of the sound that is shown.
pub(super) struct Bodies {
    subject: Subject,
    pub(super) first: Drawn,
    pub(super) second: Option<Drawn>,
    /// The kind of the joint, and how much is heard of the second body.
    pub(super) joint: [String; 2],
}

impl Bodies {
    /// Those of the sound that is shown, made again only if it is another one.
    pub(super) fn of(known: Option<Self>, shown: &Shown) -> Self {
        known.filter(|bodies| bodies.subject == shown.subject()).unwrap_or_else(|| Self::new(shown))
    }

    fn new(shown: &Shown) -> Self {
        let modes = &shown.patch().modes;
        let origin = Origin::of(modes);
        let figure = small_figure(modes, shown.family(), shown.tags());
        let about = origin.body().map_or([NO_BODY.to_owned(), String::new()], about);
        let pair = origin.pair();
        let second = pair.map(|pair| {
            let [model, material] = about_second(&pair.second);
            Drawn { figure: Figure::small(&pair.second), about: [model, material] }
        });
        let same =
            |link: &_| pair.is_some_and(|pair| std::mem::discriminant(link) == std::mem::discriminant(&pair.link));
        let kind = LINK_KINDS.iter().find(|(_, link)| same(link)).map_or("", |(kind, _)| *kind);
        let heard = pair.map_or(String::new(), |pair| format!("{:.0} % heard", 100.0 * pair.heard));
        Self { subject: shown.subject(), first: Drawn { figure, about }, second, joint: [kind.to_owned(), heard] }
    }
}

fn about(body: &Body) -> [String; 2] {
    [model_name(body.model.id()), body.material.id.replace('_', " ")]
}

/// Of a body that keeps its pitch, that it does.
fn about_second(body: &Body) -> [String; 2] {
    let [model, material] = about(body);
    if body.follows_key { [model, material] } else { [format!("{model}, {material}"), "keeps its pitch".to_owned()] }
}
