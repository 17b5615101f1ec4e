//! What the sums of a stream say: mean, deviations, shape.

use super::spread::Spread;

/// Below this variance the fourth powers of the deviations run out of exponents.
const LEAST_VARIANCE: f64 = 1e-150;

/// Mean, deviations and shape of the samples kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figures {
    pub(super) spread: Spread,
    pub(super) shape: bool,
}

impl Figures {
    /// How many samples.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.spread.count
    }

    /// The sum of squared deviations from the mean.
    #[must_use]
    pub fn sum_of_squares(&self) -> f64 {
        self.spread.sum_of_squares()
    }

    /// The mean; None of nothing.
    #[must_use]
    pub fn mean(&self) -> Option<f64> {
        (self.count() > 0).then_some(self.spread.mean.value)
    }

    /// The mean squared deviation, divided by `n`; None of nothing.
    #[must_use]
    pub fn variance_population(&self) -> Option<f64> {
        (self.count() > 0).then(|| self.sum_of_squares() / self.count() as f64)
    }

    /// The estimated variance, divided by `n - 1`; None below two samples.
    #[must_use]
    pub fn variance_sample(&self) -> Option<f64> {
        (self.count() > 1).then(|| self.sum_of_squares() / (self.count() - 1) as f64)
    }

    /// The population standard deviation (TB 038); None of nothing.
    #[must_use]
    pub fn std_population(&self) -> Option<f64> {
        self.variance_population().map(f64::sqrt)
    }

    /// The sample standard deviation; None below two samples.
    #[must_use]
    pub fn std_sample(&self) -> Option<f64> {
        self.variance_sample().map(f64::sqrt)
    }

    /// The root of the mean square; None of nothing.
    #[must_use]
    pub fn rms(&self) -> Option<f64> {
        let variance = self.variance_population()?;
        Some(self.spread.mean.value.hypot(variance.sqrt()))
    }

    /// The population skewness `m3 / m2^1.5`; None if not asked for or of a deviation below 1e-75.
    #[must_use]
    pub fn skew(&self) -> Option<f64> {
        let variance = self.varying()?;
        let third = self.spread.cubes.value / self.count() as f64;
        Some(third / variance / variance.sqrt())
    }

    /// The population excess kurtosis `m4 / m2^2 - 3`; None as for [`Self::skew`].
    #[must_use]
    pub fn excess_kurtosis(&self) -> Option<f64> {
        let variance = self.varying()?;
        let fourth = self.spread.fourths.value / self.count() as f64;
        Some(fourth / variance / variance - 3.0)
    }

    fn varying(&self) -> Option<f64> {
        self.variance_population()
            .filter(|v| self.shape && *v > LEAST_VARIANCE)
    }
}
