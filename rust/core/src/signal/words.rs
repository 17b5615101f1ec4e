//! What a filter does, in words.

use super::butterworth::{Band, Butterworth, CutoffAt, Passes};

impl Butterworth {
    /// Poles, passes, slope, cut-off, phase and settling time.
    #[must_use]
    pub fn describe(&self) -> String {
        let n = self.poles();
        let poles = if n == 1 { "pole" } else { "poles" };
        let kind = match self.band() {
            Band::Low { .. } => "",
            Band::High { .. } => "high pass, ",
            Band::Pass { .. } => "band pass, ",
            Band::Stop { .. } => "band stop, ",
        };
        let two_sided = matches!(self.band(), Band::Pass { .. } | Band::Stop { .. });
        let slope = |passes: usize| {
            let slope = if two_sided {
                passes * n / 2
            } else {
                passes * n
            };
            let sides = if two_sided { " on each side" } else { "" };
            format!("{slope}-pole slope{sides}")
        };
        let asked = match self.band() {
            Band::Low { cutoff_hz } | Band::High { cutoff_hz } => vec![cutoff_hz],
            Band::Pass { low_hz, high_hz } | Band::Stop { low_hz, high_hz } => {
                vec![low_hz, high_hz]
            }
        };
        let cutoff = hertz(&asked);
        let middle = match (self.passes(), self.cutoff_at()) {
            (Passes::Forward, _) => {
                let where_ = match self.band() {
                    Band::Low { .. } | Band::Stop { .. } => "at low frequency",
                    Band::High { .. } => "at high frequency",
                    Band::Pass { .. } => "in mid-band",
                };
                let late = significant(self.delay_s());
                format!(
                    "{n} {poles} forward, {}, -3.01 dB at {cutoff}, causal, {late} s late {where_}",
                    slope(1)
                )
            }
            (Passes::ForwardBackward, CutoffAt::PerPass) => format!(
                "{n} {poles} forward and {n} backward, {}, -3.01 dB at {cutoff} per pass (-6.02 dB there overall), \
                 zero phase",
                slope(2)
            ),
            (Passes::ForwardBackward, CutoffAt::Overall) => format!(
                "{n} {poles} forward and {n} backward, {}, -3.01 dB at {cutoff} overall (designed at {}), zero phase",
                slope(2),
                hertz(&self.designed_at_hz())
            ),
        };
        format!("{kind}{middle}, settles in {:.2} s", self.settle_s())
    }
}

/// `6.000 Hz`, or `5.000 and 20.00 Hz`.
fn hertz(values: &[f64]) -> String {
    let words: Vec<String> = values.iter().map(|v| significant(*v)).collect();
    format!("{} Hz", words.join(" and "))
}

/// Four significant digits, never in powers of ten above one.
fn significant(value: f64) -> String {
    let decimals = if value > 0.0 {
        (3.0 - value.log10().floor()).clamp(0.0, 15.0)
    } else {
        0.0
    };
    format!("{value:.*}", decimals as usize)
}

#[cfg(test)]
mod tests {
    use super::{Band, Butterworth, CutoffAt, Passes};

    #[test]
    fn the_words_state_poles_passes_and_the_point_meant() {
        let band = Band::Low { cutoff_hz: 6.0 };
        let tb038 = Butterworth::new(2, band, 1000.0, Passes::ForwardBackward, CutoffAt::Overall);
        assert_eq!(
            tb038.expect("valid").describe(),
            "2 poles forward and 2 backward, 4-pole slope, -3.01 dB at 6.000 Hz overall (designed at 7.479 Hz), \
             zero phase, settles in 0.42 s"
        );
    }
}
