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

impl From<f64> for Compensated {
    fn from(value: f64) -> Self {
        Self { value, rest: 0.0 }
    }
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

    /// The product, to about twice the digits of a double.
    pub(crate) fn times(self, other: Self) -> Self {
        let Self { value, rest } = Self::product(self.value, other.value);
        Self::sum(
            value,
            rest + (self.value * other.rest + self.rest * other.value),
        )
    }

    /// The exact product of two doubles, below the square root of the largest in magnitude.
    pub(crate) fn product(a: f64, b: f64) -> Self {
        let value = a * b;
        let ((a_high, a_low), (b_high, b_low)) = (halves(a), halves(b));
        let rest = ((a_high * b_high - value) + a_high * b_low + a_low * b_high) + a_low * b_low;
        Self { value, rest }
    }

    /// The sum, to about twice the digits of a double.
    pub(crate) fn plus(mut self, other: Self) -> Self {
        self.add_compensated(other);
        self
    }
}

impl std::ops::Neg for Compensated {
    type Output = Self;

    fn neg(self) -> Self {
        Self {
            value: -self.value,
            rest: -self.rest,
        }
    }
}

/// Two parts of 26 bits each. Source: Dekker, Numer. Math. 18 (1971) 224.
fn halves(a: f64) -> (f64, f64) {
    const SPLIT: f64 = 134_217_729.0; // 2^27 + 1
    let scaled = SPLIT * a;
    let high = scaled - (scaled - a);
    (high, a - high)
}
