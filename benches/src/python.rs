//! Runs Python scripts of this crate in a virtual environment that they create. Returns the JSON output of a script, or an error
//! message.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// Runs a script of the folder `python` and returns the content of `result`, a file in the build folder.
///
/// # Errors
/// A message if Python cannot run or the script failed to measure.
pub fn run_script(script: &str, result: &str, arguments: &[&str]) -> Result<Value, String> {
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
