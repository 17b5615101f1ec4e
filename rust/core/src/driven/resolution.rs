//! The smallest change of position that the sensor can show.

/// How finely a position channel resolves motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resolution {
    /// The smallest change it can show, in the channel's unit.
    pub step: f64,
    /// Whether the channel moves in equal steps (an encoder) rather than under noise.
    pub quantised: bool,
}

impl Resolution {
    /// Reads the resolution off a record and its smoothed version.
    ///
    /// An encoder leaves differences that are whole steps, the smallest of them larger than what smoothing removes;
    /// any other sensor is described by the step that would leave the same residual, `sqrt(12)` standard deviations.
    pub fn of(position: &[f64], smooth: &[f64]) -> Self {
        let range = span(position);
        // Decimal files leave differences that are zero but for the conversion to radians.
        let noise_of_conversion = 1e-9 * range;
        let smallest = position
            .windows(2)
            .map(|p| (p[1] - p[0]).abs())
            .filter(|d| *d > noise_of_conversion)
            .fold(f64::INFINITY, f64::min);
        let squares: f64 = position
            .iter()
            .zip(smooth)
            .map(|(x, s)| (x - s).powi(2))
            .sum();
        let residual = (squares / position.len() as f64).sqrt();
        // A step s leaves a residual of s / sqrt(12) = 0.29 s while it moves and less at rest.
        if smallest.is_finite() && smallest >= 2.0 * residual {
            Self {
                step: smallest,
                quantised: true,
            }
        } else {
            Self {
                step: (12.0_f64.sqrt() * residual).max(noise_of_conversion),
                quantised: false,
            }
        }
    }
}

/// Highest minus lowest value.
pub fn span(values: &[f64]) -> f64 {
    let (low, high) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
            (l.min(*v), h.max(*v))
        });
    high - low
}

#[cfg(test)]
mod tests {
    use super::Resolution;

    #[test]
    fn an_encoder_step_is_found_exactly() {
        let smooth: Vec<f64> = (0..5000)
            .map(|i| 0.8 * (f64::from(i) * 1e-3).sin())
            .collect();
        let raw: Vec<f64> = smooth
            .iter()
            .map(|x| (x / 3.5e-4).round() * 3.5e-4)
            .collect();
        let found = Resolution::of(&raw, &smooth);
        assert!(found.quantised);
        assert!((found.step - 3.5e-4).abs() < 1e-12, "{}", found.step);
    }

    #[test]
    fn a_noisy_sensor_is_described_by_its_noise() {
        let smooth: Vec<f64> = (0..5000)
            .map(|i| 0.8 * (f64::from(i) * 1e-3).sin())
            .collect();
        // an irrational rotation: evenly spread over +-1e-3 without being a multiple of anything
        let raw: Vec<f64> = smooth
            .iter()
            .enumerate()
            .map(|(i, x)| x + 1e-3 * (2.0 * (i as f64 * 0.618_033_988_749_895).fract() - 1.0))
            .collect();
        let found = Resolution::of(&raw, &smooth);
        assert!(!found.quantised);
        // an even spread over 2e-3 is what a step of 2e-3 leaves; 5000 points give it to 1 %
        assert!((found.step - 2e-3).abs() < 2e-5, "{}", found.step);
    }
}
