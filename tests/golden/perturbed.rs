//! Checks that golden tests can fail: an engine wrong by one part in a million is noticed, and the failure explained.

use crate::bless_cases;
use crate::cases::{INIT, init};
use crate::check::{Store, bless, check, check_audio};
use crate::score::WHOLE;

/// One part in a million.
const SLIGHTLY: f64 = 1.0 + 1e-6;

/// A store in a folder of its own, with the present result of `init` accepted.
fn store(folder: &tempfile::TempDir) -> Store {
    let store = Store { accepted: folder.path().to_owned(), failures: folder.path().join("failures") };
    bless(&store, &init());
    store
}

#[test]
fn a_pitch_off_by_a_millionth_is_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let store = store(&folder);
    assert_eq!(check(&store, &init(), &[WHOLE]), Ok(()));
    let error = check(&store, &init().out_of_tune(SLIGHTLY), &[WHOLE]).unwrap_err();
    assert!(error.contains(INIT) && error.contains("first differing frame"), "{error}");
}

#[test]
fn a_level_off_by_a_millionth_is_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let store = store(&folder);
    let audio = init().render(WHOLE);
    assert_eq!(check_audio(&store, &init(), &audio), Ok(()));
    let louder = audio.map(|channel| channel.iter().map(|sample| sample * SLIGHTLY as f32).collect());
    let error = check_audio(&store, &init(), &louder).unwrap_err();
    for part in [INIT, "first differing frame", "worst error -1", "dBFS", "accept with: cargo xtask bless preset-init"]
    {
        assert!(error.contains(part), "no ‘{part}’ in: {error}");
    }
    for (file, starts) in
        [("actual.wav", b"RIFF"), ("expected.wav", b"RIFF"), ("difference.wav", b"RIFF"), ("figure.png", b"\x89PNG")]
    {
        let bytes = std::fs::read(store.failures.join(INIT).join(file)).unwrap();
        assert!(bytes.starts_with(starts), "{file}");
    }
}

#[test]
fn a_missing_digest_fails_and_a_stale_one_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let store = store(&folder);
    let mut other = init();
    other.name = "unheard-of".to_owned();
    let error = check(&store, &other, &[WHOLE]).unwrap_err();
    assert!(error.contains("there is no ") && error.contains("cargo xtask bless unheard-of"), "{error}");
    assert_eq!(store.stale(&[INIT.to_owned()].into()), Vec::<std::path::PathBuf>::new());
    assert_eq!(store.stale(&["unheard-of".to_owned()].into()).len(), 2);
}

#[test]
fn blessing_says_what_it_did_and_only_the_reference_may() {
    let folder = tempfile::tempdir().unwrap();
    let store = store(&folder);
    let said = bless_cases(&store, &[init()], INIT);
    let unknown = bless_cases(&store, &[init()], "preset-int");
    if cfg!(debug_assertions) {
        assert_eq!(said, "blessed 1 cases; run again to verify");
        assert_eq!(unknown, "there is no golden case ‘preset-int’; there are: preset-init");
    } else {
        assert_eq!((said.clone(), unknown), (said.clone(), said.clone()));
        assert!(said.contains("without --release"), "{said}");
    }
}
