//! Arithmetic in about twice the precision of a double, on packs of numbers.
//!
//! Source: Dekker, Numer. Math. 18 (1971) 224; Knuth, "The Art of Computer Programming", vol. 2, section 4.2.2.

use crate::stats::compensated::Compensated;
use crate::stats::simd::{PACK, Pack};

/// Values and the small remainders they lack.
#[derive(Clone, Copy)]
pub(super) struct Twofold<P> {
    value: P,
    rest: P,
}

impl<P: Pack> Twofold<P> {
    /// The same number in every lane.
    #[inline(always)]
    pub(super) fn splat(v: Compensated) -> Self {
        Self {
            value: P::splat(v.value),
            rest: P::splat(v.rest),
        }
    }

    /// Doubles as they are.
    #[inline(always)]
    pub(super) fn from(value: P) -> Self {
        Self {
            value,
            rest: P::splat(0.0),
        }
    }

    /// The exact difference of doubles.
    #[inline(always)]
    pub(super) fn difference(a: P, b: P) -> Self {
        let value = a.sub(b);
        let b_part = value.sub(a);
        let rest = a.sub(value.sub(b_part)).sub(b.add(b_part));
        Self { value, rest }
    }

    /// The sum; its error is measured by the larger term.
    #[inline(always)]
    pub(super) fn plus(self, other: Self) -> Self {
        let value = self.value.add(other.value);
        let b_part = value.sub(self.value);
        let lost = self
            .value
            .sub(value.sub(b_part))
            .add(other.value.sub(b_part));
        quick(value, lost.add(self.rest.add(other.rest)))
    }

    /// The difference.
    #[inline(always)]
    pub(super) fn minus(self, other: Self) -> Self {
        let zero = P::splat(0.0);
        self.plus(Self {
            value: zero.sub(other.value),
            rest: zero.sub(other.rest),
        })
    }

    /// The product.
    #[inline(always)]
    pub(super) fn times(self, other: Self) -> Self {
        let value = self.value.mul(other.value);
        let ((a, a_low), (b, b_low)) = (halves(self.value), halves(other.value));
        let lost = a
            .mul(b)
            .sub(value)
            .add(a.mul(b_low))
            .add(a_low.mul(b))
            .add(a_low.mul(b_low));
        let cross = self.value.mul(other.rest).add(self.rest.mul(other.value));
        quick(value, lost.add(cross))
    }

    /// The sum of the lanes.
    #[inline(always)]
    pub(super) fn total(self) -> Compensated {
        let (values, rests) = (self.value.lanes(), self.rest.lanes());
        let mut total = Compensated::default();
        for i in 0..PACK {
            total.add(values[i]);
            total.add(rests[i]);
        }
        total
    }
}

/// A value and a remainder far smaller, brought into line.
#[inline(always)]
fn quick<P: Pack>(value: P, rest: P) -> Twofold<P> {
    let sum = value.add(rest);
    Twofold {
        value: sum,
        rest: rest.sub(sum.sub(value)),
    }
}

/// Two parts of 26 bits each.
#[inline(always)]
fn halves<P: Pack>(a: P) -> (P, P) {
    let scaled = P::splat(134_217_729.0).mul(a); // 2^27 + 1
    let high = scaled.sub(scaled.sub(a));
    (high, a.sub(high))
}
