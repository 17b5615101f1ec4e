//! The number a law is written for: one `f64` in a driven run, several side by side in a batch.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// The arithmetic that laws may use; selects instead of branches, so that lanes need no special case.
pub trait Lane:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The same constant in every lane.
    fn splat(value: f64) -> Self;
    /// Absolute value.
    #[must_use]
    fn abs(self) -> Self;
    /// Exponential function.
    #[must_use]
    fn exp(self) -> Self;
    /// Exponential function less 1, exact for small arguments too.
    #[must_use]
    fn exp_m1(self) -> Self;
    /// Sine, argument in radians.
    #[must_use]
    fn sin(self) -> Self;
    /// Cosine, argument in radians.
    #[must_use]
    fn cos(self) -> Self;
    /// The value kept inside `[low, high]`.
    #[must_use]
    fn clamp(self, low: Self, high: Self) -> Self;
}

impl Lane for f64 {
    fn splat(value: f64) -> Self {
        value
    }
    fn abs(self) -> Self {
        self.abs()
    }
    fn exp(self) -> Self {
        self.exp()
    }
    fn exp_m1(self) -> Self {
        self.exp_m1()
    }
    fn sin(self) -> Self {
        self.sin()
    }
    fn cos(self) -> Self {
        self.cos()
    }
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }
}
