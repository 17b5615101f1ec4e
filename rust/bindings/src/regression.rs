//! Least squares.

mod line;
mod linear;
mod polynomial;
mod recursive;
mod robust;

use numpy::PyReadonlyArray1;
use pyo3::PyResult;

pub use line::{LineSums, RollingLine, fit_line};
pub use linear::{LinearSums, fit_linear};
pub use polynomial::{PolynomialSums, RollingPolynomial, fit_polynomial};
pub use recursive::Recursive;
pub use robust::{huber, theil_sen};

/// All there is to store of a stream: whole numbers, then floats.
type State = (Vec<u64>, Vec<f64>);

fn optional<'a>(array: Option<&'a PyReadonlyArray1<'_, f64>>) -> PyResult<Option<&'a [f64]>> {
    Ok(array.map(|a| a.as_slice()).transpose()?)
}
