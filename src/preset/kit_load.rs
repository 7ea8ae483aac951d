//! Reads kits from texts and files, and writes them.

use super::complaints::Complaints;
use super::kit::{KitPreset, Playable};
use super::{Preset, kit_file, load};
use crate::error::{Error, Result};
use std::fs::File;
use std::path::{Component, Path};

impl KitPreset {
    /// Writes the kit as TOML, with the presets in it that are not the factory's. [`Playable::parse`] gives exactly the same kit.
    pub fn to_toml(&self) -> String {
        let is_of_factory = |name: &str, preset: &Preset| Preset::find(name).is_ok_and(|factory| factory == preset);
        kit_file::to_toml(self, &|name, preset| !is_of_factory(name, preset))
    }

    /// As [`KitPreset::to_toml`], but with all of its presets: it stays as it is if a later version has others in its factory.
    pub fn to_whole_toml(&self) -> String {
        kit_file::to_toml(self, &|_, _| true)
    }
}

impl Playable {
    /// Reads the preset or kit file at `path`. `open` opens it and the preset files that a kit names.
    ///
    /// # Errors
    /// As [`Preset::load`]. For a kit, [`Error::Format`] also names the place in the kit. Preset files of a kit must be
    /// in the kit's folder or below it: other paths, and links that lead outside, are rejected before they are opened.
    pub fn read(path: &Path, open: &mut dyn FnMut(&Path) -> Result<File>) -> Result<Self> {
        let mut complaints = Complaints::default();
        let playable = Self::read_on(path, open, &mut complaints)?;
        complaints.into_first(&path.display().to_string()).map(|()| playable)
    }

    /// As [`Playable::read`], but reads as much as possible. Unreadable parts get their default values; each is
    /// described in one line of the returned list.
    ///
    /// # Errors
    /// As [`Playable::read`], for a file that cannot be opened, is not TOML, or is neither a preset nor a kit.
    pub fn read_lenient(path: &Path, open: &mut dyn FnMut(&Path) -> Result<File>) -> Result<(Self, Vec<String>)> {
        let mut complaints = Complaints::default();
        let playable = Self::read_on(path, open, &mut complaints)?;
        Ok((playable, complaints.into_lines()))
    }

    fn read_on(path: &Path, open: &mut dyn FnMut(&Path) -> Result<File>, complaints: &mut Complaints) -> Result<Self> {
        let origin = path.display().to_string();
        let text = load::text(open(path)?, &origin)?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        kit_file::parse(&text, &origin, &mut |name| preset_of_kit(name, folder, open), complaints)
    }

    /// Reads a preset or kit from a text. `origin` names the text in errors. `preset` finds the presets that a kit
    /// names.
    ///
    /// # Errors
    /// [`Error::Format`] as [`Preset::parse`], and if a preset that a kit names cannot be found.
    pub fn parse(text: &str, origin: &str, preset: &mut dyn FnMut(&str) -> Result<Preset>) -> Result<Self> {
        let mut complaints = Complaints::default();
        let playable = kit_file::parse(text, origin, preset, &mut complaints)?;
        complaints.into_first(origin).map(|()| playable)
    }

    /// As [`Playable::parse`], but reads as much as possible, as [`Playable::read_lenient`] does.
    ///
    /// # Errors
    /// [`Error::Format`] for a text that is not TOML, or is neither a preset nor a kit.
    pub fn parse_lenient(
        text: &str,
        origin: &str,
        preset: &mut dyn FnMut(&str) -> Result<Preset>,
    ) -> Result<(Self, Vec<String>)> {
        let mut complaints = Complaints::default();
        let playable = kit_file::parse(text, origin, preset, &mut complaints)?;
        Ok((playable, complaints.into_lines()))
    }

    /// The preset or kit as TOML.
    pub fn to_toml(&self) -> String {
        match self {
            Self::Preset(preset) => preset.to_toml(),
            Self::Kit(kit) => kit.to_toml(),
        }
    }
}

/// Whether a sound's name is a file name: it ends in `.toml` or contains a folder.
pub(crate) fn is_file_name(name: &Path) -> bool {
    name.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) || name.components().count() > 1
}

/// The preset with this name for a kit in `folder`: a file there if the name is a file name, otherwise a factory preset.
fn preset_of_kit(name: &str, folder: &Path, open: &mut dyn FnMut(&Path) -> Result<File>) -> Result<Preset> {
    let relative = Path::new(name);
    if !is_file_name(relative) {
        return Preset::find(name).cloned();
    }
    let outside = || Error::value(name, "it lies outside the kit’s folder: expected a file in there or below");
    let is_inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    if !relative.components().all(is_inside) {
        return Err(outside());
    }
    let resolve = |path: &Path| path.canonicalize().map_err(|source| Error::io(path.display().to_string(), source));
    let path = resolve(&folder.join(relative))?;
    if !path.starts_with(resolve(folder)?) {
        return Err(outside());
    }
    if !path.is_file() {
        return Err(Error::value(name, "it is no regular file: expected a preset file"));
    }
    let origin = folder.join(relative).display().to_string();
    let text = load::text(open(&path)?, &origin)?;
    Preset::parse(&text, &origin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn load(path: &Path) -> Result<Playable> {
        let mut open = |path: &Path| File::open(path).map_err(|source| Error::io(path.display().to_string(), source));
        Playable::read(path, &mut open)
    }

    #[test]
    fn presets_are_found_in_the_kit_s_own_folder_and_below() {
        let directory = tempfile::tempdir().unwrap();
        let path = |name: &str| directory.path().join(name);
        fs::create_dir_all(path("kit/sounds")).unwrap();
        let preset = Preset { name: "Mine".to_owned(), ..Preset::find("Kick").unwrap().clone() };
        for name in ["kit/a.toml", "kit/sounds/b.toml", "outside.toml"] {
            fs::write(path(name), preset.to_toml()).unwrap();
        }
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(path("outside.toml"), path("kit/link.toml")).unwrap();
            std::os::unix::fs::symlink(path(""), path("kit/up")).unwrap();
            std::os::unix::fs::symlink(path("kit/a.toml"), path("kit/near.toml")).unwrap();
        }
        let kit = |sound: &str| {
            let text = format!("kit = 1\nname = \"k\"\nkeys = [{{ key = 36, sound = '{sound}' }}]");
            fs::write(path("kit/kit.toml"), text).unwrap();
            load(&path("kit/kit.toml"))
        };
        let outside = path("outside.toml").display().to_string();
        let is_unix = cfg!(unix);
        for name in ["a.toml", "./a.toml", "sounds/b.toml"].into_iter().chain(is_unix.then_some("near.toml")) {
            let Playable::Kit(kit) = kit(name).unwrap() else { panic!("a kit") };
            assert_eq!((kit.sounds[0].0.as_str(), &kit.sounds[0].1), (name, &preset));
        }
        for name in ["../outside.toml", "sounds/../../outside.toml", &outside, "sounds/../a.toml"]
            .into_iter()
            .chain(is_unix.then_some(["link.toml", "up/outside.toml"]).into_iter().flatten())
        {
            let error = kit(name).unwrap_err().to_string();
            let expected =
                format!("kit.toml: keys[0].sound: {name}: it lies outside the kit’s folder: expected a file");
            assert!(error.contains(&expected), "{error}");
        }
        assert!(kit("none.toml").unwrap_err().to_string().contains("none.toml"));
        fs::create_dir(path("kit/folder.toml")).unwrap();
        assert!(kit("folder.toml").unwrap_err().to_string().contains("it is no regular file"));
        let error = kit("kit.toml").unwrap_err().to_string();
        assert!(error.contains("this is a kit: expected a preset"), "{error}");
        assert!(matches!(load(&path("kit/a.toml")), Ok(Playable::Preset(_))));
    }
}
