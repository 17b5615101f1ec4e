//! A whole cascade as one linear system: `y = c s + d x`, then `s += e s + b x`.

use super::matrix::{MAX_POLES, Matrix, Vector, ZERO, apply, solve};
use super::section::Section;

/// The system of a cascade of sections, in the basis of their integrators.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateSpace {
    /// How many states.
    pub n: usize,
    /// The matrix less the identity.
    pub e: Matrix,
    /// Input to states.
    pub b: Vector,
    /// States to output.
    pub c: Vector,
    /// Input to output.
    pub d: f64,
}

impl StateSpace {
    /// The sections one after the other, at most twelve poles in all.
    pub fn new(sections: &[Section]) -> Self {
        let mut whole = Self {
            n: 0,
            e: ZERO,
            b: [0.0; MAX_POLES],
            c: [0.0; MAX_POLES],
            d: 1.0,
        };
        for section in sections {
            whole.append(section);
        }
        whole
    }

    /// Feeds the output so far into one more section.
    fn append(&mut self, section: &Section) {
        let (part, n) = (section.solved(), self.n);
        for i in 0..part.states {
            for j in 0..n {
                self.e[n + i][j] = part.b[i] * self.c[j];
            }
            self.e[n + i][n..n + part.states].copy_from_slice(&part.e[i][..part.states]);
            self.b[n + i] = part.b[i] * self.d;
        }
        for c in &mut self.c[..n] {
            *c *= part.d;
        }
        self.c[n..n + part.states].copy_from_slice(&part.c[..part.states]);
        self.d *= part.d;
        self.n += part.states;
    }

    /// One sample: what comes out; the state moves on.
    pub fn step(&self, s: &mut Vector, x: f64) -> f64 {
        let y = self.output(s, x);
        self.advance(s, x);
        y
    }

    /// One sample whose output is not wanted.
    pub fn advance(&self, s: &mut Vector, x: f64) {
        let increments = apply(self.n, &self.e, s);
        for (s, (increment, b)) in s.iter_mut().zip(increments.iter().zip(&self.b)) {
            *s += increment + b * x;
        }
    }

    /// What comes out for the next sample `x`.
    pub fn output(&self, s: &Vector, x: f64) -> f64 {
        self.c.iter().zip(s).map(|(c, s)| c * s).sum::<f64>() + self.d * x
    }

    /// The states per unit of a constant input, and those a unit slope per sample falls short of it.
    pub fn steady(&self) -> Steady {
        let level = solve(self.n, &self.e, &self.b).map(|v| -v);
        let lag = solve(self.n, &self.e, &level).map(|v| -v);
        Steady { level, lag }
    }
}

/// Where the states rest under an input that has been a ramp forever.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steady {
    /// Per unit of the next sample.
    level: Vector,
    /// Less, per unit of slope per sample.
    lag: Vector,
}

impl Steady {
    /// The state in which the next sample, `value`, continues a ramp that has risen by `slope` per sample forever.
    pub fn at(&self, value: f64, slope: f64) -> Vector {
        std::array::from_fn(|i| self.level[i] * value - self.lag[i] * slope)
    }
}
