//! `luztar._core.project`: luz, tar and their relatives over arrays.

use luztar::projections::{asymmetric, drag, luz, play, stop, tar};
use numpy::{PyReadonlyArray1, PyReadwriteArray1};
use pyo3::prelude::*;

use crate::error::CoreError;

/// One operator over arrays of one length, written into `out`. `play` and `stop` run along `x` from the state
/// `start`; what an operator does not take is ignored.
#[pyfunction]
#[pyo3(signature = (name, x, a, b, start, out))]
pub fn project(
    name: &str,
    x: PyReadonlyArray1<'_, f64>,
    a: PyReadonlyArray1<'_, f64>,
    b: PyReadonlyArray1<'_, f64>,
    start: f64,
    mut out: PyReadwriteArray1<'_, f64>,
) -> PyResult<()> {
    let (x, a, b) = (x.as_slice()?, a.as_slice()?, b.as_slice()?);
    let out = out.as_slice_mut()?;
    let mut each = |f: &dyn Fn(f64, f64, f64) -> f64| {
        for (((o, x), a), b) in out.iter_mut().zip(x).zip(a).zip(b) {
            *o = f(*x, *a, *b);
        }
    };
    match name {
        "luz" => each(&|x, a, _| luz(x, a)),
        "tar_low" => each(&|x, a, _| tar(x, a).0),
        "tar_high" => each(&|x, a, _| tar(x, a).1),
        "asymmetric" => each(&asymmetric),
        "drag" => each(&|x, c, _| drag(x, c)),
        "play" => {
            let mut y = start;
            for ((o, x), a) in out.iter_mut().zip(x).zip(a) {
                y = play(y, *x, *a);
                *o = y;
            }
        }
        "stop" => {
            let (mut s, mut last) = (start, x.first().copied().unwrap_or(0.0));
            for ((o, x), a) in out.iter_mut().zip(x).zip(a) {
                s = stop(s, x - last, *a);
                last = *x;
                *o = s;
            }
        }
        _ => {
            return Err(CoreError(luztar::Error::Unknown {
                what: "operator",
                name: name.to_owned(),
                known: "luz, tar_low, tar_high, asymmetric, drag, play, stop".to_owned(),
            })
            .into());
        }
    }
    Ok(())
}
