//! Scripts in Python beside this crate, run in an environment of their own, which they make.
//! Takes a script with its arguments; gives the JSON that it writes, or why there is none.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// What a script of the folder `python` writes into `result`, a file of the build folder.
///
/// # Errors
/// In words: Python cannot be run, or the script could not measure.
pub fn told(script: &str, result: &str, arguments: &[&str]) -> Result<Value, String> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (script, made) = (here.join("python").join(script), here.join("target/python"));
    std::fs::create_dir_all(&made).map_err(|e| e.to_string())?;
    let result = made.join(result);
    let status = Command::new("python3")
        .arg(script)
        .arg("--out")
        .arg(&result)
        .arg("--venv")
        .arg(made.join("venv"))
        .args(arguments)
        .status()
        .map_err(|e| format!("python3 cannot be run: {e}"))?;
    if !status.success() {
        return Err("the script could not measure; its message is above".to_owned());
    }
    let text = std::fs::read_to_string(&result).map_err(|e| e.to_string())?;
    serde_json::from_str(&text).map_err(|e| e.to_string())
}
