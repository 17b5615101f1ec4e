//! The Python module `luztar._core`: the export list. Each binding slices, detaches, calls and maps the error.
#![allow(missing_docs, clippy::needless_pass_by_value)]

mod driven;
mod dynamics;
mod effects;
mod error;
mod projections;
mod regression;
mod signal;
mod stats;

use pyo3::prelude::*;

#[pymodule(gil_used = false)]
mod _core {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::driven::{Recording, held_out, normal_equations, solve_block};
    #[pymodule_export]
    use crate::dynamics::{simulate_steering, steering_parameters, trace_steering};
    #[pymodule_export]
    use crate::effects::effect_cards;
    #[pymodule_export]
    use crate::projections::project;
    #[pymodule_export]
    use crate::regression::{LineSums, fit_line};
    #[pymodule_export]
    use crate::signal::{Filter, LowPass, zero_phase};
    #[pymodule_export]
    use crate::stats::Moments;

    #[pymodule_init]
    fn init(m: &Bound<'_, PyModule>) -> PyResult<()> {
        m.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
