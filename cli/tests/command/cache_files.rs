//! The files of the cache of derivations: whole files of this build only, within the limits, whatever other processes do.

use crate::common::Folder;
use clebsch_interpret::cache::{Cache, Key, Limits};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

const KEY: Key<'static> = Key {
    kind: "kind",
    choice: "choice",
    text: "model M { }",
};

/// The files of a cache, sorted by name.
pub fn files(cache: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(cache).into_iter().flatten().flatten();
    let mut all: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    all.sort();
    all
}

#[test]
fn damaged_files_are_ignored_and_replaced() {
    let folder = Folder::new("cached-damage");
    let path = folder.path("cache");
    let cache = Cache::in_folder(&path);
    cache.put(&KEY, "the data\n");
    let file = cache.file(&KEY).expect("a file");
    let whole = fs::read(&file).expect("read");
    let get = |bytes: &[u8]| {
        fs::write(&file, bytes).expect("written");
        cache.get(&KEY)
    };
    assert_eq!(get(&whole).as_deref(), Some("the data\n"));
    for length in 0..whole.len() {
        assert_eq!(get(&whole[..length]), None, "{length} bytes");
    }
    for i in 0..whole.len() {
        for bit in 0..8 {
            let mut bytes = whole.clone();
            bytes[i] ^= 1 << bit;
            assert_eq!(get(&bytes), None, "bit {bit} of byte {i}");
        }
    }
    assert_eq!(get(&[&whole[..], b"0"].concat()), None);
    cache.put(&KEY, "other data");
    assert_eq!(cache.get(&KEY).as_deref(), Some("other data"));
    assert_eq!(files(&path), [file]);
}

/// The bytes of a file, with one of its texts replaced and a valid checksum.
pub fn edited(bytes: &[u8], from: &str, to: &str) -> Vec<u8> {
    let body = String::from_utf8(bytes[..bytes.len() - 8].to_vec()).expect("UTF-8");
    let text = |own: &str| format!("{}\n{own}\n", own.len());
    assert!(body.contains(&text(from)), "{from}");
    let mut body = body.replace(&text(from), &text(to)).into_bytes();
    let checksum = format!("{:08x}", crc32fast::hash(&body));
    body.extend(checksum.as_bytes());
    body
}

#[test]
fn a_file_of_another_version_or_key_is_ignored() {
    let folder = Folder::new("cached-others");
    let cache = Cache::in_folder(folder.path("cache"));
    cache.put(&KEY, "the data");
    let file = cache.file(&KEY).expect("a file");
    let whole = fs::read(&file).expect("read");
    let text = String::from_utf8(whole.clone()).expect("UTF-8");
    let build = text.lines().nth(1).expect("the build");
    assert!(
        build.starts_with(concat!("clebsch ", env!("CARGO_PKG_VERSION"), " ")),
        "{build}"
    );
    let sources = build.rsplit(' ').next().expect("a hash");
    assert!(
        sources.len() == 32 && sources.bytes().all(|b| b.is_ascii_hexdigit()),
        "{build}"
    );
    let other = build.replace(sources, &"0".repeat(32));
    // As if two keys had one hash.
    for (from, to) in [
        (build, other.as_str()),
        (build, "clebsch 0.0.0 "),
        ("kind", "other"),
        ("choice", "other"),
        (KEY.text, "model N { }"),
    ] {
        fs::write(&file, edited(&whole, from, to)).expect("written");
        assert_eq!(cache.get(&KEY), None, "{from}");
    }
    fs::write(&file, edited(&whole, "the data", "other data")).expect("written");
    assert_eq!(cache.get(&KEY).as_deref(), Some("other data"));
}

#[test]
fn each_part_of_the_key_has_its_own_file() {
    let folder = Folder::new("cached-keys");
    let cache = Cache::in_folder(folder.path("cache"));
    let keys = [
        KEY,
        Key {
            kind: "other",
            ..KEY
        },
        Key {
            choice: "other",
            ..KEY
        },
        Key {
            text: "other",
            ..KEY
        },
        // The limits between the parts matter.
        Key {
            kind: "kindc",
            choice: "hoice",
            ..KEY
        },
    ];
    for key in &keys {
        cache.put(key, &format!("{key:?}"));
    }
    for key in &keys {
        assert_eq!(cache.get(key), Some(format!("{key:?}")));
    }
}

/// A key with this number as text.
fn numbered(text: &str) -> Key<'_> {
    Key { text, ..KEY }
}

#[test]
fn the_files_used_least_recently_are_removed_first() {
    let folder = Folder::new("cached-bound");
    let path = folder.path("cache");
    let limits = Limits {
        files: 3,
        bytes: 1 << 20,
    };
    let cache = Cache::in_folder(&path).with_limits(limits);
    let age = |text: &str, seconds: u64| {
        let file = cache.file(&numbered(text)).expect("a file");
        let then = SystemTime::now() - Duration::from_secs(seconds);
        let file = File::options().append(true).open(file).expect("opens");
        file.set_modified(then).expect("set");
    };
    let held =
        || ["0", "1", "2", "3"].map(|text| cache.file(&numbered(text)).is_some_and(|f| f.exists()));
    for (text, seconds) in [("0", 300), ("1", 200), ("2", 100)] {
        cache.put(&numbered(text), "data");
        age(text, seconds);
    }
    assert_eq!(held(), [true, true, true, false]);
    // The oldest file is used again.
    assert!(cache.get(&numbered("0")).is_some());
    let foreign = Path::new(&path).join("notes.txt");
    fs::write(&foreign, "not of the cache").expect("written");
    let remains = Path::new(&path).join("0-1-2.partial");
    fs::write(&remains, "of a killed process").expect("written");
    cache.put(&numbered("3"), "data");
    assert_eq!(held(), [true, false, true, true]);
    assert!(foreign.exists() && remains.exists());
    let file = File::options().append(true).open(&remains).expect("opens");
    let then = SystemTime::now() - Duration::from_secs(7200);
    file.set_modified(then).expect("set");
    // By bytes: the newest file alone fits.
    let small = cache.clone().with_limits(Limits {
        files: 3,
        bytes: 2150,
    });
    small.put(&numbered("1"), &"x".repeat(2000));
    assert_eq!(held(), [false, true, false, false]);
    assert!(foreign.exists() && !remains.exists());
}

#[test]
fn data_that_is_too_long_is_not_stored() {
    let folder = Folder::new("cached-long");
    let path = folder.path("cache");
    let cache = Cache::in_folder(&path);
    cache.put(&KEY, &"x".repeat(9 << 20));
    assert!(files(&path).is_empty());
}

#[test]
fn threads_read_whole_files_while_others_write() {
    let folder = Folder::new("cached-together");
    let path = folder.path("cache");
    let cache = Cache::in_folder(&path);
    let texts = ["a", "b"].map(|letter| letter.repeat(100_000));
    cache.put(&KEY, &texts[0]);
    std::thread::scope(|scope| {
        for text in &texts {
            let cache = cache.clone();
            scope.spawn(move || (0..100).for_each(|_| cache.put(&KEY, text)));
        }
        for _ in 0..200 {
            let found = cache.get(&KEY).expect("a whole file");
            assert!(texts.contains(&found), "{} bytes", found.len());
        }
    });
    assert_eq!(files(&path), [cache.file(&KEY).expect("a file")]);
}
