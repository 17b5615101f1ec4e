//! The longest step that the springs of a mechanism allow, and which of them asks for it.

use nalgebra::DMatrix;
use nalgebra::linalg::Schur;

use crate::Error;

use super::forces::{Pair, Plan};
use super::network::Network;

// An eigenvalue takes two or three.
const MOST_ITERATIONS: usize = 10_000;

/// The limit of the explicit midpoint step: `h w < 2` for the highest circular frequency w.
#[derive(Debug, Clone, PartialEq)]
pub struct LongestStep {
    /// Seconds; infinite without springs.
    pub seconds: f64,
    /// The element that is wound up most in the quickest motion; none without springs.
    pub element: Option<usize>,
}

/// Finds it with all gaps closed and all frictions sliding: the stiffest that the mechanism can be. Cubic parts count
/// at a wound-up angle of 0.
#[must_use]
pub fn longest_step(network: &Network) -> LongestStep {
    let plan = Plan::new(network);
    let n = plan.bodies;
    // (pair felt, pair that answers, torque per angle, element)
    let springs = plan
        .springs
        .iter()
        .map(|s| (s.pair, s.pair, s.stiffness, s.element));
    let assists = plan.assists.iter().map(|a| {
        let answers = Pair {
            a: a.on,
            b: plan.nodes() - 1,
            ca: -a.ratio,
            cb: 0.0,
        };
        (a.pair, answers, a.scale * steepest(&a.terms), a.element)
    });
    let all: Vec<_> = springs.chain(assists).collect();
    // M^-1/2 K M^-1/2; assistance makes it unsymmetric.
    let mut matrix = DMatrix::zeros(n, n);
    let root = |i: usize| plan.inertia[i].sqrt();
    for (felt, answers, stiffness, _) in &all {
        for (i, ci) in [(answers.a, answers.ca), (answers.b, answers.cb)] {
            for (j, cj) in [(felt.a, felt.ca), (felt.b, felt.cb)] {
                if i < n && j < n {
                    matrix[(i, j)] += stiffness * ci * cj / (root(i) * root(j));
                }
            }
        }
    }
    let largest = largest_eigenvalue(&matrix);
    if largest.is_infinite() {
        return LongestStep {
            seconds: 0.0,
            element: all.first().map(|(_, _, _, element)| *element),
        };
    }
    if largest <= 0.0 {
        return LongestStep {
            seconds: f64::INFINITY,
            element: None,
        };
    }
    // The quickest motion: a few powers of the matrix single it out well enough for a name.
    let mut shape = DMatrix::from_fn(n, 1, |i, _| 1.0 + i as f64 / n as f64);
    for _ in 0..200 {
        shape = &matrix * &shape;
        let size = shape.norm();
        if size == 0.0 {
            break;
        }
        shape /= size;
    }
    let nodes: Vec<f64> = (0..plan.nodes())
        .map(|i| if i < n { shape[i] / root(i) } else { 0.0 })
        .collect();
    let share = |(felt, answers, stiffness, _): &(Pair, Pair, f64, usize)| {
        (stiffness * felt.of(&nodes) * answers.of(&nodes)).abs()
    };
    let element = all
        .iter()
        .max_by(|a, b| share(a).total_cmp(&share(b)))
        .map(|(_, _, _, element)| *element);
    LongestStep {
        seconds: 2.0 / largest.sqrt(),
        element,
    }
}

/// The largest eigenvalue by size; infinite where numbers overflow.
fn largest_eigenvalue(matrix: &DMatrix<f64>) -> f64 {
    let size = matrix.norm();
    if !size.is_finite() {
        return f64::INFINITY;
    }
    if size == 0.0 {
        return 0.0;
    }
    // Scaled, so that no product overflows. The norm is a bound where the iteration does not end.
    let schur = Schur::try_new(matrix / size, f64::EPSILON, MOST_ITERATIONS);
    let values = schur.map(|schur| schur.complex_eigenvalues());
    values.map_or(size, |values| {
        size * values.iter().map(|v| v.norm()).fold(0.0, f64::max)
    })
}

/// The steepest slope of a sum of luz terms.
fn steepest(terms: &[(f64, f64)]) -> f64 {
    let at = |x: f64| -> f64 {
        terms
            .iter()
            .filter(|(_, a)| x >= *a)
            .map(|(k, _)| k)
            .sum::<f64>()
            .abs()
    };
    terms.iter().map(|(_, a)| at(*a)).fold(0.0, f64::max)
}

/// Refuses a step that the springs do not allow, naming the spring and the longest step.
pub(super) fn require_short(network: &Network, step_s: f64) -> Result<(), Error> {
    let longest = longest_step(network);
    if step_s < longest.seconds {
        return Ok(());
    }
    let element = longest.element.map_or("", |i| &network.elements()[i].name);
    Err(Error::Mechanism {
        place: element.to_owned(),
        problem: format!("a step of {step_s:.3e} s is too long for this spring and what it moves"),
        remedy: format!(
            "Step by less than {:.3e} s: give more substeps or a higher sample rate.",
            longest.seconds
        ),
    })
}
