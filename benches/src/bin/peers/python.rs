//! Python packages, measured by a script of this crate in its own virtual environment. Returns their points, or the reason why they
//! are missing.

use super::precision::{MOMENTS, MOMENTUM, TIME};
use super::timing::{Measured, error};
use clebsch::{DoubleDouble, Real};
use clebsch_benches::python::run_script;
use serde_json::Value;

/// The versions as text, and the measurements.
pub fn measured() -> Result<(String, Vec<Measured>), String> {
    let read = run_script("peers.py", "peers.json", &[])?;
    parsed(&read).ok_or_else(|| "peers.json is not what the script writes".to_owned())
}

fn parsed(read: &Value) -> Option<(String, Vec<Measured>)> {
    // The reference solution belongs to this problem only.
    let problem = [numbers(&read["moments"])?, numbers(&read["body_momentum"])?];
    if problem != [MOMENTS.to_vec(), MOMENTUM.to_vec()] || read["time"].as_f64()? != TIME {
        return None;
    }
    let versions = read["versions"].as_object()?;
    let named = versions
        .iter()
        .map(|(name, v)| Some(format!("{name} {}", v.as_str()?)));
    let mut named = named.collect::<Option<Vec<_>>>()?;
    named.push(format!("Python {}", read["python"].as_str()?));
    named.push(format!("{} lanes of heyoka", read["lanes"].as_u64()?));
    let points = read["points"].as_array()?.iter().map(|point| {
        let state = numbers(&point["state"])?;
        let (attitude, momentum) = state.split_at_checked(4)?;
        let mut attitude: [f64; 4] = attitude.try_into().ok()?;
        let norm = attitude.iter().map(|x| x * x).sum::<f64>().sqrt();
        attitude = attitude.map(|x| x / norm);
        let end = (attitude, momentum.try_into().ok()?);
        Some(Measured {
            method: point["method"].as_str()?.to_owned(),
            setting: point["setting"].as_str()?.to_owned(),
            error: error(&end, DoubleDouble::from_f64(TIME)),
            micros: point["micros"].as_f64()?,
        })
    });
    let mut points = points.collect::<Option<Vec<_>>>()?;
    points.sort_by_key(|point| point.method.clone());
    Some((named.join(", "), points))
}

fn numbers(list: &Value) -> Option<Vec<f64>> {
    list.as_array()?.iter().map(Value::as_f64).collect()
}
