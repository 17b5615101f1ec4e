//! The Python module `luztar._core`: the export list. Each binding slices, detaches, calls and maps the error.
// Docstrings are Python's: they say array_like without backticks.
#![allow(missing_docs, clippy::needless_pass_by_value, clippy::doc_markdown)]

mod batches;
mod door;
mod driven;
mod dynamics;
mod effects;
mod error;
mod interruptible;
mod mechanism;
mod oracle;
mod projections;
mod regression;
mod signal;
mod stats;
mod stream;
mod vehicle;

use pyo3::prelude::*;

#[pymodule(gil_used = false)]
mod _core {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::batches::{check_lanes, lane_columns, run_lanes};
    #[pymodule_export]
    use crate::driven::{Recording, held_out, normal_equations, solve_block, whitened};
    #[pymodule_export]
    use crate::dynamics::{
        simulate_steering, steering_highest_rad_s, steering_parameters, trace_steering,
    };
    #[pymodule_export]
    use crate::effects::effect_cards;
    #[pymodule_export]
    use crate::mechanism::{Mechanism, MechanismStepper, hold_or_slide};
    #[pymodule_export]
    use crate::oracle::{sampled_cubics, solve_bodies_exactly, solve_steering_exactly};
    #[pymodule_export]
    use crate::projections::project;
    #[pymodule_export]
    use crate::regression::{
        LineSums, LinearSums, PolynomialSums, Recursive, RollingLine, RollingPolynomial, fit_line,
        fit_linear, fit_polynomial, huber, theil_sen,
    };
    #[pymodule_export]
    use crate::signal::{Butterworth, ZeroPhase, even, extremes, instruction_sets};
    #[pymodule_export]
    use crate::stats::{
        Counts, Moments, QuantileSketch, Rolling, moments_by_label, moments_by_window, rolling,
    };
    #[pymodule_export]
    use crate::stream::{Bank, Filter, FixedLag};
    #[pymodule_export]
    use crate::vehicle::{car_names, drive_cars};

    #[pymodule_init]
    fn init(m: &Bound<'_, PyModule>) -> PyResult<()> {
        m.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
