//! Coloured noise made white: a lead filter that takes a slow wander down to the level of the quick noise.
//!
//! Least squares weigh all frequencies alike. Where the noise wanders, what is slow is known worse than what is quick;
//! after this filter, applied to measurement and model alike, it is known as well.

/// `(s + zero) / (s + pole)`, made discrete by the bilinear transform: gain 1 for what is quick, `zero / pole` for what
/// is slow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Whitening {
    here: f64,
    before: f64,
    back: f64,
    slow_gain: f64,
}

impl Whitening {
    /// Of a noise whose power falls from `zero_hz` on and is flat from `pole_hz` on.
    #[must_use]
    pub fn new(zero_hz: f64, pole_hz: f64, step_s: f64) -> Self {
        let quick = 2.0 / step_s;
        let (zero, pole) = (
            std::f64::consts::TAU * zero_hz,
            std::f64::consts::TAU * pole_hz,
        );
        Self {
            here: (quick + zero) / (quick + pole),
            before: (zero - quick) / (quick + pole),
            back: (quick - pole) / (quick + pole),
            slow_gain: zero / pole,
        }
    }

    /// Filters a series in place, as if its first value had stood for ever.
    pub fn apply(&self, series: &mut [f64]) {
        let Some(first) = series.first() else { return };
        let (mut x_before, mut y_before) = (*first, self.slow_gain * first);
        for value in series {
            let y = self.here * *value + self.before * x_before + self.back * y_before;
            x_before = *value;
            y_before = y;
            *value = y;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Whitening;

    #[test]
    fn its_gain_is_that_of_the_lead_at_every_frequency() {
        let (zero_hz, pole_hz, step_s) = (0.3, 3.0, 0.002);
        let filter = Whitening::new(zero_hz, pole_hz, step_s);
        for hz in [0.1, 0.5, 2.0, 6.0] {
            let mut series: Vec<f64> = (0..20_000)
                .map(|i| (std::f64::consts::TAU * hz * f64::from(i) * step_s).sin())
                .collect();
            filter.apply(&mut series);
            let late = &series[10_000..];
            let gain = (2.0 * late.iter().map(|y| y * y).sum::<f64>() / late.len() as f64).sqrt();
            let expected = ((hz * hz + zero_hz * zero_hz) / (hz * hz + pole_hz * pole_hz)).sqrt();
            // At 6 Hz the bilinear transform bends the frequency by (pi hz step)^2 / 3 = 5e-4; whole periods but one.
            assert!(
                (gain / expected - 1.0).abs() < 2e-3,
                "{hz}: {gain} {expected}"
            );
        }
    }

    #[test]
    fn what_stands_stays() {
        let mut series = [2.0; 5];
        Whitening::new(1.0, 4.0, 0.02).apply(&mut series);
        // five roundings
        assert!(series.iter().all(|y| (y - 0.5).abs() < 1e-15), "{series:?}");
    }
}
