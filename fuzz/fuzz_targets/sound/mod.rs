//! What every reader of sound files is held to.

use libfuzzer_sys::Corpus;
use sprung::internals::files::DECODER;
use sprung::io::sound_file::read;
use std::io::{Seek, Write};
use std::sync::Once;

/// Lets decoders of others panic, whose panics are errors of the file: the fuzzer would end at each.
static LET_DECODERS_PANIC: Once = Once::new();

/// Reads these bytes as a file, if they begin as one of the readers looks for: nothing panics, and what is read is a sound.
pub fn check(bytes: &[u8], is_of_format: impl Fn(&[u8]) -> bool) -> Corpus {
    if !is_of_format(bytes) {
        return Corpus::Reject;
    }
    LET_DECODERS_PANIC.call_once(|| {
        let end = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            let is_own = panic.location().is_some_and(|place| place.file().contains("sound_file"));
            if is_own || std::thread::current().name() != Some(DECODER) {
                end(panic);
            }
        }));
    });
    let mut file = tempfile::tempfile().expect("a temporary file");
    file.write_all(bytes).and_then(|()| file.rewind()).expect("a written file");
    if let Ok(sound) = read(file, "sound") {
        assert!(sound.frames() > 0, "no frame");
        assert!(sound.check_layout("sound").is_ok(), "a layout that nothing can work on");
        assert!(sound.channels.iter().all(|channel| channel.len() == sound.frames()), "channels of different lengths");
    }
    Corpus::Keep
}
