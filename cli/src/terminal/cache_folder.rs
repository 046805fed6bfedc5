//! The folder of the cache: `CLEBSCH_CACHE`, or a folder next to the other caches of the user. Takes the variables of the
//! process; gives the cache, which is empty if no folder is known.

use clebsch_interpret::Cache;
use std::ffi::OsString;
use std::path::PathBuf;

/// The variable with the folder of the cache.
const VARIABLE: &str = "CLEBSCH_CACHE";

/// The value of the variable without a cache. A folder of this name is `./off`.
const OFF: &str = "off";

/// The cache of the user who runs this process.
#[must_use]
pub fn cache_of_process() -> Cache {
    match folder(&|name| std::env::var_os(name)) {
        Some(folder) => Cache::in_folder(folder),
        None => Cache::none(),
    }
}

/// The folder that these variables choose.
fn folder(variable: &dyn Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let path = |name: &str| {
        let found = variable(name).filter(|value| !value.is_empty());
        found.map(PathBuf::from)
    };
    if let Some(own) = path(VARIABLE) {
        return Some(own).filter(|own| own.as_os_str() != OFF);
    }
    // By the conventions of each system, a relative path is not valid.
    let whole = |name: &str| path(name).filter(|path| path.is_absolute());
    let home = |below: &str| whole("HOME").map(|home| home.join(below));
    let caches = if cfg!(windows) {
        whole("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        home("Library/Caches")
    } else {
        whole("XDG_CACHE_HOME").or_else(|| home(".cache"))
    };
    Some(caches?.join("clebsch"))
}

#[cfg(all(test, unix, not(target_os = "macos")))]
mod tests {
    use super::folder;
    use std::path::Path;

    #[test]
    fn the_variable_comes_first_and_off_means_none() {
        let of = |set: &[(&str, &str)]| {
            let own = |name: &str| {
                let found = set.iter().find(|(own, _)| *own == name);
                found.map(|(_, value)| (*value).into())
            };
            folder(&own)
        };
        let home = ("HOME", "/home/me");
        let expected = [
            (vec![home], Some("/home/me/.cache/clebsch")),
            (vec![home, ("XDG_CACHE_HOME", "/x")], Some("/x/clebsch")),
            (
                vec![home, ("XDG_CACHE_HOME", "x")],
                Some("/home/me/.cache/clebsch"),
            ),
            (vec![home, ("CLEBSCH_CACHE", "own")], Some("own")),
            (vec![home, ("CLEBSCH_CACHE", "./off")], Some("./off")),
            (vec![home, ("CLEBSCH_CACHE", "off")], None),
            (
                vec![home, ("CLEBSCH_CACHE", "")],
                Some("/home/me/.cache/clebsch"),
            ),
            (vec![], None),
        ];
        for (set, wanted) in expected {
            assert_eq!(of(&set).as_deref(), wanted.map(Path::new), "{set:?}");
        }
    }
}
