//! Samples as an acquisition card stores them: counts and single precision, widened to doubles on the way in.

/// A stored sample.
pub trait Sample: Copy {
    /// Its value as a double, exactly.
    fn widen(self) -> f64;
}

impl Sample for i16 {
    fn widen(self) -> f64 {
        f64::from(self)
    }
}

impl Sample for i32 {
    fn widen(self) -> f64 {
        f64::from(self)
    }
}

impl Sample for f32 {
    fn widen(self) -> f64 {
        f64::from(self)
    }
}

impl Sample for f64 {
    fn widen(self) -> f64 {
        self
    }
}

/// From counts to a physical unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Units per count.
    pub factor: f64,
    /// The value of zero counts.
    pub offset: f64,
}

impl Scale {
    /// Samples that are in their unit already.
    pub const NONE: Self = Self {
        factor: 1.0,
        offset: 0.0,
    };

    /// Writes the physical values of `x` into as many places of `out`.
    pub fn widen<T: Sample>(self, x: &[T], out: &mut [f64]) {
        for (place, v) in out.iter_mut().zip(x) {
            *place = v.widen() * self.factor + self.offset;
        }
    }
}
