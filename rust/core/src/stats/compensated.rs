//! Sums and means that carry the part lost to rounding.

/// A number as a rounded value and the small remainder it lacks.
///
/// Source: Knuth, "The Art of Computer Programming", vol. 2, section 4.2.2, theorem B (two-sum); Neumaier,
/// Z. angew. Math. Mech. 54 (1974) 39, the running compensation.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Compensated {
    pub(crate) value: f64,
    pub(crate) rest: f64,
}

impl Compensated {
    /// The exact sum of two doubles.
    pub(crate) fn sum(a: f64, b: f64) -> Self {
        let value = a + b;
        let b_part = value - a;
        let rest = (a - (value - b_part)) + (b - b_part);
        Self { value, rest }
    }

    /// Adds a double; only the remainder rounds.
    pub(crate) fn add(&mut self, term: f64) {
        let Self { value, rest } = Self::sum(self.value, term);
        *self = Self::sum(value, self.rest + rest);
    }

    /// Adds another compensated number.
    pub(crate) fn add_compensated(&mut self, other: Self) {
        self.add(other.value);
        self.add(other.rest);
    }

    /// The difference, rounded once the leading parts have cancelled.
    pub(crate) fn minus(self, other: Self) -> f64 {
        let leading = Self::sum(self.value, -other.value);
        leading.value + (leading.rest + (self.rest - other.rest))
    }
}
