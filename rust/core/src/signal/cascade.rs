//! The arithmetic of a low-pass cascade: sections in state-variable form, all of them in one loop over the samples.
//!
//! A second-order section carries the low-pass integrator `low` and the band-pass integrator `band` of the trapezoidal
//! state-variable filter with `g = tan(pi fc / fs)` and damping `k`. Everything is an increment that vanishes with
//! `x - low`, so a constant passes unchanged bit for bit, whatever the rounding of the coefficients.
//!
//! Source: Zavalishin, "The Art of VA Filter Design", chapters 3 and 4 (trapezoidal integrators
//! without unit delay in the loop), solved for the increments.

/// Room for twelve poles.
pub(super) const MAX_PAIRS: usize = 6;

/// A pair of complex poles.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Pair {
    /// `2 g / (1 + g (g + k))`: error to band, and band to low.
    cross: f64,
    /// `2 g^2 / (1 + g (g + k))`: error to low.
    direct: f64,
    /// `2 g (g + k) / (1 + g (g + k))`: what band loses.
    loss: f64,
    /// Band per unit slope of a steady ramp, `1 / (2 g)` in samples.
    band_per_slope: f64,
    /// `x - low` per unit slope of a steady ramp, `(g + k) / (2 g)` in samples.
    error_per_slope: f64,
}

impl Pair {
    /// The section of `1 / (s^2 + k s + 1)` at the pre-warped frequency `g`.
    pub(super) fn new(g: f64, k: f64) -> Self {
        let scale = 2.0 * g / (1.0 + g * (g + k));
        Self {
            cross: scale,
            direct: scale * g,
            loss: scale * (g + k),
            band_per_slope: 0.5 / g,
            error_per_slope: 0.5 * (g + k) / g,
        }
    }
}

/// One real pole.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Single {
    /// `2 g / (1 + g)`: error to low.
    direct: f64,
    /// `x - low` per unit slope of a steady ramp, `(1 + g) / (2 g)` in samples.
    error_per_slope: f64,
}

impl Single {
    /// The section of `1 / (s + 1)` at the pre-warped frequency `g`.
    pub(super) fn new(g: f64) -> Self {
        Self {
            direct: 2.0 * g / (1.0 + g),
            error_per_slope: 0.5 * (1.0 + g) / g,
        }
    }
}

/// The coefficients: a real pole if the number of poles is odd, then the pairs from the most damped to the least.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cascade {
    pub(super) single: Option<Single>,
    pub(super) pairs: [Pair; MAX_PAIRS],
    pub(super) n_pairs: usize,
}

/// The memory of a cascade, apart from its coefficients.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct State {
    pub(super) single: f64,
    /// `[band, low]` of each pair.
    pub(super) pairs: [[f64; 2]; MAX_PAIRS],
}

impl Cascade {
    /// The state in which the next sample, `value`, continues a ramp that has risen by `slope` per sample forever.
    pub(super) fn steady(&self, value: f64, slope: f64) -> State {
        let mut state = State::default();
        let mut input = value;
        if let Some(single) = self.single {
            state.single = input - single.error_per_slope * slope;
            input = state.single + 0.5 * slope;
        }
        for (pair, memory) in self.pairs.iter().zip(&mut state.pairs).take(self.n_pairs) {
            let low = input - pair.error_per_slope * slope;
            *memory = [pair.band_per_slope * slope, low];
            input = low + 0.5 * slope;
        }
        state
    }

    /// How far the output of a steady ramp lags behind its input, in samples.
    pub(super) fn lag(&self) -> f64 {
        let single = self.single.map_or(0.0, |s| s.error_per_slope - 0.5);
        let pairs = self.pairs.iter().take(self.n_pairs);
        single + pairs.map(|p| p.error_per_slope - 0.5).sum::<f64>()
    }

    /// Filters each first member into the second, in the order given; `finish` is applied on the way out.
    pub(super) fn run<'a>(
        &self,
        state: &mut State,
        samples: impl Iterator<Item = (f64, &'a mut f64)>,
        finish: impl Fn(f64) -> f64,
    ) {
        match (self.n_pairs, self.single.is_some()) {
            (0, _) => self.run_fixed::<0, true>(state, samples, finish),
            (1, false) => self.run_fixed::<1, false>(state, samples, finish),
            (1, true) => self.run_fixed::<1, true>(state, samples, finish),
            (2, false) => self.run_fixed::<2, false>(state, samples, finish),
            (2, true) => self.run_fixed::<2, true>(state, samples, finish),
            (3, false) => self.run_fixed::<3, false>(state, samples, finish),
            (3, true) => self.run_fixed::<3, true>(state, samples, finish),
            (4, false) => self.run_fixed::<4, false>(state, samples, finish),
            (4, true) => self.run_fixed::<4, true>(state, samples, finish),
            (5, false) => self.run_fixed::<5, false>(state, samples, finish),
            (5, true) => self.run_fixed::<5, true>(state, samples, finish),
            (_, _) => self.run_fixed::<6, false>(state, samples, finish),
        }
    }

    /// [`Self::run`] with the number of sections known to the compiler, so that the state stays in registers.
    fn run_fixed<'a, const PAIRS: usize, const SINGLE: bool>(
        &self,
        state: &mut State,
        samples: impl Iterator<Item = (f64, &'a mut f64)>,
        finish: impl Fn(f64) -> f64,
    ) {
        let pairs: [Pair; PAIRS] = std::array::from_fn(|i| self.pairs[i]);
        let single = self.single.unwrap_or_default();
        let mut memory: [[f64; 2]; PAIRS] = std::array::from_fn(|i| state.pairs[i]);
        let mut single_low = state.single;
        for (x, out) in samples {
            let mut signal = x;
            if SINGLE {
                let step = single.direct * (signal - single_low);
                signal = single_low + 0.5 * step;
                single_low += step;
            }
            for (pair, [band, low]) in pairs.iter().zip(&mut memory) {
                let error = signal - *low;
                let next = (*low + pair.cross * *band) + pair.direct * error;
                *band = (*band - pair.loss * *band) + pair.cross * error;
                signal = 0.5 * (*low + next);
                *low = next;
            }
            *out = finish(signal);
        }
        state.single = single_low;
        state.pairs[..PAIRS].copy_from_slice(&memory);
    }
}
